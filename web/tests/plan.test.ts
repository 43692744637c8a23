// The plan of a controller: decoding, the ellipse of its estimate, and polygons.
import { describe, expect, test } from 'vitest';
import { decodeFrame } from '../src/frame';
import { ellipseOfCovariance, kSigmas95 } from '../src/view/ellipse';
import { crossesItself, inside, middle, polygonAt, type Point } from '../src/view/polygon';

/** A frame without cells, with an estimate and a plan, after the table in web/protocol.md. */
function message(bits: number): DataView<ArrayBuffer> {
  const estimate = bits & 32 ? 24 : 0, plan = bits & 64 ? 8 + 3 * 8 : 0;
  const v = new DataView(new ArrayBuffer(48 + estimate + plan));
  [...'FABA'].forEach((letter, i) => v.setUint8(i, letter.charCodeAt(0)));
  v.setUint16(4, 1, true);
  v.setUint16(6, 1 + bits, true);
  let at = 48;
  const f32 = (x: number) => (v.setFloat32(at, x, true), (at += 4));
  if (estimate) {
    v.setUint32(at, 1, true);
    at += 4;
    [320.5, 240.25, 4, -1.5, 2].forEach(f32);
  }
  if (plan) {
    v.setUint16(at, 3, true);
    v.setUint16(at + 2, 0b1000110, true); // current, slew, obstacle
    at += 4;
    [0.125, 10, 20, 11, 22, 12, 24].forEach(f32);
  }
  return v;
}

describe('decoding', () => {
  test('estimate and plan', () => {
    const f = decodeFrame(message(32 + 64).buffer, 1);
    expect(f.estimate).toEqual({ at: [320.5, 240.25], cov: { xx: 4, xy: -1.5, yy: 2 }, predicted: true });
    expect(f.plan).toEqual({ path: [[10, 20], [11, 22], [12, 24]], step: 0.125, active: ['current', 'slew', 'obstacle'] });
  });
  test('each alone, and neither', () => {
    expect(decodeFrame(message(32).buffer, 1)).toMatchObject({ plan: null, estimate: { at: [320.5, 240.25] } });
    expect(decodeFrame(message(64).buffer, 1)).toMatchObject({ estimate: null, plan: { step: 0.125 } });
    expect(decodeFrame(message(0).buffer, 1)).toMatchObject({ estimate: null, plan: null });
  });
  test('truncated messages are refused', () => {
    const { buffer } = message(32 + 64);
    for (let n = 48; n < buffer.byteLength; ++n) expect(() => decodeFrame(buffer.slice(0, n), 1)).toThrow('truncated');
  });
  test('a plan with more positions than the message has is refused', () => {
    const v = message(64);
    v.setUint16(48, 4, true);
    expect(() => decodeFrame(v.buffer, 1)).toThrow('truncated');
    v.setUint16(48, 2, true);
    expect(() => decodeFrame(v.buffer, 1)).toThrow('its header gives');
  });
});

describe('the 95 % ellipse of a covariance', () => {
  test('has 95 % of a normal distribution', () => {
    // The fraction within k standard deviations in two dimensions is 1 - exp(-k^2 / 2).
    expect(1 - Math.exp(-(kSigmas95 ** 2) / 2)).toBeCloseTo(0.95, 12);
  });
  test('axes along x and y', () => {
    expect(ellipseOfCovariance({ xx: 9, xy: 0, yy: 4 }, 2)).toEqual({ major: 6, minor: 4, angle: 0 });
    expect(ellipseOfCovariance({ xx: 4, xy: 0, yy: 9 }).angle).toBeCloseTo(Math.PI / 2, 12);
  });
  test('a rotated ellipse: eigenvalues 9 and 1, major axis at 30 degrees', () => {
    const c = Math.cos(Math.PI / 6), s = Math.sin(Math.PI / 6);
    const e = ellipseOfCovariance({ xx: 9 * c * c + s * s, xy: 8 * c * s, yy: 9 * s * s + c * c });
    expect([e.major, e.minor, e.angle]).toEqual([3, 1, Math.PI / 6].map((v) => expect.closeTo(v, 10)));
  });
  test('a degenerate covariance gives a line, not NaN', () => {
    expect(ellipseOfCovariance({ xx: 1, xy: 1, yy: 1 })).toMatchObject({ minor: expect.closeTo(0, 10) });
    expect(ellipseOfCovariance({ xx: 0, xy: 0, yy: 0 })).toMatchObject({ major: 0, minor: 0 });
  });
});

describe('polygons', () => {
  const square: Point[] = [[0, 0], [10, 0], [10, 10], [0, 10]], arrow: Point[] = [[0, 0], [10, 5], [0, 10], [4, 5]];

  test('inside, also of a polygon that is not convex, in both directions', () => {
    for (const polygon of [square, [...square].reverse()]) {
      expect(inside(polygon, [5, 5])).toBe(true);
      expect([[-1, 5], [11, 5], [5, -1], [5, 11]].map((p) => inside(polygon, p as Point))).toEqual([false, false, false, false]);
    }
    expect([inside(arrow, [6, 5]), inside(arrow, [2, 5])]).toEqual([true, false]);
  });
  test('the upper one of two polygons is hit', () => {
    const shifted = square.map(([x, y]): Point => [x + 5, y]);
    expect([polygonAt([square, shifted], [7, 5]), polygonAt([square, shifted], [2, 5]), polygonAt([square, shifted], [99, 5])]).toEqual([1, 0, null]);
    expect(polygonAt([], [0, 0])).toBeNull();
  });
  test('outlines that cross themselves', () => {
    expect([square, arrow, square.slice(0, 3)].map(crossesItself)).toEqual([false, false, false]);
    expect(crossesItself([[0, 0], [10, 10], [10, 0], [0, 10]])).toBe(true);
    expect(crossesItself([[0, 0], [10, 0], [10, 10], [5, -5], [0, 10]])).toBe(true);
  });
  test('the middle is the mean of the corners', () => {
    expect(middle(square)).toEqual([5, 5]);
  });
});
