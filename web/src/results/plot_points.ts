// The point of a figure that is nearest to the pointer, and its values as text.

import { seriesOf, shown, type Axis, type Layer, type PlotData } from './plot_data';
import type { Map } from './plot_drawing';

export interface Point {
  layer: number;
  i: number;
  x: number;
  y: number;
}

const isCurve = (l: Layer) => l.y.length > 0;
const isRange = (l: Layer) => l.lo.length > 0;
const pointOf = (l: Layer, i: number): Point => ({ layer: l.index, i, x: l.x[i], y: isCurve(l) ? l.y[i] : (l.lo[i] + l.hi[i]) / 2 });

/** Layers whose points can be read: the curves and marks; a range only if it has no curve. */
export function readable(plot: PlotData, hidden: ReadonlySet<number>): Layer[] {
  const curves = plot.layers.filter((l) => isCurve(l) && !hidden.has(l.index));
  return curves.length ? curves : plot.layers.filter((l) => isRange(l) && !hidden.has(l.index));
}

const isInside = (p: Point, m: Map) => {
  const x = m.x(p.x), y = m.y(p.y);
  return x >= -0.5 && x <= m.width + 0.5 && y >= -0.5 && y <= m.height + 0.5;
};

/** The visible point nearest to a place in the drawing area. */
export function nearestPoint(plot: PlotData, m: Map, px: number, py: number, hidden: ReadonlySet<number>): Point | null {
  let best: Point | null = null, least = Infinity;
  for (const l of readable(plot, hidden))
    for (let i = 0; i < l.x.length; ++i) {
      const p = pointOf(l, i), d = Math.hypot(m.x(p.x) - px, m.y(p.y) - py);
      if (d < least && isInside(p, m)) [best, least] = [p, d];
    }
  return best;
}

/** The next point of the same layer, or with `by` 0 the point of another layer that is nearest in x. Without a point: the first. */
export function nextPoint(plot: PlotData, from: Point | null, by: number, otherLayer: number, hidden: ReadonlySet<number>): Point | null {
  const layers = readable(plot, hidden), place = layers.findIndex((l) => l.index === from?.layer);
  const numbers = (l: Layer) => l.x.map((_, i) => i).filter((i) => Number.isFinite(pointOf(l, i).x + pointOf(l, i).y));
  if (!layers.length) return null;
  const layer = layers[place < 0 ? 0 : (place + otherLayer + layers.length) % layers.length], all = numbers(layer);
  if (!all.length) return null;
  if (!from || place < 0) return pointOf(layer, all[0]);
  if (otherLayer) return pointOf(layer, all.reduce((a, b) => (Math.abs(layer.x[b] - from.x) < Math.abs(layer.x[a] - from.x) ? b : a)));
  const here = all.indexOf(from.i);
  return pointOf(layer, all[Math.min(all.length - 1, Math.max(0, here + by))]);
}

const value = (a: { quantity: string; unit: string }, v: number) => [a.quantity, shown(v), a.unit].filter(Boolean).join(' ');
const quantityOf = (a: Axis) => ({ quantity: a.quantity, unit: a.unit });

/** "fuzzy: time 3.2 s, distance 41.5 px (38 … 45)". */
export function pointText(plot: PlotData, p: Point): string {
  const series = seriesOf(plot.layers).find((s) => s.layers.includes(p.layer));
  const own = series ? series.layers : [p.layer], parts = [value(quantityOf(plot.x), p.x)];
  const range = plot.layers.filter((l) => isRange(l) && own.includes(l.index)).map((l) => [l, l.x.indexOf(p.x)] as const).find(([, i]) => i >= 0);
  const interval = range ? ` (${shown(range[0].lo[range[1]])} … ${shown(range[0].hi[range[1]])})` : '';
  parts.push(value(quantityOf(plot.y), p.y) + interval);
  if (plot.right) parts.push(value(plot.right, plot.right.factor * p.y + plot.right.offset));
  return (series ? `${series.name}: ` : '') + parts.join(', ');
}
