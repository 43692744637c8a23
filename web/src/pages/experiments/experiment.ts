// Experiments as the program sends them, and changes to them.

import { amount, degrees } from '../../form/schema';
import { normalised } from '../../video/angles';

/** An entry of the list. */
export interface ExperimentCard {
  name: string;
  title: string;
  drops: number;
  videos: number;
  error?: string;
}
export interface Drop {
  name: string;
  polarity?: 'unknown' | 'north' | 'south';
  note?: string;
}
export interface Video {
  file: string;
  drop?: string;
  exposure?: string | number;
  reversal?: string | number;
  field_direction?: string | number;
  field_strength?: string | number;
  from?: string | number;
  to?: string | number;
  um_per_px?: number;
  um_per_px_se?: number;
  um_per_px_source?: string;
  segment?: FieldSegment[];
  note?: string;
}
/** A field segment; the direction is that in which the cells swim, counter-clockwise from the right. */
export interface FieldSegment {
  from?: string | number;
  to?: string | number;
  direction?: string | number;
}
/** A scale with its standard error and origin, as the experiment or a video states it. */
export interface Scale {
  um_per_px: number;
  um_per_px_se?: number;
  um_per_px_source?: string;
}
export interface Experiment {
  title?: string;
  note?: string;
  objective?: string;
  um_per_px?: number;
  um_per_px_se?: number;
  um_per_px_source?: string;
  noise?: string;
  drop?: Drop[];
  video?: Video[];
}
/** A change of one value: `from` is the value that the page has seen; undefined removes. */
export interface Change {
  path: string[];
  from?: unknown;
  to?: unknown;
}
export interface Conflict {
  path: string[];
  now: unknown;
}

/** The path of a video for the lab: relative to the workspace, or absolute in an allowed folder. */
export function pathInLab(experiment: string, file: string): string {
  if (file.startsWith('/')) return file;
  const out: string[] = [];
  for (const part of `experiments/${experiment}/${file}`.split('/')) {
    if (part === '..') out.pop(); // removes "a/.."
    else if (part !== '.') out.push(part);
  }
  return out.join('/');
}

/** The scale of a video: its own, or that of the experiment. */
export function scaleOf(e: Experiment, v: Video): Scale | undefined {
  const of = v.um_per_px === undefined ? e : v;
  return of.um_per_px === undefined ? undefined : { um_per_px: of.um_per_px, um_per_px_se: of.um_per_px_se, um_per_px_source: of.um_per_px_source };
}
/** The changes that set a scale at a path, [] or ["video", file], or remove it. */
export const scaleChanges = (path: string[], scale: Partial<Scale>): Change[] =>
  (['um_per_px', 'um_per_px_se', 'um_per_px_source'] as const).map((key) => ({ path: [...path, key], to: scale[key] }));
/** "0.64 ± 0.01 µm/px"; the value is rounded to the second digit of its standard error. */
export function scaleText({ um_per_px, um_per_px_se }: Scale): string {
  if (!um_per_px_se) return `${Number(um_per_px.toPrecision(4))} µm/px`;
  const digits = Math.min(Math.max(1 - Math.floor(Math.log10(um_per_px_se)), 0), 9);
  return `${um_per_px.toFixed(digits)} ± ${um_per_px_se.toFixed(digits)} µm/px`;
}
/** The largest relative standard error of the scales of videos, rounded; undefined if none is known. */
export function scaleUncertainty(e: Experiment): number | undefined {
  const scales = (e.video ?? []).map((v) => scaleOf(e, v)).filter((s) => s?.um_per_px_se);
  const most = Math.max(0, ...scales.map((s) => s!.um_per_px_se! / s!.um_per_px));
  return most > 0 ? Number(most.toPrecision(3)) : undefined;
}

const kIdentity: Record<string, string> = { drop: 'name', video: 'file' };

/** The value at a path of an experiment; undefined if it has none. */
export function valueAt(e: Experiment, [key, item, field]: string[]): unknown {
  const top = (e as Record<string, any>)[key];
  if (item === undefined) return top;
  const found = (top as Record<string, any>[] | undefined)?.find((one) => one[kIdentity[key]] === item);
  return field === undefined ? found : found?.[field];
}

/** The changes that undo others. An item whose identity was changed has its new one in the path. */
export const inverse = (changes: Change[]): Change[] =>
  changes
    .map(({ path, from, to }) => {
      const renamed = path.length === 3 && path[2] === kIdentity[path[0]];
      return { path: renamed ? [path[0], String(to), path[2]] : path, from: to, to: from };
    })
    .reverse();

type Value = string | number | undefined;
/** A time, s; undefined for an empty or invalid text. */
export const seconds = (value: Value) => amount(value, 's') ?? undefined;

/** Direction in which the cells swim after the reversal, degrees counter-clockwise from the right; undefined if it is not known. */
export function swimmingDirection(e: Experiment, v: Video): number | undefined {
  const field = degrees(v.field_direction), polarity = e.drop?.find((d) => d.name === v.drop)?.polarity;
  if (field === undefined || (polarity !== 'north' && polarity !== 'south')) return undefined;
  return normalised(field + (polarity === 'south' ? 180 : 0));
}

/**
 * The value of a drop or video that an error of the program is about: "video[0].exposure". An error about two values of one item,
 * "to = 3 s is not later than from = 4 s", starts with one of them. Null for other errors.
 */
export function refusalOf({ where, what }: { where: string; what: string }): { list: string; index: number; key: string } | null {
  const item = /^(drop|video)\[(\d+)\](?:\.(\w+).*)?$/.exec(where), key = item?.[3] ?? /^(\w+) = /.exec(what)?.[1];
  return item && key ? { list: item[1], index: Number(item[2]), key } : null;
}

/** The first letter from A that no drop has as its name; after Z a number. */
export function nextDropName(drops: Drop[]): string {
  const used = new Set(drops.map((d) => d.name));
  for (let i = 0; i < 26; ++i) {
    const name = String.fromCharCode(65 + i);
    if (!used.has(name)) return name;
  }
  let n = 27;
  while (used.has(String(n))) ++n;
  return String(n);
}

/** Whether exposure times can be proposed for the videos of a drop: that of one video is known. */
export const mayPropose = (videos: Video[]) => videos.some((v) => seconds(v.exposure) !== undefined);
/**
 * Air exposure times from the times of files, for videos of one drop without one, relative to the earliest file with a known
 * exposure. `modified`: Unix time of each file, s.
 */
export function proposedExposures(videos: Video[], modified: Record<string, number>): Change[] {
  const timed = videos.filter((v) => modified[v.file] > 0).sort((a, b) => modified[a.file] - modified[b.file]);
  const known = timed.find((v) => seconds(v.exposure) !== undefined);
  if (!known) return [];
  const zero = modified[known.file] - seconds(known.exposure)!;
  return timed
    .filter((v) => v.exposure === undefined && modified[v.file] >= zero)
    .map((v) => ({ path: ['video', v.file, 'exposure'], to: `${Math.round(modified[v.file] - zero)} s` }));
}
