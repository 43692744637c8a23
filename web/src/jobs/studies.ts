// Studies that are composed in the page: JSON with the keys of a study file; see POST /api/studies.

import { amount, degrees, isNumber, type Schema, variant } from '../form/schema';
import type { FieldSegment } from '../pages/experiments/experiment';
import { showQuantity } from '../quantity';
import { steps, type NumberPath } from './kinds';

/** Prior of a free parameter: uniform in a range, normal, or uniform in the range of the schema. */
export type PriorKind = 'range' | 'normal' | 'full';
export interface FreeParameter {
  path: string;
  prior: PriorKind;
  /** Lowest value, or mean. */
  a: any;
  /** Highest value, or standard deviation. */
  b: any;
}
export interface CandidateModel {
  name: string;
  type: string;
  free: FreeParameter[];
}

const withUnit = (v: number, unit = '') => (unit ? `${Number(v.toPrecision(6))} ${unit}` : Number(v.toPrecision(6)));
/** The numbers of a model that can be free, by path, with their schemas: its parameters, and the number of cells. */
export function freeChoices(swarm: Schema, type: string): Record<string, Schema> {
  const found: Record<string, Schema> = {};
  const take = (path: string, s?: Schema) => {
    if (s && isNumber(s) && s.minimum !== undefined && s.maximum !== undefined) found[path] = s;
  };
  const properties = (swarm.properties?.model && variant(swarm.properties.model, type)?.properties) || {};
  for (const [key, s] of Object.entries(properties)) take(`swarm[0].model.${key}`, s);
  take('swarm[0].count', swarm.properties?.count);
  return found;
}
/** A new free parameter: half to 1.5 times the default, within the limits of the schema. */
export function newFree(path: string, s: Schema): FreeParameter {
  const unit = s['x-unit'] ?? '', value = amount(s.default, unit);
  if (value === null || value <= 0) return { path, prior: s.type === 'integer' ? 'range' : 'full', a: withUnit(s.minimum!, unit), b: withUnit(s.maximum!, unit) };
  const low = Math.max(s.minimum!, value / 2), high = Math.min(s.maximum!, value * 1.5); // twice the default is above the largest speed of some models
  const rounded = (v: number) => (s.type === 'integer' ? Math.round(v) : v);
  return { path, prior: 'range', a: withUnit(rounded(low), unit), b: withUnit(rounded(high), unit) };
}
/** The type, with a number if other parts of the list have it as their name. */
export function newName(type: string, names: string[]): string {
  let name = type;
  for (let i = 2; names.includes(name); ++i) name = `${type} ${i}`;
  return name;
}
/** A [[model]] of a study for identify. */
export function candidateTable(c: CandidateModel) {
  const free = Object.fromEntries(c.free.map((f) => [f.path, f.prior === 'full' ? true : f.prior === 'range' ? [f.a, f.b] : { mean: f.a, sd: f.b }]));
  return { ...(c.name && c.name !== c.type ? { name: c.name } : {}), type: c.type, free };
}

/** A field segment as text: "5.6 s – 8.5 s, 90°". */
export function segmentText(s: FieldSegment): string {
  const deg = degrees(s.direction);
  return `${s.from} – ${s.to}, ${deg === undefined ? '?' : `${Math.round(deg)}°`}`;
}

/** A parameter of a sweep: its values in equal steps. */
export interface Sweep {
  number: NumberPath;
  low: any;
  high: any;
  count: number;
}
/** Maximum number of combinations of a sweep; the text 'sweep.many' has it too. */
const kMostCombinations = 200;
/** The [[model]] tables of a sweep: all combinations of the values. Throws a key of the page's texts. */
export function sweepVariants(sweeps: Sweep[]): { name: string; set: Record<string, any> }[] {
  let all: { name: string; set: Record<string, any> }[] = [{ name: '', set: {} }];
  for (const { number, low, high, count } of sweeps) {
    const unit = number.schema['x-unit'] ?? '', from = amount(low, unit), to = amount(high, unit);
    if (from === null || to === null) throw new Error('sweep.range');
    const key = number.path.split('.').at(-1)!;
    const values = steps(from, to, count).map((v) => (number.schema.type === 'integer' ? Math.round(v) : v));
    all = all.flatMap((one) =>
      [...new Set(values)].map((v) => ({
        name: `${one.name}${one.name ? ', ' : ''}${key} ${showQuantity(v, unit)}`,
        set: { ...one.set, [number.path]: unit ? `${v} ${unit}` : v },
      })),
    );
  }
  if (all.length > kMostCombinations) throw new Error('sweep.many');
  return all;
}
