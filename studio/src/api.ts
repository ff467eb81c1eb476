// The server's answers, as src/studio/mod.rs describes them.

export interface Logged {
  said: string;
  commands: unknown[];
  done: boolean;
}

export interface Summary {
  id: string;
  kind: "house" | "completion" | "grammar" | "city";
  name: string;
  revision: number;
  unsaved: boolean;
  job: Job | null;
  /** The unit in which it is merged with others of its kind; null if it cannot be merged. */
  mergesIn: string | null;
}

/** Work that takes longer than an answer may. */
export interface Job {
  id: string;
  document: string | null;
  state: "running" | "done" | "stopped" | "failed";
  error: string | null;
  step: string;
  part: number | null;
  seconds: number;
}

export interface Doc<View = unknown> extends Summary {
  undo: boolean;
  redo: boolean;
  file: string;
  formats: string[];
  warnings: string[];
  log: Logged[];
  milliseconds: number;
  view: View;
}

export interface Example {
  id: string;
  kind: Summary["kind"];
  title: string;
  about: string;
}

/** Work of a studio that ended, which can be opened again. */
export interface Unsaved {
  id: string;
  kind: Summary["kind"];
  name: string;
  file: string;
  edits: number;
  seconds: number | null;
}

export interface Listing {
  version: string;
  readOnly: boolean;
  documents: Summary[];
  examples: Example[];
  unsaved: Unsaved[];
}

/** An answer that says no. */
export class Refused extends Error {
  constructor(
    readonly status: number,
    message: string,
  ) {
    super(message);
  }
}

const token = new URLSearchParams(location.hash.slice(1)).get("token") ?? "";

async function ask(path: string, body?: unknown): Promise<Response> {
  const headers: Record<string, string> = { "x-edifice-token": token };
  if (body !== undefined) headers["content-type"] = "application/json";
  let response: Response;
  try {
    response = await fetch("/api" + path, {
      method: body === undefined ? "GET" : "POST",
      headers,
      body: body === undefined ? undefined : JSON.stringify(body),
    });
  } catch {
    throw new Refused(0, "The studio has ended. Start it again to go on.");
  }
  if (response.ok) return response;
  const text = await response.text();
  let message = text;
  try {
    message = JSON.parse(text).error ?? text;
  } catch {
    // Refusals before routing are plain text.
  }
  if (response.status === 401) message = "This page was opened without its token: use the address that the command printed.";
  throw new Refused(response.status, message || `status ${response.status}`);
}

async function json<T>(path: string, body?: unknown): Promise<T> {
  return (await ask(path, body)).json();
}

const POLL = 150;

/** Waits for a job, telling how far it is; what it came to, for a page that shows a document. */
async function followed(job: Job, tell: (job: Job) => void, shown?: Doc): Promise<Doc> {
  let now = job;
  while (now.state === "running") {
    tell(now);
    await new Promise((r) => setTimeout(r, POLL));
    now = (await json<{ job: Job }>(`/jobs/${job.id}`)).job;
  }
  if (now.state === "stopped") throw new Refused(499, "Stopped: the document is as it was before.");
  if (now.state === "failed" || now.document === null) throw new Refused(422, now.error ?? "the work failed");
  return get(now.document, shown);
}

/** A document, at once or when the job is over that makes it. */
async function document(path: string, body: unknown, tell: (job: Job) => void, shown?: Doc): Promise<Doc> {
  const said = await json<Told | { job: Job; id?: undefined }>(path, body);
  return said.id === undefined && said.job ? followed(said.job, tell, shown) : seen(said as Told, shown);
}

/** A document as it is told, perhaps by the difference of its view to the one that the page shows. */
interface Told extends Doc {
  difference?: {
    set: Record<string, unknown>;
    at: Record<string, Record<string, unknown>>;
    numbers: Record<string, Numbers>;
    gone: string[];
  };
}

/** The changes of a list in which only numbers of hundredths changed, as `src/studio/difference.rs` describes them. */
interface Numbers {
  rows: number[];
  columns: { path: number[]; times: number; off: number[] }[];
}

/** The list after the changes; entries that stay are shared with the old one. */
function renumbered(old: unknown[], { rows, columns }: Numbers): unknown[] {
  const list = [...old];
  let row = 0;
  const places = rows.map((gap) => (row += gap));
  for (const place of places) list[place] = structuredClone(list[place]);
  for (const { path, times, off } of columns) {
    const by = new Map<number, number>();
    for (let k = 0, at = 0; k < off.length; k += 2) by.set((at += off[k]), off[k + 1]);
    const last = path[path.length - 1];
    places.forEach((place, k) => {
      let holder = list[place] as unknown[];
      for (const step of path.slice(0, -1)) holder = holder[step] as unknown[];
      holder[last] = (Math.floor(100 * times * (holder[last] as number) + 0.5) + (by.get(k) ?? 0)) / 100;
    });
  }
  return list;
}

/** The document with its view. */
function seen({ difference, ...doc }: Told, shown?: Doc): Doc {
  if (!difference || !shown) return doc;
  const view: Record<string, unknown> = { ...(shown.view as Record<string, unknown>), ...difference.set };
  for (const key of difference.gone) delete view[key];
  for (const [key, entries] of Object.entries(difference.at)) {
    const list = [...(view[key] as unknown[])];
    for (const [k, value] of Object.entries(entries)) list[Number(k)] = value;
    view[key] = list;
  }
  for (const [key, changes] of Object.entries(difference.numbers)) view[key] = renumbered(view[key] as unknown[], changes);
  return { ...doc, view };
}

/** The revision of a document whose view may be told by its difference: that of a city, whose lists are long. */
const shows = (shown?: Doc) => (shown?.kind === "city" ? shown.revision : undefined);

export const listing = () => json<Listing>("/documents");
export const openExample = (example: string, tell: (job: Job) => void) => document("/documents", { example }, tell);
export const get = async (id: string, shown?: Doc) =>
  seen(await json<Told>(`/documents/${id}${shows(shown) === undefined ? "" : `?shows=${shows(shown)}`}`), shown);
/** Does commands on a document that is shown; long lists of its view that stay the same are not sent again. */
export const edit = (shown: Doc, commands: unknown[], tell: (job: Job) => void) =>
  document(`/documents/${shown.id}/edit`, { commands, revision: shown.revision, shows: shows(shown) }, tell, shown);
export const stop = (job: string) => json<{ job: Job }>(`/jobs/${job}/stop`, {});
export const question = <T>(id: string, asked: unknown) => json<T>(`/documents/${id}/ask`, asked);
const turned = async (shown: Doc, way: "undo" | "redo") =>
  seen(await json<Told>(`/documents/${shown.id}/${way}`, { shows: shows(shown) }), shown);
export const undo = (shown: Doc) => turned(shown, "undo");
export const redo = (shown: Doc) => turned(shown, "redo");
export const save = (id: string, overwrite: boolean) =>
  json<{ file: string; script: string }>(`/documents/${id}/save`, { overwrite });
export const close = (id: string, discard: boolean) => json<object>(`/documents/${id}/close`, { discard });
export const recover = (id: string, tell: (job: Job) => void) => document(`/unsaved/${id}/open`, {}, tell);
export const discard = (id: string) => json<object>(`/unsaved/${id}/discard`, {});
export const script = async (id: string) => (await ask(`/documents/${id}/script`)).blob();
export const exported = async (id: string, format: string) =>
  (await ask(`/documents/${id}/export/${format}`)).blob();
