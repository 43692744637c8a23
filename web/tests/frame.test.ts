// Messages are built byte by byte from the table in web/protocol.md, independently of src/frame.ts.
import { describe, expect, test } from 'vitest';
import { decodeFrame, responds, runOf } from '../src/frame';

interface Message {
  magic?: string;
  version?: number;
  run?: number;
  frame?: bigint;
  t?: number;
  rows?: number[][];
  grid?: { columns: number; rows: number; xy: number[] };
  cells?: { x: number; y: number; heading?: number; responds: boolean }[];
  floats?: boolean;
  picture?: { width: number; height: number; grey: number[] };
}

/** Bits of the header: cells, float32 coordinates, headings, picture. */
const kBits = { cells: 1, floats: 2, headings: 4, picture: 8 };

class Bytes {
  readonly all: number[] = [];
  private number(size: number, set: (v: DataView) => void) {
    const v = new DataView(new ArrayBuffer(size));
    set(v);
    this.all.push(...new Uint8Array(v.buffer));
  }
  u8 = (x: number) => this.all.push(x);
  u16 = (x: number) => this.number(2, (v) => v.setUint16(0, x, true));
  u32 = (x: number) => this.number(4, (v) => v.setUint32(0, x, true));
  u64 = (x: bigint) => this.number(8, (v) => v.setBigUint64(0, x, true));
  f32 = (x: number) => this.number(4, (v) => v.setFloat32(0, x, true));
  f64 = (x: number) => this.number(8, (v) => v.setFloat64(0, x, true));
}

function encode(m: Message): ArrayBuffer {
  const out = new Bytes(), cells = m.cells ?? [], rows = m.rows ?? [], headed = cells.some((c) => c.heading !== undefined);
  for (const letter of m.magic ?? 'FABA') out.u8(letter.charCodeAt(0));
  out.u16(m.version ?? 1);
  out.u16(kBits.cells + (m.floats ? kBits.floats : 0) + (headed ? kBits.headings : 0) + (m.picture ? kBits.picture : 0));
  out.u32(m.run ?? 1);
  out.u32(cells.length);
  out.u32(rows.length);
  out.u16(m.picture?.width ?? 0);
  out.u16(m.picture?.height ?? 0);
  out.u16(m.grid?.columns ?? 0);
  out.u16(m.grid?.rows ?? 0);
  out.u32(0);
  out.u64(m.frame ?? 0n);
  out.f64(m.t ?? 0);
  rows.flat().forEach(out.f64);
  (m.grid?.xy ?? []).forEach(out.f32);
  for (const c of cells) [c.x, c.y].forEach(m.floats ? out.f32 : out.u16);
  if (headed) cells.forEach((c) => out.u8(c.heading ?? 0));
  for (let i = 0; i < cells.length; i += 8) {
    out.u8(cells.slice(i, i + 8).reduce((byte, c, k) => byte + (c.responds ? 2 ** k : 0), 0));
  }
  (m.picture?.grey ?? []).forEach(out.u8);
  return new Uint8Array(out.all).buffer;
}

const kFull: Message = {
  run: 9,
  frame: 12n,
  t: 0.4,
  rows: [[11, 1.5, NaN], [12, -2.5, 4]],
  grid: { columns: 2, rows: 1, xy: [1e-4, -2e-4, 0, 3e-4] },
  cells: Array.from({ length: 11 }, (_, i) => ({ x: 1000 * i, y: 65535 - i, heading: 20 * i, responds: i === 0 || i === 9 })),
  picture: { width: 3, height: 2, grey: [0, 1, 2, 253, 254, 255] },
};

describe('a frame as literal bytes', () => {
  // prettier-ignore
  const bytes = [
    0x46, 0x41, 0x42, 0x41, 0x01, 0x00, 0x05, 0x00, // FABA, version 1, cells and headings
    0x04, 0x03, 0x02, 0x01, 0x01, 0x00, 0x00, 0x00, // run 0x01020304, 1 cell
    0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, // 1 row, no picture
    0x01, 0x00, 0x01, 0x00, 0x00, 0x00, 0x00, 0x00, // grid of 1 x 1 points
    0x02, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, // frame 2^32 + 2
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xe0, 0x3f, // t = 0.5 s
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x08, 0x40, // row: 3
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xc0, // row: -2
    0x00, 0x00, 0x80, 0x3e, 0x00, 0x00, 0x00, 0xbf, // field: 0.25 T, -0.5 T
    0x34, 0x12, 0xff, 0xff, 0x40, 0x01, // x = 0x1234, y = 65535, heading 64 of 255, responds
  ];
  const f = decodeFrame(new Uint8Array(bytes).buffer, 2);

  test('integers are little-endian', () => {
    expect(f.run).toBe(0x01020304);
    expect(f.frame).toBe(2 ** 32 + 2);
    expect([...f.xy]).toEqual([0x1234, 0xffff]);
  });
  test('floating-point numbers are little-endian', () => {
    expect(f.t).toBe(0.5);
    expect([...f.rows]).toEqual([3, -2]);
    expect([...f.field.xy]).toEqual([0.25, -0.5]);
  });
  test('heading, response and length', () => {
    expect([...f.headings!]).toEqual([64]);
    expect(responds(f, 0)).toBe(1);
    expect(f.bytes).toBe(bytes.length);
  });
});

describe('a frame with all parts', () => {
  const f = decodeFrame(encode(kFull), 3);

  test('header', () => {
    expect([f.run, f.frame, f.t, f.cells, f.rowCount]).toEqual([9, 12, 0.4, 11, 2]);
  });
  test('rows of the series, with a missing value', () => {
    expect([...f.rows]).toEqual([11, 1.5, NaN, 12, -2.5, 4]);
  });
  test('grid of the field', () => {
    expect([f.field.columns, f.field.rows]).toEqual([2, 1]);
    expect([...f.field.xy]).toEqual([1e-4, -2e-4, 0, 3e-4].map(Math.fround));
  });
  test('coordinates and headings of each cell', () => {
    expect(f.xy).toBeInstanceOf(Uint16Array);
    expect([f.xy[20], f.xy[21], f.headings![10]]).toEqual([10000, 65525, 200]);
  });
  test('response bits: lowest first, the ninth cell is in the second byte', () => {
    expect(Array.from({ length: 11 }, (_, i) => responds(f, i))).toEqual([1, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0]);
    expect(f.responding).toHaveLength(2);
  });
  test('picture', () => {
    expect(f.picture).toMatchObject({ width: 3, height: 2 });
    expect([...f.picture!.grey]).toEqual([0, 1, 2, 253, 254, 255]);
  });
});

describe('optional parts', () => {
  test('coordinates in float32 pixels', () => {
    const f = decodeFrame(encode({ floats: true, cells: [{ x: -12.5, y: 70000.25, responds: false }] }), 1);
    expect(f.xy).toBeInstanceOf(Float32Array);
    expect([...f.xy]).toEqual([-12.5, 70000.25]);
  });
  test('without headings and picture both are null, and the response bits follow the coordinates', () => {
    const f = decodeFrame(encode({ cells: [{ x: 1, y: 2, responds: true }] }), 1);
    expect([f.headings, f.picture]).toEqual([null, null]);
    expect(responds(f, 0)).toBe(1);
  });
  test('an odd number of cells does not shift the picture', () => {
    const cells = [{ x: 1, y: 2, heading: 3, responds: false }];
    const f = decodeFrame(encode({ cells, picture: { width: 2, height: 1, grey: [7, 8] } }), 1);
    expect([...f.picture!.grey]).toEqual([7, 8]);
  });
  test('no cells, no rows, no grid', () => {
    const f = decodeFrame(encode({ t: 3 }), 5);
    expect([f.cells, f.rows.length, f.field.xy.length, f.xy.length, f.t]).toEqual([0, 0, 0, 0, 3]);
  });
});

describe('invalid messages', () => {
  const complete = encode(kFull);

  test.each([0, 3, 4, 47])('%i bytes are too few for a header', (n) => {
    expect(() => decodeFrame(complete.slice(0, n), 3)).toThrow('not a frame');
  });
  test('truncated messages', () => {
    for (let n = 48; n < complete.byteLength; ++n) {
      expect(() => decodeFrame(complete.slice(0, n), 3), `${n} bytes`).toThrow('truncated');
    }
  });
  test('a message with extra bytes', () => {
    const longer = new Uint8Array(complete.byteLength + 1);
    longer.set(new Uint8Array(complete));
    expect(() => decodeFrame(longer.buffer, 3)).toThrow('its header gives');
  });
  test('rows with another number of columns', () => {
    expect(() => decodeFrame(complete, 2)).toThrow('its header gives');
    expect(() => decodeFrame(complete, 4)).toThrow();
  });
  test('a count above the length of the message', () => {
    const v = new DataView(complete.slice(0));
    v.setUint32(12, 0xffffffff, true);
    expect(() => decodeFrame(v.buffer as ArrayBuffer, 3)).toThrow('truncated');
  });
  test('a wrong magic number, and a swapped byte order', () => {
    expect(() => decodeFrame(encode({ ...kFull, magic: 'FABB' }), 3)).toThrow('not a frame');
    expect(() => decodeFrame(encode({ ...kFull, magic: 'ABAF' }), 3)).toThrow('not a frame');
  });
  test('another version, and a swapped byte order', () => {
    expect(() => decodeFrame(encode({ ...kFull, version: 2 }), 3)).toThrow('version 2');
    expect(() => decodeFrame(encode({ ...kFull, version: 256 }), 3)).toThrow('version 256');
  });
});

describe('the run of a message', () => {
  test('is read without the columns of the rows', () => {
    expect(runOf(encode({ run: 0xfffffffe, rows: [[1, 2, 3]] }))).toBe(0xfffffffe);
  });
  test('is validated like a frame', () => {
    expect(() => runOf(new ArrayBuffer(8))).toThrow('not a frame');
    expect(() => runOf(encode({ version: 3 }))).toThrow('version 3');
  });
});

test('an occupancy grid in place of the positions', () => {
  const out = new Bytes();
  for (const letter of 'FABA') out.u8(letter.charCodeAt(0));
  [1, 1 + 16].forEach(out.u16);
  [7, 70000, 0].forEach(out.u32); // run, cells, rows
  [0, 0, 0, 0].forEach(out.u16); // camera image, field
  [5, 3].forEach(out.u16); // sites
  out.u64(9n);
  out.f64(0.5);
  [4, 2, 1, 0b1010].forEach(out.u16); // planes, coarse grid, which planes are in the message
  [0b10000001, 0b1, 0, 0b1000000].forEach(out.u8); // two planes of 15 sites
  [69999, 1].forEach(out.u32);
  const f = decodeFrame(new Uint8Array(out.all).buffer, 3);
  expect([f.cells, f.xy.length, f.frame]).toEqual([70000, 0, 9]);
  expect(f.sites).toMatchObject({ columns: 5, rows: 3, counts: { columns: 2, rows: 1 } });
  expect(f.sites!.planes.map((p) => [...p])).toEqual([[], [129, 1], [], [0, 64]]);
  expect([...f.sites!.counts.cells]).toEqual([69999, 1]);
  expect(() => decodeFrame(new Uint8Array(out.all.slice(0, -1)).buffer, 3)).toThrow('truncated');
});
