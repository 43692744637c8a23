import { describe, expect, test, vi } from 'vitest';
import { comparedRange, legendDash, recordedSeries, Series, timesFromStart } from '../src/series';

const kNames = ['frame', 't_s', 'centroid_x_px'];
const kRate = 50; // Hz
const row = (frame: number, x = 10 * frame) => [frame, frame / kRate, x];
const rows = (...all: number[][]) => new Float64Array(all.flat());
const frames = (s: Series) => [...s.of('frame')];

/** A series with the frames from 0 to n - 1. */
function filled(n: number, most?: number): Series {
  const s = new Series(most);
  s.begin(kNames);
  for (let i = 0; i < n; ++i) s.take(rows(row(i)), 1);
  return s;
}

describe('taking rows', () => {
  test('appends rows in order', () => {
    const s = filled(0);
    expect(s.take(rows(row(0), row(1)), 2)).toBe(true);
    expect(s.length).toBe(2);
    expect([...s.of('centroid_x_px')]).toEqual([0, 10]);
  });
  test('takes each frame once if messages overlap', () => {
    const s = filled(0);
    s.take(rows(row(1), row(2)), 2);
    expect(s.take(rows(row(1), row(2), row(3)), 3)).toBe(true);
    expect(s.take(rows(row(2), row(3)), 2)).toBe(false);
    expect(frames(s)).toEqual([1, 2, 3]);
  });
  test('reads only as many rows as the message has', () => {
    const s = filled(0);
    s.take(rows(row(1), row(2)), 1);
    expect(frames(s)).toEqual([1]);
  });
  test('keeps NaN values', () => {
    const s = filled(0);
    s.take(rows(row(1, NaN), row(2)), 2);
    expect([...s.of('centroid_x_px')]).toEqual([NaN, 20]);
  });
  test('skips a row without a frame number, and still takes each later frame once', () => {
    const s = filled(2);
    expect(s.take(rows([NaN, 1, 2]), 1)).toBe(false);
    s.take(rows(row(1), row(2)), 2);
    s.take(rows(row(1), row(2)), 2);
    expect(frames(s)).toEqual([0, 1, 2]);
  });
  test('keeps all rows when its arrays grow', () => {
    const s = filled(5000);
    expect(s.length).toBe(5000);
    expect(frames(s).every((f, i) => f === i)).toBe(true);
    expect(s.newest('centroid_x_px')).toBe(49990);
  });
  test('is empty after begin()', () => {
    const s = filled(10);
    s.begin(['frame', 'other']);
    expect(s.length).toBe(0);
    expect(s.take(rows([0, 7]), 1)).toBe(true);
    expect(s.newest('other')).toBe(7);
    expect(s.newest('t_s')).toBeNaN();
  });
});

describe('thinning', () => {
  test('removes every second row of the older half before a row is added to a full series', () => {
    expect(frames(filled(8, 8))).toEqual([0, 1, 2, 3, 4, 5, 6, 7]);
    expect(frames(filled(9, 8))).toEqual([0, 2, 4, 5, 6, 7, 8]);
    expect(frames(filled(11, 8))).toEqual([0, 4, 6, 7, 8, 9, 10]);
  });
  test('an odd capacity', () => {
    expect(frames(filled(8, 7))).toEqual([0, 2, 3, 4, 5, 6, 7]);
    expect(frames(filled(11, 10))).toEqual([0, 2, 4, 5, 6, 7, 8, 9, 10]);
  });
  test('columns stay together', () => {
    const s = filled(25, 10), n = frames(s);
    expect([n[0], n.at(-1)]).toEqual([0, 24]);
    expect([...s.of('centroid_x_px')]).toEqual(n.map((f) => 10 * f));
    expect(s.rowAt(23 / kRate)).toBe(n.indexOf(23));
  });
  test('a live series keeps at most 30000 rows', () => {
    const s = filled(0), n = 100000;
    s.take(new Float64Array(Array.from({ length: n }, (_, i) => row(i)).flat()), n);
    expect(s.length).toBeLessThanOrEqual(30000);
    expect([s.of('frame')[0], s.newest('frame')]).toEqual([0, n - 1]);
  });
});

describe('reading', () => {
  test('an unknown column is not a number, as long as the series', () => {
    const s = filled(3);
    expect([...s.of('nothing')]).toEqual([NaN, NaN, NaN]);
    expect(s.newest('nothing')).toBeNaN();
  });
  test('an empty series', () => {
    const s = filled(0);
    expect(s.newest('t_s')).toBeNaN();
    expect(s.rowAt(1)).toBe(-1);
    expect(s.csv()).toBe('frame,t_s,centroid_x_px\n');
  });
  test('the last row that is not after a time', () => {
    const s = filled(100);
    expect(s.rowAt(-1)).toBe(-1);
    expect(s.rowAt(0)).toBe(0);
    expect(s.rowAt(0.019)).toBe(0);
    expect(s.rowAt(99)).toBe(99);
    for (let i = 0; i < 100; ++i) {
      expect(s.rowAt(i / kRate)).toBe(i);
    }
    expect(s.rowAt(0.1 + 0.2)).toBe(15); // 0.30000000000000004
    expect(s.rowAt(0.3 - 1e-12)).toBe(15);
  });
});

describe('CSV', () => {
  const answers = (body: string | null) => {
    const fetch = vi.fn(async (_: string) => new Response(body, { status: body === null ? 404 : 200 }));
    vi.stubGlobal('fetch', fetch);
    return fetch;
  };

  test('writes a header and empty cells for values that are not finite', () => {
    const s = filled(0);
    s.take(rows([0, 0, NaN], [1, 0.02, 1e-7], [2, 0.04, -Infinity]), 3);
    expect(s.csv()).toBe('frame,t_s,centroid_x_px\n0,0,\n1,0.02,1e-7\n2,0.04,\n');
  });
  test('a recorded series is what was written', async () => {
    const s = filled(0);
    s.take(rows([0, 0, NaN], [1, 0.02, 1e-7], [2, 0.04, 3]), 3);
    const fetch = answers(s.csv());
    const back = (await recordedSeries('a run'))!;
    expect(fetch).toHaveBeenCalledWith('/api/runs/a%20run/series.csv');
    expect(back.names).toEqual(kNames);
    expect(back.csv()).toBe(s.csv());
  });
  test('a recorded series keeps all of its rows', async () => {
    answers(['frame,t_s', ...Array.from({ length: 40000 }, (_, i) => `${i},${i / kRate}`)].join('\n') + '\n');
    const s = (await recordedSeries('long'))!;
    expect([s.length, s.of('frame')[0], s.newest('frame')]).toEqual([40000, 0, 39999]);
    expect(s.rowAt(0)).toBe(0);
  });
  test('a header without rows', async () => {
    answers('frame,t_s\n');
    expect((await recordedSeries('empty'))!.length).toBe(0);
  });
  test('returns null after an error of the server or of the network', async () => {
    answers(null);
    expect(await recordedSeries('x')).toBeNull();
    vi.stubGlobal('fetch', () => Promise.reject(new TypeError('network')));
    expect(await recordedSeries('x')).toBeNull();
  });
});

test('a quantity of the swarm is the truth if available, otherwise the estimate, otherwise the column of version 0.1', () => {
  const named = (...names: string[]) => {
    const s = new Series();
    s.begin(names);
    return s.swarmColumn('sigma_x_px');
  };
  expect(named('frame', 'estimated_sigma_x_px', 'true_sigma_x_px')).toBe('true_sigma_x_px');
  expect(named('frame', 'estimated_sigma_x_px')).toBe('estimated_sigma_x_px');
  expect(named('frame', 'sigma_x_px')).toBe('sigma_x_px');
});

describe('the time range of a comparison', () => {
  const recorded = filled(101); // 2 s
  test('ends at twice the duration of the recorded run', () => {
    expect(comparedRange(filled(10001), recorded, 0, 200)).toEqual([0, 4]);
  });
  test('has a shorter live run and the recorded run in full', () => {
    expect(comparedRange(filled(51), recorded, 0, 2)).toEqual([0, 2]);
  });
  test('is that of all data if the live run has no rows in it', () => {
    const late = filled(0);
    late.take(rows(row(1000), row(1001)), 2);
    expect(comparedRange(late, recorded, 0, 20.02)).toEqual([0, 20.02]);
    expect(comparedRange(filled(51), filled(0), 0, 1)).toEqual([0, 1]);
  });
});

test('a recording that begins later is aligned with the start', () => {
  const s = filled(0);
  s.take(rows(row(100), row(101), row(150)), 3);
  [0, 0.02, 1].forEach((t, i) => expect(timesFromStart(s)[i]).toBeCloseTo(t, 12));
  expect(comparedRange(filled(10001), s, 0, 200)[1]).toBeCloseTo(2, 12);
  expect([...timesFromStart(filled(0))]).toEqual([]);
});

describe('the legend of a plot with a recorded run', () => {
  test('has solid lines for the live run and dashed lines for the recorded run', () => {
    const lines = 2, all = [0, 1, 2, 3, 4].map((index) => legendDash(lines, index)); // time, two live lines, two recorded lines
    expect(all).toEqual(['solid', 'solid', 'solid', 'dashed', 'dashed']);
  });
});
