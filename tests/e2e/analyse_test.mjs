// Test of the pages Analyse and Jobs in a browser: starts every kind of job on small material and sees its result. Stops with an
// error at the first failed step. With --pictures FOLDER it saves screenshots of the page in FOLDER.
//
//   node tests/e2e/analyse_test.mjs --program build/faba --root . [--pictures docs/img/lab]

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { copyFileSync, existsSync, mkdirSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { address, complaints, faba, finish, kJobPatience, lab, page, program, serveAgain, shot, step, tab, until, workspace } from './lab_page.mjs';

const file = (...name) => join(workspace, ...name);
const open = async (kind, values = '') => {
  await page.evaluate((h) => (location.hash = h), `#/analyse/${kind}${values}`);
  await page.getByRole('link', { name: 'All analyses' }).waitFor();
};
/** Chooses a file of the input with this label. */
const pick = async (label, name, nth = 0) => {
  const input = page.getByRole('group', { name: label }).nth(nth);
  await input.getByRole('listitem').locator('label', { hasText: name }).first().locator('input').check();
};
const main = (name) => page.getByRole('button', { name, exact: true });
/** Starts the job of the form, and goes to its page. */
const start = async (button = 'Start') => {
  await main(button).click();
  const link = page.getByRole('link', { name: /^Show job \d+$/ });
  await link.waitFor();
  const id = Number((await link.textContent()).match(/\d+/)[0]);
  await link.click();
  return id;
};
const done = () => page.locator('.state.done').first().waitFor({ timeout: kJobPatience });
const picture = () => until(() => page.evaluate(() => document.querySelector('.page section img:not([alt=""])')?.naturalWidth > 0), 'the picture of the result is shown');
/** Opens the report of the job whose page is shown. */
const report = async () => {
  await page.locator('section').getByRole('link', { name: 'Show result' }).click();
  await page.locator('section svg').first().waitFor();
};
const refused = async (button, text) => {
  await main(button).click();
  await page.locator('.wrong, [role=alert]').filter({ hasText: text }).first().waitFor();
};

// Material: a run with a camera video, a video, a ruler, a drop, readings, and a measured field.
faba('run', 'scenes/as-seen.toml', '--as-seen', '--duration', '2 s', '--out', 'runs/seen', '--seed', '3');
faba('run', 'scenes/drop.toml', '--as-seen', '--duration', '0.4 s', '--out', 'runs/drop', '--seed', '3');
mkdirSync(file('videos'));
const recorded = readdirSync(file('runs/seen')).find((f) => /^video\.(mp4|avi)$/.test(f));
for (const name of ['one', 'two', '-o', 'a "quoted" name']) copyFileSync(file('runs/seen', recorded), file('videos', name + recorded.slice(5)));
writeFileSync(file('readings.csv'), 'width_um,px_1,px_2\n100,285,286\n200,570,571\n300,855,857\n');
{
  const [w, h, pitch] = [640, 480, 12.4], grey = Buffer.alloc(w * h, 205);
  for (let k = 1; k * pitch < w - 6; k++)
    for (let y = 120; y < (k % 10 ? 260 : 340); y++)
      for (let x = Math.floor(k * pitch) - 2; x < k * pitch + 4; x++) grey[y * w + x] = Math.round(205 - 150 * Math.exp(-(((x - k * pitch) / 1.3) ** 2) / 2));
  writeFileSync(file('ruler.pgm'), Buffer.concat([Buffer.from(`P5\n${w} ${h}\n255\n`), grey]));
}
{
  const rig = readFileSync(file('rigs/thesis-four-coils.toml'), 'utf8');
  let k = 0;
  writeFileSync(file('rigs/measured.toml'), rig.replaceAll('[[coil]]\n', (c) => `${c}current = "${[0.5, 0.5, 0.2, 0][k++]} A"\n`));
  const points = ['x_m,y_m,z_m'];
  for (let i = -2; i <= 2; i++) for (let j = -2; j <= 2; j++) points.push(`${i * 1e-3},${j * 1e-3},0`);
  writeFileSync(file('points.csv'), `${points.join('\n')}\n`);
  writeFileSync(file('measured.csv'), execFileSync(program, ['field', 'at', 'rigs/measured.toml', '--points', 'points.csv'], { cwd: workspace, encoding: 'utf8' }));
}

await step('the page Analyse lists the kinds by group', async () => {
  await page.goto(address);
  await page.getByRole('heading', { name: 'Scenes' }).waitFor();
  await tab('Analyse');
  for (const group of ['Videos and pictures', 'Models', 'Control', 'Coils']) await page.getByRole('heading', { name: group }).waitFor();
  const kinds = await page.evaluate(() => fetch('/api/job-kinds').then((r) => r.json()));
  assert.equal(await page.locator('section li a').count(), kinds.length + 2, 'one link for each kind, the sweep, and the coil editor');
  await shot('analyse');
});

await step('activity: missing values are reported, the time is estimated, and a message reports the end on another page', async () => {
  await page.getByRole('link', { name: 'Activity of videos' }).click();
  await refused('Start', 'missing; choose a value');
  await pick(/^Videos/, 'videos/one');
  await page.getByText(/640 × 480 px/).waitFor();
  await page.locator('[data-read=estimate]', { hasText: 'assumed' }).waitFor();
  const direction = page.getByRole('textbox', { name: 'Swimming direction after the reversal' });
  await direction.fill('400');
  await page.getByText('must be at most').waitFor();
  await direction.fill('90');
  await shot('activity-form');
  await start();
  await tab('Gallery');
  const toast = page.getByRole('status').filter({ hasText: 'activity: one' });
  await toast.waitFor({ timeout: kJobPatience });
  assert.match(await toast.textContent(), /is done/);
  await toast.getByRole('link', { name: 'Show result' }).click();
  await done();
  // Up in the picture is 270 degrees for the command.
  await page.locator('code', { hasText: '--direction=270' }).waitFor();
  await report();
  await shot('activity-result');
});

await step('the estimate of a second job is measured, and the values of one form do not appear in another', async () => {
  await open('compare');
  assert.equal(await page.locator('.chosen li').count(), 0, 'files of another form are chosen');
  await open('activity');
  await pick(/^Videos/, 'videos/two');
  await page.locator('[data-read=estimate]', { hasText: 'from earlier jobs' }).waitFor();
});

await step('activity of south-seeking cells: the direction is that of the cells, and the signal is positive', async () => {
  // The field of this run points to the left after the reversal: the cells swim against it, to the right.
  await open('activity');
  await pick(/^Videos/, 'runs/seen');
  assert.equal(await page.getByRole('textbox', { name: /direction of the field/i }).count(), 0, 'the form asks for the field');
  await page.getByRole('textbox', { name: 'Swimming direction after the reversal' }).fill('0');
  const id = await start();
  await done();
  const [video] = (await page.evaluate((n) => fetch(`/api/jobs/${n}`).then((r) => r.json()), id)).result.videos;
  assert.ok(video.signal_to_noise > 1 && video.mean_along > 0, `signal-to-noise ratio ${video.signal_to_noise}, motion along the direction ${video.mean_along}`);
});

await step('compare: reference and videos are chosen separately', async () => {
  await open('compare');
  await pick(/^Reference video/, 'runs/seen');
  await pick(/^Videos/, 'videos/two');
  await start();
  await done();
  await page.getByRole('link', { name: 'distances.csv' }).waitFor();
  await report();
});

await step('names that look like options or contain quotes are files', async () => {
  for (const name of ['-o', 'a "quoted" name']) {
    await open('drop');
    await pick(/^Picture or video/, `videos/${name}`);
    await start();
    await page.locator('.state.done, .state.failed').first().waitFor({ timeout: kJobPatience });
    assert.ok((await page.locator('code').textContent()).includes(`./videos/${name}`));
    const text = await page.locator('section').textContent();
    assert.doesNotMatch(text, /unknown option|--help/);
  }
});

await step('drop, tracks, flow, scale', async () => {
  await open('drop');
  await pick(/^Picture or video/, 'runs/drop');
  await start();
  await done();
  await picture();
  await page.getByRole('rowheader', { name: /radius px/ }).first().waitFor();
  await open('track');
  await pick(/^Video/, 'videos/one');
  await page.getByText('More options').click();
  await page.getByLabel('Minimum detections of a track').fill('0');
  await page.getByText('must be at least 1').waitFor();
  await page.getByLabel('Minimum detections of a track').fill('4');
  await start();
  await done();
  await page.getByRole('link', { name: 'tracks.csv' }).waitFor();
  await page.locator('code', { hasText: '--least=4' }).waitFor();
  await open('flow');
  await pick(/^Video/, 'videos/one');
  await start();
  await done();
  await page.locator('video').waitFor();
  await open('flow-pictures');
  await pick(/^First picture/, 'ruler.pgm');
  await pick(/^Second picture/, 'ruler.pgm');
  await start();
  await done();
  await picture();
  await open('scale');
  await pick(/^Ruler/, 'ruler.pgm');
  await page.getByLabel('Distance between marks').fill('10 um');
  await start();
  await done();
  await picture();
  await page.getByRole('link', { name: 'calibration.toml' }).waitFor();
  await shot('scale-result');
  await open('scale-table');
  await pick(/^Ruler/, 'readings.csv');
  await start();
  await done();
  await page.getByRole('heading', { name: 'Values' }).waitFor();
});

await step('a job that fails states why, and can be started again', async () => {
  writeFileSync(file('text.mp4'), 'not a video');
  await open('flow');
  await pick(/^Video/, 'text.mp4');
  await start();
  await page.locator('.state.failed').first().waitFor({ timeout: kJobPatience });
  const message = await page.locator('.wrong').first().textContent();
  assert.match(message, /text\.mp4/);
  assert.doesNotMatch(message, /\/tmp\//, 'a message has a temporary path');
  copyFileSync(file('videos', `one${recorded.slice(5)}`), file('text.mp4'));
  await page.getByRole('button', { name: 'Start again' }).click();
  await done();
  complaints.length = 0; // the browser logs requests that are refused
});

await step('messages about uploaded files name the file, not a temporary path', async () => {
  const answer = (name, body) =>
    page.evaluate(([n, b]) => fetch(`/api/upload?name=${n}`, { method: 'POST', headers: { 'Content-Type': 'application/octet-stream' }, body: b }).then((r) => r.json()), [name, body]);
  for (const [name, body] of [['notes.txt', 'text'], ['empty.mp4', ''], ['a.png', '\x89PNG'], ['a.toml', 'seed =']]) {
    const { where, what } = await answer(name, body);
    assert.equal(where, name);
    assert.doesNotMatch(`${where}: ${what}`, /\/tmp|upload-|body/);
  }
  complaints.length = 0; // the browser logs the refused requests
});

await step('coils: map, trap, tolerance, fit, library', async () => {
  await open('field-map');
  await pick(/^Coil system/, 'rigs/thesis-four-coils.toml');
  const current = (k) => page.getByLabel(`Currents ${k}`, { exact: true });
  await current(4).waitFor();
  for (const [k, v] of [[1, '0.5'], [2, '500 mA'], [3, '0'], [4, '0']]) {
    await current(k).fill(v);
    await current(k).press('Tab');
  }
  await start();
  await done();
  await picture();
  await page.locator('code', { hasText: '--current=0.5,0.5,0,0' }).waitFor();
  await shot('field-result');
  await open('field-null');
  await pick(/^Coil system/, 'rigs/thesis-four-coils.toml');
  await page.getByLabel('Polarity').selectOption('south');
  await start();
  await done();
  await page.getByRole('heading', { name: 'Values' }).waitFor();
  await shot('trap-result');
  await open('field-tolerance');
  await pick(/^Coil system/, 'rigs/thesis-two-coils.toml');
  await start();
  await done();
  await picture();
  await open('field-fit');
  await pick(/^Coil system/, 'rigs/measured.toml');
  await pick(/^Measured field/, 'measured.csv');
  await start();
  await done();
  await picture();
  await page.getByRole('link', { name: 'fitted.toml' }).waitFor();
  await open('field-library');
  await pick(/^Coil system/, 'rigs/thesis-two-coils.toml');
  await page.getByText('More options').click();
  await page.getByLabel('Steps of the current').fill('10');
  await start();
  await done();
  await page.getByRole('link', { name: 'library.h5' }).waitFor();
});

await step('an experiment: activity against exposure', async () => {
  mkdirSync(file('experiments/e1/videos'), { recursive: true });
  for (const name of ['one', 'two']) copyFileSync(file('videos', name + recorded.slice(5)), file('experiments/e1/videos', name + recorded.slice(5)));
  writeFileSync(
    file('experiments/e1/experiment.toml'),
    'title = "Ageing"\n[[drop]]\nname = "A"\npolarity = "north"\n' +
      ['one', 'two'].map((n, i) => `[[video]]\nfile = "videos/${n}${recorded.slice(5)}"\ndrop = "A"\nexposure = "${i * 60} s"\nfield_direction = "0 deg"\n`).join(''),
  );
  await open('activity-exposure');
  await pick(/^Experiment/, 'experiments/e1');
  await start();
  await done();
  await report();
});

await step('identify: a study is composed from the schema, and the terminal can run it', async () => {
  await open('identify');
  await refused('Save and start', 'Choose at least one video.');
  await pick(/^Videos/, 'runs/seen');
  await refused('Save and start', 'Add at least one model with a free parameter.');
  await page.getByRole('textbox', { name: 'Swimming direction after the reversal' }).fill('0');
  await page.getByLabel('Reversal reversal', { exact: true }).fill('0.2 s');
  await page.getByRole('group', { name: 'Add a model' }).getByRole('button', { name: 'dipole' }).click();
  await page.getByRole('button', { name: 'Remove speed', exact: true }).waitFor(); // a quantity with a unit; it is the first free parameter
  await page.getByRole('group', { name: 'dipole' }).getByLabel('highest', { exact: true }).fill('300 um/s'); // below speed_max
  await page.getByLabel('Add a free parameter').selectOption('swarm[0].count');
  await page.getByRole('group', { name: 'dipole' }).getByLabel('lowest', { exact: true }).last().fill('10');
  await page.getByRole('group', { name: 'dipole' }).getByLabel('highest', { exact: true }).last().fill('1000');
  await page.getByLabel('Name of the study').fill('Small study');
  await page.getByLabel('Look look', { exact: true }).selectOption('positions');
  await page.getByLabel('Simulations simulations', { exact: true }).fill('120');
  await page.locator('fieldset', { hasText: 'Settings' }).last().getByText('More options').click();
  await page.getByLabel('Nuisances nuisances', { exact: true }).uncheck();
  await main('Check').click();
  await page.locator('[data-read=estimate]').waitFor();
  assert.ok(!existsSync(file('studies/Small-study.toml')), 'the check saved a file');
  await shot('identify-form');
  await start('Save and start');
  await page.locator('.state.done, .state.failed').first().waitFor({ timeout: kJobPatience * 3 });
  assert.equal(await page.locator('.state.failed').count(), 0, await page.locator('section').textContent());
  await report();
  const toml = readFileSync(file('studies/Small-study.toml'), 'utf8');
  assert.match(toml, /file = "\.\.\/runs\/seen"/);
  assert.match(toml, /direction = "0 deg"/);
});

await step('compare controllers: a wrong value is refused at its place; a small comparison runs', async () => {
  await open('compare-controllers');
  await page.getByLabel('Scene').selectOption('thesis-basic');
  await refused('Save and start', 'Add at least one controller.');
  const add = page.getByRole('group', { name: 'Add a controller' });
  await add.getByRole('button', { name: 'proportional' }).click();
  await add.getByRole('button', { name: 'fuzzy' }).click();
  await page.getByLabel('Name of the study').fill('two controllers');
  await page.getByLabel('Seeds seeds', { exact: true }).fill('1');
  await page.getByText('must be at least 2').waitFor();
  await page.getByLabel('Seeds seeds', { exact: true }).fill('2');
  await start('Save and start');
  await done();
  await page.locator('code', { hasText: 'studies/two-controllers.toml' }).waitFor();
  await report();
});

await step('parameter sweep: one parameter of a scene', async () => {
  await open('sweep');
  await page.getByLabel('Scene').selectOption('thesis-basic');
  const first = page.getByRole('group', { name: 'Parameter 1' });
  await first.getByLabel('Parameter', { exact: true }).selectOption('swarm[0].count');
  await first.getByLabel('lowest', { exact: true }).fill('10');
  await first.getByLabel('highest', { exact: true }).fill('30');
  await first.getByLabel('Number of values', { exact: true }).fill('3');
  await page.getByText('3 combinations').waitFor();
  await page.getByLabel('Seeds seeds', { exact: true }).fill('2');
  await shot('sweep-form');
  await start('Save and start');
  await done();
  await report();
  await page.locator('section').getByText('count 30').first().waitFor();
});

await step('the queue: order, times, cancel, and the list after a reload', async () => {
  writeFileSync(file('studies/long.toml'), readFileSync(file('studies/controllers.toml'), 'utf8').replace('seeds = 20', 'seeds = 2000'));
  await open('compare-controllers', '?study=file');
  await pick(/^Study file/, 'long.toml');
  await start();
  await page.locator('.state.running').first().waitFor();
  for (const rig of ['two', 'four']) {
    await open('field-tolerance');
    await pick(/^Coil system/, `rigs/thesis-${rig}-coils.toml`);
    await start();
  }
  await tab('Jobs');
  const long = page.locator('li', { hasText: 'long.toml' });
  await long.getByText(/left$/).waitFor();
  const queued = page.locator('li', { has: page.locator('.state.waiting') });
  await queued.first().getByText(/starts in about/).waitFor();
  assert.equal(await queued.count(), 2);
  await queued.first().getByRole('button', { name: 'Run next' }).click(); // the newest is at the top, and was the last
  await page.reload();
  await long.getByText(/^running/).first().waitFor();
  await shot('jobs');
  await long.getByRole('button', { name: 'Cancel' }).click();
  await long.locator('.state.cancelled').waitFor();
  await until(async () => (await queued.count()) === 0, 'the queue is empty');
});

await step('ended jobs are listed by the next lab, with their results; a list can be cleared', async () => {
  const port = new URL(address).port;
  lab.removeAllListeners('exit');
  lab.kill('SIGINT');
  assert.equal(await new Promise((r) => lab.on('exit', r)), 0);
  await serveAgain('--port', port);
  await page.goto(address);
  await tab('Jobs');
  const sweep = page.locator('li', { hasText: 'sweep.toml' });
  await sweep.getByRole('link', { name: 'Open' }).click(); // shows the report at once
  await page.locator('section').getByText('count 30').first().waitFor();
  await tab('Jobs');
  await page.getByRole('button', { name: 'Clear finished jobs' }).click();
  await page.getByText('No jobs.').waitFor();
  complaints.length = 0;
});

await step('Portuguese: every kind and every description is translated; a phone', async () => {
  await page.getByLabel('Language').selectOption('pt');
  const kinds = await page.evaluate(() => fetch('/api/job-kinds').then((r) => r.json()));
  await page.setViewportSize({ width: 390, height: 844 });
  for (const k of kinds) {
    await page.evaluate((h) => (location.hash = h), `#/analyse/${k.kind}?study=file`);
    await page.getByRole('link', { name: 'Todas as análises' }).waitFor();
    await page.locator('form').waitFor();
    const text = await page.locator('section').textContent();
    for (const d of [k.schema.description, ...Object.values(k.schema.properties).map((p) => p.description)]) if (d !== 'Experiment') assert.ok(!text.includes(d), `not translated: ${d}`);
    assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= 390, `${k.kind} is wider than the screen of a phone`);
  }
  await shot('phone-pt');
});

await finish();
