// Contrast: which grey values of the file are displayed black and white, and the histogram behind the two sliders.

export interface Histogram {
  least: number;
  most: number;
  /** Quantiles of 0.1 % and 99.9 %. */
  low: number;
  high: number;
  /** In equal intervals from `least`, `step` wide. */
  step: number;
  counts: number[];
}
export interface Contrast {
  low: number;
  high: number;
}

/** Range of the sliders: the grey scale for 8 bits, otherwise the values in the picture and the present contrast. */
export function sliderRange(bits: number, h: Histogram | null, now: Contrast): Contrast {
  if (bits <= 8) return { low: 0, high: 255 };
  return { low: Math.min(h?.least ?? now.low, now.low), high: Math.max(h?.most ?? now.high, now.high) };
}
/** Step of the sliders: one grey value, or a thousandth of the range for numbers below 10. */
export const sliderStep = (range: Contrast) => (range.high - range.low > 10 ? 1 : (range.high - range.low) / 1000 || 1);

/** Contrast from the quantiles, at least one step wide. */
export function automatic(h: Histogram): Contrast {
  return h.high > h.low ? { low: h.low, high: h.high } : { low: h.least, high: h.most > h.least ? h.most : h.least + 1 };
}
/** After one slider has moved: black stays below white, by at least `step`. */
export function limited(c: Contrast, moved: 'low' | 'high', step: number): Contrast {
  if (c.high - c.low >= step) return c;
  return moved === 'low' ? { low: c.high - step, high: c.high } : { low: c.low, high: c.low + step };
}
/** Outline of the histogram as an SVG path; heights are square roots, so that few pixels are visible too. */
export function histogramPath(h: Histogram, range: Contrast, width: number, height: number): string {
  const most = Math.sqrt(Math.max(1, ...h.counts));
  const x = (grey: number) => (((grey - range.low) / (range.high - range.low || 1)) * width).toFixed(1);
  const y = (n: number) => (height * (1 - Math.sqrt(n) / most)).toFixed(1);
  return `M${x(h.least)} ${height}${h.counts.map((n, k) => `V${y(n)}H${x(h.least + (k + 1) * h.step)}`).join('')}V${height}Z`;
}
