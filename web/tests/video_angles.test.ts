import { describe, expect, test } from 'vitest';
import { directionOf, flipped, normalised, unitVector, wholeDegrees } from '../src/video/angles';

describe('directions are counter-clockwise from the right, in a picture with y down', () => {
  test.each([
    [1, 0, 0],
    [0, -1, 90], // up
    [-1, 0, 180],
    [0, 1, 270], // down
    [1, -1, 45],
    [1, 1, 315],
  ])('(%d, %d) is %d degrees', (dx, dy, deg) => {
    expect(directionOf(dx, dy)).toBeCloseTo(deg, 9);
    const [x, y] = unitVector(deg);
    expect(x).toBeCloseTo(dx / Math.hypot(dx, dy), 9);
    expect(y).toBeCloseTo(dy / Math.hypot(dx, dy), 9);
  });
});
test('angles are between 0 and 360 degrees', () => {
  expect([-90, 360, 720, 450, -1e-20].map(normalised)).toEqual([270, 0, 0, 90, 0]);
  expect(Object.is(normalised(-0), 0)).toBe(true);
  expect([359.7, 12.4].map(wholeDegrees)).toEqual([0, 12]);
});
test('the program measures clockwise: 90 degrees is down', () => {
  expect([0, 90, 180, 332].map(flipped)).toEqual([0, 270, 180, 28]);
  expect(flipped(flipped(33))).toBe(33);
});
