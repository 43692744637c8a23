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
  'x-source'?: string;
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
}

export type Kind = 'flag' | 'choice' | 'number' | 'integer' | 'text' | 'vector' | 'numbers' | 'points' | 'tables' | 'part' | 'table';

const numeric = (s: Schema) => s.type === 'number' || s.type === 'integer' || (Array.isArray(s.type) && s.type.includes('number'));

export function kindOf(s: Schema): Kind {
  if (s.oneOf) return 'part';
  if (s.enum) return 'choice';
  if (s.type === 'boolean') return 'flag';
  if (s.type === 'integer') return 'integer';
  if (numeric(s)) return 'number';
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

/** Formats a value of a scenario for display. */
export function shown(v: any, s: Schema): string {
  if (v === undefined || v === null) return '';
  const a = amount(v, s['x-unit'] ?? '');
  return a === null ? String(v) : showQuantity(a, s['x-unit'] ?? '');
}

export interface Checked {
  /** Value for the scenario; undefined: the default. */
  value?: any;
  /** Error: key of the text in i18n.ts, and its values. */
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

/** Schema of a part by its name. */
export const variant = (s: Schema, name: string) => s.oneOf?.find((o) => o.properties?.type?.const === name);
export const variants = (s: Schema) => (s.oneOf ?? []).map((o) => o.properties?.type?.const).filter((n): n is string => !!n);
