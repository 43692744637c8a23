// The part of a live run that is being marked for a recording, or that will be saved.

/** Marked frames of a run; `last` is null while they are being marked. */
export interface Marking {
  run: number;
  seed: number;
  first: number;
  last: number | null;
}
/** A part before it is saved, s: up to `most`, the end of the run or of the marked part. */
export interface Part {
  from: number;
  to: number;
  most: number;
  /** The end of the range is the present, which moves on until the part is saved. */
  open: boolean;
}

/** The marking if it belongs to this run, which is at frame `now`: another run or another server starts from the beginning. */
export function validMarking(m: Marking | null, run: number, seed: number, now: number): Marking | null {
  return m && m.run === run && m.seed === seed && m.first <= now ? m : null;
}
export const elapsed = (m: Marking, now: number, rate: number) => (now - m.first) / rate;

/** A marked part: with its last frame. */
export function partOf(first: number, last: number, rate: number): Part {
  const to = (last + 1) / rate;
  return { from: first / rate, to, most: to, open: false };
}
/** From the beginning to the present frame. */
export function completeRun(now: number, rate: number): Part {
  const to = (now + 1) / rate;
  return { from: 0, to, most: to, open: true };
}
/** The values of the request `save`; without them the recording is complete. */
export function asked(p: Part): { from?: number; to?: number } {
  return { ...(p.from > 0 ? { from: p.from } : {}), ...(p.open && p.to >= p.most ? {} : { to: p.to }) };
}
