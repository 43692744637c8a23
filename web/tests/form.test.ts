import { beforeAll, describe, expect, test } from 'vitest';
import type { Schema } from '../src/form/schema';
import { hasMatch, isMatch, wordsOf } from '../src/form/search';
import { changed, found, kSize, kSpeed, kTarget } from '../src/form/simple';
import { englishTitle, titleOf } from '../src/form/titles';
import { words } from '../src/i18n';
import { loadTexts } from '../src/i18n/program/catalogue';
import { sampleSchema } from './sample_schema';

beforeAll(() => loadTexts('pt'));

const en = words('en'), pt = words('pt');

describe('titles', () => {
  test('are made from the key, without the unit, which the value has', () => {
    expect(englishTitle('max_output')).toBe('Max output');
    expect(englishTitle('radius_px')).toBe('Radius');
    expect(englishTitle('speed_sd')).toBe('Speed, standard deviation');
    expect(englishTitle('psf_sd')).toBe('PSF, standard deviation');
  });
  test('are those of the schema if it has one; the title of a section or part is its key', () => {
    expect(englishTitle('max_speed', { type: 'number', title: 'Noise amplitude' })).toBe('Noise amplitude');
    expect(englishTitle('scale', { title: 'scale', properties: {} })).toBe('Scale');
  });
  test('are translated if there is a translation', () => {
    expect(titleOf('max_speed', { type: 'number', title: 'Noise amplitude' }, pt)).toBe('Amplitude do ruído');
    expect(titleOf('speed', {}, pt)).toBe('Velocidade');
    expect(titleOf('no_such_key', {}, pt)).toBe('No such key');
  });
});

describe('search', () => {
  const speed: Schema = { type: 'number', title: 'Noise amplitude', description: 'Not a swimming speed' };
  const model: Schema = { oneOf: [{ type: 'string', enum: ['a', 'b'] }, { description: 'A random walk', properties: { type: { const: 'a' }, max_speed: speed } }, { properties: { type: { const: 'b' }, size: {} } }] };
  test('is by key, title and description, in either language; all words must match', () => {
    for (const q of ['max_sp', 'NOISE', 'swimming', 'noise swim', 'noise max']) expect(isMatch(wordsOf(q), 'max_speed', speed, en), q).toBe(true);
    expect(isMatch(wordsOf('ruído'), 'max_speed', speed, pt)).toBe(true);
    expect(isMatch(wordsOf('noise field'), 'max_speed', speed, en)).toBe(false);
  });
  test('finds values of the selected part only', () => {
    expect(hasMatch(wordsOf('noise'), 'model', model, { type: 'a' }, en)).toBe(true);
    expect(hasMatch(wordsOf('noise'), 'model', model, 'a', en)).toBe(true);
    expect(hasMatch(wordsOf('noise'), 'model', model, { type: 'b' }, en)).toBe(false);
    expect(hasMatch(wordsOf('random walk'), 'model', model, { type: 'a' }, en)).toBe(true);
  });
  test('finds values of tables and lists; no words show everything', () => {
    const list: Schema = { type: 'array', items: { properties: { max_speed: speed } } };
    expect(hasMatch(wordsOf('noise'), 'swarm', list, [{}], en)).toBe(true);
    expect(hasMatch(wordsOf('noise'), 'swarm', list, undefined, en)).toBe(false);
    expect(hasMatch(wordsOf('noise'), 'limits', { properties: { x: {} } }, {}, en)).toBe(false);
    expect(hasMatch([], 'limits', { properties: {} }, {}, en)).toBe(true);
  });
});

describe('the simple panel finds values by role and property, not by the names of parts', () => {
  test('the speed of a model', () => {
    const model: Schema = { default: 'rod', oneOf: [{ properties: { type: { const: 'rod' }, pace: { type: 'number', 'x-role': 'speed' } } }, { properties: { type: { const: 'dot' } } }] };
    expect(found(model, { type: 'rod' }, kSpeed).map((f) => f.key)).toEqual(['pace']);
    expect(found(model, undefined, kSpeed).map((f) => f.key)).toEqual(['pace']); // the default part
    expect(found(model, 'dot', kSpeed)).toEqual([]);
  });
  test('the size of an arena and the target of a reference', () => {
    const { arena, reference } = sampleSchema.properties!;
    expect(found(arena, { type: 'round' }, kSize).map((f) => f.key)).toEqual(['radius_px']);
    expect(found(arena, 'oblong', kSize).map((f) => f.key)).toEqual(['size_px']);
    expect(found(reference, { type: 'path' }, kTarget).map((f) => f.key)).toEqual(['setpoints_px']);
    expect(found(reference, { type: 'nowhere' }, kTarget)).toEqual([]);
    expect(found(undefined, undefined, kTarget)).toEqual([]);
  });
  test('a change keeps the other values of the part', () => {
    expect(changed({ type: 'round', radius_px: 5, view_px: [1, 2] }, 'radius_px', 7)).toEqual({ type: 'round', radius_px: 7, view_px: [1, 2] });
    expect(changed({ type: 'round', radius_px: 5 }, 'radius_px', undefined)).toEqual({ type: 'round' });
    expect(changed('round', 'radius_px', 7)).toEqual({ type: 'round', radius_px: 7 });
  });
});
