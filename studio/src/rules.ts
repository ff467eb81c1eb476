// The rules of a grammar, and how they lie in a region.

export interface Part {
  symbol: string;
  size: number | null;
  relative: boolean | null;
}

export interface Sized {
  size: number;
  relative: boolean;
}

export interface Rule {
  symbol: string;
  weight: number | null;
  operation: string;
  axis: "x" | "y" | null;
  /** Whether the last part of a mirrored split stands once in the middle. */
  center: boolean;
  parts: Part[];
  /** Of a grid, from the left. */
  columns: Sized[];
  /** Of a grid, from the bottom. */
  rows: Sized[];
  text: string;
  cost: number;
}

/** The parts of a rule along an axis, or the columns or rows of a grid. */
export interface Line {
  axis: "x" | "y";
  /** How edits name each: `0`, `c0` or `r0`. */
  names: string[];
  /** What people call each. */
  labels: string[];
  sizes: Sized[];
  /** Whether it is a repeat, which puts as many periods as fit. */
  repeats: boolean;
}

/** The lines of a rule: two of a grid, one of all others. */
export function lines(rule: Rule): Line[] {
  const grid = (axis: "x" | "y", sizes: Sized[], sign: string, word: string): Line => ({
    axis,
    names: sizes.map((_, k) => `${sign}${k}`),
    labels: sizes.map((_, k) => `${word} ${k + 1}`),
    sizes,
    repeats: false,
  });
  if (rule.operation === "grid_split") return [grid("x", rule.columns, "c", "column"), grid("y", rule.rows, "r", "row")];
  if (!rule.axis) return [];
  const sizes = rule.parts.map((p) => ({ size: p.size ?? 0, relative: p.relative ?? false }));
  return [{ axis: rule.axis, names: sizes.map((_, k) => String(k)), labels: rule.parts.map((p) => p.symbol), sizes, repeats: rule.operation.startsWith("repeat") }];
}

/** Which entries of a line stand in a region of this extent, in order, and the length of a unit of relative size. */
export function layout(rule: Rule, line: Line, extent: number): { order: number[]; scale: number } {
  const all = line.sizes.map((_, k) => k);
  const period = line.sizes.reduce((sum, p) => sum + p.size, 0);
  const times = (room: number) => Math.max(1, Math.round(room / period));
  let order = all;
  if (rule.operation === "repeat") order = Array.from({ length: times(extent) }, () => all).flat();
  else if (rule.operation === "repeat_aba") order = [...Array.from({ length: times(extent - line.sizes[0].size) }, () => all).flat(), 0];
  else if (rule.operation === "sym_split") order = [...all, ...all.slice(0, all.length - (rule.center ? 1 : 0)).reverse()];
  const sum = (relative: boolean) => order.reduce((t, k) => t + (line.sizes[k].relative === relative ? line.sizes[k].size : 0), 0);
  const relative = sum(true);
  return { order, scale: relative > 0 ? (extent - sum(false)) / relative : 1 };
}
