// The position in a video, playing, and the picture that is displayed.

import type { Contrast } from './contrast';
import { fetchAbout, fetchEnd, fetchPictures, PictureStore, type Look, type Picture, type VideoAbout } from './pictures';

export const kSpeeds = [0.1, 0.25, 0.5, 1, 2, 4, 8, 16];
const kUntimed = 10; // frames per second, for videos without a frame rate
const kAhead = 1.5; // s of playing that are fetched ahead
const kBatch = 24; // frames per request while playing

export class Player {
  about = $state.raw<VideoAbout | null>(null);
  /** Position, s (or frames, without a frame rate). */
  t = $state(0);
  playing = $state(false);
  speed = $state(1);
  picture = $state.raw<Picture | null>(null);
  contrast = $state.raw<Contrast>({ low: 0, high: 255 });
  trouble = $state.raw<unknown>(null);
  /** Whether the displayed picture is not yet that of `t`. */
  waiting = $state(false);
  private store = new PictureStore();
  private width = 0;
  private busy = false;
  private ahead = false;
  private closed = false;
  private snap = false; // to the time of the picture, once it is there
  private timer = 0;

  constructor(readonly file: string) {
    void this.open();
  }
  /** Frames per second, or frames per unit of the time axis. */
  get rate() {
    return this.about?.fps || 1;
  }
  get length() {
    return this.about?.length_s || 1 / this.rate;
  }
  /** Time of the last frame. */
  get last() {
    return Math.max(0, this.length - 1 / this.rate);
  }

  private async open() {
    try {
      const first = await fetchAbout(this.file);
      this.about = first;
      this.contrast = { low: first.low, high: first.high };
      this.refresh();
      // It may take a while for a file without an index.
      const end = await fetchEnd(this.file);
      this.about = { ...first, ...end };
    } catch (e) {
      this.trouble = e;
    }
  }
  close() {
    this.closed = true;
    this.playing = false;
    cancelAnimationFrame(this.timer);
  }
  private look(): Look {
    return { width: this.width, ...this.contrast };
  }
  /** Pictures of another width, px, are fetched. */
  setWidth(width: number) {
    if (width === this.width) return;
    this.width = width;
    this.refresh();
  }
  setContrast(c: Contrast) {
    this.contrast = c;
    this.refresh();
  }
  private refresh() {
    this.store.clear();
    this.show();
  }

  go(t: number) {
    this.playing = false;
    this.snap = false;
    this.t = Math.min(Math.max(0, t), this.last);
    this.show();
  }
  /** Goes forwards or backwards by frames of the video. */
  step(frames: number) {
    const p = this.picture;
    if (!p || this.waiting) return this.go(this.t + frames / this.rate);
    if (frames === 1) this.go(p.until ?? p.t + 1 / this.rate);
    else if (frames === -1) this.go(p.t - Math.min(1e-3, 0.01 / this.rate)); // the last frame before this one
    else this.go(p.t + frames / this.rate);
    this.snap = true;
    if (!this.waiting) this.show();
  }

  /** Displays the picture at `t`: at once if it is known, otherwise as soon as it is there. One request at a time. */
  private show() {
    if (!this.about || !this.width || this.closed) return;
    const known = this.store.at(this.t);
    if (known) this.picture = known;
    if (known && this.snap) this.t = known.t;
    this.waiting = !known;
    if (known || this.busy) return;
    this.busy = true;
    const width = this.width, contrast = this.contrast;
    void fetchPictures(this.file, this.t, 2, this.look())
      .then(
        (pictures) => {
          this.trouble = null;
          if (width !== this.width || contrast !== this.contrast) return true;
          this.keep(pictures);
          if (!this.store.at(this.t)) this.picture = pictures[0] ?? this.picture; // on the way
          return true;
        },
        (e) => ((this.trouble = e), (this.playing = this.waiting = false)),
      )
      .then((more) => {
        this.busy = false;
        if (more) this.show();
      });
  }
  private keep(pictures: Picture[]) {
    const end = pictures.at(-1);
    // A response with one frame is the last frame, which is displayed to the end.
    if (pictures.length === 1 && end) end.until = Math.max(this.length, end.t + 1 / this.rate) + 1;
    this.store.add(pictures);
  }

  toggle() {
    if (this.playing) this.playing = false;
    else this.play();
  }
  private play() {
    if (!this.about || this.trouble) return;
    if (this.t >= this.last - 0.5 / this.rate) this.t = 0;
    this.playing = true;
    this.snap = false;
    let before = performance.now();
    const again = (now: number) => {
      if (!this.playing || this.closed) return;
      const pace = this.about!.fps > 0 ? this.speed : this.speed * kUntimed;
      const t = Math.min(this.last, this.t + (Math.min(now - before, 250) / 1000) * pace);
      before = now;
      const known = this.store.at(t);
      if (known) {
        this.t = t;
        this.waiting = false;
        this.picture = known;
      } else {
        this.waiting = true; // the clock waits for the pictures
      }
      this.fetchAhead(known ? t : this.t, pace);
      if (t >= this.last && known) this.playing = false;
      else this.timer = requestAnimationFrame(again);
    };
    this.timer = requestAnimationFrame(again);
  }
  private fetchAhead(t: number, pace: number) {
    if (this.ahead) return;
    const known = this.store.knownUntil(t);
    if (known && (known.until ?? known.t) - t > kAhead * pace && known.until !== undefined) return;
    if (known && known.t >= this.last - 0.5 / this.rate) return;
    this.ahead = true;
    const width = this.width, contrast = this.contrast;
    void fetchPictures(this.file, known?.t ?? t, kBatch, this.look())
      .then(
        (pictures) => width === this.width && contrast === this.contrast && this.keep(pictures),
        (e) => ((this.trouble = e), (this.playing = this.waiting = false)),
      )
      .then(() => (this.ahead = false));
  }
}
