// Drawing obstacles and paths by pointer and keyboard.
import { beforeEach, describe, expect, test } from 'vitest';
import { Changes } from '../src/changes.svelte';
import type { Drawing } from '../src/drawing.svelte';
import { variants, type Schema } from '../src/form/schema';
import type { Lab } from '../src/lab.svelte';
import { Steering } from '../src/steering.svelte';
import type { Point } from '../src/view/polygon';
import { sampleSchema } from './sample_schema';

const points: Schema = { type: 'array', items: { type: 'array', items: { type: 'number' } } };
/** With a controller that avoids obstacles and a reference that is a curve. */
function schemaWith(curve: boolean): Schema {
  const schema: Schema = JSON.parse(JSON.stringify(sampleSchema)), { controller, reference } = schema.properties!;
  controller.oneOf!.push({ title: 'eta', 'x-traits': ['feedback'], properties: { type: { const: 'eta' }, obstacle: { type: 'array' }, gain: { type: 'number' } } } as Schema);
  if (curve) reference.oneOf!.push({ title: 'bend', properties: { type: { const: 'bend' }, points_px: points } } as Schema);
  return schema;
}

class FakeLab {
  schema = schemaWith(true);
  scenario: Record<string, any> = { controller: { type: 'eta' }, estimator: { type: 'guess' } };
  scene = { view: { width: 640, height: 480 }, outline: { centre_px: [320, 240], radius_px: 0 }, box: { left: 0, top: 0, right: 639, bottom: 479 } };
  polarity = 1;
  sent: Record<string, any>[] = [];
  async exchange(event: Record<string, any>) {
    this.sent.push(event);
    await Promise.resolve();
    this.scenario = { ...this.scenario, ...event };
    return { ok: true };
  }
}

let lab: FakeLab, steering: Steering, drawing: Drawing;
beforeEach(() => {
  lab = new FakeLab();
  steering = new Steering(lab as unknown as Lab);
  drawing = steering.drawing;
});
const key = (name: string, more = {}) => drawing.key({ key: name, shiftKey: false, ctrlKey: false, metaKey: false, altKey: false, ...more });
const settled = () => new Promise((r) => setTimeout(r));
const triangle: Point[] = [[100, 100], [200, 100], [150, 180]];

describe('an obstacle by pointer', () => {
  test('is sent with the present controller, rounded to 0.1 px', async () => {
    drawing.start('obstacle');
    [[100.04, 100], [200, 100], [150, 180]].forEach((q) => drawing.place(q as Point));
    await drawing.finish();
    expect(lab.sent).toEqual([{ controller: { type: 'eta', obstacle: [{ corners_px: triangle }] } }]);
    expect([drawing.tool, drawing.corners]).toEqual([null, []]);
  });
  test('the second click of a double click adds no corner, and a click on the first corner closes', async () => {
    drawing.start('obstacle');
    triangle.forEach((q) => (drawing.place(q, 6), drawing.place([q[0] + 1, q[1]], 6)));
    expect(drawing.corners).toEqual(triangle);
    drawing.place([102, 101], 6);
    await settled();
    expect(lab.sent).toHaveLength(1);
  });
  test('a second obstacle is added; both can be removed', async () => {
    lab.scenario.controller = { type: 'eta', gain: 3, obstacle: [{ corners_px: triangle }] };
    drawing.start('obstacle');
    const other: Point[] = [[300, 300], [400, 300], [400, 400]];
    other.forEach((q) => drawing.place(q));
    await drawing.finish();
    expect(lab.scenario.controller).toEqual({ type: 'eta', gain: 3, obstacle: [{ corners_px: triangle }, { corners_px: other }] });
    await drawing.remove(0);
    expect(lab.scenario.controller.obstacle).toEqual([{ corners_px: other }]);
    await drawing.remove(5);
    expect(lab.sent).toHaveLength(2);
  });
  test('a click on an obstacle selects it, and Delete removes it', async () => {
    lab.scenario.controller = { type: 'eta', obstacle: [{ corners_px: triangle }] };
    drawing.start('obstacle');
    drawing.place([150, 120]);
    expect([drawing.selected, drawing.corners]).toEqual([0, []]);
    expect(key('Delete')).toBe(true);
    await settled();
    expect(lab.scenario.controller.obstacle).toEqual([]);
  });
  test.each([
    [triangle.slice(0, 2), 'draw.few_corners'],
    [[[0, 0], [10, 10], [10, 0], [0, 10]], 'draw.crosses'],
  ] as [Point[], string][])('%j is not sent, with the reason', async (corners, problem) => {
    drawing.start('obstacle');
    corners.forEach((q) => drawing.place(q));
    await drawing.finish();
    expect([drawing.problem, drawing.tool, lab.sent]).toEqual([problem, 'obstacle', []]);
    drawing.removeLast();
    expect([drawing.problem, drawing.corners.length]).toEqual([null, corners.length - 1]);
  });
});

describe('a controller that does not avoid obstacles', () => {
  const draw = async () => {
    drawing.start('obstacle');
    triangle.forEach((q) => drawing.place(q));
    await drawing.finish();
  };
  test('is replaced only after the answer, by one with default values', async () => {
    lab.scenario.controller = { type: 'alpha', gain: 7, field: [0, 0] };
    await draw();
    expect([lab.sent, drawing.waiting]).toEqual([[], triangle]);
    await drawing.switchController();
    expect(lab.sent).toEqual([{ controller: { type: 'eta', obstacle: [{ corners_px: triangle }] } }]);
    expect(drawing.waiting).toBeNull();
  });
  test('during manual control, the controller before it is used', async () => {
    lab.scenario.controller = { type: 'eta', gain: 4 };
    steering.pull([1, 0]);
    await settled();
    await draw();
    expect(lab.sent.at(-1)).toEqual({ controller: { type: 'eta', gain: 4, obstacle: [{ corners_px: triangle }] }, estimator: { type: 'guess' } });
  });
});

describe('by keyboard', () => {
  test('arrows move the cross-hair from the centre, within the box', () => {
    drawing.start('obstacle');
    key('ArrowRight');
    key('ArrowUp', { shiftKey: true });
    expect(drawing.cursor).toEqual([330, 239]);
    for (let i = 0; i < 80; ++i) key('ArrowLeft');
    expect(drawing.cursor).toEqual([0, 239]);
  });
  test('Space adds corners, Backspace removes one, Enter sends', async () => {
    drawing.start('obstacle');
    key(' '); // shows the cross-hair
    key(' ');
    ['ArrowRight', ' ', 'ArrowDown', ' ', 'ArrowDown', ' ', 'Backspace', 'Enter'].forEach((k) => key(k));
    await settled();
    expect(lab.sent).toEqual([{ controller: { type: 'eta', obstacle: [{ corners_px: [[320, 240], [330, 240], [330, 250]] }] } }]);
  });
  test('Escape cancels; then no key is used', () => {
    drawing.start('obstacle');
    key(' ');
    key(' ');
    expect(key('Escape')).toBe(true);
    expect([drawing.tool, drawing.corners, drawing.cursor]).toEqual([null, [], null]);
    expect([key('ArrowLeft'), key('Escape'), key(' ')]).toEqual([false, false, false]);
  });
  test('other keys and shortcuts remain those of the page', () => {
    drawing.start('path');
    expect([key('f'), key('Enter', { ctrlKey: true }), key('Delete')]).toEqual([false, false, false]);
  });
});

describe('a path', () => {
  const draw = async () => {
    drawing.start('path');
    [[10, 20], [30, 40]].forEach((q) => drawing.place(q as Point));
    await drawing.finish();
  };
  test('is one curve, or separate setpoints', async () => {
    await draw();
    expect(lab.sent).toEqual([{ reference: { type: 'bend', points_px: [[10, 20], [30, 40]] } }]);
    expect([drawing.tool, steering.sketch]).toEqual([null, []]);
    drawing.asCurve = false;
    await draw();
    expect(lab.sent[1]).toEqual({ reference: { type: 'path', setpoints_px: [[10, 20], [30, 40]] } });
  });
  test('is a list of setpoints if the program has no curve', async () => {
    lab.schema = schemaWith(false);
    expect(variants(lab.schema.properties!.reference)).not.toContain('bend');
    await draw();
    expect(lab.sent[0].reference.type).toBe('path');
  });
  test('needs two points; a point outside the arena is refused; Escape discards them', async () => {
    drawing.start('path');
    drawing.place([10, 20]);
    drawing.place([9999, 20]);
    await drawing.finish();
    expect([drawing.problem, steering.sketch, lab.sent]).toEqual(['draw.few_points', [[10, 20]], []]);
    key('Escape');
    expect([drawing.tool, steering.sketch]).toEqual([null, []]);
  });
});

test('obstacles that are drawn quickly one after the other are undone one by one; a drag of the field at once', () => {
  const changes = new Changes(), first = { controller: { type: 'eta', obstacle: [1] } }, second = { controller: { type: 'eta', obstacle: [1, 2] } };
  changes.add({ controller: { type: 'eta' } }, first, 0);
  changes.add(first, second, 10);
  expect(changes.back).toEqual(first);
  changes.removeNewest();
  expect(changes.back).toEqual({ controller: { type: 'eta' } });
  const fields = new Changes();
  [1, 2].forEach((x) => fields.add({ controller: { type: 'zeta' } }, { controller: { type: 'gamma', field: [x, 0] } }, x));
  expect(fields.back).toEqual({ controller: { type: 'zeta' } });
});
