// The bench as this page knows it: from the news of the server on every page, and from requests while the console is shown.

import { get, post } from '../connection';
import type { BenchState } from './state';

const kPause = 250; // ms between requests while the console is visible
const kElsewhere = 2000; // ms without news on other pages, while coils are armed or an activity runs

/** What the bench needs to know of the connection of the page. */
export interface PageNumber {
  readonly page: number;
  readonly connected: boolean;
}

export class Bench {
  now = $state.raw<BenchState>({ open: null });
  /** The server has reported the state since the connection was established. */
  known = $state(false);
  /** Time of the newest state, ms. */
  private heard = 0;
  /** The console is shown: it needs the complete state often. */
  shown = $state(false);
  /** Why the request to switch the coils off got no answer. */
  offFailed = $state(false);
  private news = 0;

  constructor(private link: PageNumber) {}

  /** The number of this page, which a request that starts an activity must have. */
  get page() {
    return this.link.page;
  }
  get connected() {
    return this.link.connected;
  }
  /** News of the server lack what only the console shows; it keeps the previous values of the same opening. */
  take(short: BenchState) {
    ++this.news;
    if (short.open === null || short.opening !== this.now.opening) return this.set(short);
    // Without an activity, news have no coils.
    const coils = short.coils?.length ? short.coils : this.now.coils?.map((c) => ({ ...c, current_a: 0, sensed_a: null }));
    this.set({ ...this.now, ...short, coils });
  }
  /** The connection was lost: the state of the coils is not known from now on. */
  lost() {
    this.known = false;
  }
  async refresh() {
    const before = this.news;
    const state = await get<BenchState>('/api/bench').catch(() => null);
    if (!state || !this.connected) return;
    // News that arrived meanwhile may be newer than the answer.
    if (this.news === before) this.set(state);
    else if (state.opening === this.now.opening) this.set({ ...state, ...this.now, controls: state.controls, histogram: state.histogram });
  }
  /** Requests the state until `stopped`. */
  async follow(stopped: () => boolean) {
    while (!stopped()) {
      const visible = this.shown && !document.hidden, old = performance.now() - this.heard > kElsewhere;
      if (this.connected && (visible || (old && this.isBusy))) await this.refresh();
      await new Promise((go) => setTimeout(go, kPause));
    }
  }
  get isBusy() {
    return !!this.now.armed || !!this.now.activity;
  }
  /** Sends a request; an answer with the state is taken. Throws RequestError. */
  async ask<T = BenchState>(what: string, body: Record<string, unknown> = {}): Promise<T> {
    const answer = await post<any>(`/api/bench/${what}`, body);
    if (answer && typeof answer === 'object' && 'open' in answer) {
      ++this.news; // an answer to an earlier request is older
      this.set(answer);
    }
    return answer;
  }
  /** Switches the coils off. Every page may, at any time. */
  async off() {
    this.offFailed = false;
    try {
      await this.ask('off');
    } catch {
      this.offFailed = true;
    }
  }

  private set(state: BenchState) {
    this.now = state;
    this.known = true;
    this.heard = performance.now();
  }
}
