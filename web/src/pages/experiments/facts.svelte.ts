// What the files of videos state, read once for each file.

import { get, RequestError } from '../../connection';

export interface VideoFacts {
  width: number;
  height: number;
  rate_hz: number | null;
  length_s: number | null;
  frames: number | null;
  /** Unix time of the file, s. */
  modified_s: number;
  bytes: number;
  um_per_px: number | null;
  /** Why the file cannot be read. */
  trouble?: string;
}

export class Facts {
  all = $state<Record<string, VideoFacts>>({});
  private asked = new Set<string>();

  async read(file: string) {
    if (this.asked.has(file)) return;
    this.asked.add(file);
    try {
      this.all[file] = await get<VideoFacts>(`/api/videos/about?file=${encodeURIComponent(file)}`);
    } catch (e) {
      const none = { width: 0, height: 0, rate_hz: null, length_s: null, frames: null, modified_s: 0, bytes: 0, um_per_px: null };
      this.all[file] = { ...none, trouble: e instanceof RequestError ? e.what : String(e) };
    }
  }
}
