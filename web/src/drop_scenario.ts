// The scenario for a drop detected in an image.

import { variant, type Schema } from './form/schema';
import type { Word } from './i18n';
import { findPart, sectionOf } from './part_traits';
import type { Drop } from './parts/DropEditor.svelte';

const kCells = 300;
/** Minimum radius of a drop in the editor, px. */
export const kLeastRadius = 5;

/** The text about what the editor of a drop still needs before Start; null if nothing. An empty number input gives null; the scale may be empty. */
export function missingForStart(d: Record<'x' | 'y' | 'r' | 'scale', number | null>, may: boolean): Word | null {
  if (!may) return 'gallery.needs_control';
  if (!Number.isFinite(d.x) || !Number.isFinite(d.y)) return 'gallery.needs_centre';
  if (!((d.r ?? 0) >= kLeastRadius)) return 'gallery.needs_radius';
  return (d.scale ?? 1) > 0 ? null : 'gallery.needs_scale';
}

/**
 * A swarm of the first preset in a drop of this size; null when the schema has no circular arena.
 */
export function dropScenario(schema: Schema | null, d: Drop): Record<string, any> | null {
  const arena = findPart(sectionOf(schema, 'arena'), { property: 'radius_px' });
  if (arena === undefined) return null;
  const start = findPart(sectionOf(schema, 'swarm')?.items?.properties?.start, { trait: 'in_view' });
  return {
    title: d.picture.replace(/^.*\//, ''),
    scale: scaleOf(schema, d),
    arena: { type: arena, view_px: d.image_size, centre_px: d.center_px, radius_px: d.radius_px },
    swarm: [{ count: kCells, ...presetModel(schema), ...(start === undefined ? {} : { start: { type: start } }) }],
  };
}

/** The scale, or a nominal one: the default of the program. */
function scaleOf(schema: Schema | null, d: Drop): Record<string, any> {
  if (!d.um_per_px) return { nominal_um_per_px: sectionOf(schema, 'scale')?.properties?.um_per_px?.default };
  return { um_per_px: d.um_per_px, ...(d.um_per_px_source ? { um_per_px_source: d.um_per_px_source } : {}) };
}

/** The first model with presets, with its first preset; empty if no model has presets: the default model. */
function presetModel(schema: Schema | null): { model?: { type: string; preset: string } } {
  const section = sectionOf(schema, 'swarm')?.items?.properties?.model;
  const type = findPart(section, { property: 'preset' });
  const preset = section && type !== undefined ? variant(section, type)?.properties?.preset?.enum?.[0] : undefined;
  return type === undefined || preset === undefined ? {} : { model: { type, preset } };
}
