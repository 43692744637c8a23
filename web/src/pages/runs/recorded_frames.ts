// The frames of a recorded run, fetched in batches.

import { RequestError } from '../../connection';
import { decodeFrame, type Frame } from '../../frame';
import type { Scene } from '../../view/overlay';
import { runFile } from './run_list';

/** GET /api/runs/NAME/about. */
export interface About {
  scene: Scene;
  populations: { begin: number; end: number }[];
  frames: number;
  rate: number;
  /** Time of the first frame, s. */
  from_s: number;
}

const kBatch = 32; // frames per request
const kKept = 24; // batches

export class RecordedFrames {
  private known = new Map<number, Promise<Frame[]>>();
  constructor(private name: string) {}

  async at(index: number): Promise<Frame | undefined> {
    return (await this.batch(Math.floor(index / kBatch)))[index % kBatch];
  }
  private batch(k: number): Promise<Frame[]> {
    let frames = this.known.get(k);
    if (!frames) {
      frames = this.fetch(k);
      frames.catch(() => this.known.delete(k)); // asks again
      this.known.set(k, frames);
      if (this.known.size > kKept) this.known.delete(this.known.keys().next().value!);
    }
    return frames;
  }
  private async fetch(k: number): Promise<Frame[]> {
    const r = await fetch(runFile(this.name, `frames?from=${k * kBatch}&count=${kBatch}`)).catch(() => {
      throw new RequestError('', 'The server does not answer.', 'no_answer');
    });
    if (!r.ok) throw new RequestError(this.name, (await r.json().catch(() => null))?.what ?? r.statusText);
    const all = await r.arrayBuffer(), view = new DataView(all), out: Frame[] = [];
    for (let p = 0; p < all.byteLength; ) {
      const length = view.getUint32(p, true);
      out.push(decodeFrame(all.slice(p + 4, p + 4 + length), 1));
      p += 4 + length;
    }
    return out;
  }
}
