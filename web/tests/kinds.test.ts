import { describe, expect, it } from 'vitest';
import { words } from '../src/i18n';
import { aboutTime, accepted, givenValues, missingInputs, numberPaths, queueTimes, steps, timeLeft, type InputFile, type KindInfo } from '../src/jobs/kinds';
import type { Job } from '../src/lab.svelte';
import { factsText } from '../src/video/facts.svelte';

const say = words('en');
const job = (over: Partial<Job>): Job => ({ id: 1, title: '', words: [], page: '', out: '', kind: 'activity', estimate_s: 0, state: 'waiting', doing: '', done: 0, of: 0, seconds: 0, error: '', ...over });

describe('times of jobs', () => {
  it('have one digit and a unit that fits', () => {
    expect(aboutTime(0.4, say)).toBe('less than 1 s');
    expect(aboutTime(37, say)).toBe('about 40 s');
    expect(aboutTime(57, say)).toBe('about 1 min');
    expect(aboutTime(130, say)).toBe('about 2 min');
    expect(aboutTime(3400, say)).toBe('about 60 min');
    expect(aboutTime(5 * 3600, say)).toBe('about 5 h');
    expect(aboutTime(130, words('pt'))).toBe('cerca de 2 min');
  });
  it('follow the estimate at the start and the progress at the end', () => {
    expect(timeLeft(job({ state: 'running', estimate_s: 100, seconds: 10 }))).toBe(90);
    expect(timeLeft(job({ state: 'running', seconds: 10 }))).toBeNull();
    expect(timeLeft(job({ state: 'running', seconds: 90, done: 90, of: 100 }))).toBeCloseTo(10);
    // The estimate was much too short: at half of the work it counts half.
    expect(timeLeft(job({ state: 'running', estimate_s: 10, seconds: 60, done: 1, of: 2 }))).toBeCloseTo(30);
  });
  it('of queued jobs add up in their order', () => {
    const times = queueTimes([
      job({ id: 1, state: 'running', estimate_s: 30, seconds: 10 }),
      job({ id: 2, estimate_s: 5 }),
      job({ id: 3, estimate_s: 0 }),
      job({ id: 4, estimate_s: 7 }),
      job({ id: 5, state: 'done' }),
    ]);
    expect(times.get(1)).toEqual({ start: 0, end: 20 });
    expect(times.get(2)).toEqual({ start: 20, end: 25 });
    expect(times.get(3)).toEqual({ start: 25, end: null });
    expect(times.get(4)).toEqual({ start: null, end: null });
    expect(times.has(5)).toBe(false);
  });
});

describe('files of an input', () => {
  const file = (name: string, kind: InputFile['kind'], more: Partial<InputFile> = {}): InputFile => ({ file: name, kind, bytes: 1, time: 0, ...more });
  const files = [file('videos/a.mp4', 'video'), file('b.tif', 'picture'), file('b.tif', 'video'), file('studies/x.toml', 'study', { verb: 'identify', title: 'Step response' }), file('studies/y.toml', 'study', { verb: 'moment' })];

  it('have the kind that the input accepts, and studies its verb', () => {
    expect(accepted(files, 'video', '').map((f) => f.file)).toEqual(['videos/a.mp4', 'b.tif']);
    expect(accepted(files, 'picture', '').map((f) => f.file)).toEqual(['b.tif']);
    expect(accepted(files, 'frame', '').map((f) => f.file)).toEqual(['videos/a.mp4', 'b.tif']);
    expect(accepted(files, 'study', 'identify').map((f) => f.file)).toEqual(['studies/x.toml']);
  });
  it('are searched by all words, in name and title', () => {
    expect(accepted(files, 'study', 'identify', 'STEP x').length).toBe(1);
    expect(accepted(files, 'study', 'identify', 'step z').length).toBe(0);
  });
  it('have a size and a length as text', () => {
    expect(factsText({ width: 640, height: 480, fps: 15, frames: 45, length_s: 3 })).toBe('640 × 480 px, 15 Hz, 3 s');
    expect(factsText({ width: 640, height: 480, fps: 0, frames: 1, length_s: 0 })).toBe('640 × 480 px');
  });
});

it('required values are missing until they are given', () => {
  const info = { schema: { required: ['videos', 'reference'], properties: {}, description: '' } } as unknown as KindInfo;
  expect(missingInputs(info, { videos: [], reference: 'a.mp4' })).toEqual(['videos']);
  expect(givenValues({ a: '', b: [], c: undefined, d: 0, e: false })).toEqual({ d: 0, e: false });
});

it('numbers of a scenario have paths', () => {
  const number = { type: 'number', minimum: 0, maximum: 9 }, quantity = { ...number, type: ['number', 'string'] };
  const schema = {
    properties: {
      title: { type: 'string' },
      rate: number,
      free: { type: 'number' },
      swarm: { type: 'array', items: { properties: { count: { type: 'integer', minimum: 1, maximum: 9 }, model: { oneOf: [{ properties: { type: { const: 'a' }, speed: quantity } }, { properties: { type: { const: 'b' }, other: number } }] } } } },
    },
  };
  const found = numberPaths(schema as never, { title: 'x', rate: 2, free: 1, swarm: [{ count: 3, model: { type: 'a', speed: '5 um/s' } }] });
  expect(found.map((n) => [n.path, n.value])).toEqual([['rate', 2], ['swarm[0].count', 3], ['swarm[0].model.speed', '5 um/s']]);
});

it('steps include both ends', () => {
  expect(steps(1, 2, 5)).toEqual([1, 1.25, 1.5, 1.75, 2]);
  expect(steps(3, 9, 1)).toEqual([3]);
  expect(steps(0, 1, 4)[1]).toBe(0.333333);
});
