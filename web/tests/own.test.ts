import { describe, expect, test } from 'vitest';
import { circleThrough, kLeastRadius, kNew, middle, missing, ownScenario, reachable, umPerPx, withPicture, type Detection, type Own } from '../src/own/own';
import type { Schema } from '../src/form/schema';
import { sampleSchema } from './sample_schema';

const picture: Detection = { picture: 'my drop.png', url: '/x', image_size: [640, 480], found: true, center_px: [320, 231], radius_px: 150, sd_px: { x: 0.3, y: 0.3, radius: 0.4 }, arc_deg: 355, upload: 'original-1.png' };
const nothing: Detection = { ...picture, found: false, reason: 'the picture has no arc or line', center_px: [319.5, 239.5], radius_px: 192 };
const complete: Own = { ...withPicture(kNew, picture), scale: 'typed', typed: 0.9 };

describe('a new picture', () => {
  test('has the detected circle', () => {
    expect(withPicture(kNew, picture)).toMatchObject({ step: 1, edge: 'detected', circle: { x: 320, y: 231, r: 150 }, scale: null });
  });
  test('has no circle where none was found, although the program proposes one', () => {
    expect(withPicture(kNew, nothing)).toMatchObject({ edge: null, circle: null });
  });
  test('keeps nothing of the previous picture, but the cells', () => {
    const next = withPicture({ ...complete, count: 17, ruler: { from: [0, 0], to: [9, 9], um: 3 }, typed: 3, circle: { x: 1, y: 2, r: 30 } }, nothing);
    expect(next).toMatchObject({ circle: null, ruler: null, scale: null, typed: null, count: 17 });
  });
  test('has the scale of its metadata', () => {
    expect(withPicture(kNew, { ...picture, um_per_px: 0.5 }).scale).toBe('metadata');
  });
});

describe('what a step needs', () => {
  test('picture, edge, scale, cells', () => {
    expect(missing(kNew, 0)).toBe('own.needs_picture');
    expect(missing(withPicture(kNew, nothing), 1)).toBe('own.needs_edge');
    expect(missing({ ...complete, edge: 'box', circle: null }, 1)).toBeNull();
    expect(missing({ ...complete, edge: 'drawn', circle: { x: null, y: 1, r: 50 } }, 1)).toBe('own.needs_centre');
    expect(missing({ ...complete, edge: 'drawn', circle: { x: NaN, y: 1, r: 50 } }, 1)).toBe('own.needs_centre');
    expect(missing({ ...complete, edge: 'drawn', circle: { x: 1, y: 1, r: kLeastRadius - 1 } }, 1)).toBe('own.needs_radius');
    expect(missing({ ...complete, scale: null }, 2)).toBe('own.needs_scale');
    expect(missing({ ...complete, typed: 0 }, 2)).toBe('own.needs_typed');
    expect(missing({ ...complete, scale: 'ruler' }, 2)).toBe('own.needs_ruler');
    expect(missing({ ...complete, scale: 'px' }, 2)).toBeNull();
    for (const count of [null, 0, 2.5, 1e9]) expect(missing({ ...complete, count }, 3)).toBe('own.needs_count');
    expect(missing(complete, 3)).toBeNull();
  });
  test('a step opens when all before it are complete', () => {
    expect(reachable(kNew)).toBe(0);
    expect(reachable(withPicture(kNew, nothing))).toBe(1);
    expect(reachable(withPicture(kNew, picture))).toBe(2);
    expect(reachable(complete)).toBe(4);
  });
});

test('the scale of a ruler is its length in µm over its length in px', () => {
  const ruler = { from: [10, 10] as [number, number], to: [310, 410] as [number, number], um: 250 };
  expect(umPerPx({ ...complete, scale: 'ruler', ruler })).toBeCloseTo(0.5, 12);
  expect(umPerPx({ ...complete, scale: 'ruler', ruler: { ...ruler, to: ruler.from } })).toBeNull();
  expect(umPerPx({ ...complete, scale: 'px' })).toBeNull();
});

test('the circle through three points', () => {
  const at = (deg: number): [number, number] => [100 + 70 * Math.cos((deg * Math.PI) / 180), -20 + 70 * Math.sin((deg * Math.PI) / 180)];
  const c = circleThrough(at(10), at(25), at(80))!;
  expect(c.x).toBeCloseTo(100, 8);
  expect(c.y).toBeCloseTo(-20, 8);
  expect(c.r).toBeCloseTo(70, 8);
  expect(circleThrough([0, 0], [5, 5], [9, 9])).toBeNull();
  expect(circleThrough([0, 0], [0, 0], [9, 9])).toBeNull();
});

describe('the scenario', () => {
  test('has the drop, the scale and the cells; parts are found by their properties', () => {
    expect(ownScenario(sampleSchema, complete, 'pictures/my drop.png')).toMatchObject({
      title: 'my drop',
      scale: { um_per_px: 0.9, um_per_px_source: 'typed' },
      arena: { type: 'round', view_px: [640, 480], centre_px: [320, 231], radius_px: 150 },
      swarm: [{ count: 300, model: { type: 'rod', preset: 'first' } }],
      controller: { type: 'zeta' },
      reference: { type: 'spot', setpoint_px: [320, 231] },
    });
  });
  test('has the picture as background if the schema has one', () => {
    expect(ownScenario(sampleSchema, complete, 'p.png')).not.toHaveProperty('microscope');
    const schema = { properties: { ...sampleSchema.properties, microscope: { properties: { background: { type: 'string' } } }, record: { properties: { as_seen: { type: 'boolean' } } } } };
    expect(ownScenario(schema, complete, 'p.png')).toMatchObject({ microscope: { background: 'p.png' }, record: { as_seen: true } });
  });
  test('has a controller with duty cycle if there is one', () => {
    const controller: Schema = { default: 'zeta', oneOf: [{ 'x-traits': ['feedback'], properties: { type: { const: 'zeta' } } }, { 'x-traits': ['feedback'], properties: { type: { const: 'eta' }, actuation: { enum: ['duty'] }, lead: {} } }] };
    expect(ownScenario({ properties: { ...sampleSchema.properties, controller } }, complete, 'p.png')!.controller).toEqual({ type: 'eta', actuation: 'duty', lead: '100 ms' });
  });
  test('has a box without a circle, and a manual field to pull', () => {
    const own: Own = { ...complete, edge: 'box', circle: null, action: 'pull' };
    expect(ownScenario(sampleSchema, own, 'p.png')).toMatchObject({ arena: { type: 'oblong', size_px: [640, 480] }, controller: { type: 'gamma', field: [0, 0] } });
    expect(ownScenario(sampleSchema, own, 'p.png')).not.toHaveProperty('reference');
  });
  test('has a nominal scale if the scale is not known', () => {
    const schema = { properties: { ...sampleSchema.properties, scale: { properties: { um_per_px: { type: 'number', default: 0.75 } } } } };
    expect(ownScenario(schema, { ...complete, scale: 'px' }, 'p.png')!.scale).toEqual({ nominal_um_per_px: 0.75 });
  });
  test('keeps the origin of a scale from metadata', () => {
    const own = { ...withPicture(kNew, { ...picture, um_per_px: 0.5, um_per_px_source: 'metadata' }) };
    expect(ownScenario(sampleSchema, own, 'p.png')!.scale).toEqual({ um_per_px: 0.5, um_per_px_source: 'metadata' });
  });
  test('is null without an arena or a schema', () => {
    expect(ownScenario({ properties: {} }, complete, 'p.png')).toBeNull();
    expect(ownScenario(null, complete, 'p.png')).toBeNull();
  });
  test('steers to a point in view if the centre of the drop is not', () => {
    const own: Own = { ...complete, circle: { x: 1400, y: 240, r: 1000 } };
    const [x, y] = middle(own);
    expect(x).toBeLessThan(640);
    expect(Math.hypot(x - 1400, y - 240)).toBeLessThan(1000);
  });
});
