// The set-up that the user works on: kept in the tab, so that a reload continues where it was.

import { post, upload } from '../connection';
import { kNew, withPicture, type Detection, type Own } from './own';

const kKey = 'faba.own';

function stored(): Own {
  try {
    return { ...kNew, ...JSON.parse(sessionStorage.getItem(kKey) ?? '{}') };
  } catch {
    return kNew; // storage is disabled, or has invalid data
  }
}

export class OwnDraft {
  own = $state.raw<Own>(stored());
  /** The edge of a drop is being detected. */
  looking = $state(false);
  /** The error of the last picture. */
  trouble = $state.raw<unknown>(null);
  private asked = 0;

  set(change: Partial<Own>) {
    this.own = { ...this.own, ...change };
    try {
      sessionStorage.setItem(kKey, JSON.stringify(this.own));
    } catch {
      // storage is disabled or full: a reload starts again
    }
  }
  takeFile(file: File) {
    return this.take(() => upload<Detection>(`/api/upload?name=${encodeURIComponent(file.name)}`, file));
  }
  takeNamed(file: string) {
    return this.take(() => post<Detection>('/api/pictures/detect', { file }));
  }
  /** The lab does not have the picture any more. */
  forget() {
    this.set({ ...kNew });
  }
  // The previous picture is removed at once: it must not be mistaken for the new one, also if that cannot be read.
  private async take(ask: () => Promise<Detection>) {
    const mine = ++this.asked;
    this.set({ step: 0, detection: null, edge: null, circle: null, scale: null, ruler: null });
    this.looking = true;
    this.trouble = null;
    try {
      const detection = await ask();
      if (mine === this.asked) this.set(withPicture(this.own, detection));
    } catch (e) {
      if (mine === this.asked) this.trouble = e;
    }
    if (mine === this.asked) this.looking = false;
  }
  /** The picture as a file of the workspace; copies an uploaded one there. */
  async keep(): Promise<string> {
    const d = this.own.detection!;
    if (d.file) return d.file;
    const { file } = await post<{ file: string }>('/api/pictures/keep', { upload: d.upload, name: d.picture });
    this.set({ detection: { ...d, file } });
    return file;
  }
}
