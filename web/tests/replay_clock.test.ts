import { describe, expect, test } from 'vitest';
import { ReplayClock } from '../src/pages/runs/replay_clock.svelte';

/** 40 frames of 20 Hz: a part from 2 s to the frame at 3.95 s. */
function clock() {
  const c = new ReplayClock();
  c.begin(2, 40, 20);
  return c;
}

describe('the replay', () => {
  test('starts at the first recorded frame and plays', () => {
    const c = clock();
    expect([c.t, c.frame, c.to, c.playing]).toEqual([2, 0, 3.95, true]);
    c.advance(0.5);
    expect([c.t, c.frame]).toEqual([2.5, 10]);
  });
  test('a speed', () => {
    const c = clock();
    c.speed = 0.1;
    c.advance(1);
    expect(c.frame).toBe(2);
    c.faster(-1);
    expect(c.speed).toBe(0.1);
    c.faster(1);
    expect(c.speed).toBe(0.25);
  });
  test('stops at the last frame, and plays from the start again', () => {
    const c = clock();
    c.advance(10);
    expect([c.frame, c.playing]).toEqual([39, false]);
    c.toggle();
    expect([c.t, c.playing]).toEqual([2, true]);
  });
  test('loops', () => {
    const c = clock();
    c.loop = true;
    c.advance(1.95 + 0.25);
    expect(c.t).toBeCloseTo(2.25);
    c.advance(1.95 * 3);
    expect(c.t).toBeCloseTo(2.25);
    expect(c.playing).toBe(true);
  });
  test('every frame can be reached by steps, which pause', () => {
    const c = clock();
    for (let k = 1; k < 40; ++k) {
      c.step(1);
      expect(c.frame).toBe(k);
    }
    c.step(1);
    expect([c.frame, c.playing]).toEqual([39, false]);
    c.step(-5);
    expect(c.frame).toBe(34);
    c.advance(1);
    expect(c.frame).toBe(34);
  });
  test('the time stays in the recording', () => {
    const c = clock();
    c.seek(-1);
    expect(c.t).toBe(2);
    c.seek(99);
    expect(c.t).toBe(3.95);
  });
  test('keys', () => {
    const c = clock();
    expect(c.key(' ')).toBe(true);
    expect(c.playing).toBe(false);
    for (const [key, frame] of [['ArrowRight', 1], ['.', 2], ['ArrowLeft', 1], [',', 0], ['End', 39], ['Home', 0]] as const) {
      c.key(key);
      expect(c.frame, key).toBe(frame);
    }
    c.key('l');
    expect(c.loop).toBe(true);
    for (const other of ['x', 'Tab', 'toString']) expect(c.key(other)).toBe(false);
  });
  test('of one frame', () => {
    const c = new ReplayClock();
    c.begin(1, 1, 20);
    c.loop = true;
    c.toggle();
    c.advance(1);
    expect([c.t, c.playing]).toEqual([1, false]);
  });
});
