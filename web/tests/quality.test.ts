import { describe, expect, test } from 'vitest';
import { copiedField, resultsOf } from '../src/pages/experiments/experiment';
import { qualityOf, titleOf } from '../src/quality/quality';
import { experimentOf } from '../src/results/result';

describe('the quality of a result', () => {
  test('is one of three words', () => {
    expect(qualityOf('doubtful')).toBe('doubtful');
    expect(qualityOf('')).toBeNull();
    expect(qualityOf(undefined)).toBeNull();
  });
  test('a warning has the title of the program, or the words of its aspect', () => {
    const warning = { aspect: 'frame_rate', what: '', evidence: '', advice: '' };
    expect(titleOf({ ...warning, title: 'Frame rate' })).toBe('Frame rate');
    expect(titleOf(warning)).toBe('frame rate');
  });
});

describe('results and their experiment', () => {
  test('by the folder of the result, or by the files of the command', () => {
    expect(experimentOf('experiments/a b/results/x/report.html')).toBe('a b');
    expect(experimentOf('runs/x/report.html', ['track', './experiments/old/videos/1.avi'])).toBe('old');
    expect(experimentOf('runs/x/report.html', ['track', 'my-experiments/old/1.avi'])).toBeUndefined();
  });
  test('an experiment lists its own only', () => {
    const jobs = [{ out: 'experiments/a/results/1', words: [] }, { out: 'experiments/ab/results/1', words: [] }, { out: 'runs/2', words: ['track', 'experiments/a/videos/1.avi'] }];
    expect(resultsOf(jobs, 'a')).toEqual([jobs[0], jobs[2]]);
  });
});

test('the field of a video is copied to the others, where it differs', () => {
  const videos = [{ file: 'a', exposure: '1 s', reversal: '20 s', field_direction: '180 deg' }, { file: 'b', exposure: '2 s', reversal: '20 s', to: '30 s' }];
  expect(copiedField(videos[0], videos)).toEqual([
    { path: ['video', 'b', 'to'], to: undefined },
    { path: ['video', 'b', 'field_direction'], to: '180 deg' },
  ]);
});
