// The permit to arm the coils once: requested when the dialog opens in which the user confirms that he sees the coils, and valid
// for a few seconds, on this page and for this opening of the bench only.

import type { Bench } from './bench.svelte';
import type { ArmedKind } from './state';
import { failure } from '../text';

interface Permit {
  permit: string;
  valid_s: number;
}

export class Arming {
  permit = $state<string | null>(null);
  /** s until the permit expires. */
  left = $state(0);
  trouble = $state.raw<ReturnType<typeof failure> | null>(null);
  private until = 0;
  private readonly opening: number | undefined;
  private readonly page: number;

  constructor(
    private bench: Pick<Bench, 'ask' | 'page' | 'now' | 'connected'>,
    private what: ArmedKind,
    private clock: () => number = () => performance.now(),
  ) {
    this.opening = bench.now.opening;
    this.page = bench.page;
  }
  async request() {
    this.permit = null;
    this.trouble = null;
    try {
      const { permit, valid_s } = await this.bench.ask<Permit>('permit', { page: this.page, what: this.what });
      this.permit = permit;
      this.until = this.clock() + 1000 * valid_s;
      this.tick();
    } catch (e) {
      this.trouble = failure(e);
    }
  }
  /** Called periodically: the permit is void when its time is over. */
  tick() {
    this.left = Math.max(0, (this.until - this.clock()) / 1000);
    if (this.left === 0) this.permit = null;
  }
  /** The page has reconnected, or another bench was opened, since the dialog was opened: it must not arm. */
  get isStale() {
    return !this.bench.connected || this.bench.page !== this.page || this.bench.now.opening !== this.opening;
  }
  /** The permit, for one use; null if it is void. */
  use(): string | null {
    this.tick();
    const permit = this.isStale ? null : this.permit;
    this.permit = null;
    return permit;
  }
}
