import { describe, expect, test } from 'vitest';
import { clock, following, ticks, tickStep, TimeScale, zoomed } from '../src/video/time_axis';

describe('the scale', () => {
  const scale = new TimeScale({ from_s: 10, to_s: 30 }, 400);
  test('maps the span to the width', () => {
    expect([10, 20, 30, 5].map((t) => scale.toX(t))).toEqual([0, 200, 400, -100]);
  });
  test('toTime and toX are inverse functions', () => {
    expect(scale.toTime(scale.toX(17.3))).toBeCloseTo(17.3, 12);
  });
});

describe('ticks', () => {
  test('are at round times inside the span, not too near to each other', () => {
    for (const [from, to] of [[0, 75.9], [12.31, 12.44], [0, 600], [100, 7300]]) {
      const scale = new TimeScale({ from_s: from, to_s: to }, 800), { step, times } = ticks(scale);
      expect(times.length).toBeGreaterThan(3);
      for (const t of times) {
        expect(t).toBeGreaterThanOrEqual(from - 1e-9);
        expect(t).toBeLessThanOrEqual(to + 1e-9);
        expect(Math.abs(t / step - Math.round(t / step))).toBeLessThan(1e-6);
      }
      expect(scale.toX(times[1]) - scale.toX(times[0])).toBeGreaterThanOrEqual(70 - 1e-6);
    }
  });
  test.each([[0.03, 0.05], [0.7, 1], [1.2, 2], [6, 10], [11, 15], [40, 60], [200, 300], [4000, 7200]])('a step of at least %d s is %d s', (wanted, step) => {
    expect(tickStep(wanted)).toBeCloseTo(step, 12);
  });
});

test('times are written in seconds below a minute, then in minutes', () => {
  expect([clock(3.14159), clock(59.996), clock(59.999, 0.01), clock(75, 1), clock(605.25, 0.1), clock(7, 10)]).toEqual(['3.14', '1:00.00', '1:00.00', '1:15', '10:05.3', '7']);
});

describe('zooming the axis', () => {
  test('keeps the time under the pointer', () => {
    const before = new TimeScale({ from_s: 20, to_s: 60 }, 100), span = zoomed(before.span, 2, 30, 100, 0.1);
    expect(span.to_s - span.from_s).toBeCloseTo(20, 12);
    expect(new TimeScale(span, 100).toX(30)).toBeCloseTo(before.toX(30), 9);
  });
  test('stays inside the video', () => {
    expect(zoomed({ from_s: 0, to_s: 40 }, 0.1, 40, 100, 0.1)).toEqual({ from_s: 0, to_s: 100 });
    expect(zoomed({ from_s: 60, to_s: 100 }, 0.8, 60, 100, 0.1)).toEqual({ from_s: 50, to_s: 100 });
    const near = zoomed({ from_s: 0, to_s: 1 }, 1e9, 0.5, 100, 0.2);
    expect(near.to_s - near.from_s).toBeCloseTo(0.2, 12);
  });
  test('follows the position', () => {
    expect(following({ from_s: 10, to_s: 20 }, 15, 100)).toEqual({ from_s: 10, to_s: 20 });
    expect(following({ from_s: 10, to_s: 20 }, 21, 100)).toEqual({ from_s: 20, to_s: 30 });
    expect(following({ from_s: 10, to_s: 20 }, 99.5, 100)).toEqual({ from_s: 90, to_s: 100 });
    expect(following({ from_s: 50, to_s: 60 }, 2, 100)).toEqual({ from_s: 0, to_s: 10 });
  });
});
