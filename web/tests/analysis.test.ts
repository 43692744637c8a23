import { describe, expect, test } from 'vitest';
import { areCurrents, invalidValues } from '../src/analysis';

describe('currents', () => {
  test.each(['0.5', '0.5, -0.5', '1e-3,.5, 0 ,+2.', '-1E2'])('%s is valid', (text) => {
    expect(areCurrents(text)).toBe(true);
  });
  test.each(['', ' ', '0.5,', '0.5,,1', ',', 'a', '0.5 A', '1;2', '0.5 0.5', 'NaN', 'Infinity', '0x1'])('"%s" is invalid', (text) => {
    expect(areCurrents(text)).toBe(false);
  });
});

describe('a form', () => {
  test('must have currents for a field map', () => {
    expect(invalidValues({ rig: 'rigs/a.toml', current: '' })).toEqual({ current: 'analyse.current_wrong' });
    expect(invalidValues({ rig: 'rigs/a.toml', current: '1, 2' })).toEqual({});
  });
  test('may have an empty direction, but no text', () => {
    expect(invalidValues({ video: 'runs/x', direction: '' })).toEqual({});
    expect(invalidValues({ video: 'runs/x', direction: '-90' })).toEqual({});
    expect(invalidValues({ video: 'runs/x', direction: 'up' })).toEqual({ direction: 'analyse.direction_wrong' });
  });
});
