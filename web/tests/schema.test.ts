import { describe, expect, test } from 'vitest';
import { amount, check, inputPath, kindOf, presetState, same, shown, sourceOf, variant, variants, type Schema } from '../src/form/schema';
import { sampleSchema } from './sample_schema';

const speed: Schema = { type: ['number', 'string'], 'x-unit': 'm/s', minimum: 7e-6, maximum: 3.2e-4 };
const count: Schema = { type: 'integer', minimum: 1, maximum: 5e7 };
const fraction: Schema = { type: 'number', minimum: 0, maximum: 1 };

describe('the kind of a value', () => {
  const number: Schema = { type: 'number' };
  test.each<[string, Schema, string]>([
    ['a part', { oneOf: [{ const: 'x' }] }, 'part'],
    ['a choice', { type: 'string', enum: ['a', 'b'] }, 'choice'],
    ['a flag', { type: 'boolean' }, 'flag'],
    ['an integer', { type: 'integer' }, 'integer'],
    ['a number', number, 'number'],
    ['a quantity', { type: ['number', 'string'], 'x-unit': 'm' }, 'number'],
    ['a text', { type: 'string' }, 'text'],
    ['a vector', { type: 'array', items: number, minItems: 2, maxItems: 2 }, 'vector'],
    ['a list of numbers', { type: 'array', items: number }, 'numbers'],
    ['a list of points', { type: 'array', items: { type: 'array', items: number } }, 'points'],
    ['a list of tables', { type: 'array', items: { properties: { a: number } } }, 'tables'],
    ['a list of parts', { type: 'array', items: { oneOf: [] } }, 'tables'],
    ['a table', { type: 'object', properties: {} }, 'table'],
  ])('%s', (_, schema, kind) => {
    expect(kindOf(schema)).toBe(kind);
  });
});

describe('checking input', () => {
  test('a quantity is converted to the unit of the schema, with the same value as in the program', () => {
    expect(check('186 um/s', speed)).toEqual({ value: '0.000186 m/s' });
    expect(check('7 um/s', speed)).toEqual({ value: '0.000007 m/s' });
    expect(check('0.0002', speed)).toEqual({ value: '0.0002 m/s' });
  });
  test('a number without a unit stays a number', () => {
    expect(check('12', count)).toEqual({ value: 12 });
    expect(check('50 %', fraction)).toEqual({ value: 0.5 });
  });
  test('empty input is the default, unless a value is required', () => {
    expect(check(' ', speed)).toEqual({});
    expect(check('', speed, true)).toEqual({ wrong: ['form.number', {}] });
  });
  test('invalid input', () => {
    expect(check('fast', speed)).toEqual({ wrong: ['form.number', {}] });
    expect(check('3 bananas', speed)).toEqual({ wrong: ['form.unit', { unit: 'm/s' }] });
    expect(check('3 um', fraction)).toEqual({ wrong: ['form.number', {}] });
    expect(check('1.5', count)).toEqual({ wrong: ['form.integer', {}] });
    expect(check('-5 um/s', speed)).toEqual({ wrong: ['form.least', { limit: '7 µm/s' }] });
    expect(check('0', count)).toEqual({ wrong: ['form.least', { limit: '1' }] });
    expect(check('321 um/s', speed)).toEqual({ wrong: ['form.most', { limit: '320 µm/s' }] });
    expect(check('1e999', { type: 'number' })).toEqual({ wrong: ['form.number', {}] });
  });
  test('a displayed limit is permitted', () => {
    for (let n = 1; n < 1000; ++n) {
      const limit = Number(`${n}e-6`), s: Schema = { type: ['number', 'string'], 'x-unit': 'm', minimum: limit, maximum: limit };
      expect(check(shown(limit, s), s).wrong, `${n} um`).toBeUndefined();
    }
  });
});

describe('values of a scenario', () => {
  test('the amount of a number or a quantity', () => {
    expect(amount(3, 'm')).toBe(3);
    expect(amount('3 um', 'm')).toBe(3e-6);
    expect(amount('3 s', 'm')).toBeNull();
    expect(amount([3], 'm')).toBeNull();
    expect(amount(undefined, 'm')).toBeNull();
  });
  test('are displayed with a common unit, others unchanged', () => {
    expect(shown('0.000186 m/s', speed)).toBe('186 µm/s');
    expect(shown(0.5, fraction)).toBe('0.5');
    expect(shown('north', { type: 'string' })).toBe('north');
    expect(shown(undefined, speed)).toBe('');
    expect(shown(null, speed)).toBe('');
  });
  test('are equal independent of their units', () => {
    expect(same('186 um/s', '0.000186 m/s', speed)).toBe(true);
    expect(same('186 um/s', 0.000186, speed)).toBe(true);
    expect(same('186 um/s', '187 um/s', speed)).toBe(false);
    expect(same(0, '0 m/s', speed)).toBe(true);
    expect(same(0, 1e-30, speed)).toBe(false);
  });
  test('lists are compared item by item', () => {
    const list: Schema = { type: 'array', items: { type: ['number', 'string'], 'x-unit': 'T' } };
    expect(same(['1 mT', '0 T'], [0.001, 0], list)).toBe(true);
    expect(same(['1 mT', '0 T'], [0.001], list)).toBe(false);
    expect(same([0.001], ['1 mT', '0 T'], list)).toBe(false);
    expect(same([[1, 2]], [[1, 2]], { items: { items: {} } })).toBe(true);
    expect(same([[1, 2]], [[1, 3]], { items: { items: {} } })).toBe(false);
  });
  test('of any other type are compared as JSON', () => {
    expect(same(true, true, {})).toBe(true);
    expect(same(true, false, {})).toBe(false);
    expect(same('a', undefined, {})).toBe(false);
  });
});

describe('the parts of a section', () => {
  const controllers = sampleSchema.properties!.controller;
  test('by name', () => {
    expect(variants(controllers)).toEqual(['alpha', 'beta', 'gamma', 'delta', 'zeta']);
    expect(variant(controllers, 'beta')?.title).toBe('beta');
    expect(variant(controllers, 'none')).toBeUndefined();
    expect(variants({})).toEqual([]);
  });
});

describe('presets', () => {
  const size: Schema = { type: ['number', 'string'], 'x-unit': 'm', default: '1 um', 'x-source': 'measured for first' };
  const spread: Schema = { type: 'number', default: 0, 'x-source': 'assumed' };
  const rate: Schema = { type: 'number' };
  const preset: Schema = {
    type: 'string',
    enum: ['first', 'second'],
    'x-source': { first: 'paper 1', second: 'paper 2' },
    'x-values': { first: { size: '1 um', spread: 0.3 }, second: { size: '2 um', spread: 0.3 } },
  };
  const part: Schema = { properties: { type: { const: 'rod' }, preset, size, spread, rate } };

  const state = (table: Record<string, any>) => presetState(part, { type: 'rod', ...table });
  test('the preset that the table names, with the values that differ from it', () => {
    expect(state({ preset: 'second' })).toMatchObject({ preset: 'second', changed: [] });
    expect(state({ preset: 'second', size: '2 um', spread: 0 })).toMatchObject({ preset: 'second', changed: ['spread'] });
    expect(state({ preset: 'second', spread: 0.3, size: '9 um' })).toMatchObject({ preset: 'second', changed: ['size'] });
  });
  test('the preset with the values of a resolved table, in any unit', () => {
    expect(state({ size: '0.000002 m', spread: 0.3 })).toMatchObject({ preset: 'second', changed: [] });
    expect(state({ size: '0.000001 m', spread: 0.3 })).toMatchObject({ preset: 'first', changed: [] });
  });
  test('a resolved table with some other values still shows its preset: it is not a custom table', () => {
    expect(state({ size: '2 um', spread: 0.3, rate: 1 })).toMatchObject({ preset: 'second', changed: ['rate'] });
    expect(state({ size: '2 um', spread: 0.4 })).toMatchObject({ preset: 'second', changed: ['spread'] });
  });
  test('none if its values are closer to the defaults, or if it does not have those that distinguish presets', () => {
    expect(state({}).preset).toBe('');
    expect(state({ rate: 2 }).preset).toBe('');
    expect(state({ size: '5 um', spread: 0.3 }).preset).toBe('');
    expect(presetState({ properties: { type: { const: 'dot' } } }, { type: 'dot' }).preset).toBe('');
    expect(presetState(undefined, {}).preset).toBe('');
  });
  test('the defaults are not custom values', () => {
    expect(state({ size: '0.001 mm' }).isDefault).toBe(true);
    expect(state({ size: '2 um' }).isDefault).toBe(false);
    expect(state({ rate: 2 }).isDefault).toBe(false);
  });
  test('the source of a value is that of the preset that gives it, and that of the schema for the default', () => {
    const second = { value: '2 um', source: 'paper 2' };
    expect(sourceOf(size, '0.000002 m', second)).toEqual(['form.source', { source: 'paper 2' }]);
    expect(sourceOf(size, '1 um', { value: '1 um', source: 'paper 1' })).toEqual(['form.source', { source: 'measured for first' }]);
    expect(sourceOf(size, undefined)).toEqual(['form.source', { source: 'measured for first' }]);
    expect(sourceOf(size, '3 um', second)).toEqual(['form.default_source', { source: 'measured for first', value: '1 µm' }]);
    expect(sourceOf(rate, 3)).toBeNull();
  });
});

describe('the input of an error', () => {
  const scenario = { swarm: [{ model: { type: 'rod', preset: 'first' }, start: 'seen' }], controller: { type: 'alpha' }, reference: 'path' };
  test.each([
    ['swarm[0].count', 'swarm[0].count'],
    ['scenes/x.toml:12: swarm[0].count', 'swarm[0].count'],
    ['swarm[0].model.preset', 'swarm[0].model'],
    ['swarm[0].model.type', 'swarm[0].model'],
    ['swarm[0].model.unknown', 'swarm[0].model'],
    ['swarm[0]', 'swarm[0]'],
    ['controller.field[1]', 'controller.field'],
    ['controller.current', 'controller'],
    ['reference.setpoints_px[2][0]', 'reference.setpoints_px'],
    ['title', 'title'],
    ['nothing.at.all', ''],
    ['', ''],
    ['steer', ''],
  ])('%s is at "%s"', (where, path) => {
    expect(inputPath(sampleSchema, scenario, where)).toBe(path);
  });
});
