import { beforeEach, describe, expect, test } from 'vitest';
import { Camera, type Box } from '../src/view/camera';

const kBox: Box = { left: -20, top: -10, right: 620, bottom: 470 }; // 640 x 480 px
let camera: Camera;
beforeEach(() => {
  camera = new Camera();
  camera.resize(1280, 1000);
  camera.fit(kBox);
});
const close = (a: readonly number[], b: readonly number[]) => a.forEach((v, i) => expect(v).toBeCloseTo(b[i], 9));

describe('fitting', () => {
  test('the box is as large as the canvas permits and centred', () => {
    expect(camera.scale).toBe(2);
    close(camera.toCanvas(-20, -10), [0, 20]);
    close(camera.toCanvas(620, 470), [1280, 980]);
    close(camera.toCanvas(300, 230), [640, 500]);
  });
  test('the other direction limits a wide canvas', () => {
    camera.resize(4000, 960);
    expect(camera.scale).toBe(2);
    close(camera.toCanvas(300, 230), [2000, 480]);
  });
  test('toCanvas and toPicture are inverse functions', () => {
    camera.zoom(3.7, 100, 900);
    camera.pan(-12.5, 40);
    close(camera.toPicture(...camera.toCanvas(123.4, -56.7)), [123.4, -56.7]);
  });
});

describe('zooming and panning', () => {
  test('the point under the pointer does not move', () => {
    const at = camera.toPicture(200, 700);
    camera.zoom(1.5, 200, 700);
    expect(camera.scale).toBe(3);
    close(camera.toCanvas(...at), [200, 700]);
  });
  test('panning moves all points by the same distance', () => {
    const [x, y] = camera.toCanvas(5, 6);
    camera.pan(7, -8);
    close(camera.toCanvas(5, 6), [x + 7, y - 8]);
  });
  test('the scale is limited, and the point does not move at the limits', () => {
    const at = camera.toPicture(10, 20);
    camera.zoom(1e6, 10, 20);
    expect(camera.scale).toBe(60);
    close(camera.toCanvas(...at), [10, 20]);
    camera.zoom(1e-6, 10, 20);
    expect(camera.scale).toBeCloseTo(0.2 * 2, 12);
    close(camera.toCanvas(...at), [10, 20]);
  });
  test('zooming in does not zoom out if the fitted scale is above the limit', () => {
    camera.fit({ left: 0, top: 0, right: 10, bottom: 10 });
    expect(camera.scale).toBe(100);
    camera.zoom(1.25, 640, 500);
    expect(camera.scale).toBe(100);
    camera.zoom(0.5, 640, 500);
    expect(camera.scale).toBe(50);
  });
});

describe('resizing the canvas', () => {
  test('fits again before the first zoom or pan', () => {
    camera.resize(640, 500);
    expect(camera.scale).toBe(1);
    close(camera.toCanvas(300, 230), [320, 250]);
  });
  test('keeps scale and centre after zooming', () => {
    camera.zoom(1.5, 100, 100);
    const centre = camera.toPicture(640, 500);
    camera.resize(600, 700);
    expect(camera.scale).toBe(3);
    close(camera.toCanvas(...centre), [300, 350]);
  });
  test('keeps the centre after panning', () => {
    camera.pan(30, 40);
    const centre = camera.toPicture(640, 500);
    camera.resize(100, 200);
    close(camera.toCanvas(...centre), [50, 100]);
  });
  test('follows the canvas again after fit()', () => {
    camera.zoom(2, 0, 0);
    camera.fit(kBox);
    camera.resize(640, 480);
    expect(camera.scale).toBe(1);
  });
  test('the same size has no effect', () => {
    camera.zoom(2, 5, 5);
    const before = [camera.scale, camera.x, camera.y];
    camera.resize(1280, 1000);
    expect([camera.scale, camera.x, camera.y]).toEqual(before);
  });
});
