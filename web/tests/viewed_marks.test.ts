import { describe, expect, test } from 'vitest';
import { followed, reversalValue, rulerScale, sameSegments, segmentValues, statedMarks, type StatedMarks } from '../src/pages/experiments/viewed_marks';
import { noMarks } from '../src/video/marks';

const segment = (from_s: number, to_s: number, direction_deg: number | null = null) => ({ from_s, to_s, direction_deg });
const none: StatedMarks = { reversal_s: null, segments: [] };

describe('marks of a video of an experiment', () => {
  test('are saved in ms and tenths of a degree, and read again', () => {
    const marks = { ...noMarks(), reversal_s: 4.06667, segments: [segment(5.3514, 8.577, 86.3542), segment(12, 18.18)] };
    expect(reversalValue(marks)).toBe('4.067 s');
    const segments = segmentValues(marks)!;
    expect(segments).toEqual([{ from: '5.351 s', to: '8.577 s', direction: '86.4 deg' }, { from: '12 s', to: '18.18 s' }]);
    const again = statedMarks({ file: 'a', reversal: '4.067 s', segment: segments });
    expect(again.segments).toEqual([segment(5.351, 8.577, 86.4), segment(12, 18.18)]);
    expect(sameSegments(marks, again)).toBe(true);
    expect(sameSegments({ ...marks, segments: [segment(5.36, 8.577, 86.4), segment(12, 18.18)] }, again)).toBe(false);
    expect(sameSegments({ ...marks, segments: [segment(5.351, 8.577), segment(12, 18.18)] }, again)).toBe(false);
  });
  test('without marks there are no values', () => {
    expect([reversalValue(none), segmentValues(none)]).toEqual([undefined, undefined]);
    expect(statedMarks({ file: 'a' })).toEqual(none);
  });
  test('follow the experiment unless they were changed by hand', () => {
    const now: StatedMarks = { reversal_s: 5, segments: [segment(1, 2, 90)] };
    const roi = { x: 1, y: 2, width: 3, height: 4 };
    expect(followed({ ...noMarks(), roi }, none, now)).toEqual({ ...noMarks(), ...now, roi });
    expect(followed({ ...noMarks(), reversal_s: 7 }, none, now)).toMatchObject({ reversal_s: 7, segments: now.segments });
    expect(followed({ ...noMarks(), segments: [segment(1, 3)] }, none, now)).toMatchObject({ reversal_s: 5, segments: [segment(1, 3)] });
  });
});

describe('the scale of a ruler', () => {
  test('has the standard error of its two ends', () => {
    expect(rulerScale(200, 100, 1)).toEqual({ um_per_px: 0.5, um_per_px_se: 0.00354, um_per_px_source: 'ruler' }); // 0.5 √2 / 200
    expect(rulerScale(200, 100, 0)!.um_per_px_se).toBeUndefined();
  });
  test('needs a line and a length', () => {
    for (const [px, um, end] of [[0, 10, 1], [200, 0, 1], [200, -1, 1], [200, 10, -1], [NaN, 10, 1]]) expect(rulerScale(px, um, end)).toBeNull();
  });
});
