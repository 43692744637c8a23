// Kinds of jobs, the files that they need, and the times of the queue.

import { get, post } from '../connection';
import { isNumber, variant, type Schema } from '../form/schema';
import type { Say, Word } from '../i18n';
import type { Job } from '../lab.svelte';

/** A property of the values of a job; see GET /api/job-kinds in web/protocol.md. */
export interface InputSchema extends Schema {
  'x-file'?: FileKind | 'frame';
  'x-direction'?: boolean;
  'x-currents'?: boolean;
}
export interface KindInfo {
  kind: string;
  group: 'videos' | 'models' | 'control' | 'coils';
  verb: string;
  page: string;
  outputs: string[];
  schema: { description: string; required: string[]; properties: Record<string, InputSchema> };
}
export type FileKind = 'video' | 'picture' | 'table' | 'coil_system' | 'study' | 'scene' | 'experiment';
/** A file of the workspace. */
export interface InputFile {
  file: string;
  kind: FileKind;
  bytes: number;
  /** Last change, s since 1970. */
  time: number;
  verb?: string;
  title?: string;
  coils?: number;
  currents?: boolean;
  run?: boolean;
}
export interface Estimate {
  seconds: number;
  from: 'measured' | 'assumed';
}

/** Whether a job names a file of the workspace in its command line. */
export const namesFile = (j: Job, file: string) => j.words.some((w) => w === file || w === `./${file}`);

let kinds: Promise<KindInfo[]> | null = null;
/** The kinds of jobs of the program; requested once. */
export function jobKinds(): Promise<KindInfo[]> {
  kinds ??= get<KindInfo[]>('/api/job-kinds').catch((e) => {
    kinds = null;
    throw e;
  });
  return kinds;
}
export const inputFiles = () => get<InputFile[]>('/api/inputs');
/** Videos of the workspace, newest first. */
export const videoFiles = async () => (await inputFiles()).filter((f) => f.kind === 'video').map((f) => f.file);
export const hasPicture = (kind: FileKind | 'frame') => kind === 'video' || kind === 'picture' || kind === 'frame';

/** Starts a job; returns its number. Results of an experiment go to its folder. */
export async function startJob(kind: string, values: Record<string, any>, experiment?: string): Promise<number> {
  return (await post<{ id: number }>('/api/jobs', { kind, values, ...(experiment ? { experiment } : {}) })).id;
}

/** The files of a list that an input accepts and that contain all words of the search text. */
export function accepted(files: InputFile[], wanted: FileKind | 'frame', verb: string, search = ''): InputFile[] {
  const words = search.toLowerCase().split(/\s+/).filter(Boolean);
  const seen = new Set<string>();
  return files.filter((f) => {
    const fits = wanted === 'frame' ? f.kind === 'picture' || f.kind === 'video' : f.kind === wanted;
    if (!fits || (wanted === 'study' && f.verb !== verb) || seen.has(f.file)) return false;
    const text = `${f.file} ${f.title ?? ''}`.toLowerCase();
    if (!words.every((w) => text.includes(w))) return false;
    seen.add(f.file);
    return true;
  });
}

/** Required inputs without a value. */
export const missingInputs = (k: KindInfo, values: Record<string, any>) => k.schema.required.filter((key) => isEmpty(values[key]));
export const isEmpty = (v: any) => v === undefined || v === null || v === '' || (Array.isArray(v) && v.length === 0);
/** Values without the empty ones. */
export const givenValues = (values: Record<string, any>) => Object.fromEntries(Object.entries(values).filter(([, v]) => !isEmpty(v)));

/** A number with one digit: 37 becomes 40. */
const oneDigit = (v: number) => Number(v.toPrecision(1));
/** A run time as text, with one digit: "about 2 min". */
export function aboutTime(seconds: number, say: Say): string {
  if (seconds < 1) return say('time.below_second');
  // 57 s would become 60 s.
  const units: [number, Word][] = [[3600 * 24, 'time.d'], [3600, 'time.h'], [60, 'time.min'], [1, 'time.s']];
  for (const [unit, word] of units) {
    const n = oneDigit(seconds / unit);
    const rounded = n * unit;
    if (n >= 1 && (unit === 1 ? rounded < 60 : true)) return say('time.about', { t: say(word, { n }) });
  }
  return say('time.about', { t: say('time.min', { n: 1 }) });
}

/** Remaining time of a running job, s; null if it is not known. Early in a job the estimate counts more than the progress. */
export function timeLeft(j: Job): number | null {
  const byEstimate = j.estimate_s > 0 ? Math.max(0, j.estimate_s - j.seconds) : null;
  const part = j.of > 0 ? Math.min(1, j.done / j.of) : 0;
  if (part <= 0 || j.seconds < 1) return byEstimate;
  const byProgress = (j.seconds * (1 - part)) / part;
  return byEstimate === null ? byProgress : part * byProgress + (1 - part) * byEstimate;
}
export interface QueueTime {
  /** Time until the start, s; 0 for a running job. */
  start: number | null;
  /** Time until the end, s. */
  end: number | null;
}
/** Times of the running and the queued jobs by number, in the order of the queue. */
export function queueTimes(jobs: Job[]): Map<number, QueueTime> {
  const times = new Map<number, QueueTime>();
  let at: number | null = 0;
  for (const j of jobs.filter((one) => one.state === 'running')) {
    at = timeLeft(j);
    times.set(j.id, { start: 0, end: at });
  }
  for (const j of jobs.filter((one) => one.state === 'waiting')) {
    const start: number | null = at;
    at = at === null || j.estimate_s <= 0 ? null : at + j.estimate_s;
    times.set(j.id, { start, end: at });
  }
  return times;
}

/** A number of a scenario with its path, "swarm[0].model.speed". */
export interface NumberPath {
  path: string;
  schema: Schema;
  value: any;
}
/** All numbers of a resolved scenario that have a range, with their paths. */
export function numberPaths(schema: Schema, value: any, path = ''): NumberPath[] {
  if (isNumber(schema)) return schema.minimum !== undefined && schema.maximum !== undefined ? [{ path, schema, value }] : [];
  if (Array.isArray(value)) {
    const items = schema.items;
    return items && (items.oneOf || items.properties) ? value.flatMap((v, i) => numberPaths(items, v, `${path}[${i}]`)) : [];
  }
  if (typeof value !== 'object' || value === null) return [];
  const properties = (schema.oneOf ? variant(schema, value.type) : schema)?.properties ?? {};
  return Object.entries(properties).flatMap(([key, s]) => (key in value ? numberPaths(s, value[key], path ? `${path}.${key}` : key) : []));
}

/** Values from `low` to `high` in equal steps, rounded to six digits. */
export function steps(low: number, high: number, count: number): number[] {
  return Array.from({ length: count }, (_, i) => Number((count === 1 ? low : low + ((high - low) * i) / (count - 1)).toPrecision(6)));
}
