// Planner of objective, camera and frame rate: the answer of the server, and the values in the address.

import type { Schema } from '../../form/schema';
import type { Quality, Warning } from '../../quality/quality';

export const kMeasurements = ['flow', 'tracking', 'response', 'drop_edge', 'swarm'] as const;
export interface Verdict {
  measurement: (typeof kMeasurements)[number];
  /** The figures that decide it. */
  evidence: string;
  quality: Quality;
  warnings: Warning[];
}
/** Answer to POST /api/optics; web/protocol.md. */
export interface Plan {
  setup: Record<string, any>;
  um_per_px: number;
  view_um: [number, number];
  cell_px: number;
  object_px: number;
  cells_in_view: number;
  spacing_px: number;
  crossing_time_s: number;
  crossing_frames: number;
  displacement_px: number;
  displacement_um: number;
  exposure_time_s: number;
  blur_px: number;
  resolution_um: number;
  depth_of_field_um: number;
  gathering_time_s: number;
  arc_deg: number;
  drop_radius_um: number;
  verdicts: Verdict[];
}

/** The keys of the form in three groups. */
export const kGroups = {
  objective: ['magnification', 'numerical_aperture', 'um_per_px', 'pixel_size', 'tube_factor'],
  camera: ['width_px', 'height_px', 'frame_rate', 'exposure_time'],
  sample: ['speed', 'cell_diameter', 'cell_length', 'cells_per_mm2', 'drop_radius'],
} as const;
export const kDefaultObjective = '10x';
/** What an objective determines: choosing another one replaces these values. */
const kOfObjective: readonly string[] = ['preset', ...kGroups.objective];

/** The values of an address as the server reads them: numbers, or texts with a unit. */
export const setupOf = (values: Record<string, string>): Record<string, string | number> =>
  Object.fromEntries(Object.entries(values).map(([key, text]) => [key, text.trim() !== '' && Number.isFinite(Number(text)) ? Number(text) : text]));

/** The values of the address after one has changed; `undefined`: the default. */
export function changedValues(values: Record<string, string>, key: string, value: unknown): Record<string, string> {
  const rest = Object.entries(values).filter(([k]) => k !== key);
  return Object.fromEntries(value === undefined ? rest : [...rest, [key, String(value)]]);
}

/** The values of the address with another objective. */
export function withObjective(values: Record<string, string>, objective: string): Record<string, string> {
  const kept = Object.fromEntries(Object.entries(values).filter(([key]) => !kOfObjective.includes(key)));
  return objective === kDefaultObjective ? kept : { preset: objective, ...kept };
}

/** The same plan on the command line. */
export function commandOf(values: Record<string, string>): string {
  const quoted = (text: string) => (/^[\w.+-]+$/.test(text) ? text : `'${text.replaceAll("'", `'\\''`)}'`);
  const options = Object.entries(values).map(([key, text]) => `${key === 'preset' ? '--objective' : `--${key.replaceAll('_', '-')}`} ${quoted(text)}`);
  return ['faba optics', ...options].join(' ');
}

/** Part of the properties of a schema, in the order of the keys. */
export const propertiesOf = (schema: Schema, keys: readonly string[]) =>
  Object.fromEntries(keys.filter((key) => schema.properties?.[key]).map((key) => [key, schema.properties![key]]));

/** Three significant digits, without an exponent up to a million. */
export const digits = (value: number) => (value >= 1000 && value < 1e6 ? String(Math.round(value)) : String(Number(value.toPrecision(3))));

/** 1, 2 or 5 times a power of ten, at most `length`: the length of a scale bar. */
export function barLength(length: number): number {
  const power = 10 ** Math.floor(Math.log10(length));
  return power * ([5, 2].find((n) => n * power <= length) ?? 1);
}
