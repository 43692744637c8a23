import { describe, expect, test } from 'vitest';
import { densityColours, densityOf, kSteps, niceCeiling, squareOf } from '../src/view/density';

const box = { left: -64, top: 0, right: 64, bottom: 64 };

describe('the density', () => {
  test('counts every cell once, in its square', () => {
    const xy = new Float32Array([-63, 1, -63.5, 0.5, 63, 63, 0.5, 10.5]), d = densityOf({ xy, cells: 4 }, box, 2);
    expect([d.columns, d.rows, d.side]).toEqual([64, 32, 2]);
    expect(d.counts.reduce((a, n) => a + n)).toBe(4);
    expect(d.counts[0]).toBe(2);
    expect(d.counts[32 * 64 - 1]).toBe(1);
    expect(d.counts[5 * 64 + 32]).toBe(1);
  });
  test('a uniform swarm has its number per area at the upper half of the scale', () => {
    const n = 64 * 32 * 10, xy = new Float32Array(2 * n);
    for (let i = 0; i < n; ++i) {
      xy[2 * i] = -64 + 2 * (i % 64) + 1;
      xy[2 * i + 1] = 2 * (((i / 64) | 0) % 32) + 1;
    }
    const d = densityOf({ xy, cells: n }, box, 10); // 10 cells in each 2 x 2 px: 250 in 10 x 10 px
    expect(d.most).toBe(300);
    expect(new Set(d.shades)).toEqual(new Set([Math.floor((kSteps * 250) / 300)]));
  });
  test('of quantised positions is that of pixels', () => {
    const parts = new Uint16Array([0, 0, 65535, 65535, 32768, 32768]), square = squareOf({ xy: parts }, box, { columns: 64, rows: 32, side: 2 });
    expect([square(0), square(1), square(2)]).toEqual([0, 32 * 64 - 1, 16 * 64 + 32]);
  });
  test('without cells', () => {
    expect(densityOf({ xy: new Float32Array(0), cells: 0 }, box, 1).most).toBe(1);
  });
});

test.each([[0, 1], [1, 1], [1.1, 1.5], [2.5, 3], [5.1, 6], [8.5, 10], [999, 1000], [1000, 1000], [0.035, 0.04]])('the end of a scale for %d is %d', (v, end) => {
  expect(niceCeiling(v)).toBeCloseTo(end, 12);
});

describe.each([[true, [11, 16, 23]], [false, [240, 243, 246]]] as const)('the colours, dark: %s', (dark, ground) => {
  const luminance = (c: readonly number[]) => {
    const [r, g, b] = c.map((v) => (v / 255 <= 0.04045 ? v / 255 / 12.92 : ((v / 255 + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const all = densityColours(dark).map(luminance);
  test('have increasing contrast to the ground', () => {
    expect(all).toHaveLength(kSteps);
    all.slice(1).forEach((v, i) => expect(dark ? v - all[i] : all[i] - v).toBeGreaterThan(0));
  });
  test('are visible on the ground', () => {
    const g = luminance(ground);
    for (const v of all) expect((Math.max(v, g) + 0.05) / (Math.min(v, g) + 0.05)).toBeGreaterThan(1.9);
  });
});
