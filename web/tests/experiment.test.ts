import { describe, expect, test } from 'vitest';
import { inverse, mayPropose, nextDropName, proposedExposures, swimmingDirection, valueAt, type Experiment } from '../src/pages/experiments/experiment';

const experiment: Experiment = {
  title: 'x',
  drop: [{ name: 'A', polarity: 'south' }, { name: 'B', polarity: 'north' }, { name: 'C' }],
  video: [
    { file: 'a', drop: 'A', field_direction: '180 deg', exposure: '100 s' },
    { file: 'b', drop: 'B', field_direction: '90 deg' },
    { file: 'c', drop: 'C', field_direction: '90 deg' },
    { file: 'd', drop: 'A' },
  ],
};

describe('an experiment', () => {
  test('south-seeking cells swim against the field', () => {
    expect(experiment.video!.map((v) => swimmingDirection(experiment, v))).toEqual([0, 90, undefined, undefined]);
  });
  test('values by their path', () => {
    expect(valueAt(experiment, ['title'])).toBe('x');
    expect(valueAt(experiment, ['video', 'a', 'exposure'])).toBe('100 s');
    expect(valueAt(experiment, ['drop', 'B'])).toBe(experiment.drop![1]);
    expect(valueAt(experiment, ['video', 'none', 'exposure'])).toBeUndefined();
  });
  test('changes are undone in reverse order, also of an identity', () => {
    expect(inverse([{ path: ['drop', 'A', 'name'], from: 'A', to: 'D' }, { path: ['video', 'a', 'drop'], from: 'A', to: 'D' }])).toEqual([
      { path: ['video', 'a', 'drop'], from: 'D', to: 'A' },
      { path: ['drop', 'D', 'name'], from: 'D', to: 'A' },
    ]);
  });
  test('exposure times are relative to a known one, and are not proposed without', () => {
    const videos = [{ file: 'a', exposure: '100 s' }, { file: 'b' }, { file: 'c', exposure: '7 s' }, { file: 'd' }];
    expect(proposedExposures(videos, { a: 1100, b: 1300, c: 1500, d: 0 })).toEqual([{ path: ['video', 'b', 'exposure'], to: '300 s' }]);
    expect(mayPropose([{ file: 'a' }])).toBe(false);
    expect(proposedExposures([{ file: 'a' }, { file: 'b' }], { a: 1000, b: 2000 })).toEqual([]);
  });
  test('names of drops', () => {
    expect(nextDropName([])).toBe('A');
    expect(nextDropName(experiment.drop!)).toBe('D');
  });
});
