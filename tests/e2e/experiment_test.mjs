// Test of the experiments of the lab in a browser: the complete work with a sample in windows. Eight rendered videos of two
// ageing drops are imported, their exposure times and the field are stated, the scale is measured in a picture of a ruler, and the
// activity is measured against air exposure. No path is typed, and the page is reloaded in the middle of every step.
//
//   node tests/e2e/experiment_test.mjs --program build/faba --root .

import assert from 'node:assert/strict';
import { existsSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { kExposures, knownExposure, render, studyOfRuns, user } from './ageing_drops.mjs';
import { address, complaints, context, faba, finish, kJobPatience, page, read, root, shot, step, tab, until, workspace } from './lab_page.mjs';

const reload = async () => {
  await page.reload();
  await page.getByRole('heading', { name: 'Videos' }).waitFor();
};
const field = (name, file) => page.getByRole('textbox', { name: `${name}, ${file}` });
/** Fills a field of a video and waits until it is saved. */
async function fill(name, file, value) {
  await field(name, file).fill(value);
  await field(name, file).press('Tab');
  await until(async () => toml().includes(value.replace(' ', '')) || toml().includes(value), `${name} of ${file} is saved`);
}
const toml = () => readFileSync(join(workspace, 'experiments/ageing-drops/experiment.toml'), 'utf8');

/** What the newest job of a kind has printed, when it is done. */
async function resultOf(kind) {
  const ask = (path) => page.evaluate((p) => fetch(p).then((r) => r.json()), path);
  const newest = async () => (await ask('/api/jobs')).filter((j) => j.kind === kind).at(-1);
  const end = Date.now() + kJobPatience;
  for (let job = await newest(); job?.state !== 'done'; job = await newest()) {
    assert.ok(job?.state !== 'failed' && Date.now() < end, `${kind}: ${job?.state} ${job?.error}`);
    await page.waitForTimeout(200);
  }
  return (await ask(`/api/jobs/${(await newest()).id}`)).result;
}

const films = { A: render('A', 1), B: render('B', 11) };

await step('an experiment is created', async () => {
  await page.goto(address);
  await tab('Experiments');
  await page.getByLabel('New experiment').fill('Ageing drops');
  await page.getByRole('button', { name: 'Create' }).click();
  await page.getByRole('heading', { name: 'Videos' }).waitFor();
  assert.equal(new URL(page.url()).hash, '#/experiments/ageing-drops');
  await reload();
});

await step('two drops with their polarity', async () => {
  for (const [k, name] of ['A', 'B'].entries()) {
    await page.getByRole('button', { name: 'Add a drop' }).click();
    await until(async () => (await page.locator('.drops li').count()) === k + 1, `drop ${name} is added`);
    await page.locator('.drops li').nth(k).getByLabel('Polarity').selectOption('south');
    await reload();
    assert.equal(await page.locator('.drops li').nth(k).getByLabel('Polarity').inputValue(), 'south');
  }
});

await step('eight videos are imported by choosing files', async () => {
  let count = 0;
  for (const drop of ['A', 'B']) {
    await page.getByLabel('Import into drop').selectOption(drop);
    await page.locator('.dropzone input').setInputFiles(films[drop]);
    count += films[drop].length;
    await until(async () => (await page.locator('tbody tr').count()) === count, `videos of drop ${drop}`);
    await reload();
  }
  for (const f of films.A) assert.deepEqual(readFileSync(join(workspace, 'experiments/ageing-drops/videos', f.split('/').at(-1))), readFileSync(f));
});

await step('a text file is refused with its name', async () => {
  writeFileSync(join(user, 'notes.txt'), 'no video');
  await page.locator('.dropzone input').setInputFiles(join(user, 'notes.txt'));
  await page.locator('.upload').getByText('notes.txt').waitFor();
  await page.locator('.upload .wrong').waitFor();
  assert.match(complaints.splice(0).join(), /422/);
  await reload();
  await until(async () => (await page.locator('tbody tr').count()) === 8, 'the videos are listed');
  assert.equal(await page.locator('.upload').count(), 0, 'nothing of the refused file is left to continue');
  await page.locator('.dropzone input').setInputFiles(join(user, 'notes.txt'));
  await page.locator('.upload .wrong').waitFor();
  assert.match(complaints.splice(0).join(), /422/);
  await page.locator('.upload').getByRole('button', { name: 'Remove' }).click();
  assert.equal(await page.locator('tbody tr').count(), 8);
});

await step('exposure times are proposed from the times of the files', async () => {
  for (const drop of ['A', 'B']) {
    await fill('Air exposure', `drop-${drop}-0.avi`, `${kExposures[0]} s`);
    await page.locator('.drops li').nth(drop === 'A' ? 0 : 1).getByRole('button', { name: 'Propose' }).click();
    for (const [k, exposure] of kExposures.entries())
      await until(async () => (await field('Air exposure', `drop-${drop}-${k}.avi`).inputValue()) === `${exposure} s`, `exposure of video ${k}`);
    await reload();
  }
});

await step('the field: direction, time of the reversal', async () => {
  for (const f of [...films.A, ...films.B]) {
    const name = f.split('/').at(-1);
    await fill('Field reversal at', name, '20 s');
    await fill('From', name, '19 s');
    const dial = page.getByRole('slider', { name: `Field direction after it, ${name}` });
    await dial.focus();
    for (let k = 0; k < 4; ++k) {
      await page.keyboard.press('PageUp');
      await until(async () => (await dial.getAttribute('aria-valuenow')) === String(45 * (k + 1)), 'the dial turns');
    }
  }
  await reload();
  // South-seeking cells swim against a field to the left: to the right.
  assert.equal(await page.locator('tbody tr').first().locator('.swim-text').textContent(), '0°');
});

await step('the scale is measured in a picture of a ruler', async () => {
  const ruler = join(user, 'ruler.png');
  writeFileSync(ruler, readFileSync(join(root, 'docs/img/ruler.png')));
  await page.getByRole('button', { name: 'Measure a ruler' }).click();
  await page.locator('.ruler input[type=file]').setInputFiles(ruler);
  await page.locator('.ruler [role=status]').waitFor();
  await until(async () => (await page.getByLabel('Scale').first().inputValue()) !== '', 'the scale is saved');
  await reload();
  assert.match(toml(), /um_per_px_se = [\d.e-]+\num_per_px_source = "calibration"/);
});

await step('an error is beside its value, and a removed drop is reported', async () => {
  const row = page.locator('tbody tr').first();
  await field('To', 'drop-A-0.avi').fill('18 s');
  await field('To', 'drop-A-0.avi').press('Tab');
  await row.getByRole('alert').getByText('is not later than').waitFor();
  assert.match(complaints.splice(0).join(), /422/);
  await field('To', 'drop-A-0.avi').fill('');
  await field('To', 'drop-A-0.avi').press('Tab');
  await row.getByRole('alert').waitFor({ state: 'detached' });
  await page.getByRole('button', { name: 'Remove: B', exact: true }).click();
  await page.getByText('Videos without a drop: drop-B-0.avi, ').waitFor();
  assert.equal(await page.locator('.drops li').count(), 1);
  await page.getByRole('button', { name: 'Undo', exact: true }).click();
  await page.getByText('Videos without a drop').waitFor({ state: 'detached' });
  assert.equal(await page.locator('.drops li').count(), 2);
});

await step('the viewer has the scale and the field reversal of the experiment', async () => {
  await page.getByRole('link', { name: 'View drop-A-0.avi' }).click();
  await page.getByText(/ · [\d.]+ µm\/px/).waitFor();
  assert.equal(await page.getByRole('spinbutton', { name: 'Field reversal' }).inputValue(), '20');
  await page.goBack();
  await page.getByRole('heading', { name: 'Videos' }).waitFor();
});

await step('marks, part and a measured scale are saved from the viewer, with undo', async () => {
  const before = toml();
  const saved = (part) => until(() => toml().includes(part), `${part} is saved`);
  const undo = async () => {
    await page.getByRole('button', { name: 'Undo', exact: true }).click();
    await until(() => toml() === before, 'the change is undone');
  };
  await page.getByRole('link', { name: 'View drop-A-0.avi' }).click();
  const reversal = page.getByRole('spinbutton', { name: 'Field reversal' });
  await until(async () => (await reversal.count()) === 1 && (await reversal.inputValue()) === '20', 'the reversal of the experiment');
  await reversal.fill('20.5');
  await reversal.press('Tab');
  await page.getByText('marked and not saved: 20.5 s').waitFor();
  assert.equal(toml(), before, 'nothing is saved yet');
  await page.getByRole('button', { name: 'Save: Field reversal' }).click();
  await saved('reversal = "20.5 s"');
  await undo();
  await until(async () => (await reversal.inputValue()) === '20', 'the mark follows');
  // The part, and an error beside its value.
  const to = page.getByRole('textbox', { name: 'Part that is evaluated: To' });
  await to.fill('18 s');
  await to.press('Tab');
  await page.locator('.viewed').getByRole('alert').getByText('is not later than').waitFor();
  assert.match(complaints.splice(0).join(), /422/);
  await to.fill('24 s');
  await to.press('Tab');
  await saved('to = "24 s"');
  await undo();
  // A line of 200 px over 100 um, each end with 1 px: 0.5 um/px, with a standard error of 0.5 sqrt(2) / 200.
  for (const [key, v] of Object.entries({ x1: 10, y1: 50, x2: 210, y2: 50 })) {
    await page.getByRole('spinbutton', { name: `Ruler: ${key} (px)` }).fill(String(v));
    await page.getByRole('spinbutton', { name: `Ruler: ${key} (px)` }).press('Tab');
  }
  await page.getByLabel('Length of the line').fill('100');
  assert.equal(await page.locator('[data-read="ruler-scale"]').textContent(), '0.5000 ± 0.0035 µm/px');
  await page.getByRole('button', { name: 'Use for this video only' }).click();
  await saved('um_per_px = 0.5\num_per_px_se = 0.00354\num_per_px_source = "ruler"');
  await page.locator('[data-stated=scale]').getByText('0.5000 ± 0.0035 µm/px (ruler), of this video').waitFor();
  await page.getByText(/ · 0\.5 µm\/px/).waitFor();
  await shot('experiment-viewer');
  await undo();
  await page.goBack();
  await page.getByRole('heading', { name: 'Videos' }).waitFor();
});

await step('an imported video is deleted after a question, and restored with its values', async () => {
  const before = toml(), file = join(workspace, 'experiments/ageing-drops/videos/drop-B-3.avi'), rows = page.locator('tbody tr');
  const ask = () => page.getByRole('button', { name: 'Remove: drop-B-3.avi' }).click();
  const dialog = page.getByRole('dialog');
  await ask();
  await dialog.getByRole('button', { name: 'Cancel' }).click();
  assert.equal(await rows.count(), 8);
  await ask();
  const [bytes] = /\(([\d.]+ [kM]B)\)/.exec(await dialog.getByRole('button', { name: /^Remove from the experiment and delete the file/ }).textContent()).slice(1);
  await shot('experiment-remove');
  await dialog.getByRole('button', { name: /^Remove from the experiment and delete the file/ }).click();
  await until(async () => (await rows.count()) === 7, 'the row is gone');
  assert.ok(!existsSync(file));
  await reload(); // the deletion is in the trash of the lab
  await page.getByText(`drop-B-3.avi is deleted (${bytes})`).waitFor();
  await page.locator('.undo').getByRole('button', { name: 'Undo' }).click();
  await until(async () => (await rows.count()) === 8, 'the row is back');
  assert.deepEqual(readFileSync(file), readFileSync(films.B[3]));
  assert.equal(toml(), before);
  // The button for all changes undoes it as well.
  await ask();
  await dialog.getByRole('button', { name: /^Remove from the experiment and delete the file/ }).click();
  await until(async () => (await rows.count()) === 7, 'the row is gone');
  await page.getByRole('button', { name: 'Undo', exact: true }).first().click();
  await until(async () => (await rows.count()) === 8, 'the row is back');
  assert.equal(toml(), before);
  // Only the entry.
  await ask();
  await dialog.getByRole('button', { name: 'Remove from the experiment, keep the file' }).click();
  await until(async () => (await rows.count()) === 7, 'the row is gone');
  assert.ok(existsSync(file));
  await page.getByRole('button', { name: 'Undo', exact: true }).first().click();
  await until(async () => (await rows.count()) === 8, 'the row is back');
  assert.equal(toml(), before);
});

await step('two pages change one experiment', async () => {
  const other = await context.newPage();
  await other.goto(page.url());
  const title = other.getByLabel('Title');
  await title.waitFor();
  await page.getByLabel('Objective').fill('20x');
  await page.getByLabel('Objective').press('Tab');
  await until(async () => (await other.getByLabel('Objective').inputValue()) === '20x', 'the other page follows');
  await reload();
  assert.equal(await page.getByLabel('Objective').inputValue(), '20x');
  // The same value from both, without the news in between.
  await other.route('**/api/experiments/ageing-drops', (r) => r.request().method() === 'GET' ? r.abort() : r.continue());
  await page.getByLabel('Title').fill('Mine');
  await page.getByLabel('Title').press('Tab');
  await until(() => toml().includes('title = "Mine"'), 'the title is saved');
  await title.fill('Theirs');
  await title.press('Tab');
  await other.getByRole('alert').getByText('Another page has changed').waitFor();
  assert.match(toml(), /title = "Mine"/);
  await other.getByRole('button', { name: 'Save my values' }).click();
  await until(() => toml().includes('title = "Theirs"'), 'the other title is saved');
  await other.close();
  await page.getByRole('button', { name: 'Undo' }).waitFor();
});

await step('activity against air exposure', async () => {
  await page.getByRole('button', { name: 'Activity against air exposure' }).click();
  await page.locator('[data-read="estimate"]').waitFor();
  await page.reload();
  await page.getByText('The job uses the experiment ageing-drops').waitFor();
  assert.equal(await page.locator('form').getByRole('combobox').count(), 0, 'the experiment is not asked for again');
  await page.getByRole('button', { name: 'Start' }).click();
  await page.reload();
  const result = await resultOf('activity-exposure');
  assert.equal(result.videos.length, 8);
  // With the polarity of the drop the stated field gives the direction in which the cells swim.
  for (const v of result.videos) assert.equal(v.direction_deg, 0, v.file);
  assert.ok(result.videos.filter((v) => v.responds).length >= 5, 'fresh cells respond in the stated direction');
  // Cells that were longer in air are slower and cross the picture later. bench/exposure.py measured the slopes of 20 seeds without
  // noise (table of bench/results/exposure.md).
  const [least, most] = result.peak_line.ci95, known = knownExposure();
  assert.ok(least > 0 && least <= known.slope && known.slope <= most, `${known.slope} s/s is not in the interval of ${JSON.stringify(result.peak_line)}`);
  assert.ok(known.cutoffs[0] <= result.cutoff_s && result.cutoff_s <= known.cutoffs[1], `cut-off ${result.cutoff_s} s, in the bench ${known.cutoffs} s`);
  // The same experiment, and the recorded runs without the page, in the terminal.
  assert.deepEqual(faba('activity', 'experiments/ageing-drops').peak_line, result.peak_line);
  const { peak_line, cutoff_s, cutoff_between_s, cutoff_wrong } = faba('activity', studyOfRuns());
  assert.deepEqual([result.peak_line, result.cutoff_s, result.cutoff_between_s, result.cutoff_wrong], [peak_line, cutoff_s, cutoff_between_s, cutoff_wrong]);
});

await step('the quality is explained where it is shown, and the result and its experiment are linked', async () => {
  const entry = page.locator('li').filter({ hasText: 'Activity against air exposure' }).first(), quality = entry.locator('summary');
  assert.match(await quality.textContent(), /^Quality: (good|doubtful|poor)$/);
  assert.match(await entry.textContent(), /ended \d/);
  assert.equal(await entry.locator('details p').isVisible(), false);
  await quality.focus();
  await page.keyboard.press('Enter');
  await entry.locator('details p').waitFor();
  await entry.getByRole('link', { name: 'Open' }).click();
  await page.locator('.report .quality').waitFor();
  const report = await page.locator('.report').textContent();
  assert.match(report, /drop A/);
  assert.doesNotMatch(report, /experiment A|90 down/);
  assert.match(report, /0° is right, 90° is up/);
  assert.equal(await page.locator('.report .warning').filter({ hasText: /^\s*[a-z_]+: / }).count(), 0, 'warnings have titles');
  await page.getByRole('link', { name: 'Experiment ageing-drops' }).click();
  await page.getByRole('heading', { name: 'Videos' }).waitFor();
});

await step('a narrow window has a card for each video and no sideways scrolling', async () => {
  await page.setViewportSize({ width: 390, height: 844 });
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 390);
  for (const name of ['Air exposure', 'Field reversal at', 'From', 'To', 'Field strength']) assert.ok((await field(name, 'drop-A-0.avi').boundingBox()).x < 390, name);
  await page.setViewportSize({ width: 1280, height: 800 });
});

await shot('experiment');

await step('tracks of a video, with a filter', async () => {
  await page.getByRole('link', { name: 'Tracks page' }).click();
  await page.getByText(/cells detected in this frame/).waitFor({ timeout: kJobPatience });
  await page.reload();
  await page.getByText(/cells detected in this frame/).waitFor({ timeout: kJobPatience });
  await page.getByRole('button', { name: 'Track the video' }).click();
  await page.getByText('tracks are used').waitFor({ timeout: kJobPatience });
  const used = async () => (await read('used'))[0], all = await used();
  await page.locator('[data-feature="points"]').getByLabel('Detections: Minimum, ').fill('20');
  await page.keyboard.press('Enter');
  await until(async () => (await used()) < all, 'short tracks are cut');
  const left = await used();
  const edits = join(workspace, new URL(page.url().replace('#/tracks', '')).searchParams.get('folder'), 'edits.toml');
  await until(() => existsSync(edits) && readFileSync(edits, 'utf8').includes('min = 20'), 'the cut is saved');
  await page.reload();
  await page.getByText('tracks are used').waitFor();
  assert.equal(await used(), left, 'the cut survives a reload');
  await tab('Experiments');
  await page.getByRole('link', { name: 'Theirs' }).click();
  await page.getByRole('heading', { name: 'Videos' }).waitFor();
});

await step('a model is identified from the videos, and opens in the lab', async () => {
  // These cells cross the picture before 23 s; a longer part takes longer to simulate.
  await fill('To', 'drop-A-0.avi', '23 s');
  await page.getByRole('button', { name: 'Identify a model' }).click();
  const videos = page.getByRole('group', { name: /^Videos/ });
  await videos.getByRole('checkbox').first().waitFor();
  for (const f of [...films.A.slice(1), ...films.B]) await videos.locator('label', { hasText: f.split('/').at(-1) }).locator('input').uncheck();
  // What the experiment states is in the form: south-seeking cells swim against the field.
  assert.equal(await page.getByRole('textbox', { name: /^Swimming direction after the reversal/ }).first().inputValue(), '0');
  await page.getByRole('group', { name: 'Add a model' }).getByRole('button', { name: 'dipole' }).click();
  await page.getByLabel('Name of the study').fill('fresh cells');
  await page.getByLabel('Look look', { exact: true }).selectOption('positions');
  await page.getByLabel('Simulations simulations', { exact: true }).fill('100');
  await page.getByRole('button', { name: 'Save and start' }).click();
  await page.getByRole('link', { name: /^Show job/ }).waitFor();
  await page.reload();
  const result = await resultOf('identify');
  assert.equal(result.models.length, 1);
  await page.getByRole('link', { name: 'Open' }).first().click();
  await page.reload();
  await page.getByRole('button', { name: 'Open the best model in the lab' }).click();
  await page.waitForFunction(() => location.hash === '#/lab');
  await until(() => page.evaluate(() => (document.querySelector('canvas.over')?.lab?.ticks ?? 0) > 3), 'the run of the model has frames');
  await shot('experiment-model');
});

await step('two controllers are compared, and the report is exported', async () => {
  await tab('Experiments');
  await page.getByRole('link', { name: 'Theirs' }).click();
  await page.getByRole('button', { name: 'Compare controllers' }).click();
  await page.getByLabel('Scene').selectOption('thesis-basic');
  for (const controller of ['proportional', 'fuzzy']) await page.getByRole('group', { name: 'Add a controller' }).getByRole('button', { name: controller }).click();
  await page.getByLabel('Name of the study').fill('two controllers');
  await page.getByLabel('Seeds seeds', { exact: true }).fill('2');
  await page.getByRole('button', { name: 'Save and start' }).click();
  await page.getByRole('link', { name: /^Show job/ }).waitFor();
  await page.reload();
  await resultOf('compare-controllers');
  await page.getByRole('link', { name: 'Open' }).first().click();
  await page.getByText('Files', { exact: true }).click();
  const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('link', { name: 'report.html' }).click()]);
  assert.match(readFileSync(await download.path(), 'utf8'), /fuzzy/);
});

await finish();
rmSync(user, { recursive: true, force: true });
