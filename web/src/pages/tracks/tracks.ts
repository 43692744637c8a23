// Data of the tracks page: settings, features, cuts, edits and points of tracks.

import { get, post } from '../../connection';
import type { Warning } from '../../quality/quality';

/** Options of `faba track` that the user overrides; a missing one is automatic. Keys are those of the request. */
export interface Settings {
  size?: number;
  threshold?: number;
  polarity?: string;
  background?: string;
  reach?: number;
  motion?: string;
  memory?: number;
  least?: number;
  'um-per-px'?: number;
  fps?: number;
}
const kNumberKeys = ['size', 'threshold', 'reach', 'memory', 'least', 'um-per-px', 'fps'] as const;
const kWordKeys = ['polarity', 'background', 'motion'] as const;

/** The settings in the values of an address. */
export function settingsOf(values: Record<string, string>): Settings {
  const s: Settings = {};
  for (const key of kNumberKeys) if (values[key] && Number.isFinite(Number(values[key]))) s[key] = Number(values[key]);
  for (const key of kWordKeys) if (values[key]) s[key] = values[key];
  return s;
}
/** Their inverse. */
export function valuesOf(s: Settings): Record<string, string> {
  return Object.fromEntries(Object.entries(s).filter(([, v]) => v !== undefined && v !== '').map(([k, v]) => [k, String(v)]));
}

export type Spot = [x: number, y: number, size: number, snr: number];
export interface VideoFacts {
  width: number;
  height: number;
  frames: number;
  fps: number;
  um_per_px: number | null;
  /** Grey values for the display. */
  black: number;
  white: number;
}
export interface Detected {
  frame: number;
  t_s: number;
  spots: Spot[];
  detection: Record<string, any>;
  quality: 'good' | 'doubtful' | 'poor';
  warnings: Warning[];
  video: VideoFacts;
}
export interface Linked {
  first: number;
  frames: number;
  tracks: [frame: number, x: number, y: number][][];
  reach_px: number;
  motion: string;
  crowded: boolean;
  video: VideoFacts;
}

export interface Feature {
  name: string;
  unit: string;
}
export type Fate = 'passes' | 'cut' | 'deleted' | 'kept';
export interface TrackRow {
  number: number;
  points: number;
  fate: Fate;
  /** In the order of the features; null: not defined. */
  values: (number | null)[];
}
export interface Cut {
  feature: string;
  min?: number | null;
  max?: number | null;
}
export interface Edit {
  action: 'delete' | 'keep' | 'split' | 'join';
  track: number;
  frame?: number;
  with?: number;
}
export interface Edits {
  cut: Cut[];
  edit: Edit[];
}
export interface EditedTracks {
  features: Feature[];
  tracks: TrackRow[];
  edits: { cut?: Cut[]; edit?: Edit[] };
  revision: string;
}
export interface Result extends EditedTracks {
  folder: string;
  video: string | null;
  summary: Record<string, any>;
}

/** Whether a value passes a cut: limits are included, and a missing value does not pass. As TrackCut::passes(). */
export function passes(cut: Cut, value: number | null): boolean {
  if (value === null) return false;
  return (cut.min == null || value >= cut.min) && (cut.max == null || value <= cut.max);
}
/** What happens to each track with these cuts: changes by hand have precedence. */
export function fatesOf(features: Feature[], tracks: TrackRow[], cuts: Cut[]): Fate[] {
  const at = cuts.map((c) => features.findIndex((f) => f.name === c.feature));
  return tracks.map((t) => {
    if (t.fate === 'deleted' || t.fate === 'kept') return t.fate;
    return cuts.every((c, i) => passes(c, t.values[at[i]] ?? null)) ? 'passes' : 'cut';
  });
}
export const used = (fate: Fate) => fate === 'passes' || fate === 'kept';

/** The cuts with one replaced; without limits it is removed. */
export function withCut(cuts: Cut[], cut: Cut): Cut[] {
  const others = cuts.filter((c) => c.feature !== cut.feature);
  const limited: Cut = { feature: cut.feature };
  if (cut.min != null) limited.min = cut.min;
  if (cut.max != null) limited.max = cut.max;
  if (limited.min === undefined && limited.max === undefined) return others;
  const index = cuts.findIndex((c) => c.feature === cut.feature);
  return index < 0 ? [...cuts, limited] : cuts.map((c, i) => (i === index ? limited : c));
}

export interface Histogram {
  low: number;
  high: number;
  /** Number of all tracks, and of the used ones, in each bin. */
  all: number[];
  used: number[];
}
/** Histogram with equal bins from the smallest to the largest value; null without values. */
export function histogram(values: (number | null)[], isUsed: boolean[], bins: number): Histogram | null {
  let low = Infinity, high = -Infinity;
  for (const v of values) {
    if (v === null) continue;
    low = Math.min(low, v);
    high = Math.max(high, v);
  }
  if (low > high) return null;
  if (low === high) [low, high] = [low - 0.5, high + 0.5];
  const h: Histogram = { low, high, all: Array(bins).fill(0), used: Array(bins).fill(0) };
  values.forEach((v, i) => {
    if (v === null) return;
    const bin = Math.min(bins - 1, Math.floor(((v - low) / (high - low)) * bins));
    ++h.all[bin];
    if (isUsed[i]) ++h.used[bin];
  });
  return h;
}

/** Detections of all tracks; those of track i are from start[i] to start[i + 1]. */
export interface Points {
  start: number[];
  frame: Uint32Array;
  t: Float32Array;
  x: Float32Array;
  y: Float32Array;
}
export function pointsOf(buffer: ArrayBuffer, tracks: TrackRow[]): Points {
  const n = buffer.byteLength / 16, view = new DataView(buffer);
  const p: Points = { start: [0], frame: new Uint32Array(n), t: new Float32Array(n), x: new Float32Array(n), y: new Float32Array(n) };
  for (const t of tracks) p.start.push(p.start[p.start.length - 1] + t.points);
  if (p.start[tracks.length] !== n) throw new Error('the points do not belong to these tracks');
  for (let i = 0; i < n; ++i) {
    p.frame[i] = view.getUint32(16 * i, true);
    p.t[i] = view.getFloat32(16 * i + 4, true);
    p.x[i] = view.getFloat32(16 * i + 8, true);
    p.y[i] = view.getFloat32(16 * i + 12, true);
  }
  return p;
}
/** Index after the last point of track i that is not later than a frame. */
export function pointsUpTo(p: Points, track: number, frame: number): number {
  let low = p.start[track], high = p.start[track + 1];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (p.frame[middle] <= frame) low = middle + 1;
    else high = middle;
  }
  return low;
}
/** The track nearest to a position among those with a point from `from` to `to`; -1 if none is within `reach`, px. */
export function trackAt(p: Points, isShown: boolean[], from: number, to: number, x: number, y: number, reach: number): number {
  let best = -1, least = reach * reach;
  for (let i = 0; i + 1 < p.start.length; ++i) {
    if (!isShown[i]) continue;
    for (let k = pointsUpTo(p, i, from - 1); k < p.start[i + 1] && p.frame[k] <= to; ++k) {
      const d = (p.x[k] - x) ** 2 + (p.y[k] - y) ** 2;
      if (d <= least) [best, least] = [i, d];
    }
  }
  return best;
}
/** Speed of a track over `interval` frames, at the middle of each displacement, px/s. */
export function speedOf(p: Points, track: number, interval: number): { t: number[]; v: number[] } {
  const out = { t: [] as number[], v: [] as number[] };
  let last = p.start[track];
  for (let i = p.start[track]; i < p.start[track + 1]; ++i) {
    while (p.frame[i] - p.frame[last] > interval) ++last;
    if (p.frame[i] - p.frame[last] !== interval) continue;
    const dt = p.t[i] - p.t[last];
    if (!(dt > 0)) continue;
    out.t.push((p.t[i] + p.t[last]) / 2);
    out.v.push(Math.hypot(p.x[i] - p.x[last], p.y[i] - p.y[last]) / dt);
  }
  return out;
}

/** Three significant digits, without an exponent for typical values. */
export function short(v: number | null | undefined): string {
  if (v === null || v === undefined || !Number.isFinite(v)) return '–';
  return Math.abs(v) >= 1e5 || (v !== 0 && Math.abs(v) < 1e-3) ? v.toExponential(2) : String(Number(v.toPrecision(3)));
}

/** Factor and unit for display: lengths are in µm if the scale is known. */
export function inUnit(unit: string, umPerPx: number | null): { factor: number; unit: string } {
  return umPerPx && unit.startsWith('px') ? { factor: umPerPx, unit: unit.replace('px', 'µm') } : { factor: 1, unit };
}

/** Sends only the newest of several requests: while one is under way, the last of the following ones waits. */
export class Newest {
  private busy = false;
  private next: (() => Promise<void>) | null = null;
  run(request: () => Promise<void>) {
    this.next = request;
    if (!this.busy) void this.work();
  }
  private async work() {
    this.busy = true;
    while (this.next) {
      const request = this.next;
      this.next = null;
      await request();
    }
    this.busy = false;
  }
}

/** Detection or linking; `survey` receives the progress while the program reads the sampled frames of the video. */
export async function probe<T>(what: 'detect' | 'link', asked: Record<string, unknown>, survey: (done: number, of: number) => void, stop: () => boolean): Promise<T | null> {
  for (;;) {
    const a = await post<any>(`/api/tracks/${what}`, asked);
    if (a.ready) return a as T;
    survey(a.done, a.of);
    if (stop()) return null;
    await new Promise((r) => setTimeout(r, 150));
  }
}
/** Picture of a frame; `black` and `white`: grey values, automatic if they are not known. */
export const frameUrl = (file: string, frame: number, black?: number, white?: number) =>
  `/api/videos/frame?${new URLSearchParams({ file, index: String(frame), width: '2048', ...(black !== undefined && white !== undefined ? { low: String(black), high: String(white) } : {}) })}`;
export const fileUrl = (folder: string, name: string) => `/api/tracks/file/${name}?${new URLSearchParams({ folder })}`;
export const loadResult = (folder: string) => get<Result>(`/api/tracks/result?${new URLSearchParams({ folder })}`);
export async function loadPoints(folder: string, tracks: TrackRow[]): Promise<Points> {
  const r = await fetch(`/api/tracks/points?${new URLSearchParams({ folder })}`);
  if (!r.ok) throw new Error(r.statusText);
  return pointsOf(await r.arrayBuffer(), tracks);
}
