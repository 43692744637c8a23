// The time of a replay: one time for the picture, the slider and the cursor of all plots.

export const kSpeeds = [0.1, 0.25, 0.5, 1, 2, 4, 8];

export class ReplayClock {
  /** Simulated time, s, from `from` to `to`. */
  t = $state(0);
  playing = $state(false);
  speed = $state(1);
  loop = $state(false);
  from = $state(0);
  to = $state(0);
  /** Recorded frames per second. */
  rate = $state(1);

  begin(from: number, frames: number, rate: number) {
    this.from = this.t = from;
    this.rate = rate;
    this.to = from + Math.max(0, frames - 1) / rate;
    this.playing = frames > 1;
  }
  /** Index of the displayed frame. */
  get frame(): number {
    return Math.floor((this.t - this.from) * this.rate + 1e-6);
  }
  seek(t: number) {
    this.t = Math.min(this.to, Math.max(this.from, t));
  }
  /** Goes to another frame and pauses. */
  step(frames: number) {
    this.playing = false;
    this.seek(this.from + (this.frame + frames) / this.rate);
  }
  toggle() {
    if (!this.playing && this.t >= this.to) this.t = this.from;
    this.playing = !this.playing;
  }
  faster(by: 1 | -1) {
    const k = kSpeeds.indexOf(this.speed) + by;
    if (k >= 0 && k < kSpeeds.length) this.speed = kSpeeds[k];
  }
  /** `seconds` of wall-clock time have passed. */
  advance(seconds: number) {
    if (!this.playing) return;
    const next = this.t + seconds * this.speed, length = this.to - this.from;
    if (next < this.to) this.t = next;
    else if (this.loop && length > 0) this.t = this.from + ((next - this.from) % length);
    else {
      this.t = this.to;
      this.playing = false;
    }
  }
  /** Returns whether the key has an action. */
  key(key: string): boolean {
    const does: Record<string, () => void> = {
      ' ': () => this.toggle(),
      ArrowRight: () => this.step(1),
      ArrowLeft: () => this.step(-1),
      '.': () => this.step(1),
      ',': () => this.step(-1),
      Home: () => this.seek(this.from),
      End: () => this.seek(this.to),
      l: () => (this.loop = !this.loop),
      '+': () => this.faster(1),
      '-': () => this.faster(-1),
    };
    if (!Object.hasOwn(does, key)) return false;
    does[key]();
    return true;
  }
}
