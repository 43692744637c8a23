// Test of the live lab in a browser. Stops with an error at the first failed step. With --pictures FOLDER it saves
// screenshots of the page in FOLDER.
//
//   node tests/e2e/lab_test.mjs --program build/faba --root . [--pictures docs/img/lab] [--www web/dist]

import assert from 'node:assert/strict';
import { existsSync, mkdirSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { address, complaints, context, faba, finish, kJobPatience, lab, page, panel, pictures, place, read, serveAgain, shot, step, tab, until, workspace } from './lab_page.mjs';
import { phoneSteps, workbenchSteps } from './workbench_steps.mjs';

await step('the gallery opens, and the token is removed from the address', async () => {
  await page.goto(address);
  await page.getByRole('heading', { name: 'Scenes' }).waitFor();
  assert.equal(new URL(page.url()).search, '');
  const cards = page.locator('.cards li');
  await cards.first().waitFor();
  assert.equal(await cards.count(), readdirSync(join(workspace, 'scenes')).filter((f) => f.endsWith('.toml') && f !== 'gallery.toml').length);
  await until(() => page.evaluate(() => [...document.querySelectorAll('.cards img')].slice(0, 6).every((i) => i.naturalWidth > 0)), 'pictures of the scenes');
  await shot('gallery');
});

await step('a scene is started', async () => {
  await page.getByRole('button', { name: 'Steer a swarm along a route' }).click();
  await page.getByText('Drag on the picture: the swarm swims').waitFor();
  await until(async () => (await read('swarm'))[0] > 0, 'the swarm is shown');
  await shot('first');
  const [hint, view] = [await page.locator('.hint').boundingBox(), await page.locator('.view').boundingBox()];
  assert.ok(hint.y >= view.y + view.height || hint.y + hint.height <= view.y, 'the hint covers the picture');
  await page.getByRole('button', { name: 'Close' }).click();
  await until(async () => (await read('swarm'))[0] > 120, 'the swarm moves along its route');
  await shot('route');
});

await step('dragging applies a field that moves the swarm', async () => {
  const [x, y] = await place(300, 200), [x1, y1] = await place(300, 420);
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let i = 1; i <= 10; ++i) await page.mouse.move(x + ((x1 - x) * i) / 10, y + ((y1 - y) * i) / 10);
  await shot('pull');
  const before = await read('swarm');
  await until(async () => (await read('swarm'))[1] > before[1] + 25, 'the centroid moves downwards');
  await page.mouse.up();
  const there = await read('swarm');
  assert.ok(Math.abs(there[0] - before[0]) < 25, `the swarm moved sideways: ${before} to ${there}`);
});

await step('the field is reversed, and the swarm moves back', async () => {
  const before = await read('swarm');
  await page.getByRole('button', { name: 'Reverse field' }).click();
  await until(async () => (await read('swarm'))[1] < before[1] - 20, 'the centroid moves upwards');
});

await step('arrow keys apply a field', async () => {
  const before = await read('swarm');
  await page.keyboard.down('ArrowRight');
  await until(async () => (await read('swarm'))[0] > before[0] + 15, 'the centroid moves to the right');
  await page.keyboard.up('ArrowRight');
  assert.equal(await page.locator('[data-read="goal"]').count(), 0, 'the distance to a setpoint that the manual field does not use');
});

await step('a setpoint outside the arena is refused, at its control and on the picture', async () => {
  const controller = () => page.evaluate(() => JSON.stringify(document.querySelector('canvas.over').lab.scenario.reference));
  const before = await controller();
  await page.getByLabel('x (px)').fill('700');
  await page.getByLabel('y (px)').fill('-5');
  await page.getByRole('button', { name: 'Set', exact: true }).click();
  const note = page.getByRole('status').filter({ hasText: 'is outside the arena and was not set' });
  await note.waitFor();
  assert.equal(await page.getByLabel('x (px)').getAttribute('aria-invalid'), 'true');
  await page.locator('#setpoint-refused').getByText('(700.0, -5.0) px').waitFor();
  await shot('refused');
  assert.equal(await controller(), before);
  await note.getByRole('button', { name: 'Close' }).click();
  await page.locator('#setpoint-refused').waitFor({ state: 'detached' });
});

await step('a click sets a setpoint, and the swarm reaches it', async () => {
  await page.mouse.click(...(await place(250, 300)));
  await until(async () => (await read('goal'))[0] > 0, 'the distance to the setpoint is shown');
  await until(async () => (await read('goal'))[0] < 12, 'the setpoint is reached');
  await shot('goal');
});

await workbenchSteps();

await step('pause, next frame, speed', async () => {
  await page.getByRole('button', { name: 'Pause' }).click();
  await page.getByRole('button', { name: 'Resume' }).waitFor();
  await page.waitForTimeout(200);
  const still = await read('swarm');
  await page.waitForTimeout(300);
  assert.deepEqual(await read('swarm'), still);
  await page.getByRole('button', { name: 'Next frame' }).click();
  await page.locator('.transport select').selectOption('4');
  await page.getByRole('button', { name: 'Resume' }).click();
});

await step('a route is drawn and followed', async () => {
  for (const q of [[200, 200], [320, 140], [430, 220]]) {
    await page.keyboard.down('Shift');
    await page.mouse.click(...(await place(...q)));
    await page.keyboard.up('Shift');
  }
  assert.equal(await page.locator('.panel ol li').count(), 3);
  await shot('sketch');
  await page.getByRole('button', { name: 'Follow route' }).click();
  await until(async () => (await page.locator('.panel ol li').count()) === 0, 'the route is sent');
  await until(async () => (await read('swarm'))[0] > 350, 'the swarm follows the route');
});

await step('a parameter of the model is changed during the run', async () => {
  await panel('Scenario');
  await page.getByRole('button', { name: 'All settings', exact: true }).click();
  const speed = page.getByRole('group', { name: 'Model', exact: true }).getByLabel('Speed speed', { exact: true });
  await speed.fill('-5 um/s');
  await page.getByText('must be at least').waitFor();
  await speed.fill('3 bananas');
  await page.getByText('has the wrong unit; it needs a unit such as').waitFor();
  await page.getByRole('button', { name: 'Undo', exact: true }).click();
  assert.match(await speed.inputValue(), /^[\d.]+ µm\/s$/);
  assert.equal(await page.getByText('needs a unit such as').count(), 0);
  // An error of the program that concerns two values is shown at their part.
  await speed.fill('5000 um/s');
  await page.locator('[data-refused="swarm[0].model"]').getByText('is above speed_max').waitFor();
  await page.locator('[data-refused="swarm[0].model"]').getByText('reduce speed or increase speed_max').waitFor();
  await speed.fill('60 um/s');
  await page.getByRole('button', { name: 'Apply' }).click();
  await until(async () => (await page.getByRole('button', { name: 'Apply' }).count()) === 0, 'the change is applied');
  await shot('scenario');
});

let recorded = '';
await step('the run is recorded, and the recording has the same state', async () => {
  await page.getByRole('button', { name: 'Save this run' }).click();
  await page.getByLabel('Recording name').fill('By hand');
  await page.keyboard.press('Enter');
  await panel('Jobs');
  const job = page.locator('.panel li').first();
  await job.getByText('done', { exact: true }).waitFor({ timeout: kJobPatience });
  recorded = /\(([0-9a-f]+)\)/.exec(await job.textContent())[1];
  await shot('work');
  const manifest = JSON.parse(readFileSync(join(workspace, 'runs/By-hand/manifest.json'), 'utf8'));
  assert.equal(manifest.state_hash, recorded);
  const again = faba('run', 'runs/By-hand/scenario.toml', '--out', 'again', '--threads', '1');
  assert.equal(again.state_hash, recorded);
});

await step('plots are drawn, compared with the recording, and saved', async () => {
  await tab('Runs');
  await shot('runs');
  await page.locator('tbody tr').first().getByRole('link', { name: 'By-hand', exact: true }).click();
  await page.getByRole('button', { name: 'Compare', exact: true }).click();
  await tab('Lab');
  await panel('Plots');
  await page.locator('.panel canvas').first().waitFor();
  await page.waitForTimeout(500);
  await shot('plots');
  const saved = async (button) => {
    const [d] = await Promise.all([page.waitForEvent('download'), button.click()]);
    return readFileSync(await d.path());
  };
  assert.ok((await saved(page.getByRole('button', { name: 'PNG' }).first())).subarray(1, 4).equals(Buffer.from('PNG')));
  assert.match(String(await saved(page.getByRole('button', { name: 'SVG' }).first())), /^<svg[^]*<path d="M/);
  assert.match(String(await saved(page.getByRole('button', { name: 'CSV' }))), /^frame,t_s,true_centroid_x_px/);
});

await step('the recording is replayed', async () => {
  await tab('Runs');
  await page.getByRole('link', { name: 'By-hand' }).click();
  const slider = page.locator('input[type=range][aria-label="Replay"]');
  await slider.waitFor();
  await until(async () => Number(await slider.inputValue()) > 0.2, 'the recording plays');
  await slider.fill('1');
  await page.waitForTimeout(300);
  assert.equal(Number(await slider.inputValue()), 1);
  await shot('replay');
});

await step('a recording with a name that is already used gets another name, and the page reports it', async () => {
  await tab('Lab');
  await panel('Jobs');
  await page.getByRole('button', { name: 'Save this run' }).click();
  await page.getByLabel('Recording name').fill('By hand');
  await page.keyboard.press('Enter');
  await page.getByText('The name By-hand is already used: the recording is being written to runs/By-hand-2.').waitFor();
  assert.ok(existsSync(join(workspace, 'runs/By-hand-2.toml')));
  const job = page.locator('.panel li').first();
  await job.getByRole('button', { name: 'Cancel' }).click();
  await job.getByText('cancelled').waitFor();
});

await step('the edge of a drop is detected in an uploaded video', async () => {
  faba('run', 'scenes/drop.toml', '--as-seen', '--duration', '0.2 s', '--out', 'seen', '--seed', '3');
  await tab('Gallery');
  await page.locator('.dropzone input').setInputFiles(join(workspace, 'seen/video.mp4'));
  await page.getByRole('heading', { name: 'Edge', exact: true }).waitFor();
  await page.waitForTimeout(300);
  await shot('drop');
  const radius = page.getByLabel('radius r');
  const found = Number(await radius.inputValue());
  const truth = JSON.parse(readFileSync(join(workspace, 'seen/manifest.json'), 'utf8')).arena.radius_px;
  assert.ok(Math.abs(found - truth) < 0.03 * truth, `radius ${found} px, true value ${truth} px`);
  await radius.fill(String(Math.round(found) + 5));
  const next = page.getByRole('button', { name: 'Next', exact: true });
  await next.click();
  await page.getByLabel('Unknown: lengths in px').check();
  await next.click();
  await next.click();
  await page.getByRole('button', { name: 'Start', exact: true }).click();
  await until(async () => (await read('swarm'))[0] > 0, 'a swarm is shown in the drop');
  await shot('own-drop');
});

await step('camera picture, density and trails', async () => {
  await page.getByLabel('Camera picture').check();
  await page.waitForTimeout(700);
  await shot('camera');
  await page.getByLabel('Camera picture').uncheck();
  await page.getByLabel('Density').check();
  await page.getByLabel('Trails').check();
  await page.waitForTimeout(700);
  await shot('density');
  await page.getByLabel('Density').uncheck();
  await page.getByLabel('Trails').uncheck();
});

await step('the density of a large swarm is shown with its scale', async () => {
  const scenario = { arena: { type: 'drop', radius_px: 300 }, swarm: [{ count: 25000, model: { type: 'dipole', preset: 'IT-1' } }] };
  await page.evaluate((s) => document.querySelector('canvas.over').lab.ask('start', { scenario: s, seed: 1 }), scenario);
  await until(async () => (await read('density')).at(-1) > 0, 'the scale of the density is shown');
  await until(() => page.evaluate(() => document.querySelector('canvas.over').lab.frame?.sites?.columns > 0), 'the server sends an occupancy grid');
  await shot('dense');
});

await step('the picture is drawn with WebGL', async () => {
  await page.evaluate(() => localStorage.setItem('faba.renderer', '"webgl"'));
  await page.reload();
  await until(async () => (await read('swarm'))[0] > 0, 'connected again');
  assert.equal(await page.evaluate(() => document.querySelector('canvas.over').seen.renderer), 'webgl');
  await page.waitForTimeout(300);
  await shot('webgl');
  const blue = await page.evaluate(() => {
    const from = document.querySelector('.stage canvas'), to = document.createElement('canvas').getContext('2d');
    to.canvas.width = from.width;
    to.canvas.height = from.height;
    to.drawImage(from, 0, 0);
    const px = to.getImageData(0, 0, from.width, from.height).data;
    let n = 0;
    for (let i = 0; i < px.length; i += 4) n += px[i + 2] > px[i] + 60;
    return n;
  });
  assert.ok(blue > 300, `${blue} pixels of cells`);
  await page.evaluate(() => localStorage.removeItem('faba.renderer'));
});

await step('camera of a bench: picture, gain, and calibration with a ruler', async () => {
  // A ruler with dark marks every 12.4 px on a bright background; every tenth mark is longer.
  const [w, h, pitch] = [640, 480, 12.4], grey = Buffer.alloc(w * h, 205);
  for (let k = 1; k * pitch < w - 6; k++)
    for (let y = 120; y < (k % 10 ? 260 : 340); y++)
      for (let x = Math.floor(k * pitch) - 2; x < k * pitch + 4; x++)
        grey[y * w + x] = Math.round(205 - 150 * Math.exp(-(((x - k * pitch) / 1.3) ** 2) / 2));
  mkdirSync(join(workspace, 'ruler'));
  writeFileSync(join(workspace, 'ruler/1.pgm'), Buffer.concat([Buffer.from(`P5\n${w} ${h}\n255\n`), grey]));
  writeFileSync(
    join(workspace, 'scenes/ruler.toml'),
    "title = 'A ruler'\n[arena]\ntype = 'box'\nsize_px = [640, 480]\n[[swarm]]\ncount = 1\n" +
      "[rig]\ndriver = 'none'\n[rig.camera]\ntype = 'playback'\nfile = '../ruler'\nfps = 5\n",
  );
  await tab('Bench');
  const picture = page.getByAltText('Camera picture');
  const open = async (scene) => {
    await page.getByLabel('Scene with a bench').selectOption(scene);
    await page.getByRole('button', { name: 'Open the camera' }).click();
    await until(() => picture.evaluate((i) => i.naturalWidth === 640).catch(() => false), 'a picture is shown');
  };
  const mean = async () => Number((await page.getByText(/^mean grey level \d+ of 255$/).textContent()).match(/\d+/)[0]);
  await open('bench');
  const first = await picture.getAttribute('src');
  await until(async () => (await picture.getAttribute('src')) !== first, 'the picture is updated');
  await until(async () => /[1-9]\d*\.\d Hz/.test(await page.locator('.caption').textContent()), 'the frame rate is shown');
  const part = (name) => page.getByRole('navigation', { name: 'Bench' }).getByRole('link', { name, exact: true }).click();
  await part('Scale');
  await page.getByRole('button', { name: 'Measure the ruler' }).click();
  const missing = page.getByRole('alert').filter({ hasText: 'no ruler detected' });
  await missing.waitFor();
  assert.doesNotMatch(await missing.textContent(), /ruler-taken/);
  await missing.getByRole('button', { name: 'Close' }).click();
  complaints.length = 0; // the browser logs the refused request
  const before = await mean();
  await part('Camera');
  await page.getByLabel('Gain').fill('0.5');
  await page.getByLabel('Gain').press('Enter');
  await until(async () => Math.abs((await mean()) - before / 2) < 3, 'the picture has half the brightness');
  await page.getByLabel('Gain').fill('99');
  await page.getByLabel('Gain').press('Enter');
  const alert = page.getByRole('alert').filter({ hasText: 'between 0.1 and 10' });
  await alert.waitFor();
  assert.equal(await page.getByLabel('Gain').inputValue(), '0.5'); // that of the camera
  await alert.getByRole('button', { name: 'Close' }).click();
  await alert.waitFor({ state: 'detached' });
  complaints.length = 0; // the browser logs the refused request
  await page.getByLabel('Gain').fill('1');
  await page.getByLabel('Gain').press('Enter');
  await until(async () => Math.abs((await mean()) - before) < 3, 'the picture has the previous brightness');
  await shot('bench');
  await page.getByRole('button', { name: 'Close the camera' }).click();
  await open('ruler');
  await part('Scale');
  await page.getByLabel('Objective').fill('20x');
  await page.getByLabel('Distance between marks').fill('10');
  await page.getByRole('button', { name: 'Measure the ruler' }).click();
  await page.getByText('calibrations/20x.toml').first().waitFor();
  await shot('ruler');
  const scale = Number(readFileSync(join(workspace, 'calibrations/20x.toml'), 'utf8').match(/um_per_px = ([\d.]+)/)[1]);
  assert.ok(Math.abs(scale - 10 / pitch) < 0.002, `${scale} um/px`);
  await page.getByRole('button', { name: 'Close the camera' }).click();
});

await step('a second page is read-only until it takes control', async () => {
  await tab('Lab');
  const other = await context.newPage();
  await other.goto(new URL('/', address).href);
  await other.getByRole('button', { name: 'Take control' }).waitFor();
  assert.ok(await other.getByRole('button', { name: 'Pause' }).isDisabled());
  await other.getByRole('button', { name: 'Take control' }).click();
  await page.getByText('Another page controls the swarm').waitFor();
  await other.close();
  await page.getByText('Another page controls the swarm').waitFor({ state: 'detached' });
});

await step('a lost connection is reported, and the page reconnects', async () => {
  lab.kill('SIGSTOP'); // the server hangs: the connection stays open without responses
  await page.getByText('Connection lost').waitFor();
  await page.getByText('No connection: this picture is not current').waitFor();
  await shot('frozen');
  for (const name of ['Undo change', 'Pause', 'Next frame', 'Record']) assert.ok(await page.getByRole('button', { name }).isDisabled(), `${name} is enabled without a connection`);
  assert.equal(await page.locator('aside button:enabled:not([role=tab])').count(), 0, 'the panel is enabled without a connection');
  lab.kill('SIGCONT');
  await until(async () => (await page.getByText('Connection lost').count()) === 0, 'connected again');
  const before = await read('swarm');
  await until(async () => String(await read('swarm')) !== String(before), 'the run continues');
});

await step('Portuguese, dark theme, small screen, 200 % zoom', async () => {
  await page.getByLabel('Language').selectOption('pt');
  await page.getByRole('button', { name: 'Pausar' }).waitFor();
  await page.getByLabel('Tema claro ou escuro').click();
  assert.equal(await page.locator('html').getAttribute('lang'), 'pt-BR');
  await shot('dark-pt');
  await page.setViewportSize({ width: 390, height: 844 });
  await page.waitForTimeout(300);
  assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= 390, 'the page is wider than the screen of a phone');
  await shot('phone');
  await phoneSteps();
  await page.setViewportSize({ width: 640, height: 400 }); // 1280 x 800 at 200 %
  await page.waitForTimeout(300);
  assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= 640, 'the page is wider than the window at 200 %');
  await page.setViewportSize({ width: 1280, height: 800 });
  await page.getByLabel('Idioma').selectOption('en');
});

await step('a restarted server asks for its new token', async () => {
  const port = new URL(address).port;
  lab.removeAllListeners('exit');
  lab.kill('SIGINT');
  assert.equal(await new Promise((r) => lab.on('exit', r)), 0);
  await page.getByText('Connection lost').waitFor();
  await shot('lost');
  await serveAgain('--port', port);
  await page.getByText('Open the URL printed by faba lab').waitFor();
  await page.goto(address);
  await page.getByRole('heading', { name: 'Scenes' }).waitFor();
});

await finish();
if (existsSync(pictures ?? '')) console.log(`pictures in ${pictures}`);
