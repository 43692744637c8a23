// Mapping between times and positions on the time axis.

export interface TimeSpan {
  from_s: number;
  to_s: number;
}

/** Maps the times of a span to 0 ... `width` px. */
export class TimeScale {
  constructor(
    readonly span: TimeSpan,
    readonly width: number,
  ) {}
  toX(t: number): number {
    return ((t - this.span.from_s) / (this.span.to_s - this.span.from_s)) * this.width;
  }
  toTime(x: number): number {
    return this.span.from_s + (x / this.width) * (this.span.to_s - this.span.from_s);
  }
}

/** Times of ticks in a span, at least `least` px apart, and their step. */
export function ticks(scale: TimeScale, least = 70): { step: number; times: number[] } {
  const wanted = ((scale.span.to_s - scale.span.from_s) * least) / scale.width;
  const step = tickStep(wanted), times: number[] = [];
  for (let k = Math.ceil(scale.span.from_s / step - 1e-9); k * step <= scale.span.to_s + 1e-9 * step; ++k) times.push(k * step);
  return { step, times };
}
/** The smallest round step that is not below `wanted`: 1, 2, 5 times a power of ten below a minute, then parts of minutes and hours. */
export function tickStep(wanted: number): number {
  if (!(wanted > 0)) return 1;
  const long = [15, 30, 60, 120, 300, 600, 900, 1800, 3600].find((s) => s >= wanted);
  if (wanted > 10) return long ?? 3600 * tickStep(wanted / 3600);
  const power = 10 ** Math.floor(Math.log10(wanted));
  return [1, 2, 5, 10].map((k) => k * power).find((s) => s >= wanted * (1 - 1e-9))!;
}
/** "12.5 s" is "12.5", "75 s" is "1:15"; digits for steps of `step` s. */
export function clock(t: number, step = 0.01): string {
  const digits = Math.max(0, Math.min(6, Math.ceil(-Math.log10(step) - 1e-9)));
  const rounded = Number(t.toFixed(digits));
  if (rounded < 60) return rounded.toFixed(digits);
  const minutes = Math.floor(rounded / 60), rest = (rounded - 60 * minutes).toFixed(digits);
  return `${minutes}:${rest.split('.')[0].length < 2 ? '0' : ''}${rest}`;
}

/** The span after zooming by `factor` about the time `about`, inside 0 ... `length`. */
export function zoomed(span: TimeSpan, factor: number, about: number, length: number, shortest: number): TimeSpan {
  const old = span.to_s - span.from_s;
  const long = Math.min(length, Math.max(Math.min(shortest, length), old / factor));
  const from = Math.min(Math.max(0, about - ((about - span.from_s) * long) / old), length - long);
  return { from_s: from, to_s: from + long };
}
/** The span moved so that it contains `t`. */
export function following(span: TimeSpan, t: number, length: number): TimeSpan {
  if (t >= span.from_s && t <= span.to_s) return span;
  const long = span.to_s - span.from_s;
  const from = Math.min(Math.max(0, t < span.from_s ? t - 0.9 * long : t - 0.1 * long), Math.max(0, length - long));
  return { from_s: from, to_s: from + long };
}
