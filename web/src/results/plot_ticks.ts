// Ticks of an enlarged axis.

import { fraction, valueAt, type Axis } from './plot_data';

export interface Tick {
  /** Fraction of the length of the axis. */
  at: number;
  text: string;
}

const kSteps = [1, 2, 5, 10];

/** Round numbers within [low, high], about `count`. */
function roundNumbers(low: number, high: number, count: number): { values: number[]; decimals: number } {
  const raw = (high - low) / count, power = 10 ** Math.floor(Math.log10(raw));
  const step = power * (kSteps.find((k) => k * power >= raw * (1 - 1e-9)) ?? 10);
  const values: number[] = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step && values.length < 100; ++k) values.push(k * step);
  return { values, decimals: Math.max(0, Math.ceil(-Math.log10(step) - 1e-6)) };
}

/** `count`: about as many ticks as have space. */
export function ticksOf(axis: Axis, count: number): Tick[] {
  const a = valueAt(axis, 0), b = valueAt(axis, 1), low = Math.min(a, b), high = Math.max(a, b);
  if (!(high > low)) return [];
  if (axis.log && high / low >= 10) {
    const first = Math.ceil(Math.log10(low) - 1e-9), last = Math.floor(Math.log10(high) + 1e-9), decades: number[] = [];
    for (let e = first; e <= last; e += Math.max(1, Math.ceil((last - first) / count))) decades.push(e);
    const between = decades.length <= count / 3 ? [1, 2, 5] : [1];
    return decades.flatMap((e) => between.map((k) => k * 10 ** e)).filter((v) => v >= low && v <= high).map((v) => ({ at: fraction(axis, v), text: String(Number(v.toPrecision(3))) }));
  }
  const unit = 10 ** axis.exponent, { values, decimals } = roundNumbers(low / unit, high / unit, count);
  return values.map((v) => ({ at: fraction(axis, v * unit), text: v.toFixed(Math.min(decimals, 12)).replace('-', '−') }));
}
