// Binary messages of the lab: protocol.md.

/** Which sites of a grid over the box have a cell. */
export interface Sites {
  columns: number;
  rows: number;
  /** Bits of the sites, row by row, lowest bit first: for each swarm its responsive, then its other cells. */
  planes: Uint8Array[];
  /** Number of cells in the squares of a coarse grid. */
  counts: { columns: number; rows: number; cells: Uint32Array };
}

/** Names of the limits of a plan, in the order of their bits. */
export const kPlanLimits = ['output', 'current', 'slew', 'heat', 'view', 'drop', 'obstacle'] as const;
export type PlanLimit = (typeof kPlanLimits)[number];

/** What the controller intends. */
export interface Plan {
  /** Predicted positions of the swarm, px, from the time at which the command acts to the horizon. */
  path: [number, number][];
  /** Time between two positions, s. */
  step: number;
  /** Limits without which the plan would be another. */
  active: PlanLimit[];
}
/** Estimated centroid and the covariance of its error, px and px², image axes. */
export interface CentroidEstimate {
  at: [number, number];
  cov: { xx: number; xy: number; yy: number };
  /** Of the time at which the command acts; otherwise of the picture. */
  predicted: boolean;
}

export interface Frame {
  run: number;
  frame: number;
  t: number;
  cells: number;
  /** Coordinates: parts of the box in 16 bits, or pixels; empty with an occupancy grid. */
  xy: Uint16Array | Float32Array;
  headings: Uint8Array | null;
  responding: Uint8Array;
  /** Occupancy grid in place of the positions. */
  sites: Sites | null;
  /** Rows of the series, `columns` numbers each. */
  rows: Float64Array;
  rowCount: number;
  field: { columns: number; rows: number; xy: Float32Array };
  picture: { width: number; height: number; grey: Uint8Array } | null;
  estimate: CentroidEstimate | null;
  plan: Plan | null;
  bytes: number;
}

const kHeader = 48; // bytes
const kMagic = 0x46414241; // "FABA", read as a big-endian number
const kVersion = 1;

function header(buffer: ArrayBuffer): DataView {
  const v = new DataView(buffer);
  if (buffer.byteLength < kHeader || v.getUint32(0, false) !== kMagic) throw new Error('The message is not a frame.');
  const version = v.getUint16(4, true);
  if (version !== kVersion) throw new Error(`The frame has version ${version}; this page reads version ${kVersion}.`);
  return v;
}

/** Number of the run that a message belongs to. The rest of the message can be read only with the columns of that run. */
export const runOf = (buffer: ArrayBuffer): number => header(buffer).getUint32(8, true);

/**
 * Reads a message whose rows have `columns` numbers. Cells and picture are views of `buffer`, not copies.
 * Throws an Error when the message is not a frame or when its length differs from what its header gives.
 */
export function decodeFrame(buffer: ArrayBuffer, columns: number): Frame {
  const v = header(buffer);
  const bits = v.getUint16(6, true);
  const cells = v.getUint32(12, true);
  const rowCount = v.getUint32(16, true);
  const width = v.getUint16(20, true), height = v.getUint16(22, true);
  const gx = v.getUint16(24, true), gy = v.getUint16(26, true);
  let at = kHeader;
  const take = (bytes: number) => {
    const from = at;
    at += bytes;
    if (at > buffer.byteLength) throw new Error(`The frame is truncated: it has ${buffer.byteLength} bytes.`);
    return from;
  };
  const rows = new Float64Array(buffer.slice(take(rowCount * columns * 8), at));
  const field = new Float32Array(buffer.slice(take(gx * gy * 8), at));
  const grid = bits & 16 ? { columns: v.getUint16(28, true), rows: v.getUint16(30, true) } : null;
  const sites = grid && takeSites(buffer, take, grid);
  const listed = grid ? 0 : cells; // cells with a position
  const floats = (bits & 2) !== 0;
  const positions = take(listed * (floats ? 8 : 4));
  const xy = floats ? new Float32Array(buffer, positions, listed * 2) : new Uint16Array(buffer, positions, listed * 2);
  const headings = bits & 4 ? new Uint8Array(buffer, take(listed), listed) : null;
  const responding = new Uint8Array(buffer, take(Math.ceil(listed / 8)), Math.ceil(listed / 8));
  const picture = bits & 8 ? { width, height, grey: new Uint8Array(buffer, take(width * height), width * height) } : null;
  const estimate = bits & 32 ? takeEstimate(buffer, take) : null;
  const plan = bits & 64 ? takePlan(buffer, take) : null;
  if (at !== buffer.byteLength) throw new Error(`The frame has ${buffer.byteLength} bytes; its header gives ${at}.`);
  return {
    run: v.getUint32(8, true),
    frame: Number(v.getBigUint64(32, true)),
    t: v.getFloat64(40, true),
    cells, xy, headings, responding, sites, rows, rowCount,
    field: { columns: gx, rows: gy, xy: field },
    picture, estimate, plan,
    bytes: buffer.byteLength,
  };
}

type Take = (bytes: number) => number;

function takeEstimate(buffer: ArrayBuffer, take: Take): CentroidEstimate {
  const v = new DataView(buffer, take(24), 24), [x, y, xx, xy, yy] = [4, 8, 12, 16, 20].map((k) => v.getFloat32(k, true));
  return { at: [x, y], cov: { xx, xy, yy }, predicted: v.getUint32(0, true) !== 0 };
}

function takePlan(buffer: ArrayBuffer, take: Take): Plan {
  const head = new DataView(buffer, take(8), 8), points = head.getUint16(0, true), bits = head.getUint16(2, true);
  const v = new DataView(buffer, take(8 * points), 8 * points);
  return {
    path: Array.from({ length: points }, (_, i) => [v.getFloat32(8 * i, true), v.getFloat32(8 * i + 4, true)]),
    step: head.getFloat32(4, true),
    active: kPlanLimits.filter((_, k) => bits & (1 << k)),
  };
}

function takeSites(buffer: ArrayBuffer, take: Take, { columns, rows }: { columns: number; rows: number }): Sites {
  const head = new DataView(buffer, take(8), 8), planes: Uint8Array[] = [], bytes = Math.ceil((columns * rows) / 8);
  // Planes without cells are not in the message.
  const present = head.getUint16(6, true);
  for (let k = 0; k < head.getUint16(0, true); ++k) planes.push(present & (1 << k) ? new Uint8Array(buffer, take(bytes), bytes) : new Uint8Array(0));
  const counts = { columns: head.getUint16(2, true), rows: head.getUint16(4, true) }, at = take(counts.columns * counts.rows * 4);
  const cells = new Uint32Array(buffer.slice(at, at + counts.columns * counts.rows * 4));
  return { columns, rows, planes, counts: { ...counts, cells } };
}

/** Whether a cell responds to the field. */
export const responds = (f: Frame, i: number) => (f.responding[i >> 3] >> (i & 7)) & 1;
