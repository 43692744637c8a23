// Frames of a video from the server, and those kept on the page. web/protocol.md has the format.

import { get, RequestError } from '../connection';
import type { Contrast, Histogram } from './contrast';
import type { FlowField } from './overlays';

export interface VideoAbout {
  width: number;
  height: number;
  bits: number;
  /** 0: the times are numbers of frames. */
  fps: number;
  /** According to the file header, 0: not stated; later those of VideoEnd. */
  frames: number;
  length_s: number;
  /** Grey values that are displayed black and white, unless the user changes the contrast. */
  low: number;
  high: number;
  um_per_px: number | null;
  um_per_px_source: string;
  note: string;
  damage: string;
  /** Time of the file, s since 1970. */
  modified_s: number;
}
/** What is known when the last frame was found. */
export type VideoEnd = Pick<VideoAbout, 'frames' | 'length_s' | 'damage'>;

/** A frame in 8 bits, averaged over squares of width / `width` px. */
export interface Picture {
  t: number;
  index: number;
  width: number;
  height: number;
  px: Uint8Array;
  /** Time of the next frame; undefined: not known. */
  until?: number;
}
export interface Look extends Contrast {
  /** px, maximum. */
  width: number;
}

const kHeader = 16; // bytes of a frame before its pixels
const kKept = 96 << 20; // bytes of pictures on the page

/** Frames of one response, in order; each but the last knows the time of the next. */
export function decodePictures(bytes: ArrayBuffer): Picture[] {
  const view = new DataView(bytes), out: Picture[] = [];
  for (let at = 0; at + 4 + kHeader <= bytes.byteLength; ) {
    const length = view.getUint32(at, true), t = view.getFloat64(at + 4, true);
    const width = view.getUint16(at + 16, true), height = view.getUint16(at + 18, true);
    if (out.length) out[out.length - 1].until = t;
    out.push({ t, index: view.getUint32(at + 12, true), width, height, px: new Uint8Array(bytes, at + 4 + kHeader, width * height) });
    at += 4 + length;
  }
  return out;
}

const query = (values: Record<string, string | number>) => new URLSearchParams(Object.entries(values).map(([k, v]) => [k, String(v)])).toString();
export const thumbnailUrl = (file: string) => `/api/videos/thumbnail.png?${query({ file })}`;
export const fetchAbout = (file: string) => get<VideoAbout>(`/api/videos/about?${query({ file })}`);
export const fetchEnd = (file: string) => get<VideoEnd>(`/api/videos/end?${query({ file })}`);
export const fetchHistogram = (file: string, t: number) => get<Histogram>(`/api/videos/histogram?${query({ file, t })}`);

export const fetchFlow = (file: string, t: number) => get<FlowField>(`/api/videos/flow?${query({ file, t })}`);
/** The drop in a frame; `found` is false without an edge. */
export const fetchEdge = (file: string, t: number) => get<{ found: boolean; reason?: string; center_px: [number, number]; radius_px: number }>(`/api/videos/edge?${query({ file, t })}`);

export async function fetchPictures(file: string, from: number, count: number, look: Look, signal?: AbortSignal): Promise<Picture[]> {
  const r = await fetch(`/api/videos/frames?${query({ file, from, count, ...look })}`, { signal }).catch((e) => {
    if (signal?.aborted) throw e;
    throw new RequestError('', 'The server does not answer.', 'no_answer');
  });
  if (r.ok) return decodePictures(await r.arrayBuffer());
  const j = await r.json().catch(() => null);
  throw new RequestError(j?.where ?? '', j?.what ?? r.statusText);
}

/** The pictures that are kept, up to a number of bytes; those used last stay. */
export class PictureStore {
  private all = new Map<number, Picture>(); // by time; the one used last is the last
  private bytes = 0;

  constructor(private most = kKept) {}
  clear() {
    this.all.clear();
    this.bytes = 0;
  }
  add(pictures: Picture[]) {
    for (const p of pictures) {
      const old = this.all.get(p.t);
      if (old) this.remove(old);
      this.all.set(p.t, { ...p, until: p.until ?? old?.until });
      this.bytes += p.px.length;
    }
    for (const p of this.all.values()) {
      if (this.bytes <= this.most || this.all.size <= 2) break;
      this.remove(p);
    }
  }
  /** The picture that is displayed at `t`, if it is known. */
  at(t: number): Picture | undefined {
    for (const p of this.all.values()) {
      if (t < p.t - 1e-6 || (p.until === undefined ? t > p.t + 1e-6 : t >= p.until - 1e-6)) continue;
      this.all.delete(p.t); // to the end
      this.all.set(p.t, p);
      return p;
    }
    return undefined;
  }
  /** The end of the known pictures that follow each other from `t`: the time of the last one; undefined if `t` is not known. */
  knownUntil(t: number): Picture | undefined {
    let p = this.at(t);
    for (let next = p; next; next = p?.until === undefined ? undefined : this.all.get(p.until)) p = next;
    return p;
  }
  private remove(p: Picture) {
    this.all.delete(p.t);
    this.bytes -= p.px.length;
  }
}
