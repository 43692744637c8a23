import { describe, expect, test } from 'vitest';
import { areCurrents, exampleCurrents, invalidValues } from '../src/analysis';

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
  test('has one current for each coil of the file, or none for the currents of the file', () => {
    const system = (coils: number, currents: boolean) => ({ file: 'rigs/a.toml', coils, currents });
    const wrong = (current: string, coils: number, currents = false) => invalidValues({ current }, system(coils, currents)).current;
    expect(wrong('1, 2', 2)).toBeUndefined();
    expect(wrong('1, 2, 3, 4', 1)).toBe('analyse.current_count');
    expect(wrong('1', 0)).toBeUndefined(); // the number of coils is unknown
    expect(wrong('', 2)).toBe('analyse.current_wrong');
    expect(wrong('', 2, true)).toBeUndefined();
    expect(wrong('a', 1, true)).toBe('analyse.current_wrong');
    expect([0, 1, 4].map(exampleCurrents)).toEqual(['', '0.5', '0.5, 0.5, 0, 0']);
  });
  test('may have an empty direction, but no text', () => {
    expect(invalidValues({ video: 'runs/x', direction: '' })).toEqual({});
    expect(invalidValues({ video: 'runs/x', direction: '-90' })).toEqual({});
    expect(invalidValues({ video: 'runs/x', direction: '360' })).toEqual({});
    expect(invalidValues({ video: 'runs/x', direction: '-361' })).toEqual({ direction: 'analyse.direction_wrong' });
    expect(invalidValues({ video: 'runs/x', direction: 'up' })).toEqual({ direction: 'analyse.direction_wrong' });
  });
});
