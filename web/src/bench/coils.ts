// The coil tables of a scene, [[rig.coil]], as the assistant reads, checks and writes them.

import { amount } from '../form/schema';
import { typedNumber, type Refused } from './capture';

export type Pair = [volts: number, amperes: number];
/** The table of a coil as the resolved scenario has it. */
export type CoilJson = Record<string, any>;

/** Voltage at the output for a current of the coil, A: as the program computes it from `gain` and `neutral`, or from `table`. */
export function voltsFor(coil: CoilJson, amperes: number): number {
  const wanted = (coil.polarity ?? 1) * amperes;
  const table: Pair[] = coil.table ?? [];
  const volts = table.length > 1 ? interpolated(table, wanted) : (amount(coil.neutral, 'V') ?? 0) + wanted / (amount(coil.gain, 'A/V') || 1);
  return Math.min(amount(coil.most_volts, 'V') ?? Infinity, Math.max(amount(coil.least_volts, 'V') ?? -Infinity, volts));
}
// Linear, also beyond the ends.
function interpolated(table: Pair[], amperes: number): number {
  const t = table[0][1] < table[table.length - 1][1] ? table : [...table].reverse();
  let i = 1;
  while (i + 1 < t.length && amperes > t[i][1]) ++i;
  const [[v0, a0], [v1, a1]] = [t[i - 1], t[i]];
  return v0 + ((amperes - a0) * (v1 - v0)) / (a1 - a0);
}

/** A row of the calibration as typed. */
export interface Row {
  volts: string;
  amperes: string;
}
const kLargest = 1000;
const isEmpty = (r: Row) => !r.volts.trim() && !r.amperes.trim();

/** The pairs of the rows that are not empty, by increasing voltage; NaN for an invalid text. */
export const pairsOf = (rows: Row[]): Pair[] => rows.filter((r) => !isEmpty(r)).map((r): Pair => [typedNumber(r.volts), typedNumber(r.amperes)]).sort((a, b) => a[0] - b[0]);

/** Why the program would not accept the rows as a table; undefined if it would. */
export function checkRows(rows: Row[], coil: CoilJson): Refused | undefined {
  const bad = rows.find((r) => !isEmpty(r) && [r.volts, r.amperes].some((text) => !(Math.abs(typedNumber(text)) <= kLargest)));
  if (bad) return ['assistant.bad.row', { volts: bad.volts.trim() || '–', amperes: bad.amperes.trim() || '–' }];
  const pairs = pairsOf(rows);
  if (pairs.length < 2) return ['assistant.bad.few', { n: pairs.length }];
  const up = pairs[1][1] > pairs[0][1];
  for (let i = 1; i < pairs.length; ++i) {
    const [[v0, a0], [v1, a1]] = [pairs[i - 1], pairs[i]];
    if (v0 === v1) return ['assistant.bad.twice', { volts: v1 }];
    if (a0 === a1 || a1 > a0 !== up) return ['assistant.bad.monotonic', { v0, a0, v1, a1 }];
  }
  const least = amount(coil.least_volts, 'V') ?? -Infinity, most = amount(coil.most_volts, 'V') ?? Infinity;
  const zero = interpolated(pairs, 0);
  if (zero < least || zero > most) return ['assistant.bad.zero', { volts: Number(zero.toPrecision(3)), least, most }];
  return undefined;
}

/** What the assistant found out about a coil. */
export interface Found {
  /** The needle turned the wrong way. */
  reversed: boolean;
  /** A valid table; null: gain and neutral of the scene remain. */
  table: Pair[] | null;
}
/** The coil of a scene with the results of the assistant. */
export function changedCoil(coil: CoilJson, found: Found): CoilJson {
  const out = { ...coil };
  if (found.reversed) out.polarity = -(coil.polarity ?? 1);
  if (found.table) out.table = found.table;
  if (out.table?.length) {
    delete out.gain;
    delete out.neutral;
  }
  return out;
}

/** One [[rig.coil]] in TOML; empty values are left out. */
export function coilToml(coil: CoilJson): string {
  const value = (v: any) => (Array.isArray(v) ? `[${v.map((p) => `[${p.join(', ')}]`).join(', ')}]` : JSON.stringify(v));
  const lines = Object.entries(coil).filter(([key, v]) => v !== '' && !(Array.isArray(v) && !v.length) && !(key === 'polarity' && v === 1));
  return ['[[rig.coil]]', ...lines.map(([key, v]) => `${key} = ${value(v)}`)].join('\n');
}
export const coilsToml = (coils: CoilJson[]) => `${coils.map(coilToml).join('\n\n')}\n`;

const kHeader = /^\s*\[\[?\s*([\w-]+(?:\s*\.\s*[\w-]+)*)\s*\]\]?\s*(?:#.*)?$/;

/** The text of a scene with other tables [[rig.coil]]; the comments and the other tables are unchanged. */
export function withCoils(scene: string, coils: string): string {
  let inCoil = false;
  const kept = scene.split('\n').filter((line) => {
    const header = kHeader.exec(line)?.[1].replace(/\s/g, '');
    if (header !== undefined) inCoil = header === 'rig.coil' || header.startsWith('rig.coil.');
    return !inCoil;
  });
  return `${kept.join('\n').trimEnd()}\n\n${coils}`;
}
