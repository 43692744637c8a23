// What the files of videos and pictures state, read once for each file.

import { RequestError } from '../connection';
import { fetchAbout, type VideoAbout } from './pictures';

export class Facts {
  all = $state<Record<string, VideoAbout>>({});
  /** Why a file cannot be read. */
  trouble = $state<Record<string, string>>({});
  private asked = new Set<string>();

  async read(file: string) {
    if (this.asked.has(file)) return;
    this.asked.add(file);
    try {
      this.all[file] = await fetchAbout(file);
    } catch (e) {
      this.trouble[file] = e instanceof RequestError ? e.what : String(e);
    }
  }
}

/** Size and length of a video as text: "640 × 480 px, 15 Hz, 3 s". */
export function factsText(f: Pick<VideoAbout, 'width' | 'height' | 'fps' | 'frames' | 'length_s'>): string {
  const parts = [`${f.width} × ${f.height} px`];
  if (f.frames > 1 && f.fps > 0) parts.push(`${Number(f.fps.toPrecision(3))} Hz`, `${Number(f.length_s.toPrecision(3))} s`);
  return parts.join(', ');
}
