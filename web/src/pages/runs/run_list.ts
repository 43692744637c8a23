// The list of recorded runs: entries of GET /api/runs, columns, sorting, search.

import type { Word } from '../../i18n';

export interface RunCard {
  name: string;
  title: string;
  /** Start of the recording, UTC, ISO 8601. */
  date: string;
  complete: boolean;
  /** A process is writing the run. */
  writing: boolean;
  frames: number;
  duration_s: number;
  /** Start and end of the recorded part; null: the run is recorded from its start to its end. */
  recorded_s: [number, number] | null;
  seed: string;
  state_hash: string;
  cells: number | null;
  model: string;
  bytes: number;
  files: string[];
  tags: string[];
  note: string;
  /** The following have been determined; until then they are missing. */
  measured: boolean;
  controller?: string;
  has_setpoint?: boolean;
  settling_time_s?: number | null;
  steady_rms_px?: number | null;
  steady_rms_um?: number | null;
}

export const kColumns = ['name', 'title', 'date', 'model', 'seed', 'duration', 'settled', 'error', 'size', 'tags'] as const;
export type Column = (typeof kColumns)[number];

/** Label of a column. */
export const columnWord = (c: Column): Word => `runs.column.${c}`;

const orNull = (text: string) => text || null;

/** What a column sorts by; null: no value, which comes last in both directions. */
export function sortKey(r: RunCard, c: Column): string | number | null {
  switch (c) {
    case 'name':
      return r.name;
    case 'title':
      return orNull(r.title);
    case 'date':
      return orNull(r.date);
    case 'model':
      return orNull([r.model, r.controller].filter(Boolean).join(' '));
    case 'seed':
      return r.seed === '' ? null : Number(r.seed);
    case 'duration':
      return r.duration_s;
    case 'settled':
      // Not settled is longer than every settling time.
      return r.has_setpoint ? (r.settling_time_s ?? Infinity) : null;
    case 'error':
      return r.steady_rms_um ?? r.steady_rms_px ?? null;
    case 'size':
      return r.bytes;
    case 'tags':
      return orNull(r.tags.join(' '));
  }
}

export function sorted(runs: RunCard[], c: Column, down: boolean): RunCard[] {
  const order = new Intl.Collator(undefined, { numeric: true, sensitivity: 'base' });
  const keys = new Map(runs.map((r) => [r, sortKey(r, c)]));
  return [...runs].sort((one, other) => {
    const a = keys.get(one)!, b = keys.get(other)!;
    if (a === null || b === null) return Number(a === null) - Number(b === null);
    if (a === b) return 0;
    const rising = typeof a === 'number' && typeof b === 'number' ? a - b : order.compare(String(a), String(b));
    return down ? -rising : rising;
  });
}

const plain = (text: string) => text.normalize('NFD').replace(/\p{M}/gu, '').toLowerCase();

/** The runs that contain every word of the search, in any case and without regard to accents. */
export function found(runs: RunCard[], search: string): RunCard[] {
  const words = plain(search).split(/\s+/).filter(Boolean);
  if (!words.length) return runs;
  return runs.filter((r) => {
    const text = plain([r.name, r.title, r.model, r.controller ?? '', r.seed, r.date.slice(0, 10), r.note, r.state_hash, ...r.tags].join('\n'));
    return words.every((w) => text.includes(w));
  });
}

/** "14.3 s", "2:05 min", "1:02:05 h". */
export function durationText(s: number): string {
  if (s < 99.95) return `${s.toFixed(1)} s`;
  const rounded = Math.round(s), two = (v: number) => String(v).padStart(2, '0');
  const h = Math.floor(rounded / 3600), m = Math.floor(rounded / 60) % 60;
  return h ? `${h}:${two(m)}:${two(rounded % 60)} h` : `${m}:${two(rounded % 60)} min`;
}

/** The steady-state error in micrometres if the scale is known, otherwise in pixels. */
export function errorText(r: RunCard): string {
  if (r.steady_rms_um != null) return `${r.steady_rms_um.toPrecision(3)} µm`;
  return r.steady_rms_px != null ? `${r.steady_rms_px.toPrecision(3)} px` : '–';
}

/** The time of the recording in the time zone of the browser. */
export function dateText(iso: string, language: string): string {
  const d = new Date(iso);
  return Number.isNaN(d.getTime()) ? '–' : d.toLocaleString(language === 'pt' ? 'pt-BR' : 'en-GB', { dateStyle: 'short', timeStyle: 'short' });
}

/** Tags in a typed text: separated by commas, without empty and repeated ones. */
export const tagsOf = (text: string): string[] => [...new Set(text.split(',').map((t) => t.trim()).filter(Boolean))];

/** The address of a file of a run. */
export const runFile = (name: string, file: string) => `/api/runs/${encodeURIComponent(name)}/${file}`;
