// The marks of a video that belongs to an experiment: what the experiment states, and what is marked in the viewer and not saved.

import { degrees } from '../../form/schema';
import { ordered, type Segment, type VideoMarks } from '../../video/marks';
import { seconds, type FieldSegment, type Scale, type Video } from './experiment';

/** The marks that an experiment states. */
export type StatedMarks = Pick<VideoMarks, 'reversal_s' | 'segments'>;

export function statedMarks(v: Video): StatedMarks {
  const segments = (v.segment ?? []).map((s): Segment => ({ from_s: seconds(s.from) ?? 0, to_s: seconds(s.to) ?? 0, direction_deg: rounded(degrees(s.direction), 1) }));
  return { reversal_s: seconds(v.reversal) ?? null, segments: ordered(segments) };
}
const rounded = (v: number | undefined, digits: number) => (v === undefined ? null : Number(v.toFixed(digits)));

// Times are saved in ms, directions in tenths of a degree.
const kSameTime = 6e-4, kSameDirection = 0.06;
const near = (a: number | null, b: number | null, most: number) => a === b || (a !== null && b !== null && Math.abs(a - b) < most);
export const sameReversal = (a: StatedMarks, b: StatedMarks) => near(a.reversal_s, b.reversal_s, kSameTime);
export const sameSegments = (a: StatedMarks, b: StatedMarks) =>
  a.segments.length === b.segments.length &&
  a.segments.every((s, i) => near(s.from_s, b.segments[i].from_s, kSameTime) && near(s.to_s, b.segments[i].to_s, kSameTime) && near(s.direction_deg, b.segments[i].direction_deg, kSameDirection));

/**
 * The marks after the experiment states `now` in place of `before`: those that agreed with it follow, others are kept, because they
 * were changed by hand and are not saved.
 */
export function followed(marks: VideoMarks, before: StatedMarks, now: StatedMarks): VideoMarks {
  const reversal_s = sameReversal(marks, before) ? now.reversal_s : marks.reversal_s;
  return { ...marks, reversal_s, segments: sameSegments(marks, before) ? now.segments : marks.segments };
}

const time = (s: number) => `${Number(s.toFixed(3))} s`;
/** Values of an experiment file; undefined removes. */
export const reversalValue = (m: StatedMarks) => (m.reversal_s === null ? undefined : time(m.reversal_s));
export const segmentValues = (m: StatedMarks): FieldSegment[] | undefined =>
  m.segments.length
    ? m.segments.map((s) => ({ from: time(s.from_s), to: time(s.to_s), ...(s.direction_deg === null ? {} : { direction: `${Number(s.direction_deg.toFixed(1))} deg` }) }))
    : undefined;

/** The scale from a line of `px` pixels over a length of `um`, each end of which is placed with a standard deviation of `end_px`. */
export function rulerScale(px: number, um: number, end_px: number): Scale | null {
  if (!(px > 1 && um > 0 && end_px >= 0)) return null;
  const um_per_px = um / px, digits = (v: number) => Number(v.toPrecision(6));
  const error = (um_per_px * Math.SQRT2 * end_px) / px;
  return { um_per_px: digits(um_per_px), um_per_px_se: error > 0 ? Number(error.toPrecision(3)) : undefined, um_per_px_source: 'ruler' };
}
