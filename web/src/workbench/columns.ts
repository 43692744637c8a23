// Widths of the three columns of the workbench: set-up, picture, plots. They are stored as fractions of the window, so that
// they fit every screen.

export interface Fractions {
  setup: number;
  plots: number;
}
export type Side = keyof Fractions;

/** Below this width of the window, px, the columns are stacked. */
export const kNarrow = 1000;
export const kDefault: Fractions = { setup: 0.24, plots: 0.29 };
export const kSplitter = 9; // px, width of a separator
const kLeast = { setup: 250, picture: 360, plots: 250 }; // px

const clamp = (v: number, low: number, high: number) => Math.max(low, Math.min(high, v));

/** Smallest and largest width of a column in a window of this width, px, while the other one has its width. */
export function range(side: Side, f: Fractions, width: number): [number, number] {
  const other: Side = side === 'setup' ? 'plots' : 'setup';
  const rest = width - 2 * kSplitter - kLeast.picture - Math.max(kLeast[other], f[other] * width);
  return [kLeast[side], Math.max(kLeast[side], rest)];
}

/** The widths of the columns, px; the picture has the remaining width. */
export function widths(f: Fractions, width: number): Record<Side, number> {
  // Set-up may leave the plots their smallest width only; the plots then take what set-up leaves.
  const setup = clamp(f.setup * width, ...range('setup', { ...f, plots: 0 }, width));
  const plots = clamp(f.plots * width, ...range('plots', { ...f, setup: setup / width }, width));
  return { setup: Math.round(setup), plots: Math.round(plots) };
}

/** The fractions after one column was made wider by `by` px (narrower if negative). */
export function moved(f: Fractions, side: Side, by: number, width: number): Fractions {
  const [low, high] = range(side, f, width);
  return { ...f, [side]: clamp(widths(f, width)[side] + by, low, high) / width };
}

/** Stored fractions, or the default if they are not valid. */
export function validFractions(v: unknown): Fractions {
  const f = v as Fractions | null;
  const valid = (x: unknown) => typeof x === 'number' && x > 0 && x < 1;
  return f && valid(f.setup) && valid(f.plots) ? { setup: f.setup, plots: f.plots } : kDefault;
}
