// The form of a capture, Fig. 3.9 of the thesis, and its request.

import type { Say, Word } from '../i18n';

export const kFormats = ['avi', 'mp4', 'png', 'pgm', 'ppm', 'tiff'] as const;
export type CaptureFormat = (typeof kFormats)[number];
export const kUntil = ['stopped', 'frames', 'time'] as const;
export const kKeep = ['all', 'one_of', 'every'] as const;

/** Where a recording belongs: its name, and the experiment and drop in which it is listed. */
export interface Destination {
  name: string;
  experiment: string;
  drop: string;
}
/** Numbers are texts while the user types. */
export interface CaptureForm extends Destination {
  until: (typeof kUntil)[number];
  frames: string;
  time: string;
  keep: (typeof kKeep)[number];
  oneOf: string;
  every: string;
  buffered: boolean;
  format: CaptureFormat;
  onlyCorrupt: boolean;
}
export const kCapture: CaptureForm = {
  until: 'stopped', frames: '600', time: '10', keep: 'all', oneOf: '10', every: '0.5', buffered: false, format: 'avi', onlyCorrupt: false, name: 'look', experiment: '', drop: '',
};

/** A reason for the refusal of a value: a text of the page with its values. */
export type Refused = [Word, Record<string, string | number>];
export const refusedText = (r: Refused | undefined, say: Say) => (r ? say(...r) : '');

/** A number as typed, with a decimal point or comma; NaN for another text. */
export const typedNumber = (text: string) => (text.trim() === '' ? NaN : Number(text.trim().replace(',', '.')));

export interface Range {
  min: number;
  max: number;
  integer?: boolean;
  unit?: string;
}
export function checkNumber(text: string, { min, max, integer, unit = '' }: Range): Refused | undefined {
  const value = typedNumber(text), unitText = unit && ` ${unit}`;
  if (!Number.isFinite(value) || value < min || value > max || (integer && !Number.isInteger(value)))
    return [integer ? 'bench.bad.integer' : 'bench.bad.number', { value: text.trim() || '–', min: `${min}${unitText}`, max: `${max}${unitText}` }];
  return undefined;
}
/** The names of files that the program accepts. */
export const checkName = (name: string): Refused | undefined => (/^[A-Za-z0-9_-][A-Za-z0-9 ._-]{0,59}$/.test(name) ? undefined : ['bench.bad.name', { value: name || '–' }]);

const kRanges: Record<'frames' | 'time' | 'oneOf' | 'every', Range> = {
  frames: { min: 1, max: 1e9, integer: true },
  time: { min: 0.01, max: 1e6, unit: 's' },
  oneOf: { min: 1, max: 1e6, integer: true },
  every: { min: 0.001, max: 1e5, unit: 's' },
};

/** The invalid values of a form by their fields; only fields that the form uses are checked. */
export function checkCapture(f: CaptureForm): Partial<Record<keyof CaptureForm, Refused>> {
  const out: Partial<Record<keyof CaptureForm, Refused>> = {};
  const used = ([f.until, f.keep] as string[]).map((w) => (w === 'one_of' ? 'oneOf' : w)).filter((w): w is keyof typeof kRanges => w in kRanges);
  for (const field of used) {
    const wrong = checkNumber(f[field], kRanges[field]);
    if (wrong) out[field] = wrong;
  }
  const name = checkName(f.name);
  if (name) out.name = name;
  return out;
}

/** The body of POST /api/bench/capture; the form must be valid. */
export function captureRequest(f: CaptureForm, page: number) {
  return {
    page,
    frames: f.until === 'frames' ? typedNumber(f.frames) : 0,
    time_s: f.until === 'time' ? typedNumber(f.time) : 0,
    one_of: f.keep === 'one_of' ? typedNumber(f.oneOf) : 1,
    every_s: f.keep === 'every' ? typedNumber(f.every) : 0,
    buffered: f.buffered,
    format: f.format,
    name: f.name,
    only_corrupt: f.onlyCorrupt,
    experiment: f.experiment,
    drop: f.experiment ? f.drop : '',
  };
}
/** The file or folder of a capture; the program replaces the time stamp. */
export const captureFile = (f: CaptureForm, folder: string) => `${folder}/${f.name || '…'}-YYYYMMDD-HHMMSS${f.format === 'avi' || f.format === 'mp4' ? `.${f.format}` : '/'}`;
