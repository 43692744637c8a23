// The numbers of a figure of a report. The program writes them as attributes of the drawing (src/study/plot/plot_data.h).

/** An axis in its own coordinate: the decimal logarithm of the value on a logarithmic axis. */
export interface Axis {
  /** Coordinates at the left and right of the drawing area, or at its bottom and top. */
  from: number;
  to: number;
  log: boolean;
  quantity: string;
  unit: string;
  /** The axis shows values divided by this power of ten. */
  exponent: number;
}
export interface Layer {
  index: number;
  kind: string;
  /** Label in the legend, or beside a rule; empty: none. */
  name: string;
  ink: string;
  /** Values in the units of the axes; of ribbons and bars `lo` and `hi` in place of `y`. NaN: a gap. */
  x: number[];
  y: number[];
  lo: number[];
  hi: number[];
  /** Numbers of a layer without a list of points: a level, a range, an outline. */
  at: number[];
  /** Number of points that were measured, if only some of them are drawn; otherwise 0. */
  of: number;
}
export interface PlotData {
  x: Axis;
  y: Axis;
  /** A second scale at the right: value = factor * y + offset. */
  right: { factor: number; offset: number; quantity: string; unit: string; exponent: number } | null;
  equal: boolean;
  layers: Layer[];
}

const kLetters = 'ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/';

/** The signed integers of base-64 variable-length quantities; NaN for "-". */
export function decodeCodes(codes: string): number[] {
  const out: number[] = [];
  let value = 0, unit = 1;
  for (const letter of codes) {
    if (letter === '-') {
      out.push(NaN);
      continue;
    }
    const digit = kLetters.indexOf(letter);
    if (digit < 0) return [];
    value += (digit & 31) * unit; // more than 32 bits: no bit operations
    unit *= 32;
    if (digit & 32) continue;
    out.push(value % 2 ? -(value - 1) / 2 : value / 2);
    value = 0;
    unit = 1;
  }
  return out;
}

/** The values of a column "offset step order codes". */
export function decodeColumn(column: string): number[] {
  const [offset, step, order, codes = ''] = column.split(' ');
  const first = Number(offset), by = Number(step), decimal = /^1e(-?\d+)$/.exec(step ?? '');
  let last = 0, difference = 0;
  return decodeCodes(codes).map((d) => {
    if (Number.isNaN(d)) return NaN;
    const n = d + (order === '0' ? 0 : order === '1' ? last : last + difference);
    difference = n - last;
    last = n;
    // Decimal steps are exact: 3 * 1e-1 is not 0.3 in binary arithmetic.
    return decimal ? Number(`${n}e${decimal[1]}`) : Number((first + n * by).toPrecision(12));
  });
}

/** "distance (px)" as quantity and unit; "field (T) ×10⁻⁶" has an exponent. */
export function splitLabel(label: string): { quantity: string; unit: string; exponent: number } {
  const power = /\s*×10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)$/.exec(label);
  const digits = power ? [...power[1]].map((c) => (c === '⁻' ? '-' : '⁰¹²³⁴⁵⁶⁷⁸⁹'.indexOf(c))).join('') : '0';
  const text = power ? label.slice(0, power.index) : label;
  const parts = /^(.*?)\s*\(([^()]*)\)$/.exec(text);
  return { quantity: parts ? parts[1] : text, unit: parts ? parts[2] : '', exponent: Number(digits) };
}

const numbers = (text: string | null) => (text ? text.split(' ').map(Number) : []);

/** Reads the numbers of a drawing; null if it is not a figure with numbers. */
export function readPlot(svg: Element): PlotData | null {
  const area = svg.querySelector('svg[data-x]');
  if (!area) return null;
  const labelOf = (axis: string) => [...svg.querySelectorAll(`text[data-axis="${axis}"]`)].map((t) => t.textContent ?? '').join(' ');
  const log = area.getAttribute('data-log') ?? '';
  const axisOf = (name: 'x' | 'y'): Axis => {
    const [from, to] = numbers(area.getAttribute(`data-${name}`));
    return { from, to, log: log.includes(name), ...splitLabel(labelOf(name)) };
  };
  const x = axisOf('x'), y = axisOf('y'), right = numbers(area.getAttribute('data-right'));
  if (![x.from, x.to, y.from, y.to].every(Number.isFinite) || x.from === x.to || y.from === y.to) return null;
  return {
    x,
    y,
    right: right.length === 2 ? { factor: right[0], offset: right[1], ...splitLabel(labelOf('right')) } : null,
    equal: area.hasAttribute('data-equal'),
    layers: [...area.querySelectorAll('g[data-layer]')].map((g) => readLayer(svg, g, x, y)),
  };
}

function readLayer(svg: Element, g: Element, x: Axis, y: Axis): Layer {
  const index = Number(g.getAttribute('data-layer')), kind = g.getAttribute('data-kind') ?? '';
  const column = (name: string, axis: Axis) => {
    const values = decodeColumn(g.getAttribute(`data-${name}`) ?? '');
    return axis.log ? values.map((v) => Number((10 ** v).toPrecision(6))) : values;
  };
  const label = svg.querySelector(`g[data-legend="${index}"] text`)?.textContent ?? (kind.startsWith('rule') ? g.querySelector('text')?.textContent : '');
  const ofX = kind.endsWith('-x'), at = numbers(g.getAttribute('data-at'));
  return {
    index,
    kind,
    name: label ?? '',
    ink: /\b[sf]-(\w+)/.exec(g.querySelector('[class]')?.getAttribute('class') ?? '')?.[1] ?? '',
    x: column('x', x),
    y: column('y', y),
    lo: column('lo', y),
    hi: column('hi', y),
    at: (ofX ? x : y).log && /^(rule|band)/.test(kind) ? at.map((v) => 10 ** v) : at,
    of: Number(g.getAttribute('data-of') ?? 0),
  };
}

/** The coordinate of a value on an axis. */
export const coordinate = (a: Axis, value: number) => (a.log ? Math.log10(value) : value);
/** The position of a value along an axis, as fraction of its length. */
export const fraction = (a: Axis, value: number) => (coordinate(a, value) - a.from) / (a.to - a.from);
/** The value at a fraction of an axis. */
export function valueAt(a: Axis, f: number): number {
  const v = a.from + f * (a.to - a.from);
  return a.log ? 10 ** v : v;
}

/** The layers that are hidden and shown together, by the label of the legend: layers without a label have the label of the
 * layer with their colour, for example the shaded band of a mean. */
export function seriesOf(layers: Layer[]): { name: string; ink: string; kind: string; layers: number[] }[] {
  const isLabelled = (l: Layer) => l.name !== '' && !l.kind.startsWith('rule');
  const own = (l: Layer) => !isLabelled(l) && /^(ribbon|bars|line|stairs|dot|ring|cross)$/.test(l.kind) && !['text', 'muted'].includes(l.ink);
  return layers.filter(isLabelled).map((l) => ({
    name: l.name,
    ink: l.ink,
    kind: l.kind,
    layers: [l.index, ...layers.filter((other) => own(other) && other.ink === l.ink && layers.find((first) => isLabelled(first) && first.ink === other.ink) === l).map((other) => other.index)],
  }));
}

/** A number with at most six significant digits. */
export function shown(v: number): string {
  if (!Number.isFinite(v)) return '–';
  return String(Number(v.toPrecision(6))).replace('-', '−');
}

const cell = (text: string) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
const labelled = (a: { quantity: string; unit: string }) => (a.unit ? `${a.quantity} (${a.unit})` : a.quantity);

/** The values of a figure as CSV, one row for each point. `hidden`: layers that are left out. */
export function csvOf(plot: PlotData, hidden: ReadonlySet<number> = new Set()): string {
  const layers = plot.layers.filter((l) => !hidden.has(l.index) && (l.x.length || (l.kind.startsWith('rule') && l.name)));
  const ranges = layers.some((l) => l.lo.length);
  const names = new Map(seriesOf(plot.layers).flatMap((s) => s.layers.map((i) => [i, s.name] as const)));
  const rows = [['series', labelled(plot.x), labelled(plot.y), ...(ranges ? ['low', 'high'] : [])]];
  const text = (v: number | undefined) => (v === undefined || !Number.isFinite(v) ? '' : String(v));
  for (const l of layers) {
    const name = names.get(l.index) ?? l.name, more = (i: number) => (ranges ? [text(l.lo[i]), text(l.hi[i])] : []);
    if (l.kind === 'rule-x') rows.push([name, text(l.at[0]), '', ...more(-1)]);
    else if (l.kind === 'rule-y') rows.push([name, '', text(l.at[0]), ...more(-1)]);
    else l.x.forEach((x, i) => Number.isFinite(x) && rows.push([name, text(x), text(l.y[i]), ...more(i)]));
  }
  return rows.map((r) => r.map(cell).join(',') + '\n').join('');
}
