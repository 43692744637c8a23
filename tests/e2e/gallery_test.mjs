// Test of the gallery, the form and the set-up of the user's own drop in a browser. Stops with an error at the first failed
// step. With --pictures FOLDER it saves screenshots in FOLDER; --www FOLDER reads the files of the page from a folder.
//
//   node tests/e2e/gallery_test.mjs --program build/faba --root . [--data ../shared/data] [--pictures FOLDER]

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { existsSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { address, complaints, faba, finish, option, page, panel, program, read, root, shot, skip, step, tab, until, workspace } from './lab_page.mjs';

const scenes = readdirSync(join(workspace, 'scenes')).filter((f) => f.endsWith('.toml') && f !== 'gallery.toml').map((f) => f.slice(0, -5));
const cards = page.locator('.cards li');
const next = () => page.getByRole('button', { name: 'Next', exact: true });
const isAt = (name) => page.getByRole('heading', { name, level: 3, exact: true }).waitFor();
const choose = (file) => page.locator('.dropzone input').setInputFiles(file);
/** A grey picture as PGM; `grey` gives the value of a pixel. */
function pgm(name, w, h, grey) {
  const px = Buffer.alloc(w * h);
  for (let y = 0; y < h; ++y) for (let x = 0; x < w; ++x) px[y * w + x] = grey(x, y);
  const file = join(workspace, name);
  writeFileSync(file, Buffer.concat([Buffer.from(`P5\n${w} ${h}\n255\n`), px]));
  return file;
}
/** Waits until the page has drawn two frames. */
const drawn = () => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
/** A drop with a blurred edge and noise. */
const drop = (x0, y0, r) => (x, y) => Math.round(110 + 40 / (1 + Math.exp(Math.hypot(x - x0, y - y0) - r)) + 6 * (Math.random() - 0.5));

await step('the gallery has sections by purpose, and a scene of the user is in the last one', async () => {
  writeFileSync(join(workspace, 'scenes/my-scene.toml'), readFileSync(join(workspace, 'scenes/steer.toml'), 'utf8').replace(/title = .*/, "title = 'My scene'"));
  await page.goto(address);
  await page.getByRole('heading', { name: 'Scenes' }).waitFor();
  await cards.first().waitFor();
  assert.deepEqual(await page.locator('section h3').allTextContents(), ['Start here', 'Steer', 'Step responses', 'Coils', 'Thesis', 'Yours']);
  const yours = page.locator('h3', { hasText: 'Yours' }).locator('+ ul');
  assert.deepEqual(await yours.locator('strong').allTextContents(), ['My scene'], 'every other scene is listed in scenes/gallery.toml');
  assert.equal(await cards.count(), scenes.length + 1);
  rmSync(join(workspace, 'scenes/my-scene.toml'));
});

await step('a card has model, controller and cells, and no command line; many cells give a warning', async () => {
  const basic = cards.filter({ hasText: 'Thesis, controller experiment, Basic model' });
  await basic.getByText('model basic, controller fuzzy · 500 cells').waitFor();
  await cards.filter({ hasText: 'Steer a swarm along a route' }).getByText('model dipole IT-1, controller proportional').waitFor();
  for (const text of await page.locator('.cards button').allTextContents()) assert.doesNotMatch(text, /faba run/, 'a command line in a card');
  const bench = cards.filter({ hasText: 'simulation or bench' });
  await bench.getByText('More').click();
  await bench.locator('details code, details p').first().waitFor();
  assert.deepEqual(await page.locator('.heavy').locator('xpath=..').locator('strong').allTextContents(), ['A million cells']);
  await shot('gallery-cards');
});

await step('every scene of the gallery starts', async () => {
  const titles = await page.locator('.cards strong').allTextContents();
  for (const title of titles.filter((t) => t !== 'My scene')) {
    await tab('Gallery');
    await cards.filter({ has: page.getByText(title, { exact: true }) }).getByRole('button').click();
    await page.locator('.stage').waitFor({ state: 'visible' });
    await until(() => page.evaluate((t) => document.querySelector('canvas.over')?.lab.scenario.title === t && document.querySelector('canvas.over').lab.frame?.cells > 0, title), `${title} starts`);
    assert.equal(await page.locator('.banner.wrong').count(), 0, title);
  }
});

await step('the simple panel starts the basic and fuzzy set-up of the thesis', async () => {
  await tab('Gallery');
  await page.getByRole('button', { name: 'Swarm steered to the centre of a drop' }).click();
  await page.locator('.stage').waitFor({ state: 'visible' });
  await panel('Scenario');
  assert.equal(await page.getByRole('button', { name: 'Simple', exact: true }).getAttribute('aria-pressed'), 'true');
  // The scene gives preset = "IT-1" and three other speeds; the program resolves both to values.
  const preset = page.getByLabel('preset', { exact: true });
  assert.equal(await preset.inputValue(), 'IT-1', 'the form shows custom values for preset = "IT-1"');
  assert.match(await preset.locator('option:checked').textContent(), /IT-1 \(3 changed\)/);
  await page.getByLabel('Ready-made set-up').selectOption({ label: 'Thesis, controller experiment, Basic model' });
  assert.equal(await page.getByLabel('Noise amplitude max_speed').inputValue(), '8');
  await page.getByLabel('Number of cells count').fill('120');
  await shot('simple');
  await page.getByRole('button', { name: 'Restart with these settings' }).click();
  await until(() => page.evaluate(() => document.querySelector('canvas.over').lab.frame?.cells === 120), 'the set-up runs with 120 cells');
  const s = await page.evaluate(() => document.querySelector('canvas.over').lab.scenario);
  assert.deepEqual([s.swarm[0].model.type, s.controller.type], ['basic', 'fuzzy']);
});

await step('the full form is searched by title, key and description, and the choice of the form is remembered', async () => {
  await page.getByRole('button', { name: 'All settings', exact: true }).click();
  await page.getByLabel('Search the settings').fill('noise amplitude');
  const noise = page.getByLabel('Noise amplitude max_speed');
  await noise.waitFor({ state: 'visible' });
  await noise.focus();
  await page.getByText('not a swimming speed').waitFor();
  assert.equal(await page.getByLabel('Number of cells count').isVisible(), false);
  await page.getByLabel('Search the settings').fill('max_current');
  await page.getByLabel('Max current max_current').waitFor({ state: 'visible' }); // its section was folded
  await page.getByLabel('Search the settings').fill('no such thing');
  await page.getByText('No setting has all these words').waitFor();
  await page.getByLabel('Search the settings').fill('');
  await noise.fill('-3');
  await page.getByText('Noise amplitude “-3” must be at least 0').waitFor(); // object and cause, beside the control
  await shot('full-form');
  await page.getByRole('button', { name: 'Undo', exact: true }).click();
  await page.reload();
  await panel('Scenario');
  assert.equal(await page.getByRole('button', { name: 'All settings', exact: true }).getAttribute('aria-pressed'), 'true');
  await page.getByRole('button', { name: 'Simple', exact: true }).click();
});

await step('a text file gives an error without a path, and the previous picture does not remain', async () => {
  await tab('Gallery');
  await choose(pgm('made.pgm', 640, 480, drop(200, 300, 420)));
  await isAt('Edge');
  await page.locator('.picture svg circle').first().waitFor();
  await page.getByRole('link', { name: '1. Picture' }).click();
  await isAt('Picture');
  writeFileSync(join(workspace, 'notes.txt'), 'these are notes');
  await choose(join(workspace, 'notes.txt'));
  const alert = page.getByRole('alert').filter({ hasText: 'notes.txt: cannot be read as a picture or video' });
  await alert.waitFor();
  assert.doesNotMatch(await alert.textContent(), /\/tmp|upload-|\.part/, 'a temporary path');
  assert.equal(await page.locator('.picture').count(), 0, 'the picture of the previous file is still shown');
  assert.ok(await next().isDisabled());
  complaints.length = 0; // the browser logs the refused request
});

await step('a picture without a drop: the reason, no circle, three points on an edge, or a box', async () => {
  await choose(pgm('flat.pgm', 320, 240, (x) => Math.round(90 + x / 8 + 4 * (Math.random() - 0.5))));
  await isAt('Edge');
  await page.getByText('No edge was detected:').waitFor();
  assert.equal(await page.locator('.picture svg circle').count(), 0, 'a circle is drawn where none was found');
  assert.ok(await next().isDisabled());
  await page.getByText('To continue, draw a circle').waitFor();
  await page.getByRole('button', { name: 'Draw a circle' }).click();
  const box = await page.locator('.picture svg').boundingBox(), k = box.width / 320;
  for (const deg of [20, 130, 250]) await page.mouse.click(box.x + k * (160.5 + 80 * Math.cos((deg * Math.PI) / 180)), box.y + k * (120.5 + 80 * Math.sin((deg * Math.PI) / 180)));
  const radius = page.getByLabel('radius r');
  assert.ok(Math.abs(Number(await radius.inputValue()) - 80) < 1, `radius ${await radius.inputValue()} px`);
  await page.reload();
  assert.ok(Math.abs(Number(await radius.inputValue()) - 80) < 1, 'a reload loses the circle');
  await page.getByRole('button', { name: 'Continue with a box' }).click();
  assert.equal(await page.locator('.picture svg circle').count(), 0);
  assert.ok(await next().isEnabled());
  await shot('own-box');
});

const real = option('data') && join(option('data'), 'drops', '00000.tif');
const picture = real && existsSync(real) ? real : pgm('round.pgm', 518, 488, drop(258, 228, 163));
if (picture !== real) skip('--data has no drops/00000.tif: a made picture replaces the real one');
await step(`the drop of ${real === picture ? 'a real picture' : 'a made picture'}: found, corrected by hand, scaled, started; a reload in every step keeps the state`, async () => {
  await page.getByRole('link', { name: '1. Picture' }).click();
  await choose(picture);
  await isAt('Edge');
  await page.getByText(/radius 16\d(\.\d+)? ± 0\.\d+ px, (35\d|360)° of the edge visible/).waitFor();
  await page.getByRole('link', { name: '1. Picture' }).click();
  await page.reload();
  await page.locator('.picture img').waitFor();
  await next().click();
  const radius = page.getByLabel('radius r'), x = page.locator('.numbers input').first();
  const before = [Number(await x.inputValue()), Number(await radius.inputValue())];
  await page.getByRole('application').focus();
  await page.keyboard.press('Shift+ArrowRight');
  await page.keyboard.press('+');
  await page.getByText('was changed by hand').waitFor();
  const after = [before[0] + 10, before[1] + 1];
  const shown = async () => [Number(await x.inputValue()), Number(await radius.inputValue())];
  for (const [i, v] of (await shown()).entries()) assert.ok(Math.abs(v - after[i]) < 0.02, `${v} instead of ${after[i]}`);
  await shot('own-edge');
  await page.reload();
  for (const [i, v] of (await shown()).entries()) assert.ok(Math.abs(v - after[i]) < 0.02, `${v} after a reload instead of ${after[i]}`);
  await next().click();

  await isAt('Scale');
  assert.ok(await next().isDisabled());
  await page.getByLabel('Measured: a line of known length').check();
  const box = await page.locator('.picture svg').boundingBox(), k = box.width / 518;
  await page.mouse.move(box.x + 50.5 * k, box.y + 100.5 * k);
  await page.mouse.down();
  await page.mouse.move(box.x + 250.5 * k, box.y + 100.5 * k, { steps: 4 });
  await page.mouse.up();
  await page.getByLabel('Length, µm').fill('100');
  await page.getByText(/^0\.(5|499|501)\d* µm\/px: the picture is/).waitFor();
  await shot('own-scale');
  await page.reload();
  assert.equal(await page.getByLabel('Length, µm').inputValue(), '100');
  await page.getByText(/^0\.(5|499|501)\d* µm\/px: the picture is/).waitFor();
  await next().click();

  await isAt('Cells');
  await page.getByLabel('Number of cells').fill('250');
  await page.getByLabel('In a disc in the middle').check();
  await shot('own-cells');
  await page.reload();
  assert.equal(await page.getByLabel('Number of cells').inputValue(), '250');
  assert.ok(await page.getByLabel('In a disc in the middle').isChecked());
  await next().click();

  await isAt('Start');
  await page.reload();
  await page.getByText('250 cells of the model').waitFor();
  await shot('own-start');
  await page.goBack(); // the address of every step is in the history
  await isAt('Cells');
  await page.goForward();
  await isAt('Start');
  const [saved] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Export the scenario' }).click()]);
  writeFileSync(join(workspace, 'own.toml'), readFileSync(await saved.path()));
  await page.getByRole('button', { name: 'Start', exact: true }).click();
  await page.locator('.stage').waitFor({ state: 'visible' });
  await until(() => page.evaluate(() => document.querySelector('canvas.over').lab.frame?.cells === 250), 'the swarm is shown');
  const s = await page.evaluate(() => document.querySelector('canvas.over').lab.scenario);
  assert.ok(Math.abs(s.arena.centre_px[0] - after[0]) < 0.02 && Math.abs(s.arena.radius_px - after[1]) < 0.02, JSON.stringify(s.arena));
  assert.ok(Math.abs(s.scale.um_per_px - 0.5) < 0.005);
  assert.deepEqual(readdirSync(join(workspace, 'pictures')), [picture.replace(/.*\//, '')]);
});

await step('the photograph is under the cells', async () => {
  const photo = page.locator('.stage .holder img');
  await until(() => photo.evaluate((i) => i.naturalWidth === 518), 'the photograph is loaded');
  await until(async () => (await read('swarm'))[0] > 0, 'the swarm is shown');
  await page.waitForTimeout(500);
  await shot('own-lab');
  // The picture and the cells have the same place: its width on the screen is that of 518 px.
  const [seen, expected] = await page.evaluate(() => {
    const c = document.querySelector('canvas.over'), ratio = c.width / c.getBoundingClientRect().width;
    return [document.querySelector('.stage .holder img').getBoundingClientRect().width, (c.toCanvas(517.5, 0)[0] - c.toCanvas(-0.5, 0)[0]) / ratio];
  });
  assert.ok(Math.abs(seen - expected) < 1, `${seen} and ${expected} px`);
  await page.getByLabel('Photograph').uncheck();
  await photo.waitFor({ state: 'detached' });
  await page.getByLabel('Photograph').check();
});

await step('the exported scenario runs in a terminal, and its camera sees the photograph', async () => {
  const run = faba('run', 'own.toml', '--duration', '0.4 s', '--as-seen', '--out', 'own-run', '--seed', '1');
  assert.match(run.state_hash, /^[0-9a-f]+$/);
  assert.ok(existsSync(join(workspace, 'own-run/video.mp4')));
});

await step('a video of a drop, a picture of the folder, and a picture with many pixels', async () => {
  faba('run', 'scenes/drop.toml', '--as-seen', '--duration', '0.2 s', '--out', 'seen', '--seed', '3');
  await tab('Gallery');
  await choose(join(workspace, 'seen/video.mp4'));
  await isAt('Edge');
  const truth = JSON.parse(readFileSync(join(workspace, 'seen/manifest.json'), 'utf8')).arena.radius_px;
  const found = Number(await page.getByLabel('radius r').inputValue());
  assert.ok(Math.abs(found - truth) < 0.03 * truth, `radius ${found} px, true value ${truth} px`);
  await page.getByRole('link', { name: '1. Picture' }).click();
  await page.getByLabel('Or a picture in the folder of the lab').selectOption('made.pgm');
  await isAt('Edge');
  assert.ok(Math.abs(Number(await page.getByLabel('radius r').inputValue()) - 420) < 5);
  await page.getByRole('link', { name: '1. Picture' }).click();
  await choose(pgm('large.pgm', 6000, 4000, drop(3000, 2000, 1500)));
  await page.getByRole('heading', { name: 'Edge', level: 3 }).waitFor({ timeout: 120000 });
  assert.ok(Math.abs(Number(await page.getByLabel('radius r').inputValue()) - 1500) < 20);
});

await step('Portuguese, dark theme, small screen', async () => {
  await page.getByLabel('Language').selectOption('pt');
  await page.getByLabel('Tema claro ou escuro').click();
  await page.getByRole('heading', { name: 'Sua própria gota' }).waitFor();
  await page.setViewportSize({ width: 390, height: 844 });
  for (const [place, content] of [['gallery', '.cards li'], ['own/edge', '.picture svg'], ['lab', '.stage']]) {
    await page.goto(new URL(`/#/${place}`, address).href);
    await page.locator(content).first().waitFor({ state: 'visible' });
    // The page learns the size of its window when the next frame is drawn, on a slow machine after seconds.
    await drawn();
    assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= 390, `${place} is wider than the screen of a phone`);
    await shot(`phone-${place.replace('/', '-')}`);
  }
  await page.goto(new URL('/#/gallery', address).href);
  await page.getByRole('button', { name: 'Conduzir um enxame por uma rota' }).waitFor();
});

await step('the list of parts has its columns apart', async () => {
  const { stdout } = spawnSync(program, ['parts'], { cwd: root, encoding: 'utf8' });
  for (const line of stdout.split('\n').filter((l) => l.startsWith('  '))) assert.match(line, /^ {2}\S+ {2,}\S/, line);
});

await finish();
