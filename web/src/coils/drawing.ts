// The colour map and the arrows of the field on a canvas.

import { kAxes, type Plane } from './geometry';

export const kLeast = 1e-6, kMost = 1e-2; // T, ends of the logarithmic colour scale
const kDecades = Math.log10(kMost / kLeast);

export interface Grid {
  /** Row by row from the top: x, y, z in nT; null where the field is unknown. */
  nt: (number | null)[];
  columns: number;
  rows: number;
}

/** Position of a field strength on the colour scale, 0 to 1. */
export const level = (tesla: number) => Math.min(1, Math.max(0, Math.log10(tesla / kLeast) / kDecades));

// From weak to strong; the weak end is the ground of the page.
const kLight = [[255, 255, 255], [214, 233, 245], [140, 192, 226], [63, 139, 192], [0, 82, 138]];
const kDark = [[11, 16, 23], [18, 44, 66], [24, 80, 116], [44, 130, 176], [110, 190, 232]];
export function colour(at: number, dark: boolean): [number, number, number] {
  const stops = dark ? kDark : kLight, x = at * (stops.length - 1), i = Math.min(stops.length - 2, Math.floor(x)), f = x - i;
  return [0, 1, 2].map((k) => Math.round(stops[i][k] + f * (stops[i + 1][k] - stops[i][k]))) as [number, number, number];
}

/** The component of the field in the plane of the view at a point of the grid, T; null where it is unknown. */
export function inPlane({ nt }: Grid, plane: Plane, i: number): [number, number] | null {
  const a = nt[3 * i + kAxes[plane][0]], b = nt[3 * i + kAxes[plane][1]];
  return a == null || b == null ? null : [a * 1e-9, b * 1e-9];
}

function map(grid: Grid, plane: Plane, dark: boolean): HTMLCanvasElement {
  const small = document.createElement('canvas');
  small.width = grid.columns;
  small.height = grid.rows;
  const context = small.getContext('2d')!, pixels = context.createImageData(grid.columns, grid.rows);
  for (let i = 0; i < grid.columns * grid.rows; ++i) {
    const b = inPlane(grid, plane, i);
    pixels.data.set(b ? [...colour(level(Math.hypot(...b)), dark), 255] : [128, 128, 128, 255], 4 * i);
  }
  context.putImageData(pixels, 0, 0);
  return small;
}

/** Arrows of equal length: the colour shows the strength. */
function arrows(context: CanvasRenderingContext2D, grid: Grid, plane: Plane, dark: boolean, every: number) {
  const { width, height } = context.canvas, dx = width / grid.columns, dy = height / grid.rows, size = 0.36 * every * dx;
  context.strokeStyle = dark ? 'rgba(230, 238, 246, 0.75)' : 'rgba(20, 32, 44, 0.65)';
  context.lineWidth = Math.max(1, width / 500);
  context.beginPath();
  const first = Math.floor(every / 2);
  for (let row = first; row < grid.rows; row += every)
    for (let column = first; column < grid.columns; column += every) {
      const b = inPlane(grid, plane, row * grid.columns + column), strength = b ? Math.hypot(...b) : 0;
      if (!b || strength < kLeast / 100) continue;
      const x = (column + 0.5) * dx, y = (row + 0.5) * dy, u = (b[0] / strength) * size, v = (-b[1] / strength) * size;
      context.moveTo(x - u, y - v);
      context.lineTo(x + u, y + v);
      context.lineTo(x + 0.45 * u - 0.3 * v, y + 0.45 * v + 0.3 * u);
      context.moveTo(x + u, y + v);
      context.lineTo(x + 0.45 * u + 0.3 * v, y + 0.45 * v - 0.3 * u);
    }
  context.stroke();
}

/** Draws a grid over the complete canvas, or clears it. */
export function draw(canvas: HTMLCanvasElement, grid: Grid | null, plane: Plane, dark: boolean) {
  const context = canvas.getContext('2d')!;
  context.clearRect(0, 0, canvas.width, canvas.height);
  if (!grid) return;
  context.imageSmoothingEnabled = true;
  context.imageSmoothingQuality = 'high';
  context.drawImage(map(grid, plane, dark), 0, 0, canvas.width, canvas.height);
  arrows(context, grid, plane, dark, 2);
}
