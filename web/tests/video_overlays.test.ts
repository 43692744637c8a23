import { describe, expect, test } from 'vitest';
import { available, ellipseOf, itemAt, lastNotAfter, readOverlays } from '../src/video/overlays';

describe('files of the program', () => {
  test('tracks', () => {
    const o = readOverlays('track,frame,t_s,x_px,y_px,mass,snr\n8,1,0.2,5,6,1,1\n3,0,0.1,1,2,1,1\n8,0,0.1,3,4,1,1\n')!;
    expect(o.tracks).toEqual([{ t_s: [0.1, 0.2], x: [3, 5], y: [4, 6] }, { t_s: [0.1], x: [1], y: [2] }]);
    expect(available(o)).toEqual(['detections', 'tracks']);
  });
  test('swarm, with its covariance', () => {
    const o = readOverlays('frame,t_s,signal,x_px,y_px,var_xx_px2,var_xy_px2,var_yy_px2\n0,0.5,9,1,2,4,1,3\n1,0.6,9,,,4,1,3\n')!;
    expect(o.swarm).toEqual([{ t_s: 0.5, x: 1, y: 2, xx: 4, xy: 1, yy: 3 }]);
  });
  test('the series of a run: the truth, otherwise the estimate', () => {
    const names = ['true', 'estimated'].flatMap((p) => ['centroid_x_px', 'centroid_y_px', 'sigma_x_px', 'sigma_y_px'].map((n) => `${p}_${n}`));
    expect(readOverlays(`frame,t_s,${names.join()}\n0,0.1,1,2,3,4,5,6,7,8\n`)!.swarm).toEqual([{ t_s: 0.1, x: 1, y: 2, xx: 9, xy: 0, yy: 16 }]);
    expect(readOverlays(`frame,t_s,${names.join()}\n0,0.1,,,,,5,6,7,8\n`)!.swarm).toEqual([{ t_s: 0.1, x: 5, y: 6, xx: 49, xy: 0, yy: 64 }]);
  });
  test('activity of the first video', () => {
    const o = readOverlays('video,t0_s,t1_s,activity,along\n1,0,0.5,7,1\n1,0.5,1,9,1\n2,0,0.5,100,1\n')!;
    expect(o.activity).toEqual({ t_s: [0.25, 0.75], value: [7, 9] });
  });
  test('segments, with the directions of the page', () => {
    const o = readOverlays(JSON.stringify({ videos: [{ segments: [{ t0_s: 5.6, t1_s: 8.5, direction_deg: 270 }], response: { reversal_s: 1 } }] }))!;
    expect(o).toEqual({ segments: [{ from_s: 5.6, to_s: 8.5, direction_deg: 90 }], reversal_s: 1 });
  });
  test('edge of a drop', () => {
    expect(readOverlays('{"center_px":[258.2,228.4],"radius_px":162.8}')).toEqual({ edge: { x: 258.2, y: 228.4, radius: 162.8 } });
  });
  test('others are refused', () => {
    expect(['', 'a,b\n1,2', '{', '{"videos":[]}', '{"center_px":[1,2]}', 't_s,x\n1,2'].map(readOverlays)).toEqual(Array(6).fill(null));
  });
});

describe('the items of a frame', () => {
  test('are the last ones that are not after it', () => {
    expect([-1, 0, 0.5, 2, 9].map((t) => lastNotAfter([0, 1, 2], t))).toEqual([-1, 0, 0, 2, 2]);
    const items = [{ t_s: 1 }, { t_s: 2 }];
    expect([0.5, 1, 1.4, 1.6, 2.2].map((t) => itemAt(items, t, 0.5)?.t_s)).toEqual([undefined, 1, 1, undefined, 2]);
  });
});

test('the ellipse follows the covariance: its axes are the eigenvectors', () => {
  expect(ellipseOf({ xx: 9, xy: 0, yy: 4 })).toEqual({ major: 3, minor: 2, angle: 0 });
  const e = ellipseOf({ xx: 5, xy: 4, yy: 5 }); // eigenvalues 9 and 1
  expect([e.major, e.minor, e.angle].map((v) => Number(v.toFixed(12)))).toEqual([3, 1, Number((Math.PI / 4).toFixed(12))]);
  expect(ellipseOf({ xx: 4, xy: 0, yy: 9 }).angle).toBeCloseTo(Math.PI / 2, 12);
});
