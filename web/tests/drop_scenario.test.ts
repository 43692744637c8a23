import { expect, test } from 'vitest';
import { dropScenario, kLeastRadius, missingForStart } from '../src/drop_scenario';
import { sampleSchema } from './sample_schema';

const drop = { picture: 'uploads/3/my drop.png', url: '/x', image_size: [640, 480] as [number, number], center_px: [320, 231] as [number, number], radius_px: 150, um_per_px: 0.9, found: true };

test('the arena has the edge of the drop, and the swarm the first preset', () => {
  expect(dropScenario(sampleSchema, drop)).toMatchObject({
    title: 'my drop.png',
    scale: { um_per_px: 0.9 },
    arena: { type: 'round', view_px: [640, 480], centre_px: [320, 231], radius_px: 150 },
    swarm: [{ model: { type: 'rod', preset: 'first' }, start: { type: 'seen' } }],
  });
});
test('a scale of the metadata keeps its origin; without a scale the default of the program is nominal', () => {
  expect(dropScenario(sampleSchema, { ...drop, um_per_px_source: 'metadata' })!.scale).toEqual({ um_per_px: 0.9, um_per_px_source: 'metadata' });
  const schema = { properties: { ...sampleSchema.properties, scale: { properties: { um_per_px: { type: 'number', default: 0.75 } } } } };
  expect(dropScenario(schema as typeof sampleSchema, { ...drop, um_per_px: null })!.scale).toEqual({ nominal_um_per_px: 0.75 });
});
test('the swarm has the default model if no model has presets', () => {
  const { arena } = sampleSchema.properties!;
  expect(dropScenario({ properties: { arena } }, drop)!.swarm[0]).not.toHaveProperty('model');
});
test('returns null without a circular arena or a schema', () => {
  expect(dropScenario({ properties: {} }, drop)).toBeNull();
  expect(dropScenario(null, drop)).toBeNull();
});

test('the editor gives the reason why a drop cannot be started', () => {
  const complete = { x: 10, y: 0, r: kLeastRadius, scale: 0.9 };
  expect(missingForStart(complete, true)).toBeNull();
  expect(missingForStart(complete, false)).toBe('gallery.needs_control');
  expect(missingForStart({ ...complete, x: null }, true)).toBe('gallery.needs_centre');
  expect(missingForStart({ ...complete, r: null }, true)).toBe('gallery.needs_radius');
  expect(missingForStart({ ...complete, r: kLeastRadius - 1 }, true)).toBe('gallery.needs_radius');
  expect(missingForStart({ ...complete, scale: 0 }, true)).toBe('gallery.needs_scale');
  expect(missingForStart({ ...complete, scale: null }, true)).toBeNull(); // lengths in px
});
