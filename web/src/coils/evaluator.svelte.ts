// Asks the program for the field of the coil system: one request at a time, and after it the newest, so that a drag never waits
// for outdated answers.

import { post } from '../connection';

export interface Zero {
  at_m: [number, number];
  eigenvalues_t_per_m: [number, number];
  kind: string;
}
export interface Criterion {
  available: number;
  /** null: no field is sufficient. */
  required: number | null;
  met: boolean;
}
export interface Hold {
  steering_t: Criterion;
  for_alignment_t: number | null;
  for_turning_t: number | null;
  weakest_rad: number;
  around_t: number[];
  alignment: number;
  turning_per_s: number;
  u_turn_m: number | null;
  trap_t_per_m: Criterion;
  swarm_sd_m: number | null;
  vertical_t: number;
  tilted: boolean;
  crowded: boolean;
  trapped: boolean;
}
/** See POST /api/coils/evaluate in web/protocol.md. */
export interface Evaluation {
  coils: string[];
  limits_a: number[];
  /** Of each plane, row by row from the top: x, y, z in nT; null where the field is unknown. */
  grids_nt: (number | null)[][];
  probe_t: [number | null, number | null, number | null];
  zeros: Zero[];
  trap: { currents_a: number[]; eigenvalues_t_per_m: [number | null, number | null]; dbz_dz_t_per_m: number | null; reachable: boolean; saddle: boolean };
  inside: string;
  reached: string;
  hold: Hold;
}
export interface Request {
  system: Record<string, unknown>;
  width_m: number;
  height_m: number;
  columns: number;
  rows: number;
  side: boolean;
  probe_m: number[];
  target_m: number[];
  polarity: 'north' | 'south';
  sample_m: number;
  model: unknown;
  /** While a coil is dragged: zeros are searched from fewer points. */
  fast: boolean;
}

export class Evaluator {
  answer = $state.raw<Evaluation | null>(null);
  /** The request of the answer. */
  asked: Request | null = null;
  trouble = $state.raw<unknown>(null);
  /** Number of answers so far, for measurements of the rate. */
  count = 0;
  private next: Request | null = null;
  private busy = false;
  /** There is a coil system: an answer that arrives is displayed. */
  private wanted = false;

  constructor(private readonly ask: (r: Request) => Promise<Evaluation> = (r) => post('/api/coils/evaluate', r)) {}

  /** Evaluates this request, unless a newer one replaces it; null: there is nothing to evaluate. */
  request(r: Request | null) {
    this.next = r;
    this.wanted = r !== null;
    if (!r) this.answer = this.asked = null;
    if (!this.busy) void this.run();
  }
  private async run() {
    this.busy = true;
    for (let r = this.next; r; r = this.next) {
      this.next = null;
      try {
        const answer = await this.ask(r);
        if (!this.wanted) continue;
        this.asked = r;
        this.answer = answer;
        this.trouble = null;
        ++this.count;
      } catch (e) {
        this.trouble = e;
      }
    }
    this.busy = false;
  }
}
