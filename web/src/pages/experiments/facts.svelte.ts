// What the files of videos state, read once for each file.

import { get, RequestError } from '../../connection';
import type { VideoAbout } from '../../video/pictures';

export type VideoFacts = Pick<VideoAbout, 'width' | 'height' | 'fps' | 'length_s' | 'um_per_px'> & {
  /** Time of the file, s since 1970. */
  modified_s: number;
  /** Why the file cannot be read. */
  trouble?: string;
};

export class Facts {
  all = $state<Record<string, VideoFacts>>({});
  private asked = new Set<string>();

  async read(file: string) {
    if (this.asked.has(file)) return;
    this.asked.add(file);
    try {
      this.all[file] = await get<VideoFacts>(`/api/videos/about?file=${encodeURIComponent(file)}`);
    } catch (e) {
      const none = { width: 0, height: 0, fps: 0, length_s: 0, um_per_px: null, modified_s: 0 };
      this.all[file] = { ...none, trouble: e instanceof RequestError ? e.what : String(e) };
    }
  }
}
