// The scenario for a drop detected in an image.

import { variant, type Schema } from './form/schema';
import { findPart, sectionOf } from './part_traits';
import type { Drop } from './parts/DropEditor.svelte';

const kCells = 300;

/**
 * A swarm of the first preset in a drop of this size; null when the schema has no circular arena.
 */
export function dropScenario(schema: Schema | null, d: Drop): Record<string, any> | null {
  const arena = findPart(sectionOf(schema, 'arena'), { property: 'radius_px' });
  if (arena === undefined) return null;
  const start = findPart(sectionOf(schema, 'swarm')?.items?.properties?.start, { trait: 'in_view' });
  return {
    title: d.picture.replace(/^.*\//, ''),
    scale: { um_per_px: d.um_per_px },
    arena: { type: arena, view_px: d.image_size, centre_px: d.center_px, radius_px: d.radius_px },
    swarm: [{ count: kCells, ...presetModel(schema), ...(start === undefined ? {} : { start: { type: start } }) }],
  };
}

/** The first model with presets, with its first preset; empty if no model has presets: the default model. */
function presetModel(schema: Schema | null): { model?: { type: string; preset: string } } {
  const section = sectionOf(schema, 'swarm')?.items?.properties?.model;
  const type = findPart(section, { property: 'preset' });
  const preset = section && type !== undefined ? variant(section, type)?.properties?.preset?.enum?.[0] : undefined;
  return type === undefined || preset === undefined ? {} : { model: { type, preset } };
}
