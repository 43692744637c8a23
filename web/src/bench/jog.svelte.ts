// Jogging: currents set by hand. The page sends them several times a second, which is also its heartbeat; the server switches the
// coils off without it. The page stops sending when it is hidden or left.

import { failure } from '../text';
import type { CoilState, GuardState } from './state';

export const kBeat = 150; // ms

interface Started {
  session: string;
  max_a: number[];
  deadline_s: number;
}
interface Answer {
  coils: CoilState[];
  guard: GuardState | null;
}
type Ask = <T>(what: string, body: Record<string, unknown>) => Promise<T>;

export class JogSession {
  state = $state<'idle' | 'live' | 'tripped' | 'ended'>('idle');
  /** A, one per coil. */
  wanted = $state.raw<number[]>([]);
  max = $state.raw<number[]>([]);
  coils = $state.raw<CoilState[]>([]);
  guard = $state.raw<GuardState | null>(null);
  /** Why the session ended without a request of the user. */
  trouble = $state.raw<ReturnType<typeof failure> | null>(null);
  private session = '';
  private number = 0;
  private sending = false;
  private again = false;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(private ask: Ask) {}

  get isOn() {
    return this.state === 'live' || this.state === 'tripped';
  }
  async start(page: number, permit: string) {
    const s = await this.ask<Started>('jog', { page, permit });
    this.session = s.session;
    this.max = s.max_a;
    this.wanted = s.max_a.map(() => 0);
    this.coils = [];
    this.guard = null;
    this.trouble = null;
    this.number = 0;
    this.state = 'live';
    void this.beat();
  }
  /** A current within the limits of the coil; sent at once. */
  set(coil: number, amperes: number) {
    if (this.state !== 'live' || !Number.isFinite(amperes)) return;
    const most = this.max[coil] ?? 0, current = Math.min(most, Math.max(-most, amperes));
    this.wanted = this.wanted.map((a, k) => (k === coil ? Number(current.toFixed(6)) : a));
    void this.beat();
  }
  step(coil: number, amperes: number) {
    this.set(coil, (this.wanted[coil] ?? 0) + amperes);
  }
  zero() {
    this.wanted = this.wanted.map(() => 0);
    if (this.isOn) void this.beat();
  }
  /** Ends the session: the server switches the coils off. */
  async stop() {
    if (!this.isOn) return;
    this.end();
    await this.ask('stop', {}).catch(() => {}); // without heartbeats the coils are switched off as well
  }
  /** The page is hidden or left: no more messages, and the coils off. */
  cut() {
    if (!this.isOn) return;
    this.end();
    void this.ask('off', {}).catch(() => {});
  }
  /** Resets a fault of the guard and arms again. */
  async reset(page: number, permit: string) {
    this.wanted = this.wanted.map(() => 0);
    await this.ask('jog/reset', { session: this.session, page, permit });
    if (this.state === 'tripped') this.state = 'live';
  }

  private end() {
    this.state = 'ended';
    this.wanted = this.wanted.map(() => 0);
    clearTimeout(this.timer);
  }
  private async beat() {
    if (this.sending) {
      this.again = true;
      return;
    }
    clearTimeout(this.timer);
    this.sending = true;
    this.again = false;
    const session = this.session;
    try {
      const a = await this.ask<Answer>('jog/set', { session, number: ++this.number, currents_a: this.wanted });
      if (session === this.session && this.isOn) this.take(a);
    } catch (e) {
      if (session === this.session && this.isOn) {
        this.end();
        this.trouble = failure(e);
      }
    } finally {
      this.sending = false;
    }
    if (!this.isOn) return;
    if (this.again) void this.beat();
    else this.timer = setTimeout(() => void this.beat(), kBeat);
  }
  private take({ coils, guard }: Answer) {
    this.coils = coils;
    this.guard = guard;
    const tripped = guard?.state === 'tripped';
    if (tripped && this.state === 'live') this.wanted = this.wanted.map(() => 0);
    this.state = tripped ? 'tripped' : 'live';
  }
}
