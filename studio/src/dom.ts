// Elements of the page. Text only ever becomes text: no name of a file and no label is read as markup.

export type Child = Node | string | null | undefined | false;
type Handler = (event: never) => void;
export type Attributes = Record<string, string | number | boolean | null | undefined | Handler>;

function fill<T extends Element>(node: T, attributes: Attributes, children: Child[]): T {
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") {
      node.addEventListener(name.replace(/^on/, ""), value as EventListener);
    } else if (value === true) {
      node.setAttribute(name, "");
    } else if (value !== false && value !== null && value !== undefined) {
      node.setAttribute(name, String(value));
    }
  }
  for (const child of children) {
    if (child) node.append(child);
  }
  return node;
}

/** An HTML element. */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  return fill(document.createElement(tag), attributes, children);
}

/** An SVG element. */
export function s<K extends keyof SVGElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): SVGElementTagNameMap[K] {
  return fill(document.createElementNS("http://www.w3.org/2000/svg", tag), attributes, children);
}

/** A button. */
export function button(text: string, act: () => void, attributes: Attributes = {}): HTMLButtonElement {
  return h("button", { type: "button", onclick: act, ...attributes }, text);
}

/** A field for a number, with its label; `set` is called when the user leaves it or presses Enter. */
export function field(
  label: string,
  value: number,
  set: (value: number) => void,
  attributes: Attributes = {},
): HTMLLabelElement {
  const input = h("input", { type: "number", step: "0.1", value: tidy(value), ...attributes });
  input.addEventListener("change", () => {
    const wanted = Number(input.value);
    if (input.value !== "" && Number.isFinite(wanted) && wanted !== value) set(wanted);
  });
  return h("label", { class: "field" }, h("span", {}, label), input);
}

/** A part of the side panel. */
export function section(title: string, ...children: Child[]): HTMLElement {
  return h("section", { "aria-label": title }, h("h2", {}, title), ...children);
}

/** A number as people write it. */
export function tidy(value: number, digits = 2): string {
  return Number(value.toFixed(digits)).toString();
}

/** What a control is called, for finding it again in a panel that was drawn anew. */
function called(node: Element): string {
  const label = node instanceof HTMLInputElement || node instanceof HTMLSelectElement ? node.labels?.[0]?.textContent : null;
  const name = node.getAttribute("aria-label") ?? label ?? (node instanceof HTMLTextAreaElement ? "" : node.textContent);
  return `${node.tagName} ${node.getAttribute("type") ?? ""} ${name ?? ""}`;
}

/** Puts other children into an element. Whoever works by keyboard stays at the control where he was. */
export function swap(node: Element, ...children: Child[]): void {
  const now = document.activeElement;
  const focused = now && node.contains(now) ? called(now) : null;
  const scroll = node.closest("aside")?.scrollTop;
  node.replaceChildren(...children.filter((c): c is Node | string => !!c));
  if (focused === null) return;
  const again = [...node.querySelectorAll<HTMLElement>("button, input, select, textarea, summary, [tabindex]")].find((n) => called(n) === focused);
  again?.focus({ preventScroll: true });
  const aside = node.closest("aside");
  if (aside && scroll !== undefined) aside.scrollTop = scroll;
}
