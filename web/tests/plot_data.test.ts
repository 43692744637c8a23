import { describe, expect, test } from 'vitest';
import { csvOf, decodeColumn, fraction, seriesOf, shown, splitLabel, valueAt, type Axis, type Layer, type PlotData } from '../src/results/plot_data';
import { mapOf, pathOf } from '../src/results/plot_drawing';
import { nearestPoint, nextPoint, pointText } from '../src/results/plot_points';
import { ticksOf } from '../src/results/plot_ticks';
import { enlarged, moved, part } from '../src/results/plot_zoom';

const axis = (more: Partial<Axis>): Axis => ({ from: 0, to: 10, log: false, quantity: 'time', unit: 's', exponent: 0, ...more });
const layer = (more: Partial<Layer>): Layer => ({ index: 0, kind: 'line', name: '', ink: 'blue', x: [], y: [], lo: [], hi: [], at: [], of: 0, ...more });
const plotOf = (layers: Layer[], more: Partial<PlotData> = {}): PlotData => ({ x: axis({}), y: axis({ to: 100, quantity: 'distance', unit: 'px' }), right: null, equal: false, layers, ...more });
const kArea = { left: 40, top: 20, width: 400, height: 200 };
const kNone = new Set<number>();

describe('a column of values', () => {
  test('is decoded as the program encodes it', () => {
    expect(decodeColumn('0 1e-2 0 sJiO-5S')).toEqual([1.5, 2.25, NaN, -3]); // the text of tests/study/plot/plot_data_test.cpp
    expect(decodeColumn('0 2 0 AC-G')).toEqual([0, 2, NaN, 6]);
    expect(decodeColumn('2.5 0.5 2 ACAAA')).toEqual([2.5, 3, 3.5, 4, 4.5]);
  });
  test('has decimals without errors of binary arithmetic', () => expect(decodeColumn('0 1e-1 0 G')).toEqual([0.3]));
  test('with more than 32 bits is exact', () => expect(decodeColumn('0 1e0 0 +nh4v0jnC')).not.toContain(NaN));
  test('that is damaged has no values', () => expect(decodeColumn('0 1 0 <script>')).toEqual([]));
  test('that is empty has no values', () => expect(decodeColumn('')).toEqual([]));
});

describe('an axis', () => {
  test('maps values to positions and back', () => {
    for (const a of [axis({}), axis({ from: 10, to: 0 }), axis({ from: -1, to: 3, log: true })])
      for (const f of [0, 0.25, 1]) expect(fraction(a, valueAt(a, f))).toBeCloseTo(f, 12);
    expect(fraction(axis({ from: 0, to: 2, log: true }), 10)).toBeCloseTo(0.5, 12);
    const m = mapOf(axis({}), axis({ to: 100 }), kArea);
    expect([m.x(2.5), m.y(25)]).toEqual([100, 150]);
  });
  test('label has quantity, unit and power of ten', () => {
    expect(splitLabel('time (s)')).toEqual({ quantity: 'time', unit: 's', exponent: 0 });
    expect(splitLabel('field (T) ×10⁻⁶')).toEqual({ quantity: 'field', unit: 'T', exponent: -6 });
    expect(splitLabel('signal-to-noise ratio')).toEqual({ quantity: 'signal-to-noise ratio', unit: '', exponent: 0 });
  });
  test('has ticks at round numbers of the enlarged part', () => {
    expect(ticksOf(axis({ from: 1.1, to: 1.52 }), 4).map((t) => t.text)).toEqual(['1.2', '1.4']);
    expect(ticksOf(axis({ from: -1e-6, to: 1e-6, exponent: -6 }), 4).map((t) => t.text)).toEqual(['−1.0', '−0.5', '0.0', '0.5', '1.0']);
    expect(ticksOf(axis({ from: 0, to: 3, log: true }), 4).map((t) => t.text)).toEqual(['1', '10', '100', '1000']);
    expect(ticksOf(axis({ from: 3, to: 3 }), 4)).toEqual([]);
  });
  test('is enlarged about a place, and not beyond its ends', () => {
    const a = axis({});
    expect(enlarged(a, a, 2, 0.5)).toMatchObject({ from: 2.5, to: 7.5 });
    expect(enlarged(a, a, 2, 0)).toMatchObject({ from: 0, to: 5 });
    expect(enlarged(enlarged(a, a, 4, 0.5), a, 0.1, 0.5)).toBe(a);
    expect(moved(axis({ from: 4, to: 6 }), a, -5)).toMatchObject({ from: 0, to: expect.closeTo(2, 12) });
    expect(part(axis({ from: 10, to: 0 }), axis({ from: 10, to: 0 }), 0.2, 0.4)).toMatchObject({ from: 8, to: 6 });
  });
});

describe('a drawn layer', () => {
  const m = mapOf(axis({}), axis({ to: 100 }), kArea);
  test('has its points at their values, with gaps', () => {
    expect(pathOf(layer({ x: [0, 5, NaN, 10], y: [0, 50, NaN, 100] }), m, 5)).toBe('M0.00 200.00L200.00 100.00M400.00 0.00h0');
    expect(pathOf(layer({ kind: 'stairs', x: [0, 5], y: [0, 50] }), m, 5)).toBe('M0.00 200.00H200.00V100.00');
    expect(pathOf(layer({ kind: 'dot', x: [5], y: [50] }), m, 5)).toBe('M200.00 100.00h0');
  });
  test('has a band, a rule and a range at their values', () => {
    expect(pathOf(layer({ kind: 'band-x', at: [0, 5] }), m, 5)).toBe('M0.00 0.00H200.00V200.00H0.00Z');
    expect(pathOf(layer({ kind: 'rule-y', at: [50] }), m, 5)).toBe('M0 100.00H400.00');
    expect(pathOf(layer({ kind: 'ribbon', x: [0, 10], lo: [0, 0], hi: [50, 100] }), m, 5)).toBe('M0.00 100.00L400.00 0.00L400.00 200.00L0.00 200.00Z');
  });
});

describe('the read point', () => {
  const plot = plotOf([
    layer({ name: 'mean', x: [0, 5, 10], y: [10, 50, 90] }),
    layer({ index: 1, kind: 'ribbon', x: [0, 5, 10], lo: [0, 40, 80], hi: [20, 60, 100] }),
    layer({ index: 2, name: 'other', ink: 'green', x: [5], y: [55] }),
  ], { right: { factor: 0.5, offset: 1, quantity: 'distance', unit: 'µm', exponent: 0 } });
  const m = mapOf(plot.x, plot.y, kArea);
  test('is the nearest visible one', () => {
    expect(nearestPoint(plot, m, 200, 101, kNone)).toMatchObject({ layer: 0, i: 1, x: 5, y: 50 });
    expect(nearestPoint(plot, m, 200, 89, kNone)).toMatchObject({ layer: 2, x: 5, y: 55 });
    expect(nearestPoint(plot, m, 200, 89, new Set([2]))).toMatchObject({ layer: 0, y: 50 });
    expect(nearestPoint(plot, mapOf(axis({ from: 6, to: 10 }), plot.y, kArea), 0, 0, kNone)).toMatchObject({ i: 2 });
  });
  test('has its values with units, and the range of its series', () => {
    expect(pointText(plot, { layer: 0, i: 1, x: 5, y: 50 })).toBe('mean: time 5 s, distance 50 px (40 … 60), distance 26 µm');
  });
  test('moves along a series and to another one', () => {
    const first = nextPoint(plot, null, 1, 0, kNone)!;
    expect(first).toMatchObject({ layer: 0, i: 0 });
    const second = nextPoint(plot, first, 1, 0, kNone)!;
    expect(second.i).toBe(1);
    expect(nextPoint(plot, second, 0, 1, kNone)).toMatchObject({ layer: 2, x: 5 });
    expect(nextPoint(plot, second, Infinity, 0, kNone)!.i).toBe(2);
  });
});

describe('series', () => {
  const plot = plotOf([
    layer({ kind: 'ribbon', x: [0], lo: [1], hi: [3] }),
    layer({ index: 1, name: 'a, "b"', x: [0, 0.25], y: [2, NaN] }),
    layer({ index: 2, kind: 'rule-x', name: 'cut-off', ink: 'muted', at: [4] }),
    layer({ index: 3, kind: 'band-x', ink: 'blue', at: [0, 1] }),
  ]);
  test('have the shaded range of their colour, but no bands', () => expect(seriesOf(plot.layers).map((s) => s.layers)).toEqual([[1, 0]]));
  test('are rows of CSV with quoted names', () => {
    expect(csvOf(plot)).toBe('series,time (s),distance (px),low,high\n"a, ""b""",0,,1,3\n"a, ""b""",0,2,,\n"a, ""b""",0.25,,,\ncut-off,4,,,\n');
    expect(csvOf(plot, new Set([0, 1]))).toBe('series,time (s),distance (px)\ncut-off,4,\n');
  });
  test('numbers have at most six digits', () => expect([shown(1 / 3), shown(-2), shown(NaN)]).toEqual(['0.333333', '−2', '–']));
});
