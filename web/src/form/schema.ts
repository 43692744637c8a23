// The JSON Schema of a scenario, as used by the forms.

import type { Say } from '../i18n';
import { parseQuantity, showQuantity } from '../quantity';

export interface Schema {
  title?: string;
  description?: string;
  type?: string | string[];
  enum?: string[];
  const?: string;
  minimum?: number;
  maximum?: number;
  minItems?: number;
  maxItems?: number;
  default?: any;
  items?: Schema;
  properties?: Record<string, Schema>;
  oneOf?: Schema[];
  /** Traits of a part, such as "open_loop"; see web/protocol.md. */
  'x-traits'?: string[];
  'x-unit'?: string;
  /** Role of a value, such as "speed", for code that does not know the part. */
  'x-role'?: string;
  /** Source of the default; of a preset: the source of each preset. */
  'x-source'?: string | Record<string, string>;
  'x-validity'?: string;
  'x-values'?: Record<string, Record<string, any>>;
}

/** Properties of every form component. */
export interface Piece {
  name: string;
  schema: Schema;
  /** Value in the scenario; undefined: the default. */
  value: any;
  say: Say;
  onchange: (value: any) => void;
  /** Reports whether the value at `path` is invalid. */
  onwrong: (path: string, wrong: boolean) => void;
  path: string;
  /** Error messages of the program by path. */
  refused?: Record<string, string>;
}

export type Kind = 'flag' | 'choice' | 'number' | 'integer' | 'text' | 'vector' | 'numbers' | 'points' | 'tables' | 'part' | 'table';

/** A number, or a quantity as text with a unit. */
export const isNumber = (s: Schema) => s.type === 'number' || s.type === 'integer' || (Array.isArray(s.type) && s.type.includes('number'));

export function kindOf(s: Schema): Kind {
  if (s.oneOf) return 'part';
  if (s.enum) return 'choice';
  if (s.type === 'boolean') return 'flag';
  if (s.type === 'integer') return 'integer';
  if (isNumber(s)) return 'number';
  if (s.type === 'array') {
    const of = s.items ?? {};
    if (of.oneOf || of.properties) return 'tables';
    if (of.type === 'array') return 'points';
    return s.maxItems ? 'vector' : 'numbers';
  }
  return s.properties ? 'table' : 'text';
}

/** Converts a number or quantity of a scenario to the unit of its schema. */
export function amount(v: any, unit: string): number | null {
  if (typeof v === 'number') return v;
  if (typeof v !== 'string') return null;
  const q = parseQuantity(v, unit);
  return typeof q === 'number' ? q : null;
}

/** An angle, degrees; a number is in rad. */
export function degrees(value: string | number | undefined): number | undefined {
  const angle = amount(value, 'rad');
  return angle === null ? undefined : (angle * 180) / Math.PI;
}

/** Formats a value of a scenario for display. */
export function shown(v: any, s: Schema): string {
  if (v === undefined || v === null) return '';
  const a = amount(v, s['x-unit'] ?? '');
  return a === null ? String(v) : showQuantity(a, s['x-unit'] ?? '');
}

export interface Checked {
  /** Value for the scenario; undefined: the default. */
  value?: any;
  /** Error: key of the text in the catalogues, and its values. */
  wrong?: [string, Record<string, string>];
}

/** Parses and checks the input for one number. */
export function check(text: string, s: Schema, required = false): Checked {
  if (!text.trim()) return required ? { wrong: ['form.number', {}] } : {};
  const unit = s['x-unit'] ?? '';
  const q = parseQuantity(text, unit);
  if (q === 'number') return { wrong: ['form.number', {}] };
  if (q === 'unit') return { wrong: unit ? ['form.unit', { unit }] : ['form.number', {}] };
  if (s.type === 'integer' && !Number.isInteger(q)) return { wrong: ['form.integer', {}] };
  if (s.minimum !== undefined && q < s.minimum) return { wrong: ['form.least', { limit: showQuantity(s.minimum, unit) }] };
  if (s.maximum !== undefined && q > s.maximum) return { wrong: ['form.most', { limit: showQuantity(s.maximum, unit) }] };
  return { value: unit ? `${q} ${unit}` : q };
}

/** Whether two values of a scenario are equal, independent of their units. */
export function same(a: any, b: any, s: Schema): boolean {
  if (Array.isArray(a) && Array.isArray(b)) return a.length === b.length && a.every((v, i) => same(v, b[i], s.items ?? s));
  const p = amount(a, s['x-unit'] ?? ''), q = amount(b, s['x-unit'] ?? '');
  if (p !== null && q !== null) return p === q || Math.abs(p - q) <= 1e-12 * Math.max(Math.abs(p), Math.abs(q));
  return JSON.stringify(a) === JSON.stringify(b);
}

/** The table of a part: `model = "x"` is short for `model = { type = "x" }`. */
export const partTable = (value: any): Record<string, any> => (typeof value === 'object' && value ? value : { type: typeof value === 'string' ? value : '' });

export interface PresetState {
  /** Name of the preset; empty: none. */
  preset: string;
  /** Keys with other values than those of the preset. */
  changed: string[];
  /** All values are the defaults of the schema. */
  isDefault: boolean;
}

/**
 * The preset of a part's table: the one that it names, or the one from which the fewest values differ, because a resolved scenario
 * has all values and no preset. Fewer values must differ from the preset than from the defaults, and at most half of those that
 * distinguish the presets.
 */
export function presetState(part: Schema | undefined, table: Record<string, any>): PresetState {
  const { preset, type: _, ...properties } = part?.properties ?? {};
  const names = preset?.enum ?? [], values = (name: string) => preset?.['x-values']?.[name] ?? {};
  const custom = different(properties, table, {}).length, isDefault = custom === 0;
  if (typeof table.preset === 'string') {
    const given = values(table.preset); // values that the table does not give are those of the preset
    return { preset: table.preset, changed: different(properties, { ...given, ...table }, given), isDefault: false };
  }
  const distinctive = new Set(names.flatMap((a) => names.flatMap((b) => different(properties, values(a), values(b)))));
  const best = names
    .map((name) => ({ preset: name, changed: different(properties, table, values(name)) }))
    .filter(({ changed }) => !changed.length || (changed.length < custom && changed.filter((k) => distinctive.has(k)).length <= distinctive.size / 2))
    .sort((a, b) => a.changed.length - b.changed.length)[0];
  return { ...(best ?? { preset: '', changed: [] }), isDefault };
}
/** Keys of the values of a table that differ from the wanted ones; a value that is not given is the default. */
function different(properties: Record<string, Schema>, table: Record<string, any>, wanted: Record<string, any>): string[] {
  return Object.keys(properties).filter((key) => {
    const s = properties[key], is = table[key] ?? s.default, should = wanted[key] ?? s.default;
    return is === undefined || should === undefined ? is !== should : !same(is, should, s);
  });
}

/**
 * The text about the source of a value, as arguments of say(): the source of the schema belongs to its default, and the source of a
 * preset to the values that the preset gives. Null without a source.
 */
export function sourceOf(s: Schema, now: any, preset?: { value: any; source: string }): ['form.source' | 'form.default_source', Record<string, string>] | null {
  const own = typeof s['x-source'] === 'string' ? s['x-source'] : '';
  const isDefault = s.default === undefined || now === undefined || same(now, s.default, s);
  if (!isDefault && preset?.source && preset.value !== undefined && same(now, preset.value, s)) return ['form.source', { source: preset.source }];
  if (!own) return null;
  return isDefault ? ['form.source', { source: own }] : ['form.default_source', { source: own, value: shown(s.default, s) }];
}

/**
 * The path of the input for the place of an error, such as "swarm[0].model.speed": the longest part of the place that the schema
 * has; empty if it has none. `scenario` gives the types of the parts.
 */
export function inputPath(root: Schema, scenario: any, where: string): string {
  let s = root, value = scenario, path = '';
  for (const step of where.replace(/^.*: /, '').match(/[^.[\]]+|\[\d+\]/g) ?? []) {
    if (step.startsWith('[')) {
      if (kindOf(s) !== 'tables') break; // one input for all values of a vector or list
      s = s.items!;
      value = value?.[Number(step.slice(1, -1))];
      path += step;
      continue;
    }
    const type = typeof value === 'string' ? value : value?.type;
    const properties = s.oneOf ? variant(s, type)?.properties : s.properties;
    if (step === 'type' || step === 'preset' || !Object.hasOwn(properties ?? {}, step)) break; // the part itself
    s = properties![step];
    value = typeof value === 'object' ? value?.[step] : undefined;
    path = path ? `${path}.${step}` : step;
  }
  return path;
}

/** Schema of a part by its name. */
export const variant = (s: Schema, name: string) => s.oneOf?.find((o) => o.properties?.type?.const === name);
export const variants = (s: Schema) => (s.oneOf ?? []).map((o) => o.properties?.type?.const).filter((n): n is string => !!n);
