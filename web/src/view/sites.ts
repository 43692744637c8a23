// Draws an occupancy grid: each occupied site is a square, in the colour of its swarm or of the density.

import type { Sites } from '../frame';
import type { Box, Camera } from './camera';
import type { Density } from './density';

const kGridFrom = 20000; // cells; smaller swarms have small messages, and show the headings of their cells
const kPositionBits = 33, kWorth = 0.5; // bits of a cell with its position; the grid has to be half as large
const kStep = 32; // sites; the number changes in steps, not with every step of the zoom

/**
 * The number of sites along the longer side of the box for a picture with `along` pixels there: one per pixel, or 0 if the
 * positions of the cells are smaller than the grid.
 */
export function wantedSites(cells: number, swarms: number, along: number): number {
  const sites = Math.ceil(along / kStep) * kStep, bits = swarms * sites * sites; // most swarms have one plane that is not empty
  return cells > kGridFrom && bits < kPositionBits * cells * kWorth ? sites : 0;
}

export interface Canvas {
  px: Uint32Array;
  width: number;
  height: number;
}
export interface SiteStyle {
  /** Colour of each plane. */
  colours: number[];
  /** Side of a cell, px of the canvas. */
  size: number;
  /** Colour by density in place of that of the plane: its colours by shade. */
  density: { density: Density; tints: number[] } | null;
}

/** Positions of the columns or rows of a grid on the canvas; -1: not on it. */
function places(count: number, low: number, high: number, sites: number, longer: number, scale: number, offset: number, size: number, end: number): Int32Array {
  const step = longer / sites, at = new Int32Array(count);
  for (let k = 0; k < count; ++k) {
    const p = Math.floor(Math.min(high, low + (k + 0.5) * step) * scale + offset) - (size >> 1);
    at[k] = p >= 0 && p + size <= end ? p : -1;
  }
  return at;
}

export function drawSites(canvas: Canvas, s: Sites, box: Box, camera: Camera, style: SiteStyle) {
  const { px, width } = canvas, { size } = style, longer = Math.max(box.right - box.left, box.bottom - box.top), most = Math.max(s.columns, s.rows);
  const x = places(s.columns, box.left, box.right, most, longer, camera.scale, camera.x, size, canvas.width);
  const y = places(s.rows, box.top, box.bottom, most, longer, camera.scale, camera.y, size, canvas.height);
  const d = style.density, squareX = new Uint16Array(s.columns), squareY = new Uint16Array(s.rows);
  if (d) {
    const scale = longer / most / d.density.side;
    for (let c = 0; c < s.columns; ++c) squareX[c] = Math.min(d.density.columns - 1, Math.floor((c + 0.5) * scale));
    for (let r = 0; r < s.rows; ++r) squareY[r] = Math.min(d.density.rows - 1, Math.floor((r + 0.5) * scale)) * d.density.columns;
  }
  s.planes.forEach((plane, p) => {
    for (let i = 0; i < plane.length; ++i) {
      for (let bits = plane[i]; bits; bits &= bits - 1) {
        const site = 8 * i + (31 - Math.clz32(bits & -bits)), r = (site / s.columns) | 0, c = site - r * s.columns;
        const left = x[c], top = y[r];
        if (left < 0 || top < 0) continue;
        const colour = d ? d.tints[d.density.shades[squareY[r] + squareX[c]]] : style.colours[p];
        let at = top * width + left;
        for (let b = 0; b < size; ++b, at += width) for (let a = 0; a < size; ++a) px[at + a] = colour;
      }
    }
  });
}
