// Keyboard only: an experiment is imported and measured, figures, tracks, runs, the workbench and the viewer are used without a
// mouse. Every control is reached by Tab, so that a control that has no place in the order of the focus fails the test.
//
//   node tests/e2e/keyboard_test.mjs --program build/faba --root .

import assert from 'node:assert/strict';
import { copyFileSync, existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { address, faba, finish, kJobPatience, page, read, step, tab, until, workspace } from './lab_page.mjs';

const kMostTabs = 400;
const key = (...keys) => keys.reduce((before, k) => before.then(() => page.keyboard.press(k)), Promise.resolve());
const has = (locator) => locator.evaluate((e) => e === document.activeElement).catch(() => false);
/** Whether the element with the focus, the label around it or something in it looks different from one without. */
const isVisible = () =>
  page.evaluate(() => {
    const focused = document.activeElement, all = [focused, focused.closest('label'), ...focused.querySelectorAll('*')].filter(Boolean);
    const properties = ['outlineStyle', 'outlineWidth', 'boxShadow', 'borderColor', 'backgroundColor', 'stroke', 'strokeWidth'];
    const look = () => all.map((e) => properties.map((p) => getComputedStyle(e)[p]).join()).join();
    const now = look();
    focused.blur();
    const before = look();
    focused.focus({ focusVisible: true, preventScroll: true });
    return now !== before;
  });
/** Moves the focus by Tab until it is on the control. */
async function reach(control, back = false) {
  await control.waitFor({ state: 'attached' });
  for (let k = 0; k < kMostTabs; ++k) {
    if (await has(control)) return assert.ok(await isVisible(), `the focus is not visible on ${control}`);
    await key(back ? 'Shift+Tab' : 'Tab');
  }
  assert.fail(`the focus does not reach ${control} by Tab`);
}
const press = async (control, k = 'Enter') => (await reach(control), await key(k));
const type = async (control, text) => (await reach(control), await key('Control+a'), await page.keyboard.type(text), await key('Tab'));
const go = (place) => press(page.locator('nav').getByRole('link', { name: new RegExp(`^${place}`) }));
const button = (name) => page.getByRole('button', { name, exact: true });
const toml = () => readFileSync(join(workspace, 'experiments/keys/experiment.toml'), 'utf8');

page.on('filechooser', () => {}); // the dialog is intercepted from now on

faba('run', 'scenes/short-response.toml', '--as-seen', '--seed', '3', '--out', 'runs/response');
const film = join(workspace, 'film.avi');
copyFileSync(join(workspace, 'runs/response/video.avi'), film);

await step('an experiment is created, and a video is imported with the dialog of the browser', async () => {
  await page.goto(address);
  await page.getByRole('heading', { name: 'Scenes' }).waitFor();
  await go('Experiments');
  await type(page.getByLabel('New experiment'), 'Keys');
  await press(button('Create'));
  await press(button('Add a drop'));
  await page.locator('.drops li').first().waitFor();
  const input = page.locator('.dropzone input');
  await reach(input);
  const [chooser] = await Promise.all([page.waitForEvent('filechooser'), key('Enter')]);
  await chooser.setFiles(film);
  await page.locator('tbody tr').first().waitFor();
});

await step('the exposure and the field of the video are set', async () => {
  await type(page.getByLabel('Air exposure, film.avi').first(), '60 s');
  await until(() => /exposure = "?60/.test(toml()), 'the exposure is saved');
  await type(page.getByLabel('Field reversal at, film.avi').first(), '1 s');
  const dial = page.getByRole('slider', { name: 'Field direction after it, film.avi' });
  await reach(dial);
  await key('PageUp');
  await until(async () => (await dial.getAttribute('aria-valuenow')) === '45', 'the dial turns');
  await until(() => /field_direction/.test(toml()), 'the direction is saved');
});

await step('the activity is measured, and its result is opened', async () => {
  await press(page.getByRole('button', { name: /activity/i }).or(page.getByRole('link', { name: /activity/i })).first());
  await press(button('Start').first());
  await press(page.getByRole('link', { name: /^Show job \d+$/ }));
  await page.locator('.state.done').first().waitFor({ timeout: kJobPatience });
  await press(page.locator('section').getByRole('link', { name: 'Show result' }).first());
  await page.locator('.report .plot').first().waitFor();
});

await step('a series of a figure is hidden, and the figure is zoomed', async () => {
  const figure = page.locator('.report figure').filter({ has: page.locator('.plot') }).first();
  const series = figure.locator('button[aria-pressed]').first();
  await press(series, 'Space');
  assert.equal(await series.getAttribute('aria-pressed'), 'false');
  await key('Enter');
  assert.equal(await series.getAttribute('aria-pressed'), 'true');
  const ticks = () => figure.locator('g[data-ticks] text').allTextContents();
  const before = await ticks();
  await reach(figure.locator('.plot'), true);
  await key('+', '+', '+');
  await until(async () => String(await ticks()) !== String(before), 'the figure is enlarged');
  await key('0');
  assert.deepEqual(await ticks(), before);
});

await step('tracks: a cut in a histogram', async () => {
  const folder = 'runs/keys-tracks';
  faba('track', 'film.avi', '--result', folder);
  await page.evaluate((f) => (location.hash = `#/tracks?${new URLSearchParams({ file: 'film.avi', folder: f, step: 'filter' })}`), folder);
  await page.getByText('tracks are used').waitFor();
  const [, all] = await read('used');
  const limit = page.locator('[data-feature="speed"]').getByRole('slider', { name: 'Speed: Minimum' });
  await reach(limit);
  for (let k = 0; k < 25; ++k) await key('Shift+ArrowRight');
  await until(async () => (await read('used'))[0] < all, 'the cut leaves fewer tracks');
  await until(() => existsSync(join(workspace, folder, 'edits.toml')), 'the cut is saved');
});

await step('the workbench: a setpoint is set, the swarm reaches it, and a column is resized', async () => {
  await page.setViewportSize({ width: 1600, height: 900 });
  await go('Gallery');
  await press(page.locator('.cards').getByRole('button', { name: 'Steer a swarm along a route' }));
  await page.locator('[data-read="swarm"]').waitFor();
  await until(async () => (await read('swarm'))[0] > 0, 'the swarm is shown');
  const hint = button('Close');
  if (await hint.count()) await press(hint.first());
  await type(page.getByLabel('x (px)'), '300');
  await type(page.getByLabel('y (px)'), '300');
  await press(button('Set').first());
  await until(async () => (await read('goal'))[0] < 15, 'the setpoint is reached');
  const split = page.getByRole('separator').first();
  await reach(split);
  const width = await split.getAttribute('aria-valuenow');
  await key('ArrowRight');
  if ((await split.getAttribute('aria-valuenow')) === width) await key('ArrowLeft');
  assert.notEqual(await split.getAttribute('aria-valuenow'), width);
});

await step('a run is deleted and restored', async () => {
  await go('Runs');
  const row = page.locator('tr, .cards li').filter({ has: page.getByRole('link', { name: 'response', exact: true }) }).first();
  await press(row.getByRole('button', { name: 'Delete' }));
  await press(page.getByRole('dialog').getByRole('button', { name: 'Delete' }));
  await page.getByText(/^response is deleted/).waitFor();
  assert.ok(!existsSync(join(workspace, 'runs/response')));
  await press(button('Undo'));
  await row.waitFor();
  assert.ok(existsSync(join(workspace, 'runs/response')));
});

await step('the viewer is scrubbed', async () => {
  await page.evaluate(() => (location.hash = '#/video?file=film.avi'));
  const slider = page.getByLabel('Position in the video');
  await reach(slider);
  const at = () => slider.evaluate((e) => Number(e.value ?? e.getAttribute('aria-valuenow')));
  await key('Home');
  const first = await at();
  await key('ArrowRight', 'ArrowRight', 'ArrowRight');
  await until(async () => (await at()) > first, 'the viewer moves by keys');
  await key('End');
  await until(async () => (await at()) > first + 0.5, 'the viewer goes to the end');
});

await finish();
