// Test of the page of tracks in a browser: detection while settings change, linking, tracking, cuts, edits, export; with a
// reload in between. Stops with an error at the first failed step.
//
//   node tests/e2e/tracks_page_test.mjs --program build/faba --root . [--pictures FOLDER]

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { cpSync, existsSync, mkdirSync, readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { address, complaints, faba, finish, kJobPatience, page, program, read, shot, step, until, workspace } from './lab_page.mjs';

const csv = (file) => readFileSync(join(workspace, file), 'utf8');
const dataLines = (text) => text.trim().split('\n').filter((l) => !l.startsWith('#')).slice(1);
const numberOf = async (what) => (await read(what))[0];
const used = () => numberOf('used');
let folder = '';
/** The console lists `count` requests that were refused as expected. */
async function forgetRefusals(count) {
  const isRefusal = (c) => /status of 4\d\d/.test(c);
  await until(() => complaints.filter(isRefusal).length === count, `${count} refusals on the console`);
  complaints.splice(0, complaints.length, ...complaints.filter((c) => !isRefusal(c)));
}

await step('a video is selected', async () => {
  faba('run', 'scenes/as-seen.toml', '--as-seen', '--duration', '3 s', '--out', 'seen', '--seed', '3');
  mkdirSync(join(workspace, 'videos'), { recursive: true });
  const video = readdirSync(join(workspace, 'seen')).find((f) => /^video\.(avi|mp4)$/.test(f));
  cpSync(join(workspace, 'seen', video), join(workspace, 'videos', video));
  await page.goto(`${address}#/tracks`);
  await page.getByRole('link', { name: `videos/${video}` }).click();
  await page.getByText('cells detected in this frame').waitFor();
  await page.getByText(/automatic: [\d.]+ px/).waitFor();
  await until(() => numberOf('detected').then((n) => n > 5), 'cells are detected');
  await shot('detect');
});

await step('a higher threshold detects fewer cells, as in the terminal', async () => {
  const automatic = await numberOf('detected');
  await page.getByLabel('Threshold', { exact: true }).last().fill('12');
  await page.keyboard.press('Enter');
  await until(async () => (await numberOf('detected')) < automatic, 'fewer cells are detected');
  assert.match(page.url(), /threshold=12/);
  await page.reload();
  await until(async () => (await numberOf('detected')) > 0, 'the settings survive a reload');
  const high = await numberOf('detected');
  assert.ok(high < automatic);
  // A track of one detection contains every detection of a frame.
  const file = new URL(page.url().replace('#/tracks', '')).searchParams.get('file');
  faba('track', file, '--threshold', '12', '--least', '1', '--out', 'all.csv');
  assert.equal(dataLines(csv('all.csv')).filter((l) => l.split(',')[1] === '0').length, high);
  await page.getByLabel('Threshold: automatic').check();
  await until(async () => (await numberOf('detected')) === automatic, 'the automatic threshold is used again');
});

await step('the slider of the size changes the detection by keys', async () => {
  const slider = page.getByRole('slider', { name: 'Size of a cell' });
  const before = await slider.getAttribute('aria-valuetext');
  await slider.focus();
  for (let i = 0; i < 10; ++i) await page.keyboard.press('ArrowRight');
  await until(async () => (await slider.getAttribute('aria-valuetext')) !== before, 'the size changes');
  await until(() => /size=/.test(page.url()), 'the address has the size');
  await page.getByLabel('Size of a cell: automatic').check();
});

await step('linking is previewed, and the video is tracked', async () => {
  await page.getByRole('link', { name: '2 Link' }).click();
  await page.getByText(/tracks in 12 frames/).waitFor();
  await page.getByText(/automatic: [\d.]+ px/).waitFor();
  await shot('link');
  await page.getByRole('button', { name: 'Track the video' }).click();
  await page.getByText('tracks are used').waitFor({ timeout: kJobPatience });
  folder = new URL(page.url().replace('#/tracks', '')).searchParams.get('folder');
  assert.match(folder, /^runs\/tracks-video-/);
  assert.equal((await read('used'))[1], JSON.parse(csv(`${folder}/track.json`)).tracks);
});

await step('a cut is typed, moved by keys, and dragged; the number of tracks follows', async () => {
  const measured = csv(`${folder}/tracks.csv`), all = await used();
  const box = page.locator('[data-feature="points"]');
  await box.getByLabel('Detections: Minimum, ').fill('20');
  await page.keyboard.press('Enter');
  await until(async () => (await used()) < all, 'short tracks are cut');
  const limit = page.locator('[data-feature="speed"]').getByRole('slider', { name: 'Speed: Minimum' });
  const before = await used();
  await limit.focus();
  for (let i = 0; i < 25; ++i) await page.keyboard.press('Shift+ArrowRight');
  await until(async () => (await used()) < before, 'slow tracks are cut');
  await page.locator('[data-feature="speed"]').getByRole('button', { name: 'Remove cut' }).click();
  await until(async () => (await used()) === before, 'the cut is removed');
  const svg = await page.locator('[data-feature="straightness"] svg').boundingBox();
  await page.mouse.move(svg.x + 1, svg.y + svg.height / 2);
  await page.mouse.down();
  await page.mouse.move(svg.x + svg.width * 0.6, svg.y + svg.height / 2, { steps: 5 });
  await page.mouse.up();
  await until(() => page.locator('[data-feature="straightness"]').getByRole('button', { name: 'Remove cut' }).count(), 'the cut is dragged');
  await shot('filter');
  const now = await used();
  await until(() => existsSync(join(workspace, folder, 'edits.toml')) && csv(`${folder}/edits.toml`).includes('straightness'), 'the cuts are saved');
  await page.reload();
  await page.getByText('tracks are used').waitFor();
  assert.equal(await used(), now, 'the cuts survive a reload');
  assert.equal(csv(`${folder}/tracks.csv`), measured, 'the measured tracks do not change');
});

await step('a track is selected in the picture, deleted, kept and split', async () => {
  await page.locator('[data-feature="straightness"]').getByRole('button', { name: 'Remove cut' }).click();
  const rows = dataLines(csv(`${folder}/tracks.csv`)).map((l) => l.split(',').map(Number));
  const frame = 20, here = rows.filter((r) => r[1] === frame);
  // The cell that is farthest from the others.
  const [number, , , x, y] = here.sort((a, b) => nearest(b) - nearest(a))[0];
  function nearest(r) {
    return Math.min(...here.filter((o) => o !== r).map((o) => Math.hypot(o[3] - r[3], o[4] - r[4])));
  }
  await page.getByLabel('Frame', { exact: true }).fill(String(frame));
  const size = JSON.parse(csv(`${folder}/track.json`)).image_size;
  const pad = await page.locator('.pad').boundingBox();
  const scale = Math.min(pad.width / size[0], pad.height / size[1]);
  await page.mouse.click(pad.x + pad.width / 2 + (x - size[0] / 2) * scale, pad.y + pad.height / 2 + (y - size[1] / 2) * scale);
  await page.getByRole('heading', { name: `Track ${number} ·` }).waitFor();
  const before = await read('used');
  await page.getByRole('button', { name: 'Delete', exact: true }).click();
  await page.getByRole('heading', { name: `Track ${number} · deleted` }).waitFor();
  await page.getByRole('button', { name: 'Keep', exact: true }).click();
  await page.getByRole('heading', { name: `Track ${number} · kept` }).waitFor();
  await page.getByRole('button', { name: `Split at frame ${frame}` }).click();
  await until(async () => (await read('used'))[1] === before[1] + 1, 'there is one more track');
  await page.getByRole('button', { name: `Undo: Track ${number} split at frame ${frame}` }).click();
  await until(async () => (await read('used'))[1] === before[1], 'the split is undone');
  await shot('track');
});

await step('the exported tables are those of the terminal, byte by byte', async () => {
  await page.getByRole('link', { name: '4 Result' }).click();
  await page.getByRole('button', { name: 'Export used tracks' }).click();
  await page.getByRole('link', { name: 'edited_features.csv' }).waitFor();
  await page.locator('[data-read="motion-tracks"]').waitFor();
  await shot('result');
  execFileSync(program, ['track', folder, '--edits', `${folder}/edits.toml`, '--out', 'terminal.csv', '--per-track', 'features.csv', '--quiet'], { cwd: workspace });
  assert.equal(csv('terminal.csv'), csv(`${folder}/edited_tracks.csv`));
  assert.equal(csv('features.csv'), csv(`${folder}/edited_features.csv`));
  assert.match(csv('terminal.csv'), /^# \d+ of \d+ tracks of tracks\.csv, sha256 [0-9a-f]{64}\n# cut: points from 20 to any\n# edit: delete track/);
  assert.equal(dataLines(csv('features.csv')).length, await used());
  const summary = faba('track', folder, '--edits', `${folder}/edits.toml`);
  assert.equal(await numberOf('motion-tracks'), summary.tracks);
  assert.equal(summary.tracks, await used());
});

await step('a change of another page is not overwritten', async () => {
  const other = await page.context().newPage();
  await other.goto(page.url());
  await other.getByText('tracks are used').waitFor();
  const send = (p, edits, revision) =>
    p.evaluate(
      async ([f, e, r]) => {
        const now = await (await fetch(`/api/tracks/result?${new URLSearchParams({ folder: f })}`)).json();
        const a = await fetch('/api/tracks/edits', { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify({ folder: f, revision: r ?? now.revision, edits: e }) });
        return { status: a.status, revision: now.revision };
      },
      [folder, edits, revision],
    );
  const first = await send(other, { cut: [{ feature: 'points', min: 25 }] });
  assert.equal(first.status, 200);
  assert.equal((await send(page, {}, first.revision)).status, 422);
  assert.match(csv(`${folder}/edits.toml`), /min = 25/);
  await other.close();
  await forgetRefusals(1);
});

await step('files outside of the workspace are refused', async () => {
  const status = await page.evaluate(async () => {
    const post = (url, body) => fetch(url, { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify(body) }).then((r) => r.status);
    return [await post('/api/tracks/detect', { file: '../x.mp4', frame: 0 }), await post('/api/tracks', { file: '/etc/passwd' }), await fetch('/api/tracks/file/tracks.csv?folder=..').then((r) => r.status), await fetch('/api/tracks/file/..%2Fscenario.toml?folder=seen').then((r) => r.status)];
  });
  for (const s of status) assert.ok(s >= 400 && s < 500, String(status));
  await forgetRefusals(status.length);
});

await step('Portuguese, dark theme, small screen', async () => {
  await page.getByLabel('Language').selectOption('pt');
  await page.getByRole('link', { name: '3 Filtrar' }).click();
  await page.getByLabel('Tema claro ou escuro').click();
  await page.setViewportSize({ width: 390, height: 844 });
  await page.waitForTimeout(300);
  assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= 390, 'the page is wider than the screen of a phone');
  await shot('phone');
});

await finish();
