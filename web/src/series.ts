// Time series of a run: columns with one row per frame.

const kMostLive = 30000; // rows of a live run
const kFirstCapacity = 1024; // rows

/** The first of `true_...`, `estimated_...` and the bare name of version 0.1 for which `has` holds. */
export function swarmColumn(quantity: string, has: (name: string) => boolean): string {
  return [`true_${quantity}`, `estimated_${quantity}`].find(has) ?? quantity;
}

export class Series {
  names: string[] = [];
  columns: Float64Array[] = [];
  length = 0;
  private last = -1;

  /** `most`: number of rows at which every second row of the older half is removed before the next row is added. */
  constructor(private most = kMostLive) {}

  begin(names: string[]) {
    this.names = names;
    this.columns = names.map(() => new Float64Array(kFirstCapacity));
    this.length = 0;
    this.last = -1;
  }
  /** Adds the rows of a message, except those already known. Returns whether there were new rows. */
  take(rows: Float64Array, count: number): boolean {
    const n = this.names.length, before = this.length;
    for (let r = 0; r < count; ++r) {
      const frame = rows[r * n];
      if (!(frame > this.last)) continue; // also a row without a frame number: NaN
      this.last = frame;
      if (this.length === this.most) this.thin();
      if (this.length === this.columns[0].length) this.grow();
      for (let c = 0; c < n; ++c) this.columns[c][this.length] = rows[r * n + c];
      ++this.length;
    }
    return this.length !== before;
  }
  of(name: string): Float64Array {
    const i = this.names.indexOf(name);
    return i < 0 ? new Float64Array(this.length).fill(NaN) : this.columns[i].subarray(0, this.length);
  }
  newest(name: string): number {
    const i = this.names.indexOf(name);
    return i < 0 || !this.length ? NaN : this.columns[i][this.length - 1];
  }
  /**
   * The column of a quantity of the swarm such as `centroid_x_px`: the simulated truth if available, otherwise the
   * estimate; runs of version 0.1 have no prefix.
   */
  swarmColumn(quantity: string): string {
    return swarmColumn(quantity, (name) => this.names.includes(name));
  }
  /** The last row that is not after `t` s; -1 before the first. */
  rowAt(t: number): number {
    const times = this.of('t_s');
    let low = 0, high = this.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (times[middle] <= t + 1e-9) low = middle + 1;
      else high = middle;
    }
    return low - 1;
  }
  csv(): string {
    const lines = [this.names.join(',')];
    for (let r = 0; r < this.length; ++r) lines.push(this.columns.map((c) => (Number.isFinite(c[r]) ? String(c[r]) : '')).join(','));
    return lines.join('\n') + '\n';
  }
  private grow() {
    this.columns = this.columns.map((c) => {
      const larger = new Float64Array(c.length * 2);
      larger.set(c);
      return larger;
    });
  }
  // The first row remains; the resolution decreases with the age, as in the history of the program.
  private thin() {
    const half = this.length >> 1;
    for (const c of this.columns) {
      for (let r = 0; r < half; r += 2) c[r >> 1] = c[r];
      c.copyWithin((half + 1) >> 1, half, this.length);
    }
    this.length -= half >> 1;
  }
}

/** Times since the first row of a recording, s: it may begin later than its run. Times of a live run are since its start. */
export function timesFromStart(s: Series): Float64Array {
  const t = s.of('t_s'), start = t[0] ?? 0;
  return t.map((v) => v - start);
}

/**
 * The time range of a plot with `live` and a recorded run, s: it ends at twice the duration of the recorded run, so that a short
 * recording stays visible beside a long live run. The full range [low, high] if the live run has no rows in it.
 */
export function comparedRange(live: Series, recorded: Series, low: number, high: number): [number, number] {
  const times = live.of('t_s'), end = 2 * (timesFromStart(recorded).at(-1) ?? NaN);
  return end > low && times.length > 0 && times[0] < end ? [low, Math.min(high, end)] : [low, high];
}

/** Style of the line in the legend of a plot; `index`: 0 is the time, then follow the `lines` of the live run, then those of the recorded run. */
export function legendDash(lines: number, index: number): 'solid' | 'dashed' {
  return index > lines ? 'dashed' : 'solid';
}

/** The series of a recorded run; null if not available. */
export async function recordedSeries(run: string): Promise<Series | null> {
  const r = await fetch(`/api/runs/${encodeURIComponent(run)}/series.csv`).catch(() => null);
  return r?.ok ? parseCsv(await r.text()) : null;
}

function parseCsv(text: string): Series {
  const [head, ...lines] = text.trim().split('\n');
  const s = new Series(Infinity);
  const names = head.split(',');
  s.begin(names);
  const rows = new Float64Array(lines.length * names.length);
  lines.forEach((line, r) => line.split(',').forEach((v, c) => (rows[r * names.length + c] = v === '' ? NaN : Number(v))));
  s.take(rows, lines.length);
  return s;
}
