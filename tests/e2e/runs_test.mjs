// Test of the recorded runs in a browser: table, comparison, replay, deletion with undo, and recording a part. With --pictures
// FOLDER it saves screenshots of the page in FOLDER.
//
//   node tests/e2e/runs_test.mjs --program build/faba --root . [--pictures FOLDER]

import assert from 'node:assert/strict';
import { cpSync, existsSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { address, complaints, faba, finish, kJobPatience, lab, page, panel, serveAgain, shot, step, tab, until, workspace } from './lab_page.mjs';

const runs = join(workspace, 'runs');
const row = (name) => page.locator(`tr[data-run="${name}"]`);
const names = () => page.locator('tbody tr').evaluateAll((rows) => rows.map((r) => r.dataset.run));
const manifest = (name) => JSON.parse(readFileSync(join(runs, name, 'manifest.json'), 'utf8'));
const sortBy = (column) => page.locator('thead').getByRole('button', { name: column, exact: true }).click();
const sorting = (column) => page.locator('thead th', { hasText: column }).getAttribute('aria-sort');
/** The offset of the cursor of each plot, px. */
const cursors = () => page.locator('.shared-cursor:not([hidden])').evaluateAll((all) => all.map((c) => new DOMMatrix(getComputedStyle(c).transform).m41));
const time = async () => Number((await page.locator('[data-read="replay"]').textContent()).match(/[\d.]+/)[0]);

await step('runs are recorded', async () => {
  faba('run', 'scenes/steer.toml', '--duration', '6 s', '--seed', '1', '--out', 'runs/alpha');
  faba('run', 'scenes/steer.toml', '--duration', '3 s', '--seed', '22', '--out', 'runs/beta');
  faba('run', 'scenes/drop.toml', '--as-seen', '--duration', '1 s', '--seed', '3', '--out', 'runs/gamma');
  rmSync(join(runs, 'gamma/tracks.h5')); // as a run on a bench
});

await step('the table lists them, sorted by any column', async () => {
  await page.goto(address);
  await tab('Runs');
  await row('alpha').waitFor();
  assert.deepEqual(await names(), ['gamma', 'beta', 'alpha']);
  assert.equal(await sorting('Date'), 'descending');
  await until(async () => /px|µm/.test(await row('alpha').textContent()), 'the steady error is measured');
  await sortBy('Duration');
  assert.deepEqual(await names(), ['alpha', 'beta', 'gamma']);
  assert.equal(await sorting('Duration'), 'descending');
  assert.equal(await sorting('Date'), 'none');
  await sortBy('Duration');
  assert.deepEqual(await names(), ['gamma', 'beta', 'alpha']);
  assert.equal(await sorting('Duration'), 'ascending');
  await sortBy('Seed');
  assert.deepEqual(await names(), ['alpha', 'gamma', 'beta']);
  await until(() => page.evaluate(() => [...document.querySelectorAll('tbody img')].every((i) => i.naturalWidth > 0)), 'pictures of the runs');
  await shot('runs-table');
});

await step('search, in the address, also after a reload', async () => {
  await page.getByRole('searchbox').fill('STEER 22');
  await until(async () => (await names()).join() === 'beta', 'one run is found');
  await page.getByText('1 of 3 runs').waitFor();
  await page.reload();
  await until(async () => (await names()).join() === 'beta', 'one run is found after the reload');
  await page.getByRole('searchbox').fill('no such run');
  await page.getByText('No run contains “no such run”').waitFor();
  await page.getByRole('searchbox').fill('');
  await until(async () => (await names()).length === 3, 'all runs');
});

await step('a run is renamed and tagged', async () => {
  await row('beta').getByRole('button', { name: 'Edit' }).click();
  const dialog = page.getByRole('dialog');
  await dialog.getByLabel('Name').fill('alpha');
  await dialog.getByLabel('Tags').fill('ageing, drop 2');
  await dialog.getByLabel('Note').fill('<b>second</b>');
  await dialog.getByRole('button', { name: 'Apply' }).click();
  await dialog.getByRole('alert').filter({ hasText: 'the name alpha is already used' }).waitFor();
  complaints.length = 0; // the browser logs the refused request
  await dialog.getByLabel('Name').fill('Beta drift');
  await dialog.getByRole('button', { name: 'Apply' }).click();
  await row('Beta-drift').getByText('ageing', { exact: true }).waitFor();
  assert.deepEqual(JSON.parse(readFileSync(join(runs, 'Beta-drift/tags.json'), 'utf8')), { tags: ['ageing', 'drop 2'], note: '<b>second</b>' });
  assert.ok(!existsSync(join(runs, 'beta')));
  await page.getByRole('searchbox').fill('ageing');
  await until(async () => (await names()).join() === 'Beta-drift', 'the tag is found');
  await page.getByRole('searchbox').fill('');
});

await step('two runs are compared with a shared cursor, and Back returns to the list', async () => {
  assert.ok(await page.getByRole('button', { name: /^Compare selected/ }).isDisabled());
  await page.getByLabel('Select alpha').check();
  await page.getByLabel('Select Beta-drift').check();
  await page.getByRole('button', { name: 'Compare selected (2)' }).click();
  await page.locator('[data-plot="compare-distance"] .u-over').waitFor();
  const plots = await page.locator('figure[data-plot]').count();
  assert.ok(plots >= 4, `${plots} plots`);
  await page.locator('[data-plot="compare-dispersion"] .u-over').hover();
  await until(async () => (await cursors()).length === plots, 'every plot has the cursor');
  const at = await cursors();
  assert.ok(Math.max(...at) - Math.min(...at) < 1.5, `cursors at ${at}`);
  const middle = Number((await page.locator('[data-read="cursor"]').textContent()).match(/^t = (\d\.\d\d) s$/)[1]);
  assert.ok(Math.abs(middle - 3) < 0.05, `the middle of 6 s is at ${middle} s`);
  // beta has ended at 3 s; before that both have a value.
  const values = () => page.locator('[data-plot="compare-distance"] .values b').allTextContents();
  const box = await page.locator('[data-plot="compare-distance"] .u-over').boundingBox();
  await page.mouse.move(box.x + box.width * 0.25, box.y + 20);
  await until(async () => (await values()).every((v) => Number(v) > 0), 'values of both runs at 1.5 s');
  await page.mouse.move(box.x + box.width * 0.75, box.y + 20);
  await until(async () => (await values()).filter(Boolean).length === 1, 'one run has a value at 4.5 s');
  await page.getByLabel('Time from').selectOption('setpoint');
  await shot('runs-compare');
  await page.goBack();
  await row('alpha').waitFor();
});

await step('a run is replayed: one cursor for picture and plots', async () => {
  await page.setViewportSize({ width: 1440, height: 900 });
  await row('alpha').getByRole('link', { name: 'alpha' }).click();
  const slider = page.locator('input[type=range][aria-label="Replay"]');
  await slider.waitFor();
  await until(async () => (await time()) > 0.5, 'the recording plays');
  const [before] = await cursors();
  await until(async () => (await cursors())[0] > before, 'the cursor moves');
  await page.keyboard.press(' ');
  await page.getByRole('button', { name: 'Play' }).waitFor();
  for (const control of [slider, page.getByRole('button', { name: 'Play' }), page.getByRole('button', { name: 'Loop' })]) {
    const box = await control.boundingBox();
    assert.ok(box.y > 0 && box.y + box.height <= 900, `a control at ${box.y} px is not visible at a height of 900 px`);
  }
  assert.equal(await page.evaluate(() => scrollY), 0);
  const over = page.locator('[data-plot="alpha-distance"] .u-over'), box = await over.boundingBox();
  await page.mouse.click(box.x + box.width / 2, box.y + 30);
  const middle = await time();
  assert.ok(Math.abs(middle - 3) < 0.1, `a click in the middle goes to ${middle} s`);
  await page.keyboard.press('ArrowRight');
  await until(async () => (await time()) > middle, 'the next frame');
  await page.keyboard.press('Home');
  assert.equal(await time(), 0);
  await slider.fill('2');
  const all = await cursors();
  assert.ok(all.length >= 4 && Math.max(...all) - Math.min(...all) < 1.5, `cursors at ${all}`);
  // The picture is that of this time: the clock in it cannot be read, but it changes with the frame.
  const picture = () => page.locator('.picture canvas').first().evaluate((c) => c.toDataURL());
  await page.waitForTimeout(300);
  const one = await picture();
  await slider.fill('5');
  await until(async () => (await picture()) !== one, 'another picture');
  await shot('replay');
  await page.reload();
  await slider.waitFor();
  assert.match(page.url(), /#\/runs\/alpha/);
});

await step('a run without tracks is replayed as a video', async () => {
  await page.goto(new URL('/#/runs/gamma', address).href);
  await page.getByText('the picture is its video').waitFor();
  await page.locator('.picture video').waitFor();
  await until(async () => (await time()) > 0.1, 'the video plays');
  complaints.length = 0; // the browser logs the refused request for the tracks
});

await step('runs are deleted after a question, and restored', async () => {
  await tab('Runs');
  await page.getByLabel('Select alpha').check();
  await page.getByLabel('Select gamma').check();
  const ask = page.getByRole('dialog');
  await page.getByRole('button', { name: 'Delete selected (2)' }).click();
  await ask.getByText(/This frees [\d.]+ [kM]B of disk space when the lab ends/).waitFor();
  await shot('runs-delete');
  await page.keyboard.press('Escape');
  assert.ok(existsSync(join(runs, 'alpha')));
  await page.getByRole('button', { name: 'Delete selected (2)' }).click();
  await ask.getByRole('button', { name: 'Delete' }).click();
  await page.getByText(/^2 runs are deleted \([\d.]+ [kM]B\)/).waitFor();
  assert.deepEqual(readdirSync(runs), ['Beta-drift']);
  // Not by any path.
  const hidden = readdirSync(join(workspace, '.faba-trash'))[0];
  for (const path of [`/api/runs/../.faba-trash/${hidden}/1/0/series.csv`, `/api/runs/.faba-trash/${hidden}`, `/runs/%2e%2e/.faba-trash/${hidden}/1/0/series.csv`])
    assert.ok((await page.evaluate((p) => fetch(p).then((r) => r.status), path)) >= 400, path);
  complaints.length = 0;
  await page.reload();
  await page.getByText('Deleted runs').click();
  await page.getByRole('button', { name: 'Undo: alpha' }).click();
  await row('alpha').waitFor();
  // The name of the other one is used again.
  cpSync(join(runs, 'alpha'), join(runs, 'gamma'), { recursive: true });
  await page.getByRole('button', { name: 'Undo', exact: true }).click();
  await page.getByRole('alert').filter({ hasText: 'the name is used again' }).waitFor();
  complaints.length = 0;
  await row('gamma').getByRole('button', { name: 'Delete' }).click();
  await ask.getByRole('button', { name: 'Delete' }).click();
  await page.getByText(/^2 runs are deleted/).waitFor();
  await page.getByText('Deleted runs').click();
  await page.getByRole('button', { name: 'Undo: gamma' }).last().click(); // the older one
  await row('gamma').waitFor();
  assert.ok(existsSync(join(runs, 'gamma/video.mp4')) && !existsSync(join(runs, 'gamma/tracks.h5')));
});

await step('record and stop: a part of the run is saved', async () => {
  await tab('Gallery');
  await page.getByRole('button', { name: 'Steer a swarm along a route' }).click();
  await page.getByRole('button', { name: 'Close' }).click();
  const elapsed = async () => Number((await page.locator('.transport time').textContent()).match(/[\d.]+/)[0]);
  await until(() => page.evaluate(() => document.querySelector('canvas.over')?.lab?.series.newest('t_s') > 0.3), 'the run is at 0.3 s');
  await page.getByRole('button', { name: /Record$/ }).click();
  await until(async () => (await elapsed()) > 0.5, 'the elapsed time is shown');
  await page.reload();
  await until(async () => (await elapsed()) > 1, 'recording continues after a reload');
  await shot('record');
  await page.getByRole('button', { name: /Stop/ }).click();
  await page.getByLabel('Recording name').fill('Part');
  await shot('record-part');
  await page.keyboard.press('Enter');
  await panel('Jobs');
  const job = page.locator('.panel li').first();
  await job.getByText('done', { exact: true }).waitFor({ timeout: kJobPatience });
  const m = manifest('Part');
  assert.ok(m.recorded_s[0] > 0.3 && m.recorded_s[1] - m.recorded_s[0] > 1, `recorded from ${m.recorded_s}`);
  assert.ok(Math.abs(m.duration_s - (m.recorded_s[1] - m.recorded_s[0])) < 1e-6);
  const [, first] = readFileSync(join(runs, 'Part/series.csv'), 'utf8').split('\n').map((l) => l.split(','));
  assert.ok(Math.abs(Number(first[1]) - m.recorded_s[0]) < 1e-6, `the first row is at ${first[1]} s`);
  // The same as in a recording from the beginning.
  const scenario = readFileSync(join(runs, 'Part/scenario.toml'), 'utf8').replace(/^from = .*$/m, '');
  writeFileSync(join(workspace, 'scenes/all.toml'), scenario);
  const all = faba('run', 'scenes/all.toml', '--out', 'all', '--threads', '1');
  assert.equal(all.state_hash, m.state_hash);
  const rows = readFileSync(join(workspace, 'all/series.csv'), 'utf8');
  assert.ok(rows.endsWith(readFileSync(join(runs, 'Part/series.csv'), 'utf8').split('\n').slice(1).join('\n')), 'the part differs from the run');
});

await step('"Save this run" saves from the beginning, cut with the handles', async () => {
  await page.getByRole('button', { name: 'Save this run' }).click();
  await page.getByLabel('Recording name').fill('Cut');
  await page.getByLabel('Start of the recording').focus();
  for (let k = 0; k < 5; ++k) await page.keyboard.press('ArrowRight');
  await page.getByLabel('End of the recording').focus();
  for (let k = 0; k < 3; ++k) await page.keyboard.press('ArrowLeft');
  await page.getByRole('button', { name: 'Save', exact: true }).click();
  await page.getByText('The recording is being written to runs/Cut').waitFor();
  const job = page.locator('.panel li', { hasText: 'Cut' }).first();
  await job.getByText('done', { exact: true }).waitFor({ timeout: kJobPatience });
  const rate = manifest('Cut').frames / manifest('Cut').duration_s;
  assert.ok(Math.abs(manifest('Cut').recorded_s[0] * rate - 5) < 1e-6);
  await tab('Runs');
  await row('Part').getByText(/^part from [\d.]+ s to [\d.]+ s$/).waitFor();
});

await step('the name of a recording that is being written is not given to another run', async () => {
  await tab('Lab');
  await page.getByRole('button', { name: 'Save this run' }).click();
  await page.getByLabel('Recording name').fill('Busy');
  await page.keyboard.press('Enter');
  await until(() => existsSync(join(runs, 'Busy.toml')), 'the recording has started');
  const answer = await page.evaluate(() => fetch('/api/runs/Part/rename', { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify({ to: 'Busy' }) }).then((r) => r.json()));
  assert.match(answer.what, /already used/);
  complaints.length = 0;
  await page.locator('.panel li', { hasText: 'Busy' }).first().getByText('done', { exact: true }).waitFor({ timeout: kJobPatience });
});

await step('Portuguese, dark theme, phone: cards, and nothing is wider than the screen', async () => {
  await tab('Runs');
  await page.getByLabel('Language').selectOption('pt');
  await page.getByLabel('Tema claro ou escuro').click();
  await page.getByRole('heading', { name: 'Gravações' }).waitFor();
  await shot('runs-dark-pt');
  const fits = async (width) => assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= width, `the page is wider than ${width} px`);
  for (const [width, height] of [[390, 844], [768, 1024], [1440, 900], [2560, 1440]]) {
    await page.setViewportSize({ width, height });
    await page.waitForTimeout(200);
    await fits(width);
    await shot(`runs-${width}`);
  }
  await page.setViewportSize({ width: 390, height: 844 });
  await page.getByLabel('Ordenar por').selectOption('name');
  assert.deepEqual((await names())[0], 'alpha');
  await row('alpha').getByRole('link', { name: 'alpha' }).click();
  await page.getByRole('group', { name: 'Controles da reprodução' }).waitFor();
  await page.waitForTimeout(600);
  await fits(390);
  await shot('replay-390');
  await page.setViewportSize({ width: 2560, height: 1440 });
  await page.waitForTimeout(600);
  await shot('replay-2560');
  await page.setViewportSize({ width: 1280, height: 800 });
  await page.getByLabel('Idioma').selectOption('en');
});

await step('a server that does not answer is an error, not an empty list', async () => {
  await tab('Gallery');
  lab.removeAllListeners('exit');
  lab.kill('SIGKILL');
  await page.getByText('Connection lost').waitFor();
  await tab('Runs');
  await page.getByRole('alert').filter({ hasText: 'The server does not answer' }).waitFor();
  assert.equal(await page.getByText('No recorded runs').count(), 0);
  assert.ok(existsSync(join(workspace, '.faba-trash')));
  complaints.length = 0;
});

await step('what a killed lab has left in the trash is removed at the next start, and that of a lab that ends', async () => {
  await serveAgain('--port', new URL(address).port);
  assert.ok(!existsSync(join(workspace, '.faba-trash')));
  await page.goto(address);
  await tab('Runs');
  await row('alpha').getByRole('button', { name: 'Delete' }).click();
  await page.getByRole('dialog').getByRole('button', { name: 'Delete' }).click();
  await page.getByText(/^alpha is deleted/).waitFor();
  assert.ok(existsSync(join(workspace, '.faba-trash')));
  lab.removeAllListeners('exit');
  lab.kill('SIGINT');
  await new Promise((r) => lab.on('exit', r));
  assert.ok(!existsSync(join(workspace, '.faba-trash')));
  complaints.length = 0;
});

await finish();
