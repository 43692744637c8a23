// The ellipse of one standard deviation of a swarm, from its covariance.

import type { Frame, Sites } from '../frame';

const kMostCells = 20000; // of a larger swarm a part is enough: the error of the correlation is below 0.01

export interface Ellipse {
  major: number;
  minor: number;
  /** Of the major axis, rad, from x towards y. */
  angle: number;
}

/** Correlation coefficient of x and y of the cells; 0 for fewer than two cells, or without dispersion. */
export function correlation({ xy, cells, sites }: Pick<Frame, 'xy' | 'cells'> & { sites?: Sites | null }): number {
  if (sites) return correlationOfCounts(sites.counts);
  const sums = moments(), step = Math.max(1, Math.ceil(cells / kMostCells));
  for (let i = 0; i < cells; i += step) sums.add(xy[2 * i], xy[2 * i + 1], 1);
  return sums.correlation();
}

function correlationOfCounts({ columns, rows, cells }: Sites['counts']): number {
  const sums = moments();
  for (let r = 0; r < rows; ++r) for (let c = 0; c < columns; ++c) if (cells[r * columns + c]) sums.add(c, r, cells[r * columns + c]);
  return sums.correlation();
}

// Weighted sums of squares about the mean (West, 1979).
function moments() {
  let n = 0, mx = 0, my = 0, xx = 0, yy = 0, both = 0;
  return {
    add(x: number, y: number, weight: number) {
      const dx = x - mx, dy = y - my;
      n += weight;
      mx += (weight * dx) / n;
      my += (weight * dy) / n;
      xx += weight * dx * (x - mx);
      yy += weight * dy * (y - my);
      both += weight * dx * (y - my);
    },
    correlation: () => (xx > 0 && yy > 0 ? both / Math.sqrt(xx * yy) : 0),
  };
}

/** The ellipse of the covariance matrix with these standard deviations and this correlation. */
export const ellipseOf = (sx: number, sy: number, correlated: number): Ellipse => ellipseOfCovariance({ xx: sx * sx, xy: correlated * sx * sy, yy: sy * sy });

/** Semi-axes of the ellipse that has 95 % of a normal distribution of two variables, in standard deviations: sqrt(-2 ln 0.05). */
export const kSigmas95 = Math.sqrt(-2 * Math.log(0.05));

/** The ellipse of `sigmas` standard deviations of a covariance matrix. */
export function ellipseOfCovariance({ xx, xy, yy }: { xx: number; xy: number; yy: number }, sigmas = 1): Ellipse {
  const mean = (xx + yy) / 2, half = (xx - yy) / 2, c = xy;
  const root = Math.hypot(half, c);
  return { major: sigmas * Math.sqrt(Math.max(0, mean + root)), minor: sigmas * Math.sqrt(Math.max(0, mean - root)), angle: Math.atan2(c, half) / 2 };
}
