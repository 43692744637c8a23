// What a user marks in a video. Times are in s, places in px of the picture (y down), directions in degrees counter-clockwise
// from the right (angles.ts).

export interface Segment {
  from_s: number;
  to_s: number;
  /** Direction of the field or of the motion; null: not known. */
  direction_deg: number | null;
}
export interface Region {
  x: number;
  y: number;
  width: number;
  height: number;
}
export type Point = [number, number];

export interface VideoMarks {
  /** Time of the field reversal; null: not marked. */
  reversal_s: number | null;
  /** In order, without overlap. */
  segments: Segment[];
  /** Region of interest; null: the complete picture. */
  roi: Region | null;
  /** Polygons that are left out. */
  masks: Point[][];
}
export const noMarks = (): VideoMarks => ({ reversal_s: null, segments: [], roi: null, masks: [] });

const kShortest = 1e-3; // s, of a segment

/** The segments in order; a later one in the list is cut where it overlaps an earlier one in time. */
export function ordered(segments: Segment[]): Segment[] {
  const out: Segment[] = [];
  for (const s of [...segments].sort((a, b) => a.from_s - b.from_s)) {
    const from = Math.max(s.from_s, out.at(-1)?.to_s ?? 0);
    if (s.to_s - from >= kShortest) out.push(from === s.from_s ? s : { ...s, from_s: from });
  }
  return out;
}
/** With a segment between two times in any order; it is cut at the present ones. Unchanged if there is no room. */
export function withSegment(segments: Segment[], a: number, b: number, length: number, direction_deg: number | null): Segment[] {
  let from = Math.max(0, Math.min(a, b)), to = Math.min(length, Math.max(a, b));
  for (const s of segments) {
    if (from >= s.from_s && from < s.to_s) from = s.to_s;
    else if (from < s.from_s) to = Math.min(to, s.from_s);
  }
  return to - from < kShortest ? segments : ordered([...segments, { from_s: from, to_s: to, direction_deg }]);
}
/** With another start or end of a segment, which does not pass its neighbours. */
export function withEdge(segments: Segment[], i: number, edge: 'from_s' | 'to_s', t: number, length: number): Segment[] {
  const least = edge === 'from_s' ? (segments[i - 1]?.to_s ?? 0) : segments[i].from_s + kShortest;
  const most = edge === 'from_s' ? segments[i].to_s - kShortest : (segments[i + 1]?.from_s ?? length);
  return segments.map((s, k) => (k === i ? { ...s, [edge]: Math.min(Math.max(t, least), most) } : s));
}
/** Index of the segment that contains `t`; -1: none. */
export const segmentAt = (segments: Segment[], t: number) => segments.findIndex((s) => t >= s.from_s && t < s.to_s);

/** The rectangle between two corners in whole pixels, inside the picture; null if it is empty. */
export function regionBetween(a: Point, b: Point, size: Point): Region | null {
  const inside = (v: number, most: number) => Math.min(Math.max(Math.round(v), 0), most);
  const x0 = inside(Math.min(a[0], b[0]), size[0]), x1 = inside(Math.max(a[0], b[0]), size[0]);
  const y0 = inside(Math.min(a[1], b[1]), size[1]), y1 = inside(Math.max(a[1], b[1]), size[1]);
  return x1 - x0 < 2 || y1 - y0 < 2 ? null : { x: x0, y: y0, width: x1 - x0, height: y1 - y0 };
}
/** "10,20 30,40 50,20" as points; null unless there are at least three. */
export function polygonOf(text: string): Point[] | null {
  const points = text.trim().split(/[\s;]+/).map((pair) => pair.split(',').map(Number));
  const valid = points.length > 2 && points.every((p) => p.length === 2 && p.every(Number.isFinite));
  return valid ? (points as Point[]) : null;
}
export const polygonText = (points: Point[]) => points.map((p) => p.map(Math.round).join(',')).join(' ');

/** Marks that were stored; parts that are not valid are left out. */
export function readMarks(stored: unknown): VideoMarks {
  const m = (stored ?? {}) as Partial<VideoMarks>, marks = noMarks();
  if (Number.isFinite(m.reversal_s)) marks.reversal_s = m.reversal_s!;
  const whole = (s: Segment) => Number.isFinite(s?.from_s) && Number.isFinite(s?.to_s) && s.to_s > s.from_s;
  if (Array.isArray(m.segments)) marks.segments = ordered(m.segments.filter(whole).map((s) => ({ from_s: s.from_s, to_s: s.to_s, direction_deg: Number.isFinite(s.direction_deg) ? s.direction_deg : null })));
  const r = m.roi;
  if (r && [r.x, r.y, r.width, r.height].every(Number.isFinite)) marks.roi = { x: r.x, y: r.y, width: r.width, height: r.height };
  if (Array.isArray(m.masks)) marks.masks = m.masks.filter((p) => Array.isArray(p) && polygonOf(p.map(String).join(' ')));
  return marks;
}

/** Length of a ruler: px, and um if the scale is known. */
export function rulerLength(a: Point, b: Point, um_per_px: number | null): { px: number; um: number | null } {
  const px = Math.hypot(b[0] - a[0], b[1] - a[1]);
  return { px, um: um_per_px ? px * um_per_px : null };
}
