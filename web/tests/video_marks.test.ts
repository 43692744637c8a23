import { describe, expect, test } from 'vitest';
import { noMarks, ordered, polygonOf, polygonText, readMarks, regionBetween, rulerLength, segmentAt, withEdge, withSegment, type Segment } from '../src/video/marks';

const segment = (from_s: number, to_s: number, direction_deg: number | null = null): Segment => ({ from_s, to_s, direction_deg });
const two = [segment(2, 4, 90), segment(6, 8, 270)];

describe('segments', () => {
  test('are in order and do not overlap', () => {
    expect(ordered([segment(6, 8), segment(2, 7), segment(3, 5)])).toEqual([segment(2, 7), segment(7, 8)]);
  });
  test('a new one is cut at its neighbours and at the ends of the video', () => {
    expect(withSegment(two, 3, 7, 10, 0)).toEqual([two[0], segment(4, 6, 0), two[1]]);
    expect(withSegment(two, 12, 9, 10, null)).toEqual([...two, segment(9, 10)]);
    expect(withSegment(two, 2.5, 3.5, 10, null)).toBe(two); // no room
  });
  test('an edge does not pass the other edge or a neighbour', () => {
    expect(withEdge(two, 0, 'to_s', 9, 10)[0].to_s).toBe(6);
    expect(withEdge(two, 1, 'from_s', 1, 10)[1].from_s).toBe(4);
    expect(withEdge(two, 1, 'to_s', 20, 10)[1].to_s).toBe(10);
    expect(withEdge(two, 0, 'to_s', 1, 10)[0].to_s).toBeGreaterThan(2);
    expect(withEdge(two, 0, 'from_s', 2.5, 10)).toEqual([segment(2.5, 4, 90), two[1]]);
  });
  test('contain their start, and not their end', () => {
    expect([1.9, 2, 3.9, 4, 6].map((t) => segmentAt(two, t))).toEqual([-1, 0, 0, -1, 1]);
  });
});

describe('places in the picture', () => {
  test('a region is in whole pixels inside the picture', () => {
    expect(regionBetween([50.4, 20], [10.2, -5], [100, 80])).toEqual({ x: 10, y: 0, width: 40, height: 20 });
    expect(regionBetween([90, 70], [500, 500], [100, 80])).toEqual({ x: 90, y: 70, width: 10, height: 10 });
    expect(regionBetween([5, 5], [5.4, 60], [100, 80])).toBeNull();
  });
  test('polygons are read and written as text', () => {
    expect(polygonOf(' 1,2 3,4;5,6.5 ')).toEqual([[1, 2], [3, 4], [5, 6.5]]);
    expect(['', '1,2 3,4', '1,2 3,x 5,6', '1,2,3 4,5 6,7'].map(polygonOf)).toEqual([null, null, null, null]);
    expect(polygonText([[1.2, 2], [3, 4], [5, 6]])).toBe('1,2 3,4 5,6');
  });
  test('a ruler has micrometres only with a scale', () => {
    expect(rulerLength([0, 0], [3, 4], 0.5)).toEqual({ px: 5, um: 2.5 });
    expect(rulerLength([0, 0], [3, 4], null)).toEqual({ px: 5, um: null });
  });
});

test('stored marks are read, and what is not valid is left out', () => {
  const marks = { reversal_s: 1.5, segments: two, roi: { x: 1, y: 2, width: 30, height: 40 }, masks: [[[1, 2], [3, 4], [5, 6]]] };
  expect(readMarks(JSON.parse(JSON.stringify(marks)))).toEqual(marks);
  expect([null, 7, 'x', {}, { segments: 3, roi: { x: 1 }, masks: [[1], 'a'], reversal_s: 'soon' }].map(readMarks)).toEqual(Array(5).fill(noMarks()));
  expect(readMarks({ segments: [{ from_s: 4, to_s: 3 }, two[1], null] }).segments).toEqual([two[1]]);
});
