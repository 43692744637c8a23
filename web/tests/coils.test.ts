import { describe, expect, test } from 'vitest';
import { Evaluator, type Evaluation, type Request } from '../src/coils/evaluator.svelte';
import { angleOf, handles, hull, movedTo, outlines, resizedTo, seen, snapped, turnedBy, turnedTo, type Point } from '../src/coils/geometry';
import { History } from '../src/coils/history';
import { added, duplicated, inwards, kEmpty, limited, mirrored, newCoil, systemOf, tables, without, type Coil, type System, type Vec } from '../src/coils/system';
import { fieldText, placeText, significant } from '../src/coils/text';
import { level } from '../src/coils/drawing';

const at = (...position: Vec) => newCoil(kEmpty, 'solenoid', position, 'coil');
const right = at(0.035, 0, 0);
const one: System = added(kEmpty, right);
const first = (s: System): Coil => s.coils[0];
const extent = (points: Point[], k: 0 | 1) => Math.max(...points.map((p) => p[k])) - Math.min(...points.map((p) => p[k]));

describe('a new coil', () => {
  test('points to the centre', () => {
    expect(right.axis).toEqual([-1, 0, 0]);
    expect(at(0, 0.035, 0).axis).toEqual([0, -1, 0]);
    expect(at(0, 0, -0.035).axis).toEqual([0, 0, 1]);
    expect(inwards([0, 0, 0])).toEqual([1, 0, 0]);
  });
  test('has a name that no other has', () => {
    const two = added(one, newCoil(one, 'loop', [0, 0, 0], 'coil'));
    expect(two.coils.map((c) => c.name)).toEqual(['coil 1', 'coil 2']);
    expect(newCoil(without(two, 1), 'loop', [0, 0, 0], 'coil').name).toBe('coil 3');
    expect(new Set(two.coils.map((c) => c.id)).size).toBe(2);
  });
  test('mirrored: on the other side, with a field towards the centre as well', () => {
    expect(mirrored(one, right, 'coil')).toMatchObject({ position: [-0.035, 0, 0], axis: [1, 0, 0], name: 'coil 2' });
    expect(duplicated(one, right, 0.01, 'coil')).toMatchObject({ position: [0.045, -0.01, 0], axis: right.axis });
  });
});

describe('a drag', () => {
  test('moves to the grid, in the plane of the view only', () => {
    expect(first(movedTo(one, right, 'top', [0.0204, -0.0102], 0.001)).position).toEqual([0.02, -0.01, 0]);
    expect(first(movedTo(one, right, 'side', [0.0204, -0.0102], 0.001)).position).toEqual([0.02, 0, -0.01]);
    expect(first(movedTo(one, right, 'top', [0.02041, 0], 0)).position).toEqual([0.02041, 0, 0]);
    expect(snapped(0.0349999, 0.001)).toBe(0.035);
  });
  test('turns in steps, and keeps the part of the axis out of the plane', () => {
    const up = first(turnedTo(one, right, 'top', [0.036, 0.03], 15));
    expect(up.axis).toEqual([0, 1, 0]);
    const inclined = { ...right, axis: [1, 0, 1] as Vec };
    const turned = first(turnedTo(added(kEmpty, inclined), inclined, 'top', [0.035, 0.1], 15));
    expect(turned.axis[2]).toBeCloseTo(Math.SQRT1_2, 5);
    expect(angleOf(turned, 'top')).toBeCloseTo(Math.PI / 2, 5);
    expect(first(turnedBy(one, right, 'side', Math.PI / 2, 0)).axis).toEqual([0, 0, 1]);
  });
  test('resizes radius and length; the handle follows the pointer', () => {
    const bigger = first(resizedTo(one, right, 'top', [0.015, -0.008], 0.001));
    expect(bigger.size).toMatchObject({ radius: 0.008, length: 0.04, turns: 400 });
    const size = handles(right, 'top', 0).size!;
    expect(first(resizedTo(one, right, 'top', size, 0)).size.length).toBeCloseTo(0.04, 9);
    expect(first(resizedTo(one, right, 'top', [0.035, 0], 0.001)).size).toMatchObject({ radius: 0.001, length: 0.001 });
  });
  test('of a coil seen along its axis changes its radius only', () => {
    const up: Coil = { ...right, axis: [0, 0, 1] };
    expect(first(resizedTo(added(kEmpty, up), up, 'top', [0.035, 0.012], 0.001)).size).toMatchObject({ radius: 0.012, length: 0.04 });
  });
});

describe('an outline', () => {
  test('has the length and the width of the coil', () => {
    const [outline] = outlines(right, 'top');
    expect(extent(outline, 0)).toBeCloseTo(0.04, 9);
    expect(extent(outline, 1)).toBeCloseTo(0.01, 4);
  });
  test('seen along the axis is a circle; a Helmholtz pair has two', () => {
    const up: Coil = { ...right, axis: [0, 0, 1] };
    expect(extent(outlines(up, 'top')[0], 0)).toBeCloseTo(0.01, 4);
    expect(outlines(newCoil(kEmpty, 'helmholtz', [0, 0, 0], 'c'), 'top')).toHaveLength(2);
  });
  test('the hull of a square with a point in it has four corners', () => {
    expect(hull([[0, 0], [1, 0], [0.5, 0.5], [1, 1], [0, 1]])).toHaveLength(4);
  });
  test('the views', () => expect([seen([1, 2, 3], 'top'), seen([1, 2, 3], 'side')]).toEqual([[1, 2], [1, 3]]));
});

describe('the file', () => {
  const given = { earth: { field: ['18 uT', 0, '-13 uT'] }, coil: [{ type: 'solenoid', radius: '5 mm', position: ['35 mm', 0, 0], gain: 1.03, resistance: '4 ohm' }] };
  const resolved = {
    earth: { field: ['1.8e-05 T', '0 T', '-1.3e-05 T'] },
    coil: [{ type: 'solenoid', radius: '0.005 m', length: '0.04 m', turns: 400, wire_radius: null, position: ['0.035 m', '0 m', '0 m'], axis: [-1, 0, 0], name: 'a', gain: 1.03, current: '0 A', max_current: null, resistance: '4 ohm' }],
  };
  test('has quantities with units, and no rounding errors', () => {
    const moved = movedTo(one, right, 'top', [0.1 + 0.2, 0], 0.001);
    expect(tables(moved)).toEqual({
      coil: [{ name: 'coil 1', type: 'solenoid', radius: '5 mm', length: '40 mm', turns: 400, position: ['300 mm', '0 mm', '0 mm'], axis: [-1, 0, 0], max_current: '0.5 A' }],
    });
  });
  test('is read with the defaults, and keeps keys that the editor does not have', () => {
    const s = systemOf(given, resolved);
    expect(s.earth).toEqual([1.8e-5, 0, -1.3e-5]);
    expect(first(s)).toMatchObject({ name: 'a', max: null, size: { radius: 0.005, length: 0.04, turns: 400 }, other: { gain: 1.03, resistance: '4 ohm' } });
    expect((tables(s).coil as object[])[0]).toMatchObject({ gain: 1.03, resistance: '4 ohm', radius: '5 mm' });
    expect(tables(s).earth).toEqual({ field: ['18 uT', '0 uT', '-13 uT'] });
  });
  test('a current is within the limit', () => expect([limited(0.7, 0.5), limited(-0.7, 0.5), limited(3, null)]).toEqual([0.5, -0.5, 3]));
});

describe('undo', () => {
  test('a gesture is one step, and none without a change', () => {
    const h = new History<number>();
    h.begin(1);
    h.step(1);
    h.step(2);
    h.end(3);
    expect([h.undo(3), h.redo(1), h.undo(3)]).toEqual([1, 3, 1]);
    expect(h.undo(1)).toBe(1);
    h.begin(1);
    h.end(1);
    expect(h.canUndo).toBe(false);
  });
  test('a change after undo ends redo', () => {
    const h = new History<string>();
    h.step('a');
    expect(h.undo('b')).toBe('a');
    h.step('a');
    expect(h.canRedo).toBe(false);
  });
});

describe('the evaluation', () => {
  test('has one request at a time, and afterwards only the newest', async () => {
    const asked: number[] = [], answers: (() => void)[] = [];
    const evaluator = new Evaluator((r) => {
      asked.push(r.columns);
      return new Promise((resolve) => answers.push(() => resolve({ coils: [String(r.columns)] } as unknown as Evaluation)));
    });
    const request = (columns: number) => evaluator.request({ columns } as Request);
    request(1);
    request(2);
    request(3);
    expect(asked).toEqual([1]);
    answers[0]();
    await new Promise((r) => setTimeout(r));
    expect(asked).toEqual([1, 3]);
    expect(evaluator.answer?.coils).toEqual(['1']);
    answers[1]();
    await new Promise((r) => setTimeout(r));
    expect([evaluator.answer?.coils, evaluator.count]).toEqual([['3'], 2]);
  });
  test('an answer for a coil system that was removed is not displayed, and an error is', async () => {
    let fail = false, answer = () => {};
    const evaluator = new Evaluator(() => new Promise((resolve, reject) => (answer = () => (fail ? reject(new Error('x')) : resolve({} as Evaluation)))));
    evaluator.request({} as Request);
    evaluator.request(null);
    answer();
    await new Promise((r) => setTimeout(r));
    expect(evaluator.answer).toBe(null);
    fail = true;
    evaluator.request({} as Request);
    answer();
    await new Promise((r) => setTimeout(r));
    expect(String(evaluator.trouble)).toBe('Error: x');
  });
});

test('numbers have the digits of the command line', () => {
  expect([fieldText(1.483143e-4), fieldText(-6.0621e-3), fieldText(null), fieldText(0)]).toEqual(['148.3 µT', '−6.062 mT', '–', '0 µT']);
  expect([significant(-0.389432, 6), significant(0.0359, 4), placeText(-6.38841e-3), placeText(-1e-12)]).toEqual(['−0.389432', '0.0359', '−6.3884', '0.0000']);
  expect([level(1e-9), level(1e-4), level(1)]).toEqual([0, 0.5, 1]);
});
