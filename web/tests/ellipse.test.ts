import { describe, expect, test } from 'vitest';
import type { Frame } from '../src/frame';
import { Camera } from '../src/view/camera';
import { correlation, ellipseOf } from '../src/view/ellipse';
import { Overlay, type Layers, type Palette, type Scene } from '../src/view/overlay';

/** A cloud with normal coordinates along two axes, `a` and `b` long, the first at an angle; deterministic. */
function cloud(n: number, a: number, b: number, angle: number): Float32Array {
  const xy = new Float32Array(2 * n), c = Math.cos(angle), s = Math.sin(angle);
  let seed = 1;
  const uniform = () => ((seed = (seed * 48271) % 2147483647), seed / 2147483647);
  for (let i = 0; i < n; ++i) {
    const r = Math.sqrt(-2 * Math.log(uniform())), t = 2 * Math.PI * uniform(), u = a * r * Math.cos(t), v = b * r * Math.sin(t);
    xy[2 * i] = 300 + c * u - s * v;
    xy[2 * i + 1] = 200 + s * u + c * v;
  }
  return xy;
}
/** Standard deviations of x and y, as in a series. */
function sigmas(xy: Float32Array): [number, number] {
  const of = (k: number) => {
    const v = Array.from(xy.filter((_, i) => i % 2 === k)), mean = v.reduce((p, x) => p + x, 0) / v.length;
    return Math.sqrt(v.reduce((p, x) => p + (x - mean) ** 2, 0) / (v.length - 1));
  };
  return [of(0), of(1)];
}

describe('the ellipse of a swarm', () => {
  test.each([0.3, Math.PI / 4, 1.2, -0.6, -Math.PI / 4])('with its long axis at %d rad is rotated and has the lengths of its axes', (angle) => {
    const n = 20000, xy = cloud(n, 40, 10, angle), e = ellipseOf(...sigmas(xy), correlation({ xy, cells: n }));
    expect(e.angle).toBeCloseTo(angle, 1);
    expect(e.major / 40).toBeCloseTo(1, 1.5);
    expect(e.minor / 10).toBeCloseTo(1, 1.5);
  });
  test('of a line at 45 degrees has no width, and is the line', () => {
    const xy = new Float32Array([0, 0, 10, 10, 20, 20]), rho = correlation({ xy, cells: 3 });
    expect(rho).toBeCloseTo(1, 12);
    const e = ellipseOf(10, 10, rho);
    expect(e.angle).toBeCloseTo(Math.PI / 4, 6);
    expect(e.major).toBeCloseTo(Math.SQRT2 * 10, 6);
    expect(e.minor).toBeCloseTo(0, 3);
  });
  test('without correlation is parallel to the axes, the longer one first', () => {
    expect(ellipseOf(30, 10, 0)).toEqual({ major: 30, minor: 10, angle: 0 });
    const upright = ellipseOf(10, 30, 0);
    expect([upright.major, upright.minor]).toEqual([30, 10]);
    expect(Math.abs(upright.angle)).toBeCloseTo(Math.PI / 2, 12);
  });
  test('keeps the variances: its shadow on each axis is the standard deviation', () => {
    const [sx, sy] = [17, 29], e = ellipseOf(sx, sy, -0.4), c = Math.cos(e.angle), s = Math.sin(e.angle);
    expect(Math.hypot(e.major * c, e.minor * s)).toBeCloseTo(sx, 9);
    expect(Math.hypot(e.major * s, e.minor * c)).toBeCloseTo(sy, 9);
  });
});

describe('the correlation', () => {
  test('does not depend on the scale and origin of quantised positions', () => {
    const xy = cloud(5000, 40, 15, 0.7), parts = Uint16Array.from(xy, (v, i) => (i % 2 ? v * 90 : v * 70));
    expect(correlation({ xy: parts, cells: 5000 })).toBeCloseTo(correlation({ xy, cells: 5000 }), 3);
  });
  test('of a large swarm is computed from a part of it', () => {
    const xy = cloud(100000, 40, 15, 0.7);
    expect(correlation({ xy, cells: 100000 })).toBeCloseTo(correlation({ xy: xy.subarray(0, 40000), cells: 20000 }), 1);
  });
  test('is 0 without cells, for one cell, and for cells on a horizontal line', () => {
    expect(correlation({ xy: new Float32Array(0), cells: 0 })).toBe(0);
    expect(correlation({ xy: new Float32Array([3, 4]), cells: 1 })).toBe(0);
    expect(correlation({ xy: new Float32Array([3, 4, 5, 4]), cells: 2 })).toBe(0);
  });
});

test('the overlay draws the ellipse along the cloud of the cells, not along the axes of the picture', () => {
  const angle = 0.6, n = 20000, xy = cloud(n, 40, 10, angle), drawn: number[][] = [];
  const canvas = new Proxy({} as Record<string, unknown>, { get: (_, name) => (name === 'ellipse' ? (...a: number[]) => drawn.push(a) : () => undefined), set: () => true });
  const camera = new Camera();
  camera.scale = 2;
  const marks = { centroid: [300, 200] as [number, number], sigma: sigmas(xy), setpoint: null, asked: null, sketch: [] };
  new Overlay(canvas as unknown as CanvasRenderingContext2D, () => '').draw({} as Scene, { xy, cells: n } as Frame, camera, { swarm: true } as Layers, marks, {} as Palette, 1, true);
  expect(drawn).toHaveLength(1);
  const [, , major, minor, rotation] = drawn[0];
  expect(rotation).toBeCloseTo(angle, 1);
  expect(major / (2 * 40)).toBeCloseTo(1, 1);
  expect(minor / (2 * 10)).toBeCloseTo(1, 1);
});
