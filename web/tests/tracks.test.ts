import { describe, expect, it, vi } from 'vitest';
import { fatesOf, histogram, inUnit, Newest, passes, pointsOf, pointsUpTo, settingsOf, short, speedOf, trackAt, valuesOf, withCut, type Feature, type TrackRow } from '../src/pages/tracks/tracks';

const features: Feature[] = [{ name: 'speed', unit: 'px/s' }, { name: 'turning', unit: 'deg/s' }];
const row = (number: number, speed: number | null, turning: number | null, fate: TrackRow['fate'] = 'passes', points = 2): TrackRow => ({ number, points, fate, values: [speed, turning] });

describe('cuts', () => {
  it('includes its limits, and rejects a missing value', () => {
    expect(passes({ feature: 'speed', min: 2, max: 3 }, 2)).toBe(true);
    expect(passes({ feature: 'speed', min: 2, max: 3 }, 3)).toBe(true);
    expect(passes({ feature: 'speed', min: 2 }, 1.999)).toBe(false);
    expect(passes({ feature: 'speed', max: 3 }, 3.001)).toBe(false);
    expect(passes({ feature: 'speed', max: 3 }, null)).toBe(false);
  });
  it('all must pass, and changes by hand have precedence', () => {
    const tracks = [row(1, 5, 10), row(2, 1, 10), row(3, 1, 10, 'kept'), row(4, 5, 10, 'deleted'), row(5, 5, null), row(6, 5, 10, 'cut')];
    const cuts = [{ feature: 'speed', min: 2 }, { feature: 'turning', max: 20 }];
    expect(fatesOf(features, tracks, cuts)).toEqual(['passes', 'cut', 'kept', 'deleted', 'cut', 'passes']);
    expect(fatesOf(features, tracks, [])).toEqual(['passes', 'passes', 'kept', 'deleted', 'passes', 'passes']);
  });
  it('replaces the cut of a feature in its place, and removes one without limits', () => {
    const cuts = [{ feature: 'speed', min: 2 }, { feature: 'turning', max: 9 }];
    expect(withCut(cuts, { feature: 'speed', min: 3, max: null })).toEqual([{ feature: 'speed', min: 3 }, { feature: 'turning', max: 9 }]);
    expect(withCut(cuts, { feature: 'speed', min: null, max: null })).toEqual([{ feature: 'turning', max: 9 }]);
    expect(withCut([], { feature: 'snr', max: 4 })).toEqual([{ feature: 'snr', max: 4 }]);
    expect(cuts).toHaveLength(2);
  });
});

describe('histogram', () => {
  it('counts each value once, with the largest in the last bin', () => {
    const h = histogram([0, 1, 2, 4, null], [true, false, true, true, true], 4)!;
    expect([h.low, h.high]).toEqual([0, 4]);
    expect(h.all).toEqual([1, 1, 1, 1]);
    expect(h.used).toEqual([1, 0, 1, 1]);
  });
  it('has a width for equal values, and does not exist without values', () => {
    const h = histogram([3, 3], [true, true], 2)!;
    expect(h.high).toBeGreaterThan(h.low);
    expect(h.all.reduce((a, b) => a + b)).toBe(2);
    expect(histogram([null], [true], 2)).toBeNull();
  });
});

function buffer(points: [frame: number, t: number, x: number, y: number][]): ArrayBuffer {
  const view = new DataView(new ArrayBuffer(16 * points.length));
  points.forEach(([frame, ...values], i) => {
    view.setUint32(16 * i, frame, true);
    values.forEach((v, k) => view.setFloat32(16 * i + 4 + 4 * k, v, true));
  });
  return view.buffer;
}
const tracks = [row(1, 1, 1, 'passes', 3), row(2, 1, 1, 'passes', 2)];
const p = pointsOf(buffer([[0, 0, 0, 0], [1, 0.5, 3, 4], [3, 1.5, 3, 4], [2, 1, 100, 50], [3, 1.5, 110, 50]]), tracks);

describe('points', () => {
  it('belong to their tracks', () => {
    expect(p.start).toEqual([0, 3, 5]);
    expect(() => pointsOf(buffer([[0, 0, 0, 0]]), tracks)).toThrow();
  });
  it('are found by their frame', () => {
    expect(pointsUpTo(p, 0, 1)).toBe(2);
    expect(pointsUpTo(p, 0, 2)).toBe(2);
    expect(pointsUpTo(p, 1, 1)).toBe(3);
    expect(pointsUpTo(p, 1, 9)).toBe(5);
  });
  it('select the nearest shown track that is visible at this time', () => {
    expect(trackAt(p, [true, true], 0, 3, 108, 50, 5)).toBe(1);
    expect(trackAt(p, [true, true], 0, 2, 108, 50, 5)).toBe(-1); // not there yet
    expect(trackAt(p, [true, false], 0, 3, 108, 50, 5)).toBe(-1);
    expect(trackAt(p, [true, true], 0, 3, 3, 5, 5)).toBe(0);
  });
  it('have a speed over displacements of an interval only', () => {
    expect(speedOf(p, 0, 1)).toEqual({ t: [0.25], v: [10] });
    expect(speedOf(p, 0, 2)).toEqual({ t: [1], v: [0] });
    expect(speedOf(p, 1, 1).v[0]).toBeCloseTo(20);
  });
});

it('settings survive the address', () => {
  const s = { size: 5.2, threshold: 12, polarity: 'bright', 'um-per-px': 0.35 };
  expect(settingsOf(valuesOf(s))).toEqual(s);
  expect(settingsOf({ size: 'x', file: 'a.mp4' })).toEqual({});
  expect(valuesOf({ size: undefined, reach: 3 })).toEqual({ reach: '3' });
});

it('lengths are in micrometres only if the scale is known', () => {
  expect(inUnit('px/s', 0.5)).toEqual({ factor: 0.5, unit: 'µm/s' });
  expect(inUnit('px/s', null)).toEqual({ factor: 1, unit: 'px/s' });
  expect(inUnit('s', 0.5)).toEqual({ factor: 1, unit: 's' });
  expect([short(1234.5), short(0.00001), short(null), short(12)]).toEqual(['1230', '1.00e-5', '–', '12']);
});

it('only the newest of several requests is sent', async () => {
  const sent: number[] = [], newest = new Newest();
  let release = () => {};
  const request = (n: number) => () => {
    sent.push(n);
    return new Promise<void>((r) => (release = r));
  };
  for (const n of [1, 2, 3]) newest.run(request(n));
  expect(sent).toEqual([1]);
  release();
  await vi.waitFor(() => expect(sent).toEqual([1, 3]));
});
