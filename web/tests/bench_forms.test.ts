import { describe, expect, test } from 'vitest';
import { captureFile, captureRequest, checkCapture, checkName, checkNumber, kCapture, type CaptureForm } from '../src/bench/capture';
import { barLength } from '../src/bench/draw';
import { partOf, responseDefaults } from '../src/bench/scene';
import { checkResponse, kResponse, responseRequest, timeline, type ResponseForm } from '../src/bench/schedule';
import { clockText, coilsWord } from '../src/bench/state';

const capture = (change: Partial<CaptureForm>): CaptureForm => ({ ...kCapture, ...change });
const response = (change: Partial<ResponseForm>): ResponseForm => ({ ...kResponse, ...change });

describe('a capture', () => {
  test('until stopped keeps every frame: no limit is sent', () => {
    expect(captureRequest(capture({ frames: '7', time: '8', oneOf: '9', every: '3' }), 4)).toMatchObject({ page: 4, frames: 0, time_s: 0, one_of: 1, every_s: 0, buffered: false, format: 'avi', only_corrupt: false });
  });
  test('sends only the limits that are chosen', () => {
    expect(captureRequest(capture({ until: 'frames', frames: '600', keep: 'one_of', oneOf: '10' }), 1)).toMatchObject({ frames: 600, time_s: 0, one_of: 10, every_s: 0 });
    expect(captureRequest(capture({ until: 'time', time: '2,5', keep: 'every', every: '0.5' }), 1)).toMatchObject({ frames: 0, time_s: 2.5, one_of: 1, every_s: 0.5 });
  });
  test('has a drop only with an experiment', () => {
    expect(captureRequest(capture({ drop: 'A' }), 1)).toMatchObject({ experiment: '', drop: '' });
    expect(captureRequest(capture({ drop: 'A', experiment: 'x' }), 1)).toMatchObject({ experiment: 'x', drop: 'A' });
  });
  test('refuses values beside their fields, and only those that are used', () => {
    expect(checkCapture(capture({ frames: 'many', time: '-1', oneOf: '0', every: '' }))).toEqual({});
    expect(Object.keys(checkCapture(capture({ until: 'frames', frames: '1.5', keep: 'one_of', oneOf: '0' }))).sort()).toEqual(['frames', 'oneOf']);
    expect(Object.keys(checkCapture(capture({ until: 'time', time: '', keep: 'every', every: 'x', name: '../a' }))).sort()).toEqual(['every', 'name', 'time']);
  });
  test('names its files with a time stamp', () => {
    expect(captureFile(capture({}), 'captures')).toBe('captures/look-YYYYMMDD-HHMMSS.avi');
    expect(captureFile(capture({ format: 'pgm' }), 'captures')).toBe('captures/look-YYYYMMDD-HHMMSS/');
  });
});

describe('typed values', () => {
  test('have limits with a unit', () => {
    expect(checkNumber('3', { min: 1, max: 5 })).toBeUndefined();
    expect(checkNumber('0,5', { min: 1, max: 5, unit: 's' })).toEqual(['bench.bad.number', { value: '0,5', min: '1 s', max: '5 s' }]);
    for (const bad of ['', ' ', 'a', '1 s', 'Infinity']) expect(checkNumber(bad, { min: 1, max: 5 })).toBeDefined();
  });
  test('names have no folders', () => {
    for (const good of ['look', 'drop A.2', '_x-1']) expect(checkName(good)).toBeUndefined();
    for (const bad of ['', '.hidden', 'a/b', '..', 'ação', 'x'.repeat(61)]) expect(checkName(bad)).toBeDefined();
  });
});

describe('a schedule', () => {
  const form = response({ repeat: '3', every: '40', gather: '20', before: '1', record: '6' });
  test('has the phases of every response, and waits between them', () => {
    const phases = timeline(form);
    expect(phases.filter((p) => p.phase === 'record').map((p) => p.from_s)).toEqual([21, 61, 101]);
    expect(phases.filter((p) => p.phase === 'wait').map((p) => [p.from_s, p.to_s])).toEqual([[27, 40], [67, 80]]);
    expect(phases.at(-1)).toEqual({ phase: 'record', from_s: 101, to_s: 107, response: 2 });
    phases.slice(1).forEach((p, i) => expect(p.from_s).toBe(phases[i].to_s));
  });
  test('without a pause has no wait', () => {
    expect(timeline({ ...form, every: '27' }).filter((p) => p.phase === 'wait')).toEqual([]);
  });
  test('is refused if the period is shorter than one response', () => {
    expect(checkResponse(form)).toEqual({});
    expect(checkResponse({ ...form, every: '26.9' })).toEqual({ every: ['bench.bad.every', { every: '26.9', one: 27 }] });
    expect(checkResponse({ ...form, every: '27' })).toEqual({});
    expect(checkResponse({ ...form, every: 'x' }).every?.[0]).toBe('bench.bad.number');
  });
  test('of one response needs no period', () => {
    expect(checkResponse({ ...form, repeat: '1', every: '' })).toEqual({});
    expect(responseRequest({ ...form, repeat: '1', every: '' }, 1, 'p').every_s).toBe(0);
  });
  test('is sent with the direction of pictures, which counts clockwise', () => {
    expect(responseRequest({ ...form, direction: 90, field: '500', experiment: 'x', drop: 'A' }, 2, 'ab')).toEqual({
      page: 2, permit: 'ab', repeat: 3, every_s: 40, direction_deg: 270, field_ut: 500, gather_s: 20, before_s: 1, record_s: 6, name: 'response', experiment: 'x', drop: 'A',
    });
  });
  test('starts with the values of the scene', () => {
    const scenario = { rig: { step_response: { direction: '90 deg', field: '0.0005 T', gather: '12 s', before: '1 s', record: '6 s', repeat: 2, every: '60 s' } } };
    expect(responseDefaults(scenario)).toEqual({ direction: 270, field: '500', gather: '12', before: '1', record: '6', repeat: '2', every: '60' });
    expect(responseDefaults({})).toEqual({});
  });
});

describe('the state of the coils', () => {
  const guard = { state: 'disarmed' as const, heat: 0, reason: '', write_ok: true };
  test('is unknown without a connection, whatever was last known', () => {
    expect(coilsWord({ open: 'b', armed: true, guard: { ...guard, state: 'armed' } }, false)).toBe('unknown');
    expect(coilsWord({ open: 'b' }, false)).toBe('unknown');
  });
  test('is armed if the activity or the guard is', () => {
    expect(coilsWord({ open: 'b', armed: true, guard }, true)).toBe('armed');
    expect(coilsWord({ open: 'b', armed: false, guard: { ...guard, state: 'armed' } }, true)).toBe('armed');
    expect(coilsWord({ open: 'b', armed: false, guard }, true)).toBe('off');
    expect(coilsWord({ open: 'b', guard: null }, true)).toBe('off');
  });
  test('is a fault if the guard has tripped', () => {
    expect(coilsWord({ open: 'b', armed: true, guard: { ...guard, state: 'tripped' } }, true)).toBe('fault');
  });
});

test('times are clocks', () => {
  expect([0, 5.9, 65, 3599.9, 3725, -1].map(clockText)).toEqual(['0:00', '0:05', '1:05', '59:59', '1:02:05', '0:00']);
});
test('a scale bar has a round length that fits', () => {
  expect([123, 99, 4.9, 0.21].map(barLength)).toEqual([100, 50, 2, 0.2]);
});
test('an unknown part of the address is the camera', () => {
  expect([partOf(undefined), partOf('nope'), partOf('jog')]).toEqual(['camera', 'camera', 'jog']);
});
