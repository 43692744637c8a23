// Test of the work with a real recording in a browser, without a typed path: rollers.mp4 is imported into an experiment and viewed,
// its eight field segments are found, two are corrected by hand and saved, and a model is identified with them.
//
// Needs --data FOLDER with the recordings (tests/real); without it the test is skipped: exit code 77.
//
//   node tests/e2e/rollers_test.mjs --program build/faba --root . --data ../shared/data [--pictures FOLDER]

import assert from 'node:assert/strict';
import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { address, finish, kJobPatience, option, page, shot, skip, step, tab, until, workspace } from './lab_page.mjs';

const video = join(option('data') ?? '/absent', 'step-response/rollers.mp4');
// Read from the video by eye; y up.
const kUp = 90, kDown = 270;
const kTruth = [
  { from: 5.6, to: 8.5, deg: kUp }, { from: 12.6, to: 18.2, deg: kDown }, { from: 20.5, to: 23.2, deg: kDown }, { from: 25.8, to: 32.3, deg: kUp },
  { from: 35.2, to: 38.4, deg: kUp }, { from: 45.2, to: 58.4, deg: kDown }, { from: 61.0, to: 68.9, deg: kUp }, { from: 69.5, to: 73.6, deg: kDown },
];
const folder = join(workspace, 'experiments/rollers');
const toml = () => readFileSync(join(folder, 'experiment.toml'), 'utf8');
const segment = (n, what) => page.getByRole('spinbutton', { name: `Segment ${n}: ${what}` });
const valueOf = async (n, what) => Number(await segment(n, what).inputValue());
const apart = (a, b) => Math.abs(((((a - b) % 360) + 540) % 360) - 180);
/** The newest job of a kind, when it is done. */
async function done(kind) {
  const jobs = () => page.evaluate(() => fetch('/api/jobs').then((r) => r.json()));
  const end = Date.now() + kJobPatience;
  for (;;) {
    const job = (await jobs()).filter((j) => j.kind === kind).at(-1);
    if (job?.state === 'done') return job;
    assert.ok(job?.state !== 'failed' && Date.now() < end, `${kind}: ${job?.state} ${job?.error}`);
    await page.waitForTimeout(200);
  }
}

async function importVideo() {
  await page.goto(address);
  await tab('Experiments');
  await page.getByLabel('New experiment').fill('Rollers');
  await page.getByRole('button', { name: 'Create' }).click();
  await page.locator('.dropzone input').setInputFiles(video);
  await page.getByText('2048 × 1080 px, 13.7 Hz, 75.9 s').waitFor();
  assert.deepEqual(readFileSync(join(folder, 'videos/rollers.mp4')), readFileSync(video));
  // The scale of the recording is not known: speeds in um/s are px/s.
  await page.getByLabel('Scale').first().fill('1');
  await page.getByLabel('Scale').first().press('Tab');
  await until(() => toml().includes('um_per_px_source = "typed"'), 'the scale is saved');
  await shot('rollers-imported');
}

async function findSegments() {
  await page.getByRole('link', { name: 'View rollers.mp4' }).click();
  await page.getByText(/^frame 1 of 10\d\d/).waitFor();
  await page.getByRole('button', { name: 'Find segments' }).click();
  await done('activity');
  await segment(8, 'to (s)').waitFor();
  assert.equal(await page.getByRole('button', { name: /^Go to segment/ }).count(), kTruth.length);
  for (const [i, truth] of kTruth.entries()) {
    for (const key of ['from', 'to']) assert.ok(Math.abs((await valueOf(i + 1, `${key} (s)`)) - truth[key]) < 0.5, `segment ${i + 1} ${key}`);
    assert.ok(apart(await valueOf(i + 1, 'direction (°)'), truth.deg) < 45, `direction of segment ${i + 1}`);
  }
  await shot('rollers-segments');
}

/** The x of a time on the time axis, and the y of the strip of the segments. */
async function onAxis(t) {
  const box = await page.locator('.axis svg').boundingBox(), length = Number(await page.getByLabel('Position in the video').getAttribute('max'));
  return [box.x + (t / length) * box.width, box.y + 56];
}

async function correctByHand() {
  // By keyboard: the reversal as it was read by eye.
  await segment(8, 'from (s)').fill('69.5');
  await segment(8, 'from (s)').press('Tab');
  // By pointer: the end of the first segment; a pixel of the axis is about 0.1 s.
  const end = await valueOf(1, 'to (s)');
  const [x, y] = await onAxis(end), [to] = await onAxis(8.1);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move((x + to) / 2, y);
  await page.mouse.move(to, y);
  await page.mouse.up();
  const moved = await valueOf(1, 'to (s)');
  assert.ok(moved < end - 0.2 && Math.abs(moved - 8.1) < 0.3, `the end moved from ${end} to ${moved} s`);
  await page.locator('[data-stated=segments]').getByText('marked and not saved: 8').waitFor();
  await page.reload(); // marks that are not saved survive
  await until(async () => (await segment(8, 'from (s)').count()) === 1 && (await valueOf(8, 'from (s)')) === 69.5, 'the marks are kept');
  await page.getByRole('button', { name: 'Save: Segments' }).click();
  await until(() => /\[\[video\.segment\]\]\nfrom = "69.5 s"/.test(toml()), 'the segments are saved');
  await page.locator('[data-stated=segments]').getByText(/^in the experiment: 8$/).waitFor();
  await shot('rollers-corrected');
  return moved;
}

async function identify(end) {
  await page.getByRole('link', { name: 'Rollers' }).first().click();
  await page.getByText('field segments: 8').waitFor();
  await page.getByRole('button', { name: 'Identify a model' }).click();
  await page.getByText('Field segments of the experiment: 8').waitFor();
  await page.getByRole('group', { name: 'Add a model' }).getByRole('button', { name: 'dipole' }).click();
  await page.getByRole('textbox', { name: /^lowest/ }).fill('0 um/s');
  await page.getByRole('textbox', { name: /^highest/ }).fill('150 um/s');
  await page.getByLabel('Boundary boundary', { exact: true }).selectOption('none');
  await page.getByLabel('Look look', { exact: true }).selectOption('positions');
  await page.getByLabel('Simulations simulations', { exact: true }).fill('100');
  await shot('rollers-study');
  await page.getByRole('button', { name: 'Save and start' }).click();
  await page.getByRole('link', { name: /^Show job/ }).waitFor();
  const job = await done('identify');
  // The study has the corrected segments, with directions clockwise as in the picture.
  const study = readFileSync(join(folder, 'studies/rollers.toml'), 'utf8');
  assert.match(study, new RegExp(`to = "${moved(end)} s"\ndirection = "`));
  assert.match(study, /from = "69.5 s"/);
  const { result } = await page.evaluate((id) => fetch(`/api/jobs/${id}`).then((r) => r.json()), job.id);
  assert.equal(result.models.length, 1);
  await page.getByRole('link', { name: 'Open' }).first().click();
  await page.getByRole('heading', { name: 'rollers' }).first().waitFor();
  await shot('rollers-result');
}
const moved = (end) => String(Number(end.toFixed(3))).replace('.', '\\.');

if (existsSync(video)) {
  let end = 0;
  await step('the recording is imported', importVideo);
  await step('its segments are found in the viewer', findSegments);
  await step('a segment is corrected by keyboard and pointer, and saved', async () => (end = await correctByHand()));
  await step('a model is identified with the segments', () => identify(end));
} else {
  skip('rollers.mp4 is absent; give --data FOLDER');
}
await finish();
