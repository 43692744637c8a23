import { describe, expect, test } from 'vitest';
import { barLength, changedValues, commandOf, digits, setupOf, withObjective } from '../src/pages/optics/optics';

describe('the address of the optics planner', () => {
  test('has numbers and texts with a unit', () => {
    expect(setupOf({ preset: '100x', width_px: '800', speed: '140 um/s', exposure_time: '' })).toEqual({ preset: '100x', width_px: 800, speed: '140 um/s', exposure_time: '' });
  });
  test('another objective replaces what belongs to the objective only', () => {
    const values = { preset: '20x', numerical_aperture: '0.5', um_per_px: '0.3', speed: '60 um/s' };
    expect(withObjective(values, '100x')).toEqual({ preset: '100x', speed: '60 um/s' });
    expect(withObjective(values, '10x')).toEqual({ speed: '60 um/s' });
  });
  test('a default is not part of it', () => {
    expect(changedValues({ speed: '60 um/s', width_px: '800' }, 'speed', undefined)).toEqual({ width_px: '800' });
    expect(changedValues({}, 'frame_rate', '60 Hz')).toEqual({ frame_rate: '60 Hz' });
  });
  test('is a command', () => {
    expect(commandOf({})).toBe('faba optics');
    expect(commandOf({ preset: '100x', frame_rate: '60 Hz', cells_per_mm2: '300' })).toBe("faba optics --objective 100x --frame-rate '60 Hz' --cells-per-mm2 300");
    expect(commandOf({ speed: "1'; rm" })).toBe("faba optics --speed '1'\\''; rm'");
  });
});

test('figures have three digits', () => {
  expect([0.2066, 2.758, 15.47, 384.7, 1234.5].map(digits)).toEqual(['0.207', '2.76', '15.5', '385', '1235']);
});
test('a scale bar is 1, 2 or 5 times a power of ten', () => {
  expect([0.3, 0.6, 1, 19, 20, 499].map(barLength)).toEqual([0.2, 0.5, 1, 10, 20, 200]);
});
