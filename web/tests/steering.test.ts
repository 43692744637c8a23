import { beforeEach, describe, expect, test, vi } from 'vitest';
import type { Lab } from '../src/lab.svelte';
import { inArena, inView, Steering } from '../src/steering.svelte';
import { sampleSchema } from './sample_schema';

/** A mock of Lab; an exchange changes the scenario like the server. */
class FakeLab {
  schema: typeof sampleSchema | null = sampleSchema;
  scenario: Record<string, any> = { controller: { type: 'alpha', gain: 2 }, estimator: { type: 'guess' } };
  scene = { view: { width: 640, height: 480 }, outline: { centre_px: [320, 240], radius_px: 400 }, box: { left: -80, top: -160, right: 720, bottom: 640 } };
  polarity = 1;
  sent: Record<string, any>[] = [];
  accepts = true;
  async exchange(event: Record<string, any>) {
    this.sent.push(event);
    await Promise.resolve();
    if (this.accepts) this.scenario = { ...this.scenario, ...event };
    return { ok: this.accepts };
  }
}

let lab: FakeLab, steering: Steering;
beforeEach(() => {
  lab = new FakeLab();
  steering = new Steering(lab as unknown as Lab);
});
/** Waits until every exchange has been answered. */
const settled = () => new Promise((r) => setTimeout(r));
const field = (event: Record<string, any>) => event.controller.field.map((v: string) => Number.parseFloat(v));

describe('manual control', () => {
  test('sends the open-loop controller with a field, the world y axis up', async () => {
    steering.pull([0.6, 0.8]);
    await settled();
    expect(lab.sent).toEqual([{ controller: { type: 'gamma', field: ['0.0000690000 T', '-0.0000920000 T'] } }]);
    expect(steering.byHand).toBe(true);
  });
  test('reverses the field for cells that swim against it', async () => {
    lab.polarity = -1;
    steering.pull([0, 1]);
    await settled();
    expect(field(lab.sent[0])[1]).toBeCloseTo(115e-6, 10);
  });
  test('a drag of a third of the view or longer is full deflection', () => {
    steering.drag([80, 0]);
    expect(steering.direction).toEqual([0.5, 0]);
    steering.drag([0, -480]);
    expect(steering.direction).toEqual([0, -1]);
    steering.drag(null);
    expect(steering.direction).toEqual([0, -1]);
  });
  test('only the newest direction is kept while an exchange is pending', async () => {
    [0.1, 0.2, 0.3, 1].forEach((x) => steering.pull([x, 0]));
    await settled();
    expect(lab.sent.map((e) => field(e)[0])).toEqual([11.5e-6, 115e-6]);
  });
  test('reverses and stops', async () => {
    steering.pull([1, -0.5]);
    steering.reverse();
    expect(steering.direction).toEqual([-1, 0.5]);
    steering.stop();
    await settled();
    expect(field(lab.sent.at(-1)!).map(Math.abs)).toEqual([0, 0]);
  });
  test('arrow keys: diagonals have length 1, repeated key events send nothing', async () => {
    const key = (name: string, down: boolean) => steering.key({ key: name } as KeyboardEvent, down);
    expect(key('a', true)).toBe(false);
    expect(key('ArrowRight', true)).toBe(true);
    key('ArrowUp', true);
    expect(steering.direction[0]).toBeCloseTo(Math.SQRT1_2, 12);
    expect(steering.direction[1]).toBeCloseTo(-Math.SQRT1_2, 12);
    await settled();
    const sent = lab.sent.length;
    expect(key('ArrowUp', true)).toBe(true);
    await settled();
    expect(lab.sent).toHaveLength(sent);
    key('ArrowUp', false);
    key('ArrowRight', false);
    expect(steering.direction).toEqual([0, 0]);
  });
  test('the left stick of a gamepad, with a dead zone', () => {
    const pad = { connected: true, axes: [0.1, 0.05] };
    vi.stubGlobal('navigator', { getGamepads: () => [null, pad] });
    steering.poll();
    expect(steering.direction).toEqual([0, 0]);
    pad.axes = [0.9, -0.9];
    steering.poll();
    expect(Math.hypot(...steering.direction)).toBeCloseTo(1, 12);
  });
});

describe('a setpoint', () => {
  test('is the reference with one setpoint, to a tenth of a pixel; the controller stays', async () => {
    await steering.goal([12.34, 56.78]);
    expect(lab.sent).toEqual([{ reference: { type: 'spot', setpoint_px: [12.3, 56.8] } }]);
  });
  test('is marked until the answer', async () => {
    const answered = steering.goal([1, 2]);
    expect(steering.asked).toEqual([1, 2]);
    await answered;
    expect(steering.asked).toBeNull();
  });
  test('replaces manual control by the previous parts, with their parameters', async () => {
    steering.pull([1, 0]);
    await settled();
    steering.pull([0, 1]);
    await settled();
    await steering.goal([1, 2]);
    expect(lab.sent.at(-1)).toMatchObject({ controller: { type: 'alpha', gain: 2 }, estimator: { type: 'guess' } });
    expect(steering.byHand).toBe(false);
    expect(steering.direction).toEqual([0, 0]);
  });
  test('uses the default controller if the scenario started with an open-loop one', async () => {
    lab.scenario = { controller: { type: 'beta' } };
    await steering.goal([1, 2]);
    expect(lab.sent[0].controller).toEqual({ type: 'zeta' });
  });
  test('does not use the parts of a previous run', async () => {
    steering.pull([1, 0]);
    await settled();
    steering.begin();
    lab.scenario = { controller: { type: 'gamma' } };
    await steering.goal([1, 2]);
    expect(lab.sent.at(-1)!.controller).toEqual({ type: 'zeta' });
  });
});

describe('a setpoint outside of the camera view', () => {
  const view = { width: 640, height: 480 };
  test.each<[[number, number], boolean]>([
    [[0, 0], true],
    [[-0.5, -0.5], true],
    [[639.4, 479.4], true],
    [[639.5, 10], false],
    [[10, 479.5], false],
    [[-0.6, 10], false],
    [[700, 240], false],
  ])('%j: in view %s', (at, inside) => {
    expect(inView(at, view)).toBe(inside);
  });
  test('is reported with its position and the view; a setpoint in the view clears the report', async () => {
    await steering.goal([700.04, 240]);
    expect(steering.outside).toEqual({ x: 700, y: 240, ...view });
    expect(lab.sent).toHaveLength(1);
    await steering.goal([100, 240]);
    expect(steering.outside).toBeNull();
  });
  test('is reported for a route', async () => {
    steering.point([10, 10], null);
    steering.point([10, -5], null);
    await steering.route();
    expect(steering.outside).toEqual({ x: 10, y: -5, ...view });
    steering.begin();
    expect(steering.outside).toBeNull();
  });
});

describe('a setpoint outside of the arena', () => {
  const box = { left: 0, top: 0, right: 100, bottom: 50 }, drop = { centre_px: [50, 25] as [number, number], radius_px: 20 };
  test.each<[[number, number], boolean, boolean]>([
    [[50, 25], true, true],
    [[70, 25], true, true],
    [[65, 40], false, true],
    [[99999, -5], false, false],
    [[50, 51], false, false],
  ])('%j: in the drop %s, in the box %s', (at, inDrop, inBox) => {
    expect(inArena(at, { box, outline: drop })).toBe(inDrop);
    expect(inArena(at, { box, outline: { ...drop, radius_px: 0 } })).toBe(inBox);
  });
  test('is refused and reported; a setpoint in the arena clears the report', async () => {
    await steering.goal([99999, -5]);
    expect(steering.unreachable).toEqual({ x: 99999, y: -5 });
    expect([lab.sent, steering.asked, steering.outside]).toEqual([[], null, null]);
    await steering.goal([700, 240]);
    expect(steering.unreachable).toBeNull();
    expect(steering.outside).not.toBeNull();
  });
});

describe('a point of a route outside of the arena', () => {
  test('is refused and reported; a point that is moved outside stays', () => {
    steering.point([10, 20], null);
    steering.point([99999, 20], null);
    expect(steering.sketch).toEqual([[10, 20]]);
    expect(steering.unreachable).toEqual({ x: 99999, y: 20 });
    steering.point([-9000, 0], 0);
    expect(steering.sketch).toEqual([[10, 20]]);
    steering.point([11, 20], 0);
    expect([steering.sketch, steering.unreachable]).toEqual([[[11, 20]], null]);
  });
});

describe('undo', () => {
  test('of manual control leaves no direction; of a field, the previous one', async () => {
    const before = lab.scenario;
    steering.pull([1, 0]);
    await settled();
    const first = lab.scenario;
    Object.assign(lab, { undo: async () => (lab.scenario = first) });
    await steering.undo();
    expect(steering.direction[0]).toBeCloseTo(1, 6);
    Object.assign(lab, { undo: async () => (lab.scenario = before) });
    await steering.undo();
    expect(steering.direction).toEqual([0, 0]);
  });
});

describe('a route', () => {
  test('points are added and moved, and the reference with several setpoints is sent', async () => {
    steering.point([1.04, 2], null);
    steering.point([3, 4], null);
    steering.point([5, 6.06], 1);
    expect(steering.sketch).toEqual([[1, 2], [5, 6.1]]);
    await steering.route();
    expect(lab.sent).toEqual([{ reference: { type: 'path', setpoints_px: [[1, 2], [5, 6.1]] } }]);
    expect(steering.sketch).toEqual([]);
  });
  test('remains after a refusal', async () => {
    lab.accepts = false;
    steering.point([1, 2], null);
    await steering.route();
    expect(steering.sketch).toEqual([[1, 2]]);
  });
});

describe('without a schema', () => {
  test('nothing is sent or marked', async () => {
    lab.schema = null;
    expect([steering.mayPull, steering.mayHold, steering.mayRoute, steering.byHand]).toEqual([false, false, false, false]);
    steering.pull([1, 0]);
    await steering.goal([1, 2]);
    steering.point([1, 2], null);
    await steering.route();
    expect(lab.sent).toEqual([]);
    expect([steering.direction, steering.asked]).toEqual([[0, 0], null]);
    expect(steering.sketch).toHaveLength(1);
  });
});
