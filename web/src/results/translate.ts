// Translation of a report: its texts, and the labels of its drawings, whose places follow from their lengths.

import type { Clean } from './sanitise';

export type Translate = (text: string) => string;
type Content = (Clean | string)[];

const kTextAttributes = ['aria-label', 'alt', 'title'];
// Lengths of a legend, as in src/study/plot.
const kRow = 18, kSwatch = 20, kCharacter = 6.6, kBetween = 16;

const attribute = (e: Clean, name: string) => e.attributes.find(([n]) => n === name)?.[1];
const elements = (content: Content) => content.filter((c): c is Clean => typeof c !== 'string');
const textOf = (content: Content): string => content.map((c) => (typeof c === 'string' ? c : textOf(c.children))).join('');

/** The translation of a text between tags: white space around it and code do not change. */
function shown(text: string, tag: string, translate: Translate): string {
  const core = text.trim();
  return core === '' || tag === 'code' || tag === 'pre' ? text : text.replace(core, () => translate(core));
}

/** One line, or two that break at the space nearest to the middle. */
function lines(text: string, count: number): string[] {
  if (count < 2) return [text];
  const spaces = [...text.matchAll(/ /g)].map((m) => m.index).sort((a, b) => Math.abs(a - text.length / 2) - Math.abs(b - text.length / 2));
  return spaces.length ? [text.slice(0, spaces[0]), text.slice(spaces[0] + 1)] : [text, ''];
}

/** The labels of axes; the program writes a long one as two texts. */
function axisLabels(content: Content, translate: Translate): Map<Clean, string> {
  const axes = new Map<string, Clean[]>();
  for (const e of elements(content)) {
    const axis = attribute(e, 'data-axis');
    if (axis) axes.set(axis, [...(axes.get(axis) ?? []), e]);
  }
  return new Map([...axes.values()].flatMap((all) => {
    const parts = lines(translate(all.map((e) => textOf(e.children)).join(' ')), all.length);
    return all.map((e, i): [Clean, string] => [e, parts[i]]);
  }));
}

/** The content with its texts translated. */
export function translated(content: Content, translate: Translate, tag = ''): Content {
  const labels = axisLabels(content, translate);
  return content.map((one) => {
    if (typeof one === 'string') return shown(one, tag, translate);
    const attributes = one.attributes.map(([name, value]): [string, string] => [name, kTextAttributes.includes(name) ? translate(value) : value]);
    const label = labels.get(one);
    const copy = { ...one, attributes, children: label === undefined ? translated(one.children, translate, one.tag) : [label] };
    return one.tag === 'svg' ? withLegend(copy) : copy;
  });
}

const changed = (e: Clean, values: Record<string, string>): Clean => ({ ...e, attributes: e.attributes.map(([n, v]) => [n, values[n] ?? v]) });
const placeOf = (entry: Clean) => (attribute(elements(entry.children)[0], 'transform') ?? '').match(/-?[\d.]+/g)?.map(Number) ?? [0, 0];

/** An entry of a legend at another place. */
function moved(entry: Clean, x: number, y: number): Clean {
  const [swatch, label] = elements(entry.children);
  return { ...entry, children: [changed(swatch, { transform: `translate(${x.toFixed(1)} ${y.toFixed(1)})` }), changed(label, { x: (x + kSwatch / 2 + 5).toFixed(1), y: (y + 4).toFixed(1) })] };
}

/** A drawing in which the entries of the legend stand side by side with their translated labels; more rows need space at the top. */
function withLegend(svg: Clean): Clean {
  const entries = elements(svg.children).filter((e) => attribute(e, 'data-legend') !== undefined && elements(e.children).length === 2);
  const box = (attribute(svg, 'viewBox') ?? '').split(' ').map(Number);
  if (!entries.length || box.length !== 4) return svg;
  const [left, top] = placeOf(entries[0]), rows = (placeOf(entries[entries.length - 1])[1] - top) / kRow;
  const places = new Map<Clean, [number, number]>();
  let x = left, row = 0;
  for (const entry of entries) {
    const length = kSwatch + 5 + kCharacter * textOf(entry.children).trim().length;
    if (x > left && x - kSwatch / 2 + length > box[0] + box[2]) [x, row] = [left, row + 1];
    places.set(entry, [x, row]);
    x += length + kBetween;
  }
  const more = kRow * Math.max(0, Math.round(row - rows));
  const children = svg.children.map((c) => (typeof c !== 'string' && places.has(c) ? moved(c, places.get(c)![0], top - more + kRow * places.get(c)![1]) : c));
  return changed({ ...svg, children }, { viewBox: [box[0], box[1] - more, box[2], box[3] + more].join(' ') });
}
