import { describe, expect, test } from 'vitest';
import type { Sites } from '../src/frame';
import { Camera } from '../src/view/camera';
import { densityOf } from '../src/view/density';
import { correlation } from '../src/view/ellipse';
import { drawSites, wantedSites } from '../src/view/sites';

describe('the wanted number of sites', () => {
  test('is one per pixel of the picture, in steps', () => {
    expect(wantedSites(1e5, 1, 400)).toBe(416);
    expect(wantedSites(1e5, 1, 416)).toBe(416);
  });
  test('is 0, for positions, in small swarms, and where the grid would be larger than the positions', () => {
    expect(wantedSites(20000, 1, 300)).toBe(0);
    expect(wantedSites(1e5, 1, 2000)).toBe(0);
    expect(wantedSites(1e6, 1, 2000)).toBeGreaterThan(0);
    expect(wantedSites(1e5, 1, 992)).toBe(992);
    expect(wantedSites(1e5, 4, 700)).toBe(0);
  });
});

const box = { left: 0, top: 0, right: 8, bottom: 4 };
/** A grid of 8 x 4 sites with two planes. */
function grid(on: [number, number][], off: [number, number][] = []): Sites {
  const plane = (cells: [number, number][]) => {
    const bits = new Uint8Array(4);
    for (const [c, r] of cells) bits[r] |= 1 << c;
    return bits;
  };
  return { columns: 8, rows: 4, planes: [plane(on), plane(off)], counts: { columns: 64, rows: 32, cells: new Uint32Array(64 * 32) } };
}
function drawn(s: Sites, scale: number, size: number, shift = 0): string[] {
  const width = 8 * scale, height = 4 * scale, px = new Uint32Array(width * height), camera = new Camera();
  camera.scale = scale;
  camera.x = shift;
  camera.y = 0;
  drawSites({ px, width, height }, s, box, camera, { colours: [1, 2], size, density: null });
  return Array.from({ length: height }, (_, y) => [...px.subarray(y * width, (y + 1) * width)].map((v) => '.ox'[v]).join(''));
}

describe('drawing', () => {
  test('every occupied site is a pixel in the colour of its plane', () => {
    expect(drawn(grid([[0, 0], [7, 3], [3, 1]], [[4, 2]]), 1, 1)).toEqual(['o.......', '...o....', '....x...', '.......o']);
  });
  test('larger cells are squares about the centre of their site', () => {
    expect(drawn(grid([[1, 1]]), 2, 2)).toEqual(['................', '................', '..oo............', '..oo............', '................', '................', '................', '................']);
  });
  test('sites outside of the canvas are not drawn', () => {
    expect(drawn(grid([[0, 0], [7, 0]]), 1, 1, -3)).toEqual(['....o...', '........', '........', '........']);
  });
});

test('density and correlation are computed from the counts', () => {
  const s = grid([]);
  for (let k = 0; k < 32; ++k) s.counts.cells[k * 64 + 2 * k] = 5; // a diagonal
  const f = { xy: new Uint16Array(0), cells: 160, sites: s };
  expect(correlation(f)).toBeCloseTo(1, 9);
  const d = densityOf(f, box, 8 / 64);
  expect([d.counts.reduce((a, n) => a + n), d.most]).toEqual([160, 5]);
});
