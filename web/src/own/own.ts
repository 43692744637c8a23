// The set-up of a simulation from the user's own picture of a drop: its data, what is still missing, and its scenario.

import { variant, type Schema } from '../form/schema';
import type { Word } from '../i18n';
import { defaultPart, findPart, handController, hasTrait, sectionOf, setpointReference } from '../part_traits';

export type Point = [number, number];

/** The answer of the program to a picture. */
export interface Detection {
  picture: string;
  url: string;
  image_size: Point;
  found: boolean;
  reason?: string;
  center_px: Point;
  radius_px: number;
  sd_px?: { x: number; y: number; radius: number };
  arc_deg?: number;
  /** In the metadata of the picture; null: not stated. */
  um_per_px?: number | null;
  um_per_px_source?: string | null;
  /** Name of an uploaded file in the lab, or path in the workspace. */
  upload?: string;
  file?: string;
}

/** A circle in px; null: an empty input. */
export interface Circle {
  x: number | null;
  y: number | null;
  r: number | null;
}
export interface Ruler {
  from: Point;
  to: Point;
  /** Its length in µm; null: not stated yet. */
  um: number | null;
}

export const kSteps = ['picture', 'edge', 'scale', 'cells', 'start'] as const;
export type Place = 'edge' | 'centre' | 'anywhere';

export interface Own {
  step: number;
  detection: Detection | null;
  /** Origin of the arena; null: not decided. */
  edge: 'detected' | 'drawn' | 'box' | null;
  circle: Circle | null;
  scale: 'metadata' | 'typed' | 'ruler' | 'px' | null;
  typed: number | null;
  ruler: Ruler | null;
  /** Table of the model; null: the first preset. */
  model: Record<string, any> | null;
  count: number | null;
  place: Place;
  action: 'steer' | 'pull';
}

export const kLeastRadius = 5; // px
export const kMostCells = 1_000_000;
const kCells = 300;

export const kNew: Own = { step: 0, detection: null, edge: null, circle: null, scale: null, typed: null, ruler: null, model: null, count: kCells, place: 'edge', action: 'steer' };

/** The state after a new picture: nothing of the previous one remains. A circle only if the program found one. */
export function withPicture(own: Own, d: Detection): Own {
  const fresh: Own = { ...kNew, model: own.model, count: own.count, place: own.place, action: own.action, step: 1, detection: d };
  if (d.found) Object.assign(fresh, { edge: 'detected', circle: detectedCircle(d) });
  if (d.um_per_px) fresh.scale = 'metadata';
  return fresh;
}
const hundredths = (v: number) => Math.round(100 * v) / 100; // finer than the uncertainty of any edge
export const detectedCircle = (d: Detection): Circle => ({ x: hundredths(d.center_px[0]), y: hundredths(d.center_px[1]), r: hundredths(d.radius_px) });

const given = (v: number | null | undefined): v is number => typeof v === 'number' && Number.isFinite(v);

/** What a step still needs before the next one; null: nothing. */
export function missing(own: Own, step: number): Word | null {
  switch (kSteps[step]) {
    case 'picture':
      return own.detection ? null : 'own.needs_picture';
    case 'edge':
      if (own.edge === null) return 'own.needs_edge';
      if (own.edge === 'box') return null;
      if (!given(own.circle?.x) || !given(own.circle?.y)) return 'own.needs_centre';
      return given(own.circle.r) && own.circle.r >= kLeastRadius ? null : 'own.needs_radius';
    case 'scale':
      if (own.scale === null) return 'own.needs_scale';
      return own.scale === 'px' || given(umPerPx(own)) ? null : own.scale === 'ruler' ? 'own.needs_ruler' : 'own.needs_typed';
    case 'cells':
      return given(own.count) && Number.isInteger(own.count) && own.count >= 1 && own.count <= kMostCells ? null : 'own.needs_count';
    default:
      return null;
  }
}
/** The last step that can be opened: all steps before it are complete. */
export function reachable(own: Own): number {
  let step = 0;
  while (step < kSteps.length - 1 && !missing(own, step)) ++step;
  return step;
}

export const rulerLength = (r: Ruler) => Math.hypot(r.to[0] - r.from[0], r.to[1] - r.from[1]);

/** The scale in µm/px; null: not known, or not complete. */
export function umPerPx(own: Own): number | null {
  const positive = (v: number | null | undefined) => (given(v) && v > 0 ? v : null);
  if (own.scale === 'metadata') return positive(own.detection?.um_per_px);
  if (own.scale === 'typed') return positive(own.typed);
  if (own.scale !== 'ruler' || !own.ruler || !positive(own.ruler.um)) return null;
  const length = rulerLength(own.ruler);
  return length >= 1 ? own.ruler.um! / length : null;
}

/** The circle through three points; null if they are on one line. */
export function circleThrough([ax, ay]: Point, [bx, by]: Point, [cx, cy]: Point): { x: number; y: number; r: number } | null {
  const [ux, uy, vx, vy] = [bx - ax, by - ay, cx - ax, cy - ay];
  const d = 2 * (ux * vy - uy * vx), longest = Math.max(ux * ux + uy * uy, vx * vx + vy * vy);
  if (Math.abs(d) < 1e-6 * longest) return null;
  const u = ux * ux + uy * uy, v = vx * vx + vy * vy;
  const x = (vy * u - uy * v) / d, y = (ux * v - vx * u) / d;
  return { x: ax + x, y: ay + y, r: Math.hypot(x, y) };
}

/** A point well inside the arena and in view: the centre of the drop, or the visible point closest to it. */
export function middle(own: Own): Point {
  const [w, h] = own.detection?.image_size ?? [0, 0];
  if (own.edge === 'box' || !own.circle) return [Math.round(w / 2), Math.round(h / 2)];
  const { x, y, r } = own.circle as { x: number; y: number; r: number };
  const into = (v: number, size: number) => Math.min(Math.max(v, 0.2 * size), 0.8 * size);
  const seen: Point = x >= 0 && y >= 0 && x < w && y < h ? [x, y] : [into(x, w), into(y, h)];
  if (Math.hypot(seen[0] - x, seen[1] - y) > 0.9 * r) return [Math.min(Math.max(x, 0), w - 1), Math.min(Math.max(y, 0), h - 1)].map(Math.round) as Point;
  return seen.map(Math.round) as Point;
}

/** The scenario, with the picture `file` of the workspace as background; null when the schema has no such arena. */
export function ownScenario(schema: Schema | null, own: Own, file: string): Record<string, any> | null {
  const arena = arenaOf(schema, own);
  if (!arena || !own.detection) return null;
  return {
    title: own.detection.picture.replace(/^.*\//, '').replace(/\.\w{1,5}$/, ''),
    scale: scaleOf(schema, own),
    ...pictureOf(schema, file),
    arena,
    swarm: [{ count: own.count, ...modelOf(schema, own), ...startOf(schema, own) }],
    ...actionOf(schema, own),
  };
}

// The camera sees the cells on the picture: with as_seen the scenario keeps its microscope, and recordings show both (Fig. 3.22 of the thesis).
function pictureOf(schema: Schema | null, file: string): Record<string, any> {
  const has = (section: string, key: string) => Object.hasOwn(sectionOf(schema, section)?.properties ?? {}, key);
  return {
    ...(has('camera', 'rate') ? { camera: { rate: '60 Hz' } } : {}),
    ...(has('microscope', 'background') ? { microscope: { background: file } } : {}),
    ...(has('record', 'as_seen') ? { record: { as_seen: true } } : {}),
  };
}

function arenaOf(schema: Schema | null, own: Own): Record<string, any> | null {
  const section = sectionOf(schema, 'arena'), size = own.detection?.image_size;
  const type = findPart(section, { property: own.edge === 'box' ? 'size_px' : 'radius_px' });
  if (type === undefined || !size) return null;
  if (own.edge === 'box') return { type, size_px: size };
  return { type, view_px: size, centre_px: [own.circle?.x, own.circle?.y], radius_px: own.circle?.r };
}

/** The scale, or a nominal one: the default of the program. */
function scaleOf(schema: Schema | null, own: Own): Record<string, any> {
  const um = umPerPx(own);
  if (um === null) return { nominal_um_per_px: sectionOf(schema, 'scale')?.properties?.um_per_px?.default };
  const source = own.scale === 'metadata' ? (own.detection?.um_per_px_source ?? 'metadata') : 'typed';
  return { um_per_px: um, um_per_px_source: source };
}

/** The first model with presets, with its first preset; null if no model has presets. */
export function firstPreset(schema: Schema | null): Record<string, any> | null {
  const section = sectionOf(schema, 'swarm')?.items?.properties?.model;
  const type = findPart(section, { property: 'preset' });
  const preset = section && type !== undefined ? variant(section, type)?.properties?.preset?.enum?.[0] : undefined;
  return preset === undefined ? null : { type, preset };
}
function modelOf(schema: Schema | null, own: Own): { model?: Record<string, any> } {
  const model = own.model ?? firstPreset(schema);
  return model ? { model } : {};
}

function startOf(schema: Schema | null, own: Own): { start?: Record<string, any> } {
  const section = sectionOf(schema, 'swarm')?.items?.properties?.start;
  const has = (type: string, key: string) => section !== undefined && Object.hasOwn(variant(section, type)?.properties ?? {}, key);
  if (own.place === 'edge') {
    const type = findPart(section, { property: 'depth_px' });
    return type === undefined ? {} : { start: { type, ...(has(type, 'visible') ? { visible: true } : {}) } };
  }
  if (own.place === 'centre') {
    const type = findPart(section, { property: 'radius_px' });
    return type === undefined ? {} : { start: { type, centre_px: middle(own), radius_px: Math.max(kLeastRadius, 0.1 * sizeOf(own)) } };
  }
  const type = defaultPart(section) ?? findPart(section, { trait: 'in_view' });
  return type === undefined ? {} : { start: { type } };
}
const sizeOf = (own: Own) => Math.min(own.edge === 'box' ? Infinity : (own.circle?.r ?? Infinity), ...(own.detection?.image_size ?? [0, 0]).map((v) => v / 2));

// Values of a controller with which the cells of the presets gather at the setpoint, in drops of any size: the duty cycle sets their mean
// speed, and a turn takes longer than a frame (as scenes/steer.toml).
const kSteering: Record<string, unknown> = { actuation: 'duty', max_output: 40, hold_frames: 1, lead: '100 ms' };

/** A controller that steers to the middle, or a manual field of zero. */
function actionOf(schema: Schema | null, own: Own): Record<string, any> {
  const controllers = sectionOf(schema, 'controller'), hand = handController(schema);
  if (own.action === 'pull' && hand !== undefined) return { controller: { type: hand, field: [0, 0] } };
  const hold = setpointReference(schema), standard = defaultPart(controllers);
  const feedback = hasTrait(controllers, undefined, 'feedback') ? standard : findPart(controllers, { trait: 'feedback' });
  const steers = findPart(controllers, { trait: 'feedback', property: 'actuation' }) ?? feedback;
  const properties = (controllers && steers !== undefined && variant(controllers, steers)?.properties) || {};
  const values = Object.fromEntries(Object.entries(kSteering).filter(([key]) => Object.hasOwn(properties, key)));
  return {
    ...(steers === undefined ? {} : { controller: { type: steers, ...values } }),
    ...(hold === undefined ? {} : { reference: { type: hold, setpoint_px: middle(own) } }),
  };
}
