// What can be drawn over a video: results of the program, from its files. Lengths in px of the picture, y down; directions as
// in angles.ts.

import { flipped } from './angles';
import type { Segment } from './marks';

export interface Track {
  t_s: number[];
  x: number[];
  y: number[];
}
export interface SwarmRow {
  t_s: number;
  x: number;
  y: number;
  /** Covariance, px^2. */
  xx: number;
  xy: number;
  yy: number;
}
export interface FlowField {
  t_s: number;
  /** Arrows at (x, y) with the displacement (u, v) to the next frame. */
  arrows: [x: number, y: number, u: number, v: number][];
}
export interface VideoOverlays {
  edge?: { x: number; y: number; radius: number } | null;
  /** Positions of detected cells in frames, in order of time; without it, those of the tracks. */
  detections?: { t_s: number; xy: [number, number][] }[];
  tracks?: Track[];
  flow?: FlowField[];
  swarm?: SwarmRow[];
  /** Segments that the program has found. */
  segments?: Segment[];
  /** Time of the field reversal that the program has found, or that was recorded. */
  reversal_s?: number | null;
  /** Activity against time. */
  activity?: { t_s: number[]; value: number[] };
}
export const kOverlays = ['edge', 'detections', 'tracks', 'flow', 'swarm', 'segments'] as const;
export type OverlayName = (typeof kOverlays)[number];

/** The overlays for which there are data. */
export function available(o: VideoOverlays): OverlayName[] {
  return kOverlays.filter((k) => {
    if (k === 'edge') return !!o.edge;
    if (k === 'detections') return !!(o.detections?.length || o.tracks?.length);
    return !!o[k]?.length;
  });
}

/** A file of results as overlays; null if it has none. */
export function readOverlays(text: string): VideoOverlays | null {
  return text.trimStart().startsWith('{') ? fromJson(text) : fromCsv(text);
}

function fromJson(text: string): VideoOverlays | null {
  let j: any;
  try {
    j = JSON.parse(text);
  } catch {
    return null;
  }
  // `faba drop --json`
  if (Array.isArray(j.center_px) && j.radius_px > 0) return { edge: { x: j.center_px[0], y: j.center_px[1], radius: j.radius_px } };
  return ofActivity(j);
}

/** The output of `faba activity --json`, whose directions are clockwise, for a video or the first one; null for another object. */
export function ofActivity(j: any, file?: string): VideoOverlays | null {
  const a = Array.isArray(j?.videos) ? j.videos.find((v: any) => file === undefined || v.video === file || v.video === `./${file}`) : undefined;
  if (!a || !Array.isArray(a.segments)) return null;
  const segments = a.segments.map((s: any) => ({ from_s: s.t0_s, to_s: s.t1_s, direction_deg: flipped(s.direction_deg) }));
  return { segments, reversal_s: a.response?.reversal_s ?? null };
}

function fromCsv(text: string): VideoOverlays | null {
  const lines = text.trim().split(/\r?\n/), names = lines[0].split(',');
  const rows = lines.slice(1).map((l) => l.split(','));
  const column = (name: string) => {
    const i = names.indexOf(name);
    return i < 0 ? null : rows.map((r) => (r[i] === '' || r[i] === undefined ? NaN : Number(r[i])));
  };
  const t = column('t_s'), x = column('x_px'), y = column('y_px'), track = column('track');
  if (t && x && y && track) return { tracks: tracksOf(track, t, x, y) };
  const [xx, xy, yy] = ['var_xx_px2', 'var_xy_px2', 'var_yy_px2'].map(column);
  if (t && x && y && xx && xy && yy) return { swarm: swarmOf(t, x, y, xx, xy, yy) };
  const from = column('t0_s'), to = column('t1_s'), activity = column('activity'), video = column('video');
  if (from && to && activity) {
    const first = from.map((_, k) => k).filter((k) => !video || video[k] === video[0]); // of several videos
    return { activity: { t_s: first.map((k) => (from[k] + to[k]) / 2), value: first.map((k) => activity[k]) } };
  }
  return t ? swarmOfSeries(t, column) : null;
}

function tracksOf(id: number[], t: number[], x: number[], y: number[]): Track[] {
  const all = new Map<number, number[]>();
  id.forEach((n, k) => (all.get(n) ?? all.set(n, []).get(n)!).push(k));
  return [...all.values()].map((rows) => {
    rows.sort((a, b) => t[a] - t[b]);
    return { t_s: rows.map((k) => t[k]), x: rows.map((k) => x[k]), y: rows.map((k) => y[k]) };
  });
}
function swarmOf(t: number[], x: number[], y: number[], xx: number[], xy: number[], yy: number[]): SwarmRow[] {
  return t.map((t_s, k) => ({ t_s, x: x[k], y: y[k], xx: xx[k], xy: xy[k], yy: yy[k] })).filter((r) => Object.values(r).every(Number.isFinite));
}
/** The series of a run has the standard deviations along the axes of the picture. */
function swarmOfSeries(t: number[], column: (name: string) => number[] | null): VideoOverlays | null {
  for (const prefix of ['true_', 'estimated_', '']) {
    const [x, y, sx, sy] = ['centroid_x_px', 'centroid_y_px', 'sigma_x_px', 'sigma_y_px'].map((c) => column(prefix + c));
    if (!x || !y || !sx || !sy) continue;
    const xy = column(`${prefix}covariance_px2`) ?? t.map(() => 0);
    const swarm = swarmOf(t, x, y, sx.map((s) => s * s), xy, sy.map((s) => s * s));
    if (swarm.length) return { swarm };
  }
  return null;
}

/** Index of the last time that is not after `t`; -1: all are later. */
export function lastNotAfter(times: ArrayLike<number>, t: number): number {
  let low = 0, high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] <= t + 1e-6) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}
/** The item of the frame at `t`: the last one that is not after it, if it is not older than `oldest` s. */
export function itemAt<T extends { t_s: number }>(items: T[], t: number, oldest: number): T | null {
  let low = 0, high = items.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (items[middle].t_s <= t + 1e-6) low = middle + 1;
    else high = middle;
  }
  const found = items[low - 1];
  return found && t - found.t_s <= oldest + 1e-6 ? found : null;
}

/** Half axes and direction of the ellipse of one standard deviation. */
export function ellipseOf(r: Pick<SwarmRow, 'xx' | 'xy' | 'yy'>): { major: number; minor: number; angle: number } {
  const mean = (r.xx + r.yy) / 2, d = Math.hypot((r.xx - r.yy) / 2, r.xy);
  return { major: Math.sqrt(Math.max(0, mean + d)), minor: Math.sqrt(Math.max(0, mean - d)), angle: 0.5 * Math.atan2(2 * r.xy, r.xx - r.yy) };
}
