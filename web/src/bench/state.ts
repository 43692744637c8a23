// The state of a bench as the program sends it, and what the page derives from it. web/protocol.md has the format.

import type { Word } from '../i18n';
import { addressOf } from '../router.svelte';

export interface CameraControl {
  name: string;
  value: number;
  automatically: boolean | null;
}
export interface CoilState {
  /** A, commanded; 0 when not armed. */
  current_a: number;
  /** A; null without an input that senses the current. */
  sensed_a: number | null;
  max_a: number;
}
export interface GuardState {
  state: 'disarmed' | 'armed' | 'tripped';
  /** Relative to the thermal limit. */
  heat: number;
  reason: string;
  write_ok: boolean;
}
export const kActivities = ['capture', 'step-response', 'run', 'jog'] as const;
export type ActivityKind = (typeof kActivities)[number];
/** Activities that need armed coils. */
export type ArmedKind = Exclude<ActivityKind, 'capture'>;
export interface Memory {
  used_bytes: number;
  available_bytes: number;
  total_bytes: number;
}
export interface Activity {
  kind: ActivityKind;
  title: string;
  started_s_ago: number;
  progress: number | null;
  left_s: number | null;
  armed: boolean;
  /** It was asked to end. */
  stopping?: boolean;
  out: string;
  phase?: 'gathering' | 'waiting' | 'recording' | '';
  index?: number;
  of?: number;
  taken?: number;
  kept?: number;
  corrupt?: number;
  dropped?: number;
  memory?: Memory;
  /** Largest lateness of the machine in the activity. */
  late_ms?: number;
}
export interface FinishedActivity {
  kind: ActivityKind;
  title: string;
  ok: boolean;
  what: string;
  out: string;
  experiment?: string | null;
  taken?: number;
  kept?: number;
  dropped?: number;
  corrupt?: number;
  late_ms?: number;
  duration_s?: number;
  ago_s: number;
}
export type Outline = { centre_px: [number, number]; radius_px: number } | { corners_px: [number, number][] };
export interface Estimate {
  cells: number;
  centroid_px: [number, number];
  covariance_px2: [number, number, number];
}
export interface BenchState {
  open: string | null;
  /** Changes whenever a bench is opened. */
  opening?: number;
  size_px?: [number, number];
  um_per_px?: number | null;
  rate_hz?: number | null;
  frames?: number;
  dropped?: number;
  corrupt?: number;
  mean?: number;
  saturated?: number;
  /** Pixels per bin of 4 grey levels. */
  histogram?: number[];
  controls?: CameraControl[];
  outline?: Outline | null;
  estimate?: Estimate | null;
  setpoint_px?: [number, number] | null;
  coils?: CoilState[];
  guard?: GuardState | null;
  armed?: boolean;
  last_fault?: { reason: string; ago_s: number } | null;
  sample?: { exposure_s: number } | null;
  activity?: Activity | null;
  finished?: FinishedActivity[];
  trouble?: string;
}

export type CoilsWord = 'off' | 'armed' | 'fault' | 'unknown';
/**
 * What the bar of every page shows of the coils. `known` is false without a connection: the guard then switches the coils off
 * without the server, but the page cannot see it.
 */
export function coilsWord(s: BenchState, known: boolean): CoilsWord {
  if (!known) return 'unknown';
  if (s.guard?.state === 'tripped') return 'fault';
  return s.armed || s.guard?.state === 'armed' ? 'armed' : 'off';
}
export const kCoilsIcons: Record<CoilsWord, string> = { off: '○', armed: '⚡', fault: '⚠', unknown: '?' };
export const kindWord = (kind: ActivityKind) => `bench.kind.${kind}` as Word;

/** The experiment in whose folder a recording is; empty for another place. */
export const experimentOf = (f: FinishedActivity) => f.experiment ?? /^experiments\/([^/]+)\//.exec(f.out)?.[1] ?? '';
/** The address of a recording; empty for an activity without one. */
export function addressOfResult(f: FinishedActivity): string {
  if (!f.out || f.kind === 'jog') return '';
  if (f.kind === 'capture') return addressOf('video', [], { file: f.out, ...(experimentOf(f) ? { experiment: experimentOf(f) } : {}) });
  return f.kind === 'run' ? addressOf('runs', [f.out.replace(/^runs\//, '')]) : addressOf('runs');
}

/** The number of a coil for the user, from 1. */
export const coilNumber = (index: number) => index + 1;
/** "1:05" or "1:02:05"; the time is rounded down. */
export function clockText(seconds: number): string {
  const s = Math.max(0, Math.floor(seconds)), two = (n: number) => String(n).padStart(2, '0');
  const h = Math.floor(s / 3600), m = Math.floor(s / 60) % 60;
  return h ? `${h}:${two(m)}:${two(s % 60)}` : `${m}:${two(s % 60)}`;
}
