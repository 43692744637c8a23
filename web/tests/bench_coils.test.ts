import { beforeEach, describe, expect, test, vi } from 'vitest';
import { AssistantDraft, foundOf, isDone, measureSensing } from '../src/bench/assistant.svelte';
import { changedCoil, checkRows, coilsToml, coilToml, voltsFor, withCoils, type Row } from '../src/bench/coils';

const coil = { channel: '0', gain: '0.2 A/V', neutral: '2.5 V', polarity: 1, table: [], least_volts: '0 V', most_volts: '5 V', max_current: '0.45 A', sense: '' };
const rows = (...pairs: [string, string][]): Row[] => pairs.map(([volts, amperes]) => ({ volts, amperes }));
const kGood = rows(['5', '0.49'], ['0', '-0.52'], ['2,46', '0'], ['', '']);

describe('the voltage of a current', () => {
  test('follows gain and neutral, polarity, and the range of the output', () => {
    expect(voltsFor(coil, 0.1)).toBeCloseTo(3);
    expect(voltsFor({ ...coil, polarity: -1 }, 0.1)).toBeCloseTo(2);
    expect(voltsFor(coil, 2)).toBe(5);
  });
  test('is interpolated in a table, also one whose currents decrease', () => {
    expect(voltsFor({ ...coil, table: [[0, -0.5], [2.5, 0], [5, 0.25]] }, 0.125)).toBeCloseTo(3.75);
    expect(voltsFor({ ...coil, table: [[0, 0.5], [5, -0.5]] }, 0.25)).toBeCloseTo(1.25);
  });
});

describe('a calibration', () => {
  test('is accepted in any order of its rows', () => {
    expect(checkRows(kGood, coil)).toBeUndefined();
    expect(foundOf({ lamp: '', needle: '', sensed: [], rows: kGood }, coil)).toEqual({ reversed: false, table: [[0, -0.52], [2.46, 0], [5, 0.49]] });
  });
  test.each([
    ['assistant.bad.few', rows(['0', '1'])],
    ['assistant.bad.row', rows(['0', '1'], ['5', 'x'])],
    ['assistant.bad.row', rows(['0', '1'], ['5', ''])],
    ['assistant.bad.twice', rows(['0', '-1'], ['0', '1'])],
    ['assistant.bad.monotonic', rows(['0', '-1'], ['2', '1'], ['5', '0.5'])],
    ['assistant.bad.monotonic', rows(['0', '0'], ['2', '0'])],
    ['assistant.bad.zero', rows(['4', '1'], ['5', '1.1'])],
  ])('is refused: %s', (word, bad) => {
    expect(checkRows(bad as Row[], coil)?.[0]).toBe(word);
    expect(foundOf({ lamp: '', needle: '', sensed: [], rows: bad as Row[] }, coil).table).toBeNull();
  });
});

describe('the coil table', () => {
  test('has the measured table in place of gain and neutral', () => {
    const text = coilToml(changedCoil(coil, { reversed: true, table: [[0, -0.52], [5, 0.49]] }));
    expect(text).toBe('[[rig.coil]]\nchannel = "0"\npolarity = -1\ntable = [[0, -0.52], [5, 0.49]]\nleast_volts = "0 V"\nmost_volts = "5 V"\nmax_current = "0.45 A"');
  });
  test('keeps gain and neutral without a measurement, and reverses a reversed coil to 1', () => {
    expect(changedCoil({ ...coil, polarity: -1 }, { reversed: true, table: null })).toMatchObject({ polarity: 1, gain: '0.2 A/V', neutral: '2.5 V' });
    expect(coilToml(coil)).toContain('gain = "0.2 A/V"');
    expect(coilToml(coil)).not.toContain('polarity');
  });
  test('replaces only the tables of the coils in a scene', () => {
    const scene = '# A bench\ntitle = "x"\n\n[rig]\n\n[[rig.coil]]   # first\nchannel = "0"\ntable = [\n  [0.0, -0.5],\n  [5.0, 0.5]\n]\n[[ rig . coil ]]\nchannel = "1"\n\n[rig.guard]  # limits\nmax_slew = "1 A/s"\n';
    expect(withCoils(scene, coilsToml([coil]))).toBe(`# A bench\ntitle = "x"\n\n[rig]\n\n[rig.guard]  # limits\nmax_slew = "1 A/s"\n\n${coilToml(coil)}\n`);
    expect(withCoils('[rig]\n', 'X\n')).toBe('[rig]\n\nX\n');
  });
});

describe('the assistant', () => {
  beforeEach(() => {
    const kept = new Map<string, string>();
    vi.stubGlobal('localStorage', { getItem: (k: string) => kept.get(k) ?? null, setItem: (k: string, v: string) => kept.set(k, v) });
  });
  test('continues after a reload, for each scene', () => {
    const first = new AssistantDraft('bench', 2);
    first.go('polarity', 1);
    first.set({ needle: 'reversed', rows: kGood });
    const second = new AssistantDraft('bench', 2);
    expect([second.step, second.coil, second.now.needle, second.now.rows]).toEqual(['polarity', 1, 'reversed', kGood]);
    expect(new AssistantDraft('other', 2).now.needle).toBe('');
    expect(new AssistantDraft('bench', 1)).toMatchObject({ coil: 0 }); // the scene has fewer coils now
  });
  test('a step is done only with its result', () => {
    const none = { lamp: '' as const, needle: '' as const, sensed: [], rows: [] };
    expect(isDone('lamp', { ...none, lamp: 'other' }, coil, 0.05)).toBe(false);
    expect(isDone('lamp', { ...none, lamp: 'only' }, coil, 0.05)).toBe(true);
    expect(isDone('sensing', none, coil, 0.05)).toBe(false);
    expect(isDone('sensing', { ...none, sensed: [{ set: 0.1, sensed: 0.16 }] }, coil, 0.05)).toBe(false);
    expect(isDone('sensing', { ...none, sensed: [{ set: 0.1, sensed: null }] }, coil, 0.05)).toBe(false);
    expect(isDone('sensing', { ...none, sensed: [{ set: 0.1, sensed: 0.12 }] }, coil, 0.05)).toBe(true);
    expect(isDone('calibration', { ...none, rows: kGood }, coil, 0.05)).toBe(true);
  });
  test('measures at five currents and ends at zero; it stops with the session', async () => {
    const session = { state: 'live' as string, max: [0.4], coils: [] as any[], sets: [] as number[], set(_: number, a: number) { this.sets.push(a); this.coils = [{ current_a: a, sensed_a: a + 0.01, max_a: 0.4 }]; } };
    const sensed = await measureSensing(session as any, 0, async () => {});
    expect(session.sets).toEqual([-0.2, -0.1, 0, 0.1, 0.2, 0]);
    expect(sensed.map((s) => s.set)).toEqual([-0.2, -0.1, 0, 0.1, 0.2]);
    expect(sensed[0].sensed).toBeCloseTo(-0.19);
    session.sets = [];
    const cut = await measureSensing(session as any, 0, async () => void (session.state = 'ended'));
    expect(cut).toEqual([]);
    expect(session.sets).toEqual([-0.2, 0]);
  });
});
