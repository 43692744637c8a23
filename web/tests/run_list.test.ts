import { describe, expect, test } from 'vitest';
import { kWords } from '../src/i18n';
import { columnWord, dateText, durationText, errorText, found, kColumns, sorted, tagsOf, type RunCard } from '../src/pages/runs/run_list';
import { bytesText } from '../src/units';

const run = (name: string, more: Partial<RunCard> = {}): RunCard => ({
  name,
  title: '',
  date: '2026-03-01T12:00:00Z',
  complete: true,
  writing: false,
  frames: 100,
  duration_s: 4,
  recorded_s: null,
  seed: '1',
  state_hash: '',
  cells: 100,
  model: 'dipole',
  bytes: 1000,
  files: [],
  tags: [],
  note: '',
  measured: true,
  controller: 'fuzzy',
  has_setpoint: true,
  settling_time_s: 1,
  steady_rms_px: 3,
  ...more,
});
const names = (runs: RunCard[]) => runs.map((r) => r.name);

describe('sorting', () => {
  test('names with numbers in the order of the numbers', () => {
    const runs = [run('steer-10'), run('steer-2'), run('Steer-1')];
    expect(names(sorted(runs, 'name', false))).toEqual(['Steer-1', 'steer-2', 'steer-10']);
    expect(names(sorted(runs, 'name', true))).toEqual(['steer-10', 'steer-2', 'Steer-1']);
    expect(names(runs)).toEqual(['steer-10', 'steer-2', 'Steer-1']);
  });
  test('settled: not settled is the longest, without a setpoint last in both directions', () => {
    const runs = [run('open', { has_setpoint: false, settling_time_s: null }), run('never', { settling_time_s: null }), run('slow', { settling_time_s: 9 }), run('fast', { settling_time_s: 0 })];
    expect(names(sorted(runs, 'settled', false))).toEqual(['fast', 'slow', 'never', 'open']);
    expect(names(sorted(runs, 'settled', true))).toEqual(['never', 'slow', 'fast', 'open']);
  });
  test('seeds as numbers, and by every other column', () => {
    expect(names(sorted([run('b', { seed: '10' }), run('a', { seed: '9' }), run('none', { seed: '' })], 'seed', true))).toEqual(['b', 'a', 'none']);
    const a = run('a', { title: 'A', date: '2025-01-01T00:00:00Z', model: 'basic', duration_s: 1, steady_rms_px: 1, bytes: 5, tags: ['x'] });
    const b = run('b', { title: 'B', date: '2026-01-01T00:00:00Z', duration_s: 2, steady_rms_px: 2, bytes: 6, tags: ['y'] });
    for (const c of kColumns.filter((c) => !['seed', 'settled'].includes(c))) {
      expect(names(sorted([b, a], c, false)), c).toEqual(['a', 'b']);
      expect(names(sorted([a, b], c, true)), c).toEqual(['b', 'a']);
    }
  });
  test('the order of equal runs is kept', () => {
    expect(names(sorted([run('b'), run('a')], 'title', true))).toEqual(['b', 'a']);
  });
  test('each column has a label', () => {
    for (const c of kColumns) expect(kWords.en[columnWord(c)]).toBeTruthy();
  });
});

describe('search', () => {
  const runs = [run('drift-1', { tags: ['Célula'], note: 'second drop' }), run('steer', { title: 'Route', seed: '77' })];
  test('finds names, titles, tags, notes, seeds; in any case, without accents', () => {
    for (const text of ['DRIFT', 'celula', 'CÉLULA', 'second', ' drift  drop ']) expect(names(found(runs, text)), text).toEqual(['drift-1']);
    for (const text of ['route', '77', 'steer fuzzy']) expect(names(found(runs, text)), text).toEqual(['steer']);
  });
  test('needs every word', () => {
    expect(found(runs, 'drift route')).toEqual([]);
    expect(found(runs, '2026-03-01').length).toBe(2);
    expect(found(runs, '  ')).toBe(runs);
  });
});

describe('texts', () => {
  test('of sizes', () => {
    expect([0, 999, 1000, 12_340, 999_400, 1_000_000, 25_600_000, 3e9].map(bytesText)).toEqual(['0 B', '999 B', '1.00 kB', '12.3 kB', '999 kB', '1.00 MB', '25.6 MB', '3.00 GB']);
  });
  test('of durations', () => {
    expect([0, 9.96, 99.94, 99.96, 125, 3725].map(durationText)).toEqual(['0.0 s', '10.0 s', '99.9 s', '1:40 min', '2:05 min', '1:02:05 h']);
  });
  test('of errors: micrometres if the scale is known', () => {
    expect(errorText(run('a', { steady_rms_um: 3.456 }))).toBe('3.46 µm');
    expect(errorText(run('a', { steady_rms_um: null }))).toBe('3.00 px');
    expect(errorText(run('a', { steady_rms_px: null }))).toBe('–');
  });
  test('of dates', () => {
    expect(dateText('', 'en')).toBe('–');
    expect(dateText('2026-03-01T12:00:00Z', 'en')).toMatch(/2026/);
  });
  test('tags are separated by commas, each once', () => {
    expect(tagsOf(' a, b c ,, a,')).toEqual(['a', 'b c']);
  });
});
