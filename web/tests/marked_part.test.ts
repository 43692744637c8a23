import { describe, expect, test } from 'vitest';
import { asked, elapsed, partOf, validMarking, completeRun } from '../src/parts/marked_part';

const kMarking = { run: 3, seed: 7, first: 40, last: null };

describe('a marked part', () => {
  test('contains its first and its last frame', () => {
    expect(partOf(40, 79, 20)).toEqual({ from: 2, to: 4, most: 4, open: false });
    expect(asked(partOf(40, 79, 20))).toEqual({ from: 2, to: 4 });
    expect(asked(partOf(0, 79, 20))).toEqual({ to: 4 });
  });
  test('is not used for another run, another server, or a time before it', () => {
    expect(validMarking(kMarking, 3, 7, 40)).toBe(kMarking);
    for (const [run, seed, now] of [[4, 7, 50], [3, 8, 50], [3, 7, 39]]) expect(validMarking(kMarking, run, seed, now)).toBeNull();
    expect(validMarking(null, 3, 7, 50)).toBeNull();
  });
  test('the elapsed time is simulated time', () => {
    expect(elapsed(kMarking, 60, 20)).toBe(1);
  });
});

describe('the complete run', () => {
  test('is saved until the request, unless its end is moved', () => {
    const all = completeRun(99, 20);
    expect(asked(all)).toEqual({});
    expect(asked({ ...all, from: 1 })).toEqual({ from: 1 });
    expect(asked({ ...all, to: 3 })).toEqual({ to: 3 });
  });
});
