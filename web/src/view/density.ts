// Number density of the cells on a grid over the arena, and its colour scale.

import type { Frame, Sites } from '../frame';
import type { Box } from './camera';
import type { Rgb } from './cells';

/** Swarms with more cells show their density unless the user switches it off: single cells overlap. */
export const kLargeSwarm = 20000;
const kSquares = 64; // along the longer side, as in the occupancy grid of the program
const kWithin = 0.98; // fraction of the occupied squares that are within the colour scale; cells pile up at walls
const kNice = [1, 1.5, 2, 3, 4, 5, 6, 8, 10];

export interface Density {
  columns: number;
  rows: number;
  /** Side of a square, image px. */
  side: number;
  counts: Uint32Array;
  /** Colour of each square: an index from 0 to kSteps - 1. */
  shades: Uint8Array;
  /** Upper end of the colour scale, cells per unit area (see densityOf). */
  most: number;
}
export const kSteps = 32;

/** The next number that is a step of kNice times a power of ten and is not smaller. */
export function niceCeiling(v: number): number {
  if (!(v > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(v) + 1e-12);
  return kNice.map((k) => k * power).find((k) => k >= v * (1 - 1e-9))!;
}

/** `unit`: side of the unit of area in image px, such as 1 mm. */
export function densityOf(f: Pick<Frame, 'xy' | 'cells'> & { sites?: Sites | null }, box: Box, unit: number): Density {
  const width = box.right - box.left, height = box.bottom - box.top, side = Math.max(width, height) / kSquares;
  const { columns, rows, cells: counts } = f.sites?.counts ?? countsOf(f, box, Math.ceil(width / side - 1e-9), Math.ceil(height / side - 1e-9), side);
  const occupied = counts.filter((n) => n > 0).sort(), high = occupied.length ? occupied[Math.floor(kWithin * (occupied.length - 1))] : 0;
  const perUnit = (unit / side) ** 2, most = niceCeiling(high * perUnit);
  const shades = new Uint8Array(counts.length);
  for (let k = 0; k < counts.length; ++k) shades[k] = Math.min(kSteps - 1, Math.floor((counts[k] * perUnit * kSteps) / most));
  return { columns, rows, side, counts, shades, most };
}

function countsOf(f: Pick<Frame, 'xy' | 'cells'>, box: Box, columns: number, rows: number, side: number): Sites['counts'] {
  const cells = new Uint32Array(columns * rows), square = squareOf(f, box, { columns, rows, side });
  for (let i = 0; i < f.cells; ++i) ++cells[square(i)];
  return { columns, rows, cells };
}

/** The square of a cell. */
export function squareOf(f: Pick<Frame, 'xy'>, box: Box, { columns, rows, side }: Pick<Density, 'columns' | 'rows' | 'side'>) {
  const { xy } = f, parts = xy instanceof Uint16Array;
  const kx = (parts ? (box.right - box.left) / 65535 : 1) / side, ky = (parts ? (box.bottom - box.top) / 65535 : 1) / side;
  const ox = parts ? 0 : -box.left / side, oy = parts ? 0 : -box.top / side;
  return (i: number) => {
    const c = Math.min(columns - 1, Math.max(0, (xy[2 * i] * kx + ox) | 0));
    const r = Math.min(rows - 1, Math.max(0, (xy[2 * i + 1] * ky + oy) | 0));
    return r * columns + c;
  };
}

// Viridis (van der Walt and Smith, 2015) without its end that has little contrast to the background.
const kDark: Rgb[] = [[65, 68, 135], [49, 104, 142], [33, 145, 140], [53, 183, 121], [144, 215, 67], [253, 231, 37]];
const kLight: Rgb[] = [[122, 190, 60], [53, 170, 112], [33, 145, 140], [49, 104, 142], [68, 57, 131], [68, 1, 84]];

/** Colours from low to high density, kSteps of them. */
export function densityColours(dark: boolean): Rgb[] {
  const stops = dark ? kDark : kLight;
  return Array.from({ length: kSteps }, (_, k) => {
    const at = (k / (kSteps - 1)) * (stops.length - 1), i = Math.min(stops.length - 2, Math.floor(at));
    return [0, 1, 2].map((c) => Math.round(stops[i][c] + (at - i) * (stops[i + 1][c] - stops[i][c]))) as Rgb;
  });
}
