import { describe, expect, test } from 'vitest';
import { currentText, lengthText, lengthUnit } from '../src/units';
import { kDefault, kSplitter, moved, range, validFractions, widths } from '../src/workbench/columns';
import { keyAction } from '../src/workbench/keys';
import { controllerInCharge, modelsOf } from '../src/workbench/run_summary';
import { sampleSchema } from './sample_schema';

describe('the columns', () => {
  const picture = (f = kDefault, width: number) => width - 2 * kSplitter - widths(f, width).setup - widths(f, width).plots;

  test.each([1000, 1280, 1440, 1920, 2560, 3840])('all have room in a window of %d px, and the picture is the widest', (width) => {
    const w = widths(kDefault, width);
    expect(Math.min(w.setup, w.plots)).toBeGreaterThanOrEqual(250);
    expect(picture(kDefault, width)).toBeGreaterThan(Math.max(w.setup, w.plots));
  });
  test('an extreme division leaves room for each column', () => {
    for (const f of [{ setup: 0.99, plots: 0.99 }, { setup: 0.01, plots: 0.01 }, { setup: 0.01, plots: 0.99 }])
      for (const width of [1000, 1440, 2560]) {
        const w = widths(f, width);
        expect(Math.min(w.setup, w.plots)).toBeGreaterThanOrEqual(250);
        expect(picture(f, width)).toBeGreaterThanOrEqual(360);
      }
  });
  test('are moved by pixels, within their range', () => {
    const width = 1440, before = widths(kDefault, width), wider = moved(kDefault, 'setup', 40, width);
    expect(widths(wider, width)).toEqual({ setup: before.setup + 40, plots: before.plots });
    expect(widths(moved(kDefault, 'plots', -30, width), width).plots).toBe(before.plots - 30);
    expect(widths(moved(kDefault, 'setup', -5000, width), width).setup).toBe(range('setup', kDefault, width)[0]);
    expect(widths(moved(kDefault, 'setup', 5000, width), width)).toEqual({ setup: Math.round(range('setup', kDefault, width)[1]), plots: before.plots });
  });
  test('stored values that are not valid give the default', () => {
    for (const v of [null, 3, {}, { setup: 0.2 }, { setup: NaN, plots: 0.2 }, { setup: '0.2', plots: 0.2 }, { setup: 0.2, plots: 7 }]) expect(validFractions(v)).toEqual(kDefault);
    expect(validFractions({ setup: 0.2, plots: 0.3 })).toEqual({ setup: 0.2, plots: 0.3 });
  });
});

describe('keys', () => {
  const key = (name: string, more = {}) => ({ key: name, ctrlKey: false, metaKey: false, altKey: false, shiftKey: false, target: { tagName: 'BODY' }, ...more });
  test.each([[' ', 'pause'], ['.', 'step'], ['r', 'reverse'], ['0', 'stop'], ['+', 'in'], ['f', 'fit'], ['?', 'help'], ['ArrowLeft', 'arrow'], ['x', null]])('%s: %s', (name, action) => {
    expect(keyAction(key(name), true)).toBe(action);
  });
  test('Ctrl+Z and Cmd+Z undo; other shortcuts of the browser are left to it', () => {
    expect(keyAction(key('z', { ctrlKey: true }), true)).toBe('undo');
    expect(keyAction(key('z', { metaKey: true }), true)).toBe('undo');
    for (const e of [key('z', { ctrlKey: true, shiftKey: true }), key('r', { ctrlKey: true }), key('0', { metaKey: true }), key('f', { altKey: true })]) expect(keyAction(e, true)).toBeNull();
  });
  test('that the focused element uses', () => {
    for (const tagName of ['INPUT', 'SELECT', 'TEXTAREA']) for (const name of ['r', 'ArrowUp', ' ', '?']) expect(keyAction(key(name, { target: { tagName, type: 'text' } }), true)).toBeNull();
    expect(keyAction(key('z', { ctrlKey: true, target: { tagName: 'INPUT', type: 'text' } }), true)).toBeNull();
    expect(keyAction(key(' ', { target: { tagName: 'BUTTON' } }), true)).toBeNull();
    expect(keyAction(key('r', { target: { tagName: 'BUTTON' } }), true)).toBe('reverse');
    expect(keyAction(key('r', { target: { tagName: 'INPUT', type: 'checkbox' } }), true)).toBe('reverse');
    expect(['ArrowUp', 'r'].map((k) => keyAction(key(k, { target: { tagName: 'INPUT', type: 'range' } }), true))).toEqual([null, 'reverse']);
  });
  test('of a page without control change the view only', () => {
    expect(['f', '+', '?', ' ', 'r', 'ArrowUp'].map((k) => keyAction(key(k), false))).toEqual(['fit', 'in', 'help', null, null, null]);
  });
});

describe('the header', () => {
  test('names each different model once, with its preset', () => {
    const swarm = [{ model: { type: 'rod', preset: 'first' } }, { model: 'dot' }, { model: { type: 'rod', preset: 'first' } }, { model: { type: 'rod', preset: '' } }];
    expect(modelsOf(sampleSchema, { swarm })).toEqual([{ type: 'rod', preset: 'first' }, { type: 'dot' }, { type: 'rod' }]);
    expect(modelsOf(null, {})).toEqual([]);
  });
  test.each([
    [{ type: 'gamma' }, 'by_hand', 'gamma'],
    [{ type: 'beta' }, 'schedule', 'beta'],
    ['alpha', 'feedback', 'alpha'],
    [undefined, 'feedback', 'zeta'],
  ])('the controller %j is %s: %s', (controller, kind, name) => {
    expect(controllerInCharge(sampleSchema, { controller })).toEqual({ kind, name });
  });
});

describe('units', () => {
  test('lengths are in micrometres if the scale is known and the user does not want pixels', () => {
    expect(lengthText(10, lengthUnit(1.16, 'um'))).toBe('11.6');
    expect(lengthUnit(1.16, 'px')).toEqual({ name: 'px', perPixel: 1 });
    expect(lengthUnit(null, 'um')).toEqual({ name: 'px', perPixel: 1 });
    expect(lengthText(NaN, lengthUnit(2, 'um'))).toBe('–');
  });
  test.each([[0.123, '123 mA'], [-0.0052, '−5.2 mA'], [0, '0 mA'], [-1e-6, '0 mA'], [1.5, '1.50 A'], [0.9996, '1.00 A'], [-0.99, '−990 mA'], [NaN, '–']])('%d A is %s', (amperes, text) => {
    expect(currentText(amperes)).toBe(text);
  });
});
