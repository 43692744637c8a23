import { describe, expect, it } from 'vitest';
import { candidateTable, freeChoices, newFree, sweepVariants } from '../src/jobs/studies';

const speed = { type: ['number', 'string'], 'x-unit': 'm/s', minimum: 0, maximum: 0.001, default: '186 um/s' };
const swarm = { properties: { count: { type: 'integer', minimum: 1, maximum: 100000 }, model: { oneOf: [{ properties: { type: { const: 'dipole' }, speed, note: { type: 'string' } } }] } } };

describe('free parameters', () => {
  it('are the numbers of the model with a range, and the number of cells', () => {
    expect(Object.keys(freeChoices(swarm, 'dipole'))).toEqual(['swarm[0].model.speed', 'swarm[0].count']);
    expect(Object.keys(freeChoices(swarm, 'unknown'))).toEqual(['swarm[0].count']);
  });
  it('begin with half to twice the default, within the limits', () => {
    expect(newFree('p', speed)).toEqual({ path: 'p', prior: 'range', a: '0.000093 m/s', b: '0.000279 m/s' });
    expect(newFree('p', { ...speed, maximum: 0.0002 }).b).toBe('0.0002 m/s');
    expect(newFree('p', { type: 'number', minimum: 0, maximum: 2 })).toEqual({ path: 'p', prior: 'full', a: 0, b: 2 });
    expect(newFree('p', { type: 'integer', minimum: 1, maximum: 9 }).prior).toBe('range'); // an integer needs a range
  });
  it('are written as in a study file', () => {
    const free = [
      { path: 'a', prior: 'range' as const, a: 1, b: 2 },
      { path: 'b', prior: 'normal' as const, a: '1 s', b: '2 s' },
      { path: 'c', prior: 'full' as const, a: 1, b: 2 },
    ];
    expect(candidateTable({ name: 'dipole', type: 'dipole', free })).toEqual({ type: 'dipole', free: { a: [1, 2], b: { mean: '1 s', sd: '2 s' }, c: true } });
    expect(candidateTable({ name: 'slow', type: 'dipole', free: [] }).name).toBe('slow');
  });
});

describe('sweep', () => {
  const number = (path: string, schema: object) => ({ path, schema, value: 1 });
  it('has a model for each combination of values', () => {
    const all = sweepVariants([
      { number: number('swarm[0].model.speed', speed), low: '100 um/s', high: '200 um/s', count: 2 },
      { number: number('swarm[0].count', { type: 'integer' }), low: 10, high: 12, count: 3 },
    ]);
    expect(all.length).toBe(6);
    expect(all[0]).toEqual({ name: 'speed 100 µm/s, count 10', set: { 'swarm[0].model.speed': '0.0001 m/s', 'swarm[0].count': 10 } });
    expect(new Set(all.map((v) => v.name)).size).toBe(6);
  });
  it('has no value twice', () => {
    expect(sweepVariants([{ number: number('n', { type: 'integer' }), low: 1, high: 2, count: 9 }]).map((v) => v.set.n)).toEqual([1, 2]);
  });
  it('refuses missing bounds and too many combinations', () => {
    expect(() => sweepVariants([{ number: number('n', {}), low: undefined, high: 2, count: 2 }])).toThrow('sweep.range');
    const many = { number: number('n', {}), low: 0, high: 1, count: 100 };
    expect(() => sweepVariants([many, { ...many, number: number('m', {}) }])).toThrow('sweep.many');
  });
});
