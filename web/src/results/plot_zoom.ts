// Enlarging a part of the axes of a figure.

import type { Axis } from './plot_data';

const kMostZoom = 1e5;

/** The axis from fraction `low` to `high` of its length; the full axis if the part is larger; limited to `full`. */
export function part(axis: Axis, full: Axis, low: number, high: number): Axis {
  const length = full.to - full.from;
  const at = (v: number) => (axis.from + v * (axis.to - axis.from) - full.from) / length; // as fraction of the full axis
  let a = at(Math.min(low, high)), b = at(Math.max(low, high));
  if (b - a >= 1) return full;
  if (b - a < 1 / kMostZoom) return axis;
  if (a < 0) [a, b] = [0, b - a];
  if (b > 1) [a, b] = [a - (b - 1), 1];
  return { ...full, from: full.from + a * length, to: full.from + b * length };
}

/** The axis enlarged by `factor` about a fraction of it. */
export const enlarged = (axis: Axis, full: Axis, factor: number, about: number) => part(axis, full, about - about / factor, about + (1 - about) / factor);
/** The axis moved by a fraction of its length. */
export const moved = (axis: Axis, full: Axis, by: number) => part(axis, full, by, 1 + by);
