import { describe, expect, test } from 'vitest';
import { inverse, mayPropose, nextDropName, pathInLab, proposedExposures, refusalOf, scaleChanges, scaleOf, scaleText, scaleUncertainty, swimmingDirection, valueAt, type Experiment } from '../src/pages/experiments/experiment';

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
  test('an error is about one value of an item, or about the item', () => {
    expect(refusalOf({ where: 'video[1].exposure', what: '-1 s is below the minimum' })).toEqual({ list: 'video', index: 1, key: 'exposure' });
    expect(refusalOf({ where: 'video[0]', what: 'to = 3 s is not later than from = 4 s' })).toEqual({ list: 'video', index: 0, key: 'to' });
    expect(refusalOf({ where: 'drop[1]', what: 'name = "A" is used by another drop' })).toEqual({ list: 'drop', index: 1, key: 'name' });
    expect(refusalOf({ where: 'video[2].segment[1]', what: 'to = 3 s is not later than from = 4 s' })).toEqual({ list: 'video', index: 2, key: 'segment' });
    expect(refusalOf({ where: 'drop[1]', what: 'key "name" is missing' })).toBeNull();
    expect(refusalOf({ where: 'um_per_px', what: '0 is below the minimum' })).toBeNull();
  });
  test('paths for the lab', () => {
    expect(pathInLab('x', 'videos/a.mp4')).toBe('experiments/x/videos/a.mp4');
    expect(pathInLab('x', '../../films/./a.mp4')).toBe('films/a.mp4');
    expect(pathInLab('x', '/data/a.mp4')).toBe('/data/a.mp4');
  });
  test('a scale has its standard error, and is not mixed with that of the experiment', () => {
    const e: Experiment = { um_per_px: 0.64, um_per_px_se: 0.0123, um_per_px_source: 'calibration', video: [{ file: 'a' }, { file: 'b', um_per_px: 2 }, { file: 'c', um_per_px: 2, um_per_px_se: 0.2 }] };
    const [a, b, c] = e.video!;
    expect(scaleText(scaleOf(e, a)!)).toBe('0.640 ± 0.012 µm/px');
    expect(scaleText(scaleOf(e, b)!)).toBe('2 µm/px');
    expect(scaleOf({}, a)).toBeUndefined();
    expect(scaleUncertainty({ ...e, video: [a, b] })).toBe(0.0192);
    expect(scaleUncertainty({ ...e, video: [a, c] })).toBe(0.1); // the largest
    expect(scaleUncertainty({ video: [b] })).toBeUndefined();
    expect(scaleChanges(['video', 'c'], {})).toEqual(['um_per_px', 'um_per_px_se', 'um_per_px_source'].map((key) => ({ path: ['video', 'c', key], to: undefined })));
  });
  test('names of drops', () => {
    expect(nextDropName([])).toBe('A');
    expect(nextDropName(experiment.drop!)).toBe('D');
  });
});
