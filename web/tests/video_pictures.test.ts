import { describe, expect, test } from 'vitest';
import { decodePictures, PictureStore, type Picture } from '../src/video/pictures';

function encoded(frames: { t: number; index: number; px: number[] }[]): ArrayBuffer {
  const bytes = new Uint8Array(frames.reduce((n, f) => n + 20 + f.px.length, 0)), v = new DataView(bytes.buffer);
  let at = 0;
  for (const f of frames) {
    v.setUint32(at, 16 + f.px.length, true);
    v.setFloat64(at + 4, f.t, true);
    v.setUint32(at + 12, f.index, true);
    v.setUint16(at + 16, f.px.length, true);
    v.setUint16(at + 18, 1, true);
    bytes.set(f.px, at + 20);
    at += 20 + f.px.length;
  }
  return bytes.buffer;
}
const picture = (t: number, until?: number, bytes = 4): Picture => ({ t, index: 0, width: bytes, height: 1, px: new Uint8Array(bytes), until });

test('frames of a response are decoded, and know the time of the next', () => {
  const [a, b, ...more] = decodePictures(encoded([{ t: 0.5, index: 7, px: [1, 2, 3] }, { t: 0.75, index: 8, px: [9, 0, 255] }]));
  expect(more).toEqual([]);
  expect([a.t, a.until, a.index, a.width, a.height, [...a.px]]).toEqual([0.5, 0.75, 7, 3, 1, [1, 2, 3]]);
  expect([b.t, b.until, [...b.px]]).toEqual([0.75, undefined, [9, 0, 255]]);
  expect(decodePictures(new ArrayBuffer(0))).toEqual([]);
});

describe('pictures that are kept', () => {
  test('are found from their time to that of the next one', () => {
    const store = new PictureStore();
    store.add([picture(1, 1.25), picture(1.25)]);
    expect([0.9, 1, 1.2, 1.25, 1.3].map((t) => store.at(t)?.t)).toEqual([undefined, 1, 1, 1.25, undefined]);
  });
  test('the time of the next frame is kept if the same frame comes again', () => {
    const store = new PictureStore();
    store.add([picture(1, 2)]);
    store.add([picture(1)]);
    expect(store.at(1.5)?.t).toBe(1);
  });
  test('the run of known pictures ends at the first gap', () => {
    const store = new PictureStore();
    store.add([picture(0, 1), picture(1, 2), picture(2), picture(5, 6)]);
    expect(store.knownUntil(0.5)?.t).toBe(2);
    expect(store.knownUntil(3)).toBeUndefined();
  });
  test('those not used for the longest time are removed first', () => {
    const store = new PictureStore(30);
    store.add([picture(0, 1, 10), picture(1, 2, 10), picture(2, 3, 10)]);
    store.at(0);
    store.add([picture(3, 4, 10)]);
    expect([0, 1, 2, 3].map((t) => store.at(t)?.t)).toEqual([0, undefined, 2, 3]);
  });
});
