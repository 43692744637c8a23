// The planner of the optics in the lab: immediate answers that equal those of the command, an address with the changed values, and
// errors of the program.
//
//   node tests/e2e/optics_page_test.mjs --program build/faba --root . [--pictures FOLDER]

import assert from 'node:assert/strict';
import { address, complaints, faba, finish, page, shot, step, until } from './lab_page.mjs';

const figure = (name) => page.locator(`[data-figure="${name}"]`).textContent();
const quality = (measurement) => page.locator(`[data-measurement="${measurement}"]`).getAttribute('class').then((c) => c.split(' ').find((w) => ['good', 'doubtful', 'poor'].includes(w)));
const verdicts = async () => Object.fromEntries(await Promise.all(['flow', 'tracking', 'response', 'drop_edge', 'swarm'].map(async (m) => [m, await quality(m)])));
/** The verdicts of the command for the same setup. */
const planned = (...words) => Object.fromEntries(faba('optics', ...words).verdicts.map((v) => [v.measurement, v.quality]));
const input = (label) => page.getByLabel(label, { exact: false }).first();

await page.goto(address);

await step('the page Analyse leads to the planner, which starts with the setup of the thesis', async () => {
  await page.goto(`${address.split('#')[0]}#/analyse`);
  await page.getByRole('link', { name: 'Plan the optics' }).click();
  await page.locator('[data-figure="view"]').waitFor();
  assert.match(page.url(), /#\/optics$/);
  assert.equal(await figure('view'), '513 × 385 µm');
  assert.deepEqual(await verdicts(), planned());
  await shot('optics-10x');
});

await step('another objective: the answers, the drawing, the address and the command follow', async () => {
  const drawn = () => page.locator('figure svg').first().getAttribute('aria-label');
  const before = await drawn();
  await page.getByLabel('Objective', { exact: true }).selectOption('100x');
  await until(async () => (await figure('view')) === '51.3 × 38.5 µm', 'the view of 100x is shown');
  assert.deepEqual(await verdicts(), planned('--objective', '100x'));
  assert.equal(await quality('swarm'), 'poor');
  assert.ok(await page.getByText('Cells leave the view before a swarm forms.').isVisible());
  assert.notEqual(await drawn(), before);
  assert.match(page.url(), /#\/optics\?preset=100x$/);
  assert.ok(await page.getByText('faba optics --objective 100x', { exact: true }).isVisible());
  await shot('optics-100x');
});

await step('a typed frame rate is in the address, and a reload keeps it', async () => {
  await input('Frame rate').fill('240 Hz');
  await until(async () => (await figure('displacement')).startsWith('9.67 px'), 'the displacement at 240 Hz is shown');
  assert.deepEqual(await verdicts(), planned('--objective', '100x', '--frame-rate', '240 Hz'));
  await page.reload();
  await until(async () => (await figure('displacement')).startsWith('9.67 px'), 'the displacement after the reload');
  assert.match(await input('Frame rate').inputValue(), /^240/);
});

await step('a value out of range is refused at its input, and a contradiction by the program', async () => {
  await input('Frame rate').fill('-3 Hz');
  await page.locator('.field .wrong').first().waitFor();
  await input('Frame rate').fill('240 Hz');
  await input('Exposure time').fill('10 ms');
  await page.getByRole('alert').filter({ hasText: 'must be at most the frame period' }).waitFor();
  assert.match(complaints.splice(0).join(), /422/); // the browser logs the refused request
  await input('Exposure time').fill('1 ms');
  await until(async () => (await page.getByRole('alert').count()) === 0, 'the error disappears');
});

await step('in Portuguese', async () => {
  await page.getByLabel('Language').selectOption('pt');
  await page.getByRole('heading', { name: 'Planejador da óptica' }).waitFor();
  await page.getByText('As células deixam o campo de visão antes de um enxame se formar.').waitFor();
});

await finish();
