import { describe, expect, test } from 'vitest';
import type { Frame } from '../src/frame';
import { recordedMarks, tesla, zeros } from '../src/view/overlay';

describe('the strength of a field', () => {
  test.each([
    [0, '0.00 nT'],
    [3.456e-9, '3.46 nT'],
    [5e-7, '500 nT'],
    [1.15e-4, '115 µT'],
    [1e-6, '1.00 µT'],
    [5e-3, '5.00 mT'],
    [0.25, '250 mT'],
    [1.5, '1.50 T'],
    [12345, '12345 T'],
  ])('%d T is %s', (b, text) => {
    expect(tesla(b)).toBe(text);
  });
  test('a value that rounds up to 1000 takes the next unit', () => {
    expect(tesla(9.996e-7)).toBe('1.00 µT');
    expect(tesla(9.996e-4)).toBe('1.00 mT');
    expect(tesla(0.9996)).toBe('1.00 T');
    expect(tesla(9.994e-4)).toBe('999 µT');
  });
});

describe('zeros of the field', () => {
  const grid = (columns: number, rows: number, field: (c: number, r: number) => [number, number]): Frame => {
    const xy = new Float32Array(columns * rows * 2);
    for (let r = 0; r < rows; ++r) for (let c = 0; c < columns; ++c) xy.set(field(c, r), 2 * (r * columns + c));
    return { field: { columns, rows, xy } } as Frame;
  };
  const near = (found: [number, number][], wanted: [number, number][]) => {
    expect(found).toHaveLength(wanted.length);
    found.forEach((q, i) => q.forEach((v, k) => expect(v).toBeCloseTo(wanted[i][k], 5)));
  };

  test('a linear field has one zero, between the points of the grid', () => {
    near(zeros(grid(5, 4, (c, r) => [c - 1.25, r - 2.6])), [[1.25, 2.6]]);
    near(zeros(grid(5, 4, (c, r) => [r - 0.7 + (c - 3.2), r - 0.7 - (c - 3.2)])), [[3.2, 0.7]]);
  });
  test('a zero at a point of the grid, where six triangles meet, is returned once', () => {
    near(zeros(grid(5, 4, (c, r) => [c - 2, 1 - r])), [[2, 1]]);
  });
  test('a homogeneous field has none', () => {
    expect(zeros(grid(6, 6, () => [1e-4, 0]))).toEqual([]);
    expect(zeros(grid(1, 1, () => [0, 0]))).toEqual([]);
  });
  test('none outside of the grid', () => {
    expect(zeros(grid(4, 4, (c, r) => [c + 0.5, r - 1]))).toEqual([]);
  });
  test('two', () => {
    const f = grid(9, 3, (c, r) => [Math.abs(c - 4) - 2.5, r - 1.25]);
    near(zeros(f), [[1.5, 1.25], [6.5, 1.25]]);
  });
});

describe('marks of a recorded row', () => {
  const of = (row: Record<string, number>) => (name: string) => row[name] ?? NaN;

  test('pairs of columns', () => {
    const row = { true_centroid_x_px: 1, true_centroid_y_px: 2, true_sigma_x_px: 3, true_sigma_y_px: 4, estimated_centroid_x_px: 9, setpoint_x_px: 5, setpoint_y_px: 6 };
    expect(recordedMarks(of(row))).toEqual({ centroid: [1, 2], sigma: [3, 4], setpoint: [5, 6] });
  });
  test('a pair with a missing value gives null', () => {
    expect(recordedMarks(of({ centroid_x_px: 1, sigma_y_px: 4 }))).toEqual({ centroid: null, sigma: null, setpoint: null });
  });
});
