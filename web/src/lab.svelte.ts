// State of the lab in the page: one object shared by all components.

import { Bench } from './bench/bench.svelte';
import { Changes } from './changes.svelte';
import { Connection, get, type Answer, type Link, type Listener, type News, type RequestError } from './connection';
import type { Schema } from './form/schema';
import { decodeFrame, runOf, type Frame } from './frame';
import type { Word } from './i18n';
import { Series } from './series';
import type { Scene } from './view/overlay';

export interface RunNews {
  run: number;
  seed: number;
  rate: number;
  populations: { begin: number; end: number; polarity: 'north' | 'south' }[];
  coils: { name: string; max_a: number }[];
  columns: string[];
}
export interface Job {
  id: number;
  title: string;
  words: string[];
  page: string;
  out: string;
  /** Kind of job; empty for a recording. */
  kind: string;
  /** Run time estimated before the start, s; 0: unknown. */
  estimate_s: number;
  state: 'waiting' | 'running' | 'done' | 'failed' | 'cancelled';
  doing: string;
  done: number;
  of: number;
  seconds: number;
  error: string;
  /** Time of the end, s since 1970; 0: not ended. */
  ended?: number;
  /** Of the measurement; empty without one. */
  quality?: string;
}
export interface Trouble {
  where: string;
  what: string;
  /** Text of the page in place of `what`. */
  word?: Word;
}

/** State hash of a run up to a frame, as in the manifest of a recording. */
export interface HashNews {
  frame: number;
  /** s */
  t: number;
  hash: string;
  /** At the end of the scenario. */
  end: boolean;
  /** Parts were exchanged: the scenario alone does not give this hash. */
  changed: boolean;
}

const kTick = 100; // ms

export class Lab {
  connected = $state(false);
  refused = $state(false);
  everConnected = $state(false);
  /** A state message was received; the message of a run comes before it. */
  hasState = $state(false);
  page = $state(0);
  steering = $state(0);
  pages = $state(1);
  running = $state(false);
  speed = $state(1);
  realSpeed = $state(0);
  events = $state(0);
  run = $state.raw<RunNews | null>(null);
  scene = $state.raw<Scene | null>(null);
  /** Present scenario, resolved. */
  scenario = $state.raw<Record<string, any>>({});
  jobs = $state.raw<Job[]>([]);
  /** The newest change of an experiment by any page, and the number of changes. */
  experimentNews = $state.raw({ name: '', count: 0 });
  /** A list of jobs was received. */
  hasJobs = $state(false);
  /** JSON Schema of a scenario; null until the program has sent it. */
  schema = $state.raw<Schema | null>(null);
  trouble = $state.raw<Trouble | null>(null);
  stopped = $state.raw<Trouble | null>(null);
  /** Of the run when it was paused; only in the demonstration. */
  hash = $state.raw<HashNews | null>(null);
  /** Increases when new data are available, at most ten times a second; triggers numbers and plots. The picture follows `frame`. */
  ticks = $state(0);
  private ticked = -Infinity;
  private ticking = 0;

  // Not reactive: they change sixty times a second.
  frame: Frame | null = null;
  readonly series = new Series();
  readonly link: Link;
  readonly changes = new Changes();
  readonly bench: Bench = new Bench(this);

  /** This page controls the run. False without a connection: all controls of the run are disabled. */
  readonly steers = $derived(this.connected && this.page !== 0 && this.page === this.steering);

  /** `connect` opens the way to the program. */
  constructor(connect: (listener: Listener) => Link = (listener) => new Connection(listener)) {
    this.link = connect({
      news: (n) => this.onNews(n),
      frame: (b) => this.onFrame(b),
      state: (s) => {
        this.connected = s.connected;
        this.refused = s.refused;
        if (!s.connected) {
          this.page = this.steering = 0; // the next connection gets another number
          return;
        }
        this.everConnected = true;
        void this.fetchSchema();
      },
    });
  }

  /** Sends a request and shows its error. */
  async ask(what: string, values: Record<string, unknown> = {}): Promise<Answer> {
    const a = await this.link.ask(what, values);
    if (!a.ok && a.what !== 'connection') this.trouble = { where: a.where ?? '', what: a.what ?? '', word: a.word };
    else if (a.ok) this.trouble = null;
    return a;
  }
  async exchange(event: Record<string, unknown>) {
    const before = this.scenario;
    const a = await this.ask('exchange', { event });
    if (a.ok) this.changes.add(before, event);
    return a;
  }
  /** Undoes the newest change of this page. */
  async undo() {
    const { back } = this.changes;
    if (back && (await this.ask('exchange', { event: back })).ok) this.changes.removeNewest();
  }

  private async fetchSchema() {
    if (this.schema) return;
    try {
      this.schema = await get<Schema>('/api/schema');
    } catch (e) {
      const { what, word } = e as RequestError;
      this.trouble = { where: '/api/schema', what, word };
    }
  }

  private onNews(n: News) {
    switch (n.say) {
      case 'hello':
        this.page = n.page;
        break;
      case 'run': {
        const [left, top, right, bottom] = n.box;
        this.run = { run: n.run, seed: n.seed, rate: n.frame.rate, populations: n.populations, coils: n.coils, columns: n.columns };
        this.scene = { view: n.frame, outline: n.outline, box: { left, top, right, bottom }, setpoints: n.setpoints };
        this.scenario = n.scenario;
        this.events = n.events;
        this.stopped = null;
        this.hash = null;
        this.series.begin(n.columns);
        this.changes.clear();
        this.frame = null;
        break;
      }
      case 'bench':
        this.bench.take(n.state);
        break;
      case 'experiment':
        this.experimentNews = { name: n.name, count: this.experimentNews.count + 1 };
        break;
      case 'history':
        if (n.run === this.run?.run) this.takeHistory(n.rows);
        break;
      case 'parts':
        this.scenario = n.scenario;
        this.events = n.events;
        if (this.scene) this.scene = { ...this.scene, setpoints: n.setpoints };
        break;
      case 'state':
        this.hasState = true;
        this.running = n.running;
        this.speed = n.speed;
        this.realSpeed = n.real_speed;
        break;
      case 'pages':
        this.pages = n.pages;
        this.steering = n.steering;
        if (!this.steers) this.changes.clear(); // another page may change the same parts
        break;
      case 'jobs':
        this.jobs = n.jobs;
        this.hasJobs = true;
        break;
      case 'hash':
        this.hash = { frame: n.frame, t: n.t, hash: n.hash, end: n.end, changed: n.changed };
        break;
      case 'stopped':
        this.stopped = { where: n.where, what: n.what };
        this.running = false;
        break;
    }
  }

  private onFrame(b: ArrayBuffer) {
    if (!this.run) return;
    // The server sends JSON before queued frames: the last frame of a run can arrive after the news of the next run.
    if (runOf(b) !== this.run.run) return;
    const f = decodeFrame(b, this.run.columns.length);
    this.frame = f;
    this.series.take(f.rows, f.rowCount);
    this.tick();
  }
  // The values of a series; null is written for those that are not finite.
  private takeHistory(rows: (number | null)[][]) {
    this.series.take(Float64Array.from(rows.flat(), (v) => v ?? NaN), rows.length);
    this.tick();
  }
  private tick() {
    if (this.ticking) return;
    const wait = this.ticked + kTick - performance.now();
    this.ticking = window.setTimeout(() => {
      this.ticking = 0;
      this.ticked = performance.now();
      ++this.ticks;
    }, Math.max(0, wait));
  }

  /** +1 when cells swim along the field, -1 against it. */
  get polarity() {
    const count = { north: 0, south: 0 };
    for (const p of this.run?.populations ?? []) count[p.polarity] += p.end - p.begin;
    return count.north > count.south ? 1 : -1;
  }
}
