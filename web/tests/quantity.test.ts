import { describe, expect, test } from 'vitest';
import { parseQuantity, parseUnit, showQuantity } from '../src/quantity';

const kMicro = '\u00b5', kMu = '\u03bc';
const size = (text: string) => {
  const f = parseUnit(text)!;
  return Number(`${f.factor}e${f.ten}`);
};

describe('units', () => {
  test.each([
    ['m', 1, [1, 0, 0, 0, 0, 0, 0]],
    ['um', 1e-6, [1, 0, 0, 0, 0, 0, 0]],
    ['kg', 1, [0, 1, 0, 0, 0, 0, 0]],
    ['um/s', 1e-6, [1, 0, -1, 0, 0, 0, 0]],
    ['A m^2', 1, [2, 0, 0, 1, 0, 0, 0]],
    ['A*m^2', 1, [2, 0, 0, 1, 0, 0, 0]],
    ['1/(T s)', 1, [0, -1, 1, 1, 0, 0, 0]],
    ['1/s', 1, [0, 0, -1, 0, 0, 0, 0]],
    ['mPa s', 1e-3, [-1, 1, -1, 0, 0, 0, 0]],
    ['um^2/s', 1e-12, [2, 0, -1, 0, 0, 0, 0]],
    ['s^-1', 1, [0, 0, -1, 0, 0, 0, 0]],
    ['mT/m', 1e-3, [-1, 1, -2, -1, 0, 0, 0]],
    ['G', 1e-4, [0, 1, -2, -1, 0, 0, 0]],
    ['GHz', 1e9, [0, 0, -1, 0, 0, 0, 0]],
    ['min', 60, [0, 0, 1, 0, 0, 0, 0]],
    ['%', 0.01, [0, 0, 0, 0, 0, 0, 0]],
    ['px', 1, [0, 0, 0, 0, 0, 0, 1]],
  ])('%s', (text, factor, dim) => {
    expect(size(text)).toBe(factor);
    expect(parseUnit(text)!.dim.map((d) => d + 0)).toEqual(dim);
  });
  test('a slash divides by the next factor only', () => {
    expect(parseUnit('m/s s')!.dim.map((d) => d + 0)).toEqual([1, 0, 0, 0, 0, 0, 0]);
    expect(parseUnit('m/(s s)')!.dim.map((d) => d + 0)).toEqual([1, 0, -2, 0, 0, 0, 0]);
  });
  test('compound units have the dimension of their definition', () => {
    expect(parseUnit('V s')!.dim).toEqual(parseUnit('T m^2')!.dim);
    expect(parseUnit('ohm A')!.dim).toEqual(parseUnit('V')!.dim);
    expect(parseUnit('H A^2')!.dim).toEqual(parseUnit('J')!.dim);
    expect(parseUnit('N/m^2')!.dim).toEqual(parseUnit('Pa')!.dim);
  });
  test('both characters for micro', () => {
    expect(size(`${kMicro}T`)).toBe(1e-6);
    expect(size(`${kMu}T`)).toBe(1e-6);
  });
  test.each(['', 'parsec', 'um/', '/s', 'm)', '(m', 'm^', 'm^x', 'm^12', 'u', 'um1', '1s', 'k1', '%m', 'constructor', 'm//s'])('%j is not a unit', (text) => {
    expect(parseUnit(text)).toBeNull();
  });
});

describe('reading a quantity', () => {
  test.each([
    ['186 um/s', 'm/s', 1.86e-4],
    ['186um/s', 'm/s', 1.86e-4],
    [`  186 ${kMicro}m/s `, 'm/s', 1.86e-4],
    ['0.05 T', 'mT', 50],
    ['1 G', 'uT', 100],
    ['2 min', 's', 120],
    ['180 deg', 'rad', Math.PI],
    ['50 %', '', 0.5],
    ['-3.5e-2 A', 'A', -0.035],
    ['+.5 s', 's', 0.5],
    ['1,5 um', 'm', 1.5e-6],
    ['3.', '', 3],
  ])('%j in %j', (text, unit, value) => {
    expect(parseQuantity(text, unit)).toBe(value);
  });
  test('a number without a unit is in the unit of the schema', () => {
    expect(parseQuantity('0.0002', 'm/s')).toBe(0.0002);
    expect(parseQuantity('7', 'px')).toBe(7);
  });
  test('decimal prefixes round once: the value is the same double as without a prefix', () => {
    for (let n = 1; n < 1000; ++n) {
      expect(parseQuantity(`${n} um`, 'm')).toBe(Number(`${n}e-6`));
      expect(parseQuantity(`${n} nT`, 'T')).toBe(Number(`${n}e-9`));
      expect(parseQuantity(`${n} um^2/s`, 'm^2/s')).toBe(Number(`${n}e-12`));
    }
  });
  test('very small units', () => {
    expect(parseQuantity('3 fm^2', 'm^2')).toBeCloseTo(3e-30, 44);
    expect(parseQuantity('2e-16 A m^2', 'A m^2')).toBe(2e-16);
  });
  test.each(['', '   ', 'um', 'abc', '--3', '- 3', '.', 'e5', 'NaN', 'Infinity'])('%j has no number', (text) => {
    expect(parseQuantity(text, 'm')).toBe('number');
  });
  test('a number out of the range of a double is invalid', () => {
    expect(parseQuantity('1e999', '')).toBe('number');
    expect(parseQuantity('-1e999 um', 'm')).toBe('number');
  });
  test.each(['3 bananas', '3 s', '3 m/s', '3 m m', '1.2.3', '3 px', '5e', '3 %'])('%j has the wrong unit for a length', (text) => {
    expect(parseQuantity(text, 'm')).toBe('unit');
  });
  test('a unit is invalid if the schema has none', () => {
    expect(parseQuantity('3 m', '')).toBe('unit');
    expect(parseQuantity('3 m/m', '')).toBe(3);
  });
});

describe('showing a quantity', () => {
  test.each([
    [1.86e-4, 'm/s', `186 ${kMicro}m/s`],
    [1.5e-3, 'm/s', '1.5 mm/s'],
    [7e-7, 'm', `0.7 ${kMicro}m`],
    [2.5e-8, 'm', '25 nm'],
    [-1.15e-4, 'T', `-115 ${kMicro}T`],
    [0.05, 'T', '50 mT'],
    [0.02, 's', '20 ms'],
    [Math.PI / 2, 'rad', '90 deg'],
    [12, 'px', '12 px'],
    [0.25, '', '0.25'],
    [0, 'T', '0 T'],
    [1e-30, 'm', '1e-30 m'],
  ])('%d %s is %s', (value, unit, text) => {
    expect(showQuantity(value, unit)).toBe(text);
  });
  test('a seed is shown with all its digits', () => {
    expect(showQuantity(232237428458673, '')).toBe('232237428458673');
    expect(showQuantity(0.123456789, '')).toBe('0.123457');
  });
  test('six digits, and the unit is chosen before rounding', () => {
    expect(showQuantity(1.23456789e-4, 'm')).toBe(`123.457 ${kMicro}m`);
    expect(showQuantity(9.99999999e-4, 'm')).toBe(`1000 ${kMicro}m`);
  });
  test('a displayed quantity is parsed as the same value', () => {
    for (const unit of ['m', 'm/s', 'T', 's', 'A', 'rad', 'T/m', 'H', 'px', '']) {
      for (const value of [0, 3.2e-9, 4.25e-7, 7e-6, 1.15e-4, 0.0123, 0.1, 1, 999, 123456, -6e-6]) {
        const back = parseQuantity(showQuantity(value, unit), unit) as number;
        expect(Math.abs(back - value), `${value} ${unit}`).toBeLessThanOrEqual(1e-5 * Math.abs(value));
      }
    }
  });
});
