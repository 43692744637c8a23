// Uploads of videos into an experiment, in parts: an interrupted one continues where it stopped when the same file is chosen
// again.

import { get, remove } from '../../connection';

const kPart = 2 << 20; // bytes
const kPause = 1500; // ms before the next attempt without a connection

export interface Upload {
  name: string;
  size: number;
  received: number;
  state: 'waiting' | 'running' | 'interrupted' | 'done' | 'failed';
  what: string;
}

export class Uploads {
  list = $state<Upload[]>([]);
  private queue: { upload: Upload; file: File; drop: string }[] = [];
  private working = false;
  private cancelled = new Set<Upload>();

  constructor(private experiment: string) {}

  private get path() {
    return `/api/experiments/${encodeURIComponent(this.experiment)}/imports`;
  }
  /** Incomplete uploads of before: they continue when their file is chosen again. */
  async load() {
    const left = await get<{ name: string; size: number; received: number }[]>(this.path);
    this.list = left.map((one) => ({ ...one, state: 'interrupted', what: '' }));
  }
  add(file: File, drop: string) {
    this.list = this.list.filter((u) => u.size !== file.size || u.state !== 'interrupted');
    this.list.push({ name: file.name, size: file.size, received: 0, state: 'waiting', what: '' });
    this.queue.push({ upload: this.list.at(-1)!, file, drop });
    void this.work();
  }
  private async work() {
    if (this.working) return;
    this.working = true;
    for (let next = this.queue.shift(); next; next = this.queue.shift())
      if (!this.cancelled.has(next.upload)) await this.send(next.upload, next.file, next.drop);
    this.working = false;
  }
  private async send(upload: Upload, file: File, drop: string) {
    const about = new URLSearchParams({ name: file.name, size: String(file.size) });
    upload.state = 'running';
    try {
      upload.received = (await get<{ received: number }>(`${this.path}?${about}`)).received;
      const more = new URLSearchParams({ modified: String(Math.round(file.lastModified / 1000)), drop });
      do {
        if (this.cancelled.has(upload)) return;
        const part = file.slice(upload.received, upload.received + kPart);
        const address = `${this.path}?${about}&${more}&offset=${upload.received}`;
        const answer = await fetch(address, { method: 'POST', headers: { 'Content-Type': 'application/octet-stream' }, body: part }).catch(() => null);
        if (!answer) {
          await new Promise((go) => setTimeout(go, kPause));
          continue;
        }
        const j = await answer.json();
        if (!answer.ok) throw new Error(j.what);
        upload.received = j.received;
      } while (upload.received < file.size);
      upload.state = 'done';
      this.list = this.list.filter((u) => u !== upload);
    } catch (e) {
      upload.state = 'failed';
      upload.what = (e as Error).message;
    }
  }
  async cancel(upload: Upload) {
    this.cancelled.add(upload);
    this.list = this.list.filter((u) => u !== upload);
    const about = new URLSearchParams({ name: upload.name, size: String(upload.size) });
    await remove(`${this.path}?${about}`).catch(() => null); // nothing was received yet
  }
}
