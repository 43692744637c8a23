import { describe, expect, test } from 'vitest';
import { defaultPart, findPart, handController, hasTrait, isOpenLoop, routeReference, sectionOf, setpointReference, typeOf } from '../src/part_traits';
import { sampleSchema, schemaWithoutTraits } from './sample_schema';

const controllers = sectionOf(sampleSchema, 'controller');

describe('the type of a part', () => {
  test.each([
    ['fast', 'fast'],
    [{ type: 'fast', gain: 1 }, 'fast'],
    [{}, undefined],
    [{ type: 3 }, undefined],
    [null, undefined],
    [undefined, undefined],
    [7, undefined],
  ])('%j', (value, type) => {
    expect(typeOf(value)).toBe(type);
  });
});

describe('the default part', () => {
  test('is the default of the section', () => {
    expect(defaultPart(controllers)).toBe('zeta');
  });
  test('is unknown without a default, a section or a schema', () => {
    expect(defaultPart(sectionOf(schemaWithoutTraits, 'controller'))).toBeUndefined();
    expect(defaultPart(sectionOf(sampleSchema, 'nothing'))).toBeUndefined();
    expect(defaultPart(sectionOf(null, 'controller'))).toBeUndefined();
  });
});

describe('traits', () => {
  test('of a part as a table and as a name', () => {
    expect(hasTrait(controllers, { type: 'zeta' }, 'seeks_null')).toBe(true);
    expect(hasTrait(controllers, 'alpha', 'feedback')).toBe(true);
    expect(hasTrait(controllers, 'alpha', 'seeks_null')).toBe(false);
  });
  test('of the default when the scenario does not give the section', () => {
    expect(hasTrait(controllers, undefined, 'seeks_null')).toBe(true);
    expect(hasTrait(sectionOf(sampleSchema, 'reference'), undefined, 'no_target')).toBe(true);
    expect(hasTrait(sectionOf(sampleSchema, 'estimator'), undefined, 'no_estimate')).toBe(false);
  });
  test('unknown parts, unknown sections and old schemas have none', () => {
    expect(hasTrait(controllers, 'omega', 'feedback')).toBe(false);
    expect(hasTrait(controllers, null, 'feedback')).toBe(false);
    expect(hasTrait(undefined, 'alpha', 'feedback')).toBe(false);
    expect(hasTrait(sectionOf(schemaWithoutTraits, 'controller'), 'alpha', 'feedback')).toBe(false);
  });
});

describe('finding a part', () => {
  test('by trait, by property, by both: the first one', () => {
    expect(findPart(controllers, { trait: 'open_loop' })).toBe('beta');
    expect(findPart(controllers, { property: 'field' })).toBe('alpha');
    expect(findPart(controllers, { trait: 'open_loop', property: 'field' })).toBe('gamma');
  });
  test('no part matches', () => {
    expect(findPart(controllers, { trait: 'seeks_null', property: 'field' })).toBeUndefined();
    expect(findPart(controllers, { property: 'toString' })).toBeUndefined();
    expect(findPart(undefined, {})).toBeUndefined();
  });
  test('the list of names in a section is not a part', () => {
    expect(findPart(controllers, {})).toBe('alpha');
  });
});

describe('parts for steering', () => {
  test('open loop is a trait of the current controller', () => {
    expect(isOpenLoop(sampleSchema, { type: 'beta' })).toBe(true);
    expect(isOpenLoop(sampleSchema, 'gamma')).toBe(true);
    expect(isOpenLoop(sampleSchema, { type: 'alpha' })).toBe(false);
    expect(isOpenLoop(sampleSchema, undefined)).toBe(false);
    expect(isOpenLoop(null, { type: 'beta' })).toBe(false);
  });
  test('manual control needs an open-loop controller with a field', () => {
    expect(handController(sampleSchema)).toBe('gamma');
  });
  test('references are distinguished by one or several setpoints', () => {
    expect(setpointReference(sampleSchema)).toBe('spot');
    expect(routeReference(sampleSchema)).toBe('path');
  });
  test('nothing is found without a schema', () => {
    expect([handController(null), setpointReference(null), routeReference(null)]).toEqual([undefined, undefined, undefined]);
    expect(handController(schemaWithoutTraits)).toBeUndefined();
  });
});
