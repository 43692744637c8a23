// A JSON Schema as sent by /api/schema, with fictitious part names: the page must not depend on names.
import type { Schema } from '../src/form/schema';

const part = (type: string, traits: string[] | undefined, properties: Record<string, Schema> = {}): Schema => ({
  title: type,
  type: 'object',
  ...(traits ? { 'x-traits': traits } : {}),
  properties: { ...properties, type: { const: type } },
});
const section = (standard: string | undefined, ...parts: Schema[]): Schema => ({
  ...(standard === undefined ? {} : { default: standard }),
  oneOf: [{ type: 'string', enum: parts.map((p) => p.title!) }, ...parts],
});
const numbers: Schema = { type: 'array', items: { type: 'number' } };
const vector: Schema = { ...numbers, minItems: 2, maxItems: 2 };
const length: Schema = { type: ['number', 'string'], 'x-unit': 'px' };

export const sampleSchema: Schema = {
  properties: {
    title: { type: 'string' },
    arena: section('oblong', part('oblong', [], { size_px: vector }), part('round', [], { view_px: vector, centre_px: vector, radius_px: length })),
    controller: section(
      'zeta',
      part('alpha', ['feedback'], { field: vector }),
      part('beta', ['open_loop'], { current: numbers }),
      part('gamma', ['open_loop'], { field: vector, current: numbers }),
      part('delta', ['open_loop'], { field: vector }),
      part('zeta', ['feedback', 'seeks_null']),
    ),
    reference: section('nowhere', part('nowhere', ['no_target']), part('path', [], { setpoints_px: { type: 'array', items: vector } }), part('spot', [], { setpoint_px: vector })),
    estimator: section('guess', part('blind', ['no_estimate']), part('guess', ['needs_positions'])),
    swarm: {
      type: 'array',
      items: {
        type: 'object',
        properties: {
          count: { type: 'integer' },
          start: section('anywhere', part('anywhere', []), part('seen', ['in_view'])),
          model: section('dot', part('dot', []), part('rod', [], { preset: { type: 'string', enum: ['first', 'second'] } })),
        },
      },
    },
  },
};

/** A schema without traits and defaults. */
export const schemaWithoutTraits: Schema = JSON.parse(JSON.stringify(sampleSchema, (key, value) => (key === 'x-traits' || key === 'default' ? undefined : value)));
