// Draws the layers of a figure of a report again, for an enlarged part of its axes, with the looks that the program gave them.

import { fraction, type Axis, type Layer, type PlotData } from './plot_data';
import { ticksOf } from './plot_ticks';

export interface Area {
  left: number;
  top: number;
  width: number;
  height: number;
}
/** Positions in the drawing area. */
export interface Map {
  x: (v: number) => number;
  y: (v: number) => number;
  width: number;
  height: number;
}
export const kSvg = 'http://www.w3.org/2000/svg';
const kFar = 1e5; // renderers lose precision at larger coordinates
const near = (v: number) => Math.min(kFar, Math.max(-kFar, v));

export function mapOf(x: Axis, y: Axis, area: Area): Map {
  return {
    x: (v) => near(fraction(x, v) * area.width),
    y: (v) => near((1 - fraction(y, v)) * area.height),
    width: area.width,
    height: area.height,
  };
}

const f = (v: number) => v.toFixed(2);
const at = (m: Map, x: number, y: number) => `${f(m.x(x))} ${f(m.y(y))}`;

/** Runs of consecutive indices that hold numbers. */
function sections(values: number[][]): number[][] {
  const out: number[][] = [];
  let open = false;
  values[0].forEach((_, i) => {
    const number = values.every((column) => Number.isFinite(column[i]));
    if (number && !open) out.push([]);
    if (number) out[out.length - 1].push(i);
    open = number;
  });
  return out;
}

function curve(l: Layer, m: Map): string {
  const step = (i: number) => (l.kind === 'stairs' ? `H${f(m.x(l.x[i]))}V${f(m.y(l.y[i]))}` : `L${at(m, l.x[i], l.y[i])}`);
  return sections([l.x, l.y]).map(([first, ...rest]) => `M${at(m, l.x[first], l.y[first])}` + (rest.length ? rest.map(step).join('') : 'h0')).join('');
}
function marks(l: Layer, m: Map, size: number): string {
  const r = size / 2;
  const mark = (i: number) => {
    const x = m.x(l.x[i]), y = m.y(l.y[i]);
    if (l.kind === 'ring') return `M${f(x - r)} ${f(y)}a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0`;
    if (l.kind === 'cross') return `M${f(x - r)} ${f(y)}h${2 * r}m${-r} ${-r}v${2 * r}`;
    return `M${f(x)} ${f(y)}h0`;
  };
  return sections([l.x, l.y]).flat().map(mark).join('');
}
function ribbon(l: Layer, m: Map): string {
  return sections([l.x, l.lo, l.hi])
    .map((s) => 'M' + [...s.map((i) => at(m, l.x[i], l.hi[i])), ...[...s].reverse().map((i) => at(m, l.x[i], l.lo[i]))].join('L') + 'Z')
    .join('');
}
function bars(l: Layer, m: Map): string {
  const kCap = 3;
  return sections([l.x, l.lo, l.hi]).flat()
    .map((i) => {
      const x = m.x(l.x[i]), lo = f(m.y(l.lo[i])), hi = f(m.y(l.hi[i]));
      return `M${f(x - kCap)} ${lo}H${f(x + kCap)}M${f(x)} ${lo}V${hi}M${f(x - kCap)} ${hi}H${f(x + kCap)}`;
    })
    .join('');
}
const kBox = (x0: number, y0: number, x1: number, y1: number) => `M${f(x0)} ${f(y0)}H${f(x1)}V${f(y1)}H${f(x0)}Z`;
function ellipse([x, y, rx, ry]: number[], m: Map): string {
  const x0 = m.x(x - rx), x1 = m.x(x + rx), a = Math.abs(x1 - x0) / 2, b = Math.abs(m.y(y + ry) - m.y(y - ry)) / 2, cy = f(m.y(y));
  return `M${f(x0)} ${cy}A${f(a)} ${f(b)} 0 1 0 ${f(x1)} ${cy}A${f(a)} ${f(b)} 0 1 0 ${f(x0)} ${cy}`;
}

/** Path data of a layer. `markSize`: diameter of its marks. */
export function pathOf(l: Layer, m: Map, markSize: number): string {
  const [a, b, c, d] = l.at;
  if (l.kind === 'line' || l.kind === 'stairs') return curve(l, m);
  if (l.kind === 'dot' || l.kind === 'ring' || l.kind === 'cross') return marks(l, m, markSize);
  if (l.kind === 'ribbon') return ribbon(l, m);
  if (l.kind === 'bars') return bars(l, m);
  if (!l.at.length) return '';
  if (l.kind === 'rule-x') return `M${f(m.x(a))} 0V${f(m.height)}`;
  if (l.kind === 'rule-y') return `M0 ${f(m.y(a))}H${f(m.width)}`;
  if (l.kind === 'band-x') return kBox(m.x(a), 0, m.x(b), m.height);
  if (l.kind === 'band-y') return kBox(0, m.y(a), m.width, m.y(b));
  if (l.kind === 'box') return kBox(m.x(a), m.y(b), m.x(c), m.y(d));
  return l.kind === 'ellipse' ? ellipse(l.at, m) : '';
}

const kLooks = ['class', 'fill', 'fill-opacity', 'stroke', 'stroke-width', 'stroke-dasharray'];

/** The elements of a layer for other axes, with the looks of `drawn`, those of the program. */
export function layerElements(l: Layer, m: Map, drawn: Element[]): Element[] {
  const shape = drawn.find((e) => e.localName !== 'g');
  if (!shape) return [];
  const path = shape.ownerDocument.createElementNS(kSvg, 'path');
  for (const name of kLooks) if (shape.hasAttribute(name)) path.setAttribute(name, shape.getAttribute(name)!);
  const size = l.kind === 'dot' ? Number(shape.getAttribute('stroke-width')) : 5;
  path.setAttribute('d', pathOf(l, m, size));
  const label = drawn.find((e) => e.localName === 'g');
  if (!label) return [path];
  const moved = label.cloneNode(true) as Element, text = moved.querySelector('text');
  if (text && l.kind === 'rule-x') {
    const left = text.getAttribute('text-anchor') === 'end';
    text.setAttribute('x', f(m.x(l.at[0]) + (left ? -5 : 5)));
  } else if (text) {
    const y = m.y(l.at[0]);
    text.setAttribute('y', f(y < 20 ? y + 14 : y - 5));
  }
  return [path, moved];
}

/** Grid and tick labels for other axes; `ticks`: the group of the program, for its looks. */
export function tickElements(plot: PlotData, x: Axis, y: Axis, area: Area, ticks: Element): Element {
  const out = ticks.cloneNode(false) as Element, path = ticks.querySelector('path')!.cloneNode(false) as Element;
  const style = ticks.querySelector('text');
  const text = (left: number, top: number, anchor: string, words: string) => {
    const t = (style ? style.cloneNode(false) : ticks.ownerDocument.createElementNS(kSvg, 'text')) as Element;
    for (const [name, value] of [['x', f(left)], ['y', f(top)], ['text-anchor', anchor]]) t.setAttribute(name, value);
    t.textContent = words;
    out.append(t);
  };
  const bottom = area.top + area.height, end = area.left + area.width;
  let grid = '';
  out.append(path);
  for (const t of ticksOf(x, Math.max(2, Math.floor(area.width / 70)))) {
    const left = area.left + t.at * area.width;
    grid += `M${f(left)} ${f(area.top)}v${f(area.height)}`;
    text(left, bottom + 16, 'middle', t.text);
  }
  const rows = Math.max(2, Math.floor(area.height / 42));
  for (const t of ticksOf(y, rows)) {
    const top = bottom - t.at * area.height;
    grid += `M${f(area.left)} ${f(top)}h${f(area.width)}`;
    text(area.left - 6, top + 4, 'end', t.text);
  }
  if (plot.right) {
    const { factor, offset, exponent } = plot.right;
    for (const t of ticksOf({ ...y, log: false, exponent, from: factor * y.from + offset, to: factor * y.to + offset }, rows))
      text(end + 6, bottom - t.at * area.height + 4, 'start', t.text);
  }
  path.setAttribute('d', grid);
  return out;
}
