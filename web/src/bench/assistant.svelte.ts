// The first-run assistant: what the user has found out about each coil of a scene. It is kept in the browser.

import { remember, remembered } from '../settings';
import { checkRows, pairsOf, type CoilJson, type Found, type Row } from './coils';
import type { JogSession } from './jog.svelte';

export const kSteps = ['lamp', 'polarity', 'sensing', 'calibration', 'result'] as const;
export type Step = (typeof kSteps)[number];
export interface Sensed {
  /** A */
  set: number;
  sensed: number | null;
}
export interface CoilDraft {
  /** Whether the lamp lights with this coil only. */
  lamp: '' | 'only' | 'other';
  /** Direction of the compass needle. */
  needle: '' | 'right' | 'reversed';
  sensed: Sensed[];
  rows: Row[];
}
interface Kept {
  step: Step;
  coil: number;
  coils: CoilDraft[];
}
const kEmpty: CoilDraft = { lamp: '', needle: '', sensed: [], rows: [] };

export class AssistantDraft {
  step = $state<Step>('lamp');
  coil = $state(0);
  coils = $state.raw<CoilDraft[]>([]);

  constructor(readonly scene: string, count: number) {
    const kept = remembered<Partial<Kept>>(this.key, {});
    // A scene that has changed has other coils: an incomplete or longer list is filled up or cut.
    this.coils = Array.from({ length: count }, (_, k) => ({ ...kEmpty, ...kept.coils?.[k] }));
    this.step = kSteps.find((s) => s === kept.step) ?? 'lamp';
    this.coil = Math.min(Math.max(0, kept.coil ?? 0), Math.max(0, count - 1));
  }
  private get key() {
    return `assistant.${this.scene}`;
  }
  get now(): CoilDraft {
    return this.coils[this.coil] ?? kEmpty;
  }
  go(step: Step, coil = this.coil) {
    this.step = step;
    this.coil = coil;
    this.keep();
  }
  set(change: Partial<CoilDraft>) {
    this.coils = this.coils.map((c, k) => (k === this.coil ? { ...c, ...change } : c));
    this.keep();
  }
  clear() {
    this.coils = this.coils.map(() => kEmpty);
    this.go('lamp', 0);
  }
  private keep() {
    remember(this.key, { step: this.step, coil: this.coil, coils: this.coils } satisfies Kept);
  }
}

/** Whether a step has a result for a coil. */
export function isDone(step: Step, c: CoilDraft, coil: CoilJson, tolerance: number): boolean {
  if (step === 'lamp') return c.lamp === 'only';
  if (step === 'polarity') return c.needle !== '';
  if (step === 'sensing') return c.sensed.length > 0 && c.sensed.every((s) => isWithin(s, tolerance));
  return step === 'calibration' && checkRows(c.rows, coil) === undefined;
}
export const isWithin = (s: Sensed, tolerance: number) => s.sensed !== null && Math.abs(s.sensed - s.set) <= tolerance;

export const foundOf = (c: CoilDraft, coil: CoilJson): Found => ({ reversed: c.needle === 'reversed', table: checkRows(c.rows, coil) ? null : pairsOf(c.rows) });

/** Fractions of the largest current at which the sensed currents are compared. */
export const kSensingFractions = [-0.5, -0.25, 0, 0.25, 0.5];
const kSettle = 500; // ms; the guard reads the inputs after `sense_settling`, 100 ms

/** Sets the currents one after the other, and reads what the inputs sense. Stops with the session. */
export async function measureSensing(session: Pick<JogSession, 'set' | 'coils' | 'max' | 'state'>, coil: number, wait = (ms: number) => new Promise<void>((go) => setTimeout(go, ms))): Promise<Sensed[]> {
  const out: Sensed[] = [];
  for (const fraction of kSensingFractions) {
    if (session.state !== 'live') break;
    const set = Number((fraction * (session.max[coil] ?? 0)).toPrecision(3));
    session.set(coil, set);
    await wait(kSettle);
    if (session.state === 'live') out.push({ set, sensed: session.coils[coil]?.sensed_a ?? null });
  }
  session.set(coil, 0);
  return out;
}
