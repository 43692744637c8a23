// A coil system as the editor holds it: SI units; its file has quantities with units.

import { amount } from '../form/schema';

export type Vec = [number, number, number];
export const kTypes = ['solenoid', 'loop', 'thick_coil', 'helmholtz', 'dipole'] as const;
export type CoilType = (typeof kTypes)[number];

export interface Coil {
  /** Unique in the editor. */
  id: number;
  type: CoilType;
  name: string;
  /** Of its centre, m. */
  position: Vec;
  /** Direction of its field for a positive current; of any length. */
  axis: Vec;
  /** Dimensions in m, turns, and the moment of a dipole in A m^2/A, by their keys in the file. */
  size: Record<string, number>;
  /** A. */
  current: number;
  /** A; null: no limit. */
  max: number | null;
  /** The other keys of its file, which the editor keeps. */
  other: Record<string, unknown>;
}
export interface System {
  coils: Coil[];
  /** Ambient field, T. */
  earth: Vec;
}

export interface SizeKey {
  key: string;
  /** Unit of the file and of the schema. */
  unit: 'm' | '' | 'A m^2/A';
  least: number;
  most: number;
  /** For a new coil. */
  start: number;
}
const length = (key: string, start: number): SizeKey => ({ key, unit: 'm', least: 1e-6, most: 10, start });
const turns = (start: number): SizeKey => ({ ...length('turns', start), unit: '', least: 1e-3, most: 1e6 });
/** The dimensions of each type, as in docs/reference/field.md. */
export const kSizes: Record<CoilType, SizeKey[]> = {
  solenoid: [length('radius', 0.005), length('length', 0.04), turns(400)],
  loop: [length('radius', 0.01), turns(100)],
  thick_coil: [length('inner_radius', 0.005), length('outer_radius', 0.01), length('length', 0.02), turns(400)],
  helmholtz: [length('radius', 0.05), length('distance', 0.05), turns(100)],
  dipole: [{ ...length('moment', 0.03), unit: 'A m^2/A', least: -1e6, most: 1e6 }, { ...length('radius', 0.001), least: 1e-9 }],
};
export const kMostCoils = 24;
const kStartCurrent = 0.5; // A, the largest current of a new coil
const kPlace = 10; // m, largest coordinate

export const kEmpty: System = { coils: [], earth: [0, 0, 0] };

const digits = (v: number) => Number(v.toPrecision(10));
/** "35 mm"; exactly the value that the program reads. */
const millimetres = (v: number) => `${digits(v * 1e3)} mm`;
export const inMillimetres = (v: number) => digits(v * 1e3);
const written = (v: number, unit: SizeKey['unit']) => (unit === 'm' ? millimetres(v) : digits(v));

function coilTable(c: Coil): Record<string, unknown> {
  return {
    ...(c.name ? { name: c.name } : {}),
    type: c.type,
    ...Object.fromEntries(kSizes[c.type].map(({ key, unit }) => [key, written(c.size[key], unit)])),
    position: c.position.map(millimetres),
    axis: c.axis.map((v) => Number(v.toFixed(6))),
    ...(c.current ? { current: `${digits(c.current)} A` } : {}),
    ...(c.max === null ? {} : { max_current: `${digits(c.max)} A` }),
    ...c.other,
  };
}

/** The tables of the coil system file. */
export function tables(s: System): Record<string, unknown> {
  const earth = s.earth.some((v) => v !== 0) ? { earth: { field: s.earth.map((v) => `${digits(v * 1e6)} uT`) } } : {};
  return { ...earth, coil: s.coils.map(coilTable) };
}

const kEdited = ['type', 'name', 'position', 'axis', 'current', 'max_current'];
const vector = (values: unknown, unit: string): Vec => {
  const list = Array.isArray(values) ? values : [];
  return [0, 1, 2].map((i) => amount(list[i], unit) ?? 0) as Vec;
};

/** The coil system of a file: `given` has its tables as they are written, `resolved` those with all defaults. */
export function systemOf(given: Record<string, any>, resolved: Record<string, any>): System {
  const coils = (resolved.coil as Record<string, any>[]).map((c, i): Coil => {
    const type = c.type as CoilType, keys = kSizes[type];
    const size = Object.fromEntries(keys.map(({ key, unit }) => [key, amount(c[key], unit) ?? 0]));
    if (type === 'helmholtz' && c.distance == null) size.distance = size.radius * (c.opposed ? Math.sqrt(3) : 1);
    const edited = [...kEdited, ...keys.map((k) => k.key)];
    return {
      id: i + 1, type, size, name: c.name ?? '',
      position: vector(c.position, 'm'), axis: vector(c.axis, ''),
      current: amount(c.current, 'A') ?? 0, max: amount(c.max_current, 'A'),
      other: Object.fromEntries(Object.entries(given.coil[i]).filter(([key]) => !edited.includes(key))),
    };
  });
  return { coils, earth: vector(resolved.earth?.field, 'T') };
}

export const newId = (s: System) => Math.max(0, ...s.coils.map((c) => c.id)) + 1;

/** "coil 3", not used yet. */
function freeName(s: System, base: string): string {
  for (let n = s.coils.length + 1; ; ++n) if (!s.coils.some((c) => c.name === `${base} ${n}`)) return `${base} ${n}`;
}

/** A new coil at a position, with its axis towards the centre. */
export function newCoil(s: System, type: CoilType, position: Vec, base: string): Coil {
  const size = Object.fromEntries(kSizes[type].map(({ key, start }) => [key, start]));
  return { id: newId(s), type, name: freeName(s, base), position, axis: inwards(position), size, current: 0, max: kStartCurrent, other: {} };
}

/** The unit vector from a position to the centre, along x at the centre; in steps of 15 degrees in a plane. */
export function inwards(p: Vec): Vec {
  const length = Math.hypot(...p);
  if (length < 1e-9) return [1, 0, 0];
  const flat = p.findIndex((v) => Math.abs(v) < 1e-9);
  if (flat < 0) return p.map((v) => -v / length + 0) as Vec;
  const [a, b] = [0, 1, 2].filter((i) => i !== flat);
  const step = Math.PI / 12, angle = Math.round(Math.atan2(-p[b], -p[a]) / step) * step;
  const axis: Vec = [0, 0, 0];
  axis[a] = tidy(Math.cos(angle));
  axis[b] = tidy(Math.sin(angle));
  return axis;
}
/** Without rounding errors and negative zeros. */
export const tidy = (v: number) => Number(v.toFixed(6)) + 0;

export const without = (s: System, id: number): System => ({ ...s, coils: s.coils.filter((c) => c.id !== id) });
export const changed = (s: System, id: number, change: Partial<Coil>): System => ({ ...s, coils: s.coils.map((c) => (c.id === id ? { ...c, ...change } : c)) });
export const added = (s: System, c: Coil): System => ({ ...s, coils: [...s.coils, c] });

/** A copy, moved by `step` m to the right and down. */
export function duplicated(s: System, c: Coil, step: number, base: string): Coil {
  return { ...c, id: newId(s), name: freeName(s, base), position: placed([c.position[0] + step, c.position[1] - step, c.position[2]]) };
}
/** A copy on the other side of the centre, with the mirrored axis: both fields point towards the centre, or both away. */
export function mirrored(s: System, c: Coil, base: string): Coil {
  const flip = (v: Vec) => v.map((x) => -x + 0) as Vec;
  return { ...c, id: newId(s), name: freeName(s, base), position: flip(c.position), axis: flip(c.axis) };
}
export const placed = (p: Vec): Vec => p.map((v) => Math.min(kPlace, Math.max(-kPlace, Number(v.toFixed(9)) + 0))) as Vec;

/** The current within the limit. */
export const limited = (amperes: number, max: number | null) => (max === null ? amperes : Math.min(max, Math.max(-max, amperes)));
