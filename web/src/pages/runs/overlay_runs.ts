// Curves of recorded runs over a common time, for plots that overlay several runs.

import type { Word } from '../../i18n';
import type { Series } from '../../series';

/** Zero of the common time: the start of each run, of its recording, or its first change of the setpoint. */
export const kAlignments = ['run', 'recording', 'setpoint'] as const;
export type Alignment = (typeof kAlignments)[number];

export interface Curve {
  label: string;
  /** Index of the run, which determines the colour. */
  run: number;
  /** The second quantity of a plot is dashed. */
  dashed: boolean;
  t: ArrayLike<number>;
  v: ArrayLike<number>;
}
export interface Quantity {
  key: 'distance' | 'dispersion' | 'field' | 'speed' | 'responding';
  unit: string;
  lines: { label: string; of: (s: Series, um_per_px: number | null) => ArrayLike<number> }[];
}

/** Speed of the centroid from frame to frame, um/s, or px/s if the scale is not known. */
export function centroidSpeed(s: Series, um_per_px: number | null): Float64Array {
  const t = s.of('t_s'), x = s.of(s.swarmColumn('centroid_x_px')), y = s.of(s.swarmColumn('centroid_y_px'));
  const out = new Float64Array(t.length).fill(NaN);
  for (let i = 1; i < t.length; ++i) out[i] = (Math.hypot(x[i] - x[i - 1], y[i] - y[i - 1]) * (um_per_px ?? 1)) / (t[i] - t[i - 1]);
  return out;
}

/** The plots of a recorded run; `scaled`: the scale of every displayed run is known. */
export function quantities(say: (key: Word) => string, scaled: boolean): Quantity[] {
  const column = (name: string) => (s: Series) => s.of(name);
  const swarm = (quantity: string) => (s: Series) => s.of(s.swarmColumn(quantity));
  return [
    { key: 'distance', unit: 'px', lines: [{ label: say('plot.distance'), of: column('distance_px') }] },
    { key: 'dispersion', unit: 'px', lines: [{ label: 'σx', of: swarm('sigma_x_px') }, { label: 'σy', of: swarm('sigma_y_px') }] },
    { key: 'speed', unit: scaled ? 'µm/s' : 'px/s', lines: [{ label: say('plot.speed'), of: (s, k) => centroidSpeed(s, scaled ? k : null) }] },
    { key: 'field', unit: 'µT', lines: [{ label: 'Bx', of: column('field_x_ut') }, { label: 'By', of: column('field_y_ut') }] },
    { key: 'responding', unit: '', lines: [{ label: say('plot.responding'), of: column('responding_count') }] },
  ];
}

/** The time of a run that is zero in the plots. */
export function origin(s: Series, alignment: Alignment): number {
  const t = s.of('t_s');
  if (alignment === 'run' || !t.length) return 0;
  if (alignment === 'recording') return t[0];
  const x = s.of('setpoint_x_px'), y = s.of('setpoint_y_px');
  let before = -1;
  for (let i = 0; i < t.length; ++i) {
    if (!Number.isFinite(x[i]) || !Number.isFinite(y[i])) continue;
    if (before >= 0 && (x[i] !== x[before] || y[i] !== y[before])) return t[i];
    before = i;
  }
  return t[0]; // the setpoint does not change
}

/** Whether a curve has a value. */
export const hasValues = (v: ArrayLike<number>) => Array.prototype.some.call(v, (one: number) => Number.isFinite(one));

/** The curves of one plot. */
export function curves(q: Quantity, runs: { label: string; series: Series; um_per_px: number | null }[], alignment: Alignment): Curve[] {
  const all: Curve[] = [];
  runs.forEach((run, index) => {
    const zero = origin(run.series, alignment), t = run.series.of('t_s').map((one) => one - zero);
    q.lines.forEach((line, k) => {
      const v = line.of(run.series, run.um_per_px);
      if (hasValues(v)) all.push({ label: runs.length > 1 ? `${run.label} ${q.lines.length > 1 ? line.label : ''}`.trim() : line.label, run: index, dashed: k > 0, t, v });
    });
  });
  return all;
}

/** The value of a curve at a time: that of the last row that is not after it; NaN outside the curve. */
export function valueAt(c: Pick<Curve, 't' | 'v'>, time: number): number {
  let low = 0, high = c.t.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (c.t[middle] <= time + 1e-9) low = middle + 1;
    else high = middle;
  }
  const step = c.t.length > 1 ? c.t[1] - c.t[0] : 0;
  return low === 0 || (low === c.t.length && time > c.t[low - 1] + step) ? NaN : c.v[low - 1];
}

/**
 * The points that a plot of limited width needs: at most `most`, always with the smallest and the largest value of each interval, so
 * that no peak is lost.
 */
export function reduced(c: Pick<Curve, 't' | 'v'>, most: number): { t: number[]; v: (number | null)[] } {
  const n = c.t.length, t: number[] = [], v: (number | null)[] = [];
  const add = (i: number) => {
    t.push(c.t[i]);
    v.push(Number.isFinite(c.v[i]) ? c.v[i] : null);
  };
  if (n <= most) {
    for (let i = 0; i < n; ++i) add(i);
    return { t, v };
  }
  const intervals = Math.floor(most / 2);
  for (let k = 0; k < intervals; ++k) {
    const from = Math.floor((k * n) / intervals), to = Math.floor(((k + 1) * n) / intervals);
    let low = from, high = from;
    for (let i = from; i < to; ++i) {
      if (!(c.v[i] >= c.v[low])) low = i;
      if (!(c.v[i] <= c.v[high])) high = i;
    }
    for (const i of low === high ? [low] : [Math.min(low, high), Math.max(low, high)]) add(i);
  }
  return { t, v };
}
