// The ellipse of one standard deviation of a swarm, from its covariance.

import type { Frame } from '../frame';

const kMostCells = 20000; // of a larger swarm a part is enough: the error of the correlation is below 0.01

export interface Ellipse {
  major: number;
  minor: number;
  /** Of the major axis, rad, from x towards y. */
  angle: number;
}

/** Correlation coefficient of x and y of the cells; 0 for fewer than two cells, or without dispersion. */
export function correlation({ xy, cells }: Pick<Frame, 'xy' | 'cells'>): number {
  const step = Math.max(1, Math.ceil(cells / kMostCells));
  let n = 0, mx = 0, my = 0, xx = 0, yy = 0, both = 0;
  for (let i = 0; i < cells; i += step) {
    const x = xy[2 * i], y = xy[2 * i + 1], dx = x - mx, dy = y - my;
    ++n;
    mx += dx / n;
    my += dy / n;
    xx += dx * (x - mx);
    yy += dy * (y - my);
    both += dx * (y - my);
  }
  return xx > 0 && yy > 0 ? both / Math.sqrt(xx * yy) : 0;
}

/** The ellipse of the covariance matrix with these standard deviations and this correlation. */
export function ellipseOf(sx: number, sy: number, correlated: number): Ellipse {
  const mean = (sx * sx + sy * sy) / 2, half = (sx * sx - sy * sy) / 2, c = correlated * sx * sy;
  const root = Math.hypot(half, c);
  return { major: Math.sqrt(mean + root), minor: Math.sqrt(Math.max(0, mean - root)), angle: Math.atan2(c, half) / 2 };
}
