import { describe, expect, test } from 'vitest';
import { words } from '../src/i18n';
import { centroidSpeed, curves, origin, quantities, reduced, valueAt } from '../src/pages/runs/overlay_runs';
import { Series } from '../src/series';

const kNames = ['frame', 't_s', 'distance_px', 'setpoint_x_px', 'setpoint_y_px', 'true_centroid_x_px', 'true_centroid_y_px', 'true_sigma_x_px', 'true_sigma_y_px'];
/** A run of 10 Hz from frame `first`, whose setpoint changes at frame `change`; the centroid moves 3 px to the right and 4 px down per frame. */
function series(first: number, frames: number, change = Infinity): Series {
  const s = new Series(Infinity);
  s.begin(kNames);
  for (let k = first; k < first + frames; ++k) s.take(new Float64Array([k, k / 10, 100 - k, k < change ? 5 : 6, 5, 3 * k, 4 * k, 2, 3]), 1);
  return s;
}
const of = (v: ArrayLike<number>) => Array.from(v, (one) => Number(one.toFixed(6)));

describe('alignment', () => {
  const complete = series(0, 50, 20), part = series(30, 10, 35), steady = series(12, 5);
  test('from the start of the run: a part begins later', () => {
    expect([origin(complete, 'run'), origin(part, 'run')]).toEqual([0, 0]);
  });
  test('from the start of the recording', () => {
    expect([origin(complete, 'recording'), origin(part, 'recording')]).toEqual([0, 3]);
  });
  test('from the first change of the setpoint; without a change from the start of the recording', () => {
    expect([origin(complete, 'setpoint'), origin(part, 'setpoint'), origin(steady, 'setpoint')]).toEqual([2, 3.5, 1.2]);
  });
  test('curves have the aligned times', () => {
    const runs = [complete, part].map((s, k) => ({ label: `run ${k}`, series: s, um_per_px: null }));
    const [a, b] = curves(quantities(words('en'), false)[0], runs, 'setpoint');
    expect(of(a.t)[0]).toBe(-2);
    expect(of(b.t)[0]).toBe(-0.5);
    expect(valueAt(a, 0)).toBe(80);
    expect(valueAt(b, 0)).toBe(65);
    expect([a.run, b.run]).toEqual([0, 1]);
    expect([a.label, b.label]).toEqual(['run 0', 'run 1']);
  });
  test('a series without rows', () => {
    const none = new Series();
    none.begin(kNames);
    for (const a of ['run', 'recording', 'setpoint'] as const) expect(origin(none, a)).toBe(0);
  });
});

describe('quantities', () => {
  test('two quantities of one plot: the second is dashed, with the name of the run', () => {
    const q = quantities(words('en'), true).find((one) => one.key === 'dispersion')!;
    const all = curves(q, [{ label: 'a', series: series(0, 3), um_per_px: 1 }, { label: 'b', series: series(0, 3), um_per_px: 1 }], 'run');
    expect(all.map((c) => [c.label, c.dashed])).toEqual([['a σx', false], ['a σy', true], ['b σx', false], ['b σy', true]]);
  });
  test('a run without a quantity has no curve', () => {
    const q = quantities(words('en'), true).find((one) => one.key === 'field')!;
    expect(curves(q, [{ label: 'a', series: series(0, 3), um_per_px: 1 }], 'run')).toEqual([]);
  });
  test('speed of the centroid in px/s and um/s', () => {
    expect(of(centroidSpeed(series(0, 3), null)).slice(1)).toEqual([50, 50]);
    expect(of(centroidSpeed(series(0, 3), 0.5)).slice(1)).toEqual([25, 25]);
    expect(centroidSpeed(series(0, 3), null)[0]).toBeNaN();
    expect(quantities(words('en'), false).find((q) => q.key === 'speed')!.unit).toBe('px/s');
  });
});

describe('the cursor', () => {
  const c = { t: [1, 1.1, 1.2], v: [5, 6, 7] };
  test('has the value of the last row that is not after it', () => {
    expect([1, 1.05, 1.1, 1.2, 1.29].map((t) => valueAt(c, t))).toEqual([5, 5, 6, 7, 7]);
  });
  test('has no value outside the curve', () => {
    for (const t of [0.99, 1.31, -5]) expect(valueAt(c, t)).toBeNaN();
    expect(valueAt({ t: [], v: [] }, 1)).toBeNaN();
  });
});

describe('reduction', () => {
  test('keeps short curves', () => {
    expect(reduced({ t: [0, 1, 2], v: [1, NaN, 3] }, 10)).toEqual({ t: [0, 1, 2], v: [1, null, 3] });
  });
  test('loses no peak, and the times increase', () => {
    const t = Array.from({ length: 10_000 }, (_, k) => k), v = t.map((k) => (k === 5003 ? 99 : k === 777 ? -99 : Math.sin(k)));
    const r = reduced({ t, v }, 1000);
    expect(r.t.length).toBeLessThanOrEqual(1000);
    expect(Math.max(...(r.v as number[]))).toBe(99);
    expect(Math.min(...(r.v as number[]))).toBe(-99);
    expect(r.t.every((one, k) => k === 0 || one > r.t[k - 1])).toBe(true);
    expect(r.t[r.v.indexOf(99)]).toBe(5003);
  });
  test('rows without values stay gaps', () => {
    const t = Array.from({ length: 100 }, (_, k) => k), r = reduced({ t, v: t.map((k) => (k < 50 ? NaN : k)) }, 10);
    expect(r.v.slice(0, 2).every((v) => v === null)).toBe(true);
    expect(r.v[r.v.length - 1]).toBe(99);
  });
});
