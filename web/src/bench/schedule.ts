// Step responses on a schedule: the form, the times of each phase, and what is refused.

import { flipped } from '../video/angles';
import { checkName, checkNumber, typedNumber, type Destination, type Range, type Refused } from './capture';

/** Numbers are texts while the user types. */
export interface ResponseForm extends Destination {
  repeat: string;
  /** s */
  every: string;
  /** deg, counter-clockwise from the right: the swimming direction before the field reversal. */
  direction: number;
  /** uT */
  field: string;
  /** s */
  gather: string;
  before: string;
  record: string;
}
export const kResponse: ResponseForm = { repeat: '1', every: '60', direction: 180, field: '1000', gather: '20', before: '1', record: '6', name: 'response', experiment: '', drop: '' };

const kRanges: Record<'repeat' | 'every' | 'field' | 'gather' | 'before' | 'record', Range> = {
  repeat: { min: 1, max: 1000, integer: true },
  every: { min: 0, max: 1e5, unit: 's' },
  field: { min: 1, max: 1e5, unit: 'µT' },
  gather: { min: 0.1, max: 1e5, unit: 's' },
  before: { min: 0.1, max: 1e4, unit: 's' },
  record: { min: 0.1, max: 1e4, unit: 's' },
};

/** Duration of one response, s: gathering, the picture before the reversal, and the recording. */
export const durationOfOne = (f: ResponseForm) => typedNumber(f.gather) + typedNumber(f.before) + typedNumber(f.record);

export function checkResponse(f: ResponseForm): Partial<Record<keyof ResponseForm, Refused>> {
  const out: Partial<Record<keyof ResponseForm, Refused>> = {};
  for (const field of Object.keys(kRanges) as (keyof typeof kRanges)[]) {
    const wrong = field === 'every' && typedNumber(f.repeat) === 1 ? undefined : checkNumber(f[field], kRanges[field]);
    if (wrong) out[field] = wrong;
  }
  const name = checkName(f.name);
  if (name) out.name = name;
  const one = durationOfOne(f), every = typedNumber(f.every);
  if (!out.every && typedNumber(f.repeat) > 1 && Number.isFinite(one) && every < one) out.every = ['bench.bad.every', { every: f.every.trim(), one: Number(one.toPrecision(4)) }];
  return out;
}

export const kPhases = ['gather', 'before', 'record', 'wait'] as const;
export interface PhaseOfSchedule {
  phase: (typeof kPhases)[number];
  from_s: number;
  to_s: number;
  /** Number of the response, from 0. */
  response: number;
}
/** The phases of all responses, in order of time; the form must be valid. */
export function timeline(f: ResponseForm): PhaseOfSchedule[] {
  const out: PhaseOfSchedule[] = [];
  const repeat = typedNumber(f.repeat), every = typedNumber(f.every);
  const lengths = [typedNumber(f.gather), typedNumber(f.before), typedNumber(f.record)];
  for (let response = 0; response < repeat; ++response) {
    let t = response * (repeat > 1 ? every : 0);
    lengths.forEach((length, i) => {
      out.push({ phase: kPhases[i], from_s: t, to_s: t + length, response });
      t += length;
    });
    const next = (response + 1) * every;
    if (response + 1 < repeat && next > t) out.push({ phase: 'wait', from_s: t, to_s: next, response });
  }
  return out;
}

/** The body of POST /api/bench/step-response; the form must be valid. Directions of the bench count clockwise, as in a picture. */
export function responseRequest(f: ResponseForm, page: number, permit: string) {
  return {
    page,
    permit,
    repeat: typedNumber(f.repeat),
    every_s: typedNumber(f.repeat) > 1 ? typedNumber(f.every) : 0,
    direction_deg: flipped(f.direction),
    field_ut: typedNumber(f.field),
    gather_s: typedNumber(f.gather),
    before_s: typedNumber(f.before),
    record_s: typedNumber(f.record),
    name: f.name,
    experiment: f.experiment,
    drop: f.experiment ? f.drop : '',
  };
}
