// Test of the video viewer in a browser. Stops with an error at the first failed step. With --pictures FOLDER it saves
// screenshots of the page in FOLDER.
//
// With --data FOLDER it opens the recordings in this folder, too (tests/real). Without them these steps are skipped: exit code 77.
//
//   node tests/e2e/video_viewer_test.mjs --program build/faba --root . [--data ../shared/data] [--pictures FOLDER]

import assert from 'node:assert/strict';
import { cpSync, existsSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { address, complaints, faba, finish, option, page, shot, skip, step, until, workspace } from './lab_page.mjs';

const kScene = ['run', 'scenes/as-seen.toml', '--seed', '1', '--duration', '3 s'];
faba(...kScene, '--out', 'runs/response'); // 15 frames per second, 45 frames, field reversal at 1 s
faba('track', 'runs/response', '--out', 'tracks.csv', '--swarm', 'swarm.csv');
faba('activity', 'runs/response', '--out', 'activity.csv');
const complete = readFileSync(join(workspace, 'runs/response/video.avi'));
writeFileSync(join(workspace, 'cut.avi'), complete.subarray(0, complete.length / 2));
writeFileSync(join(workspace, 'empty.mp4'), '');
writeFileSync(join(workspace, 'notes <b>1.mp4'), 'These are notes.\n');

const base = new URL(address).origin;
const viewer = page.locator('.viewer');
const frame = async () => Number(await viewer.getAttribute('data-index'));
const time = async () => Number(await viewer.getAttribute('data-time'));
const open = async (file) => {
  await page.goto(`${base}/#/video?file=${encodeURIComponent(file)}`);
  await page.getByRole('heading', { name: file }).waitFor();
};
const atFrame = (n) => until(async () => (await frame()) === n, `frame ${n}`);
/** The marks of the open video, as the page keeps them. */
const marks = () => page.evaluate(() => JSON.parse(localStorage.getItem('faba.marks.runs/response') ?? 'null'));
/** A position in the window of a point of the picture. */
const place = async (x, y) => {
  const canvas = page.locator('.viewer canvas'), box = await canvas.boundingBox();
  const [cx, cy, ratio] = await canvas.evaluate((c, [px, py]) => [...c.toCanvas(px, py), c.width / c.getBoundingClientRect().width], [x, y]);
  return [box.x + cx / ratio, box.y + cy / ratio];
};
const drag = async (from, to) => {
  await page.mouse.move(...from);
  await page.mouse.down();
  for (let i = 1; i <= 5; ++i) await page.mouse.move(from[0] + ((to[0] - from[0]) * i) / 5, from[1] + ((to[1] - from[1]) * i) / 5);
  await page.mouse.up();
};
/** Mean grey value of a square of the displayed picture. */
const grey = async (x, y) => {
  const canvas = page.locator('.viewer canvas');
  return canvas.evaluate((c, [px, py]) => {
    const [cx, cy] = c.toCanvas(px, py), d = c.getContext('2d').getImageData(cx - 5, cy - 5, 11, 11).data;
    return d.reduce((sum, v, i) => sum + (i % 4 === 0 ? v : 0), 0) / 121;
  }, [x, y]);
};
const tool = (name) => page.getByRole('group', { name: 'Tool' }).getByRole('button', { name }).click();

await step('the list shows the videos with thumbnails', async () => {
  await page.goto(address);
  await page.getByRole('navigation').waitFor();
  await page.goto(`${base}/#/video`);
  const entry = page.getByRole('link', { name: 'runs/response' });
  await until(() => entry.locator('img').evaluate((i) => i.naturalWidth > 100), 'the thumbnail');
  complaints.length = 0; // the thumbnails of files that are not videos
  await entry.click();
  await atFrame(0);
  await page.getByText('frame 1 of 45').waitFor();
  await page.getByText('0.9164 µm/px').waitFor();
  await shot('video');
});

await step('the picture is that of the program', async () => {
  const file = readFileSync(join(workspace, 'runs/response/manifest.json'), 'utf8');
  assert.match(file, /"complete": ?true/);
  const sent = await page.evaluate(async () => {
    const r = await fetch('/api/videos/frames?file=runs/response&from=0&count=1&low=0&high=255');
    const b = await r.arrayBuffer(), v = new DataView(b), width = v.getUint16(16, true), px = new Uint8Array(b, 20);
    let sum = 0;
    for (let y = 235; y <= 245; ++y) for (let x = 395; x <= 405; ++x) sum += px[y * width + x];
    return { width, height: v.getUint16(18, true), mean: sum / 121 };
  });
  assert.deepEqual([sent.width, sent.height], [640, 480]);
  await page.getByLabel('Swarm ellipse').uncheck();
  await until(async () => Math.abs((await grey(400, 240)) - sent.mean) < 4, `the grey value ${sent.mean}`);
});

await step('keys go frame by frame, forwards and backwards', async () => {
  for (const [key, n] of [['.', 1], ['ArrowRight', 2], ['ArrowRight', 3], [',', 2], ['ArrowLeft', 1], ['Shift+ArrowRight', 11], ['End', 44], [',', 43], ['Home', 0]]) {
    await page.keyboard.press(key);
    await atFrame(n);
    await until(async () => Math.abs((await time()) - n / 15) < 1e-3, `the time of frame ${n}`);
  }
});

await step('the slider and a click on the time axis go to a time', async () => {
  await page.getByLabel('Position in the video').focus();
  await page.keyboard.press('End');
  await atFrame(44);
  const box = await page.locator('.axis svg').boundingBox();
  await page.mouse.click(box.x + box.width / 2, box.y + 20);
  await until(async () => Math.abs((await time()) - 1.5) < 0.1, 'the middle');
  await page.locator('h2').click(); // takes the focus from the slider
});

await step('playing shows the frames in real time, to the end', async () => {
  await page.keyboard.press('Home');
  await atFrame(0);
  await page.locator('.viewer .speed select').selectOption('2');
  await page.getByRole('button', { name: 'Play', exact: true }).click();
  await until(async () => (await frame()) > 20, 'playing');
  await page.getByRole('button', { name: 'Play', exact: true }).waitFor(); // at the end
  await atFrame(44);
});

await step('contrast: black and white by two sliders, or automatically', async () => {
  await page.keyboard.press('Home');
  await atFrame(0);
  const before = await grey(400, 240);
  await page.getByRole('button', { name: 'Automatic' }).click();
  await until(async () => Math.abs((await grey(400, 240)) - before) > 15, 'another contrast');
  await page.getByLabel('White').fill('60'); // below all grey values of this place
  await until(async () => (await grey(400, 240)) > 250, 'white');
  await page.getByRole('button', { name: 'Full range' }).click();
  await until(async () => Math.abs((await grey(400, 240)) - before) < 4, 'the full range');
});

await step('results of the program are drawn over the picture', async () => {
  const files = ['tracks.csv', 'swarm.csv', 'activity.csv'].map((f) => join(workspace, f));
  await page.locator('input[type="file"]').setInputFiles(files);
  for (const name of ['Detections', 'Tracks', 'Swarm ellipse']) await page.getByLabel(name, { exact: true }).waitFor();
  assert.ok(((await page.locator('.axis .curve').getAttribute('d')) ?? '').length > 200, 'the activity curve');
  await page.getByLabel('Position in the video').fill('1.2');
  await until(async () => Math.abs((await time()) - 1.2) < 1e-3, '1.2 s');
  const coloured = () => page.locator('.viewer canvas').evaluate((c) => {
    const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
    let n = 0;
    for (let i = 0; i < d.length; i += 4) n += Math.abs(d[i] - d[i + 2]) > 60 ? 1 : 0;
    return n;
  });
  const all = await coloured();
  assert.ok(all > 500, `${all} coloured pixels`);
  await shot('video-overlays');
  for (const name of ['Detections', 'Tracks', 'Swarm ellipse']) await page.getByLabel(name, { exact: true }).uncheck();
  await until(async () => (await coloured()) === 0, 'no overlays');
  await page.locator('input[type="file"]').setInputFiles(join(workspace, 'scenes/as-seen.toml'));
  await page.getByText('as-seen.toml is not a file of tracks').waitFor();
});

await step('the flow to the next frame is computed and drawn', async () => {
  const answer = page.waitForResponse((r) => r.url().includes('/api/videos/flow'));
  await page.getByLabel('Flow to the next frame').check();
  const { t_s, arrows } = await (await answer).json();
  assert.ok(Math.abs(t_s - 1.2) < 1e-3 && arrows.length > 10, `${arrows.length} arrows at ${t_s} s`);
  assert.ok(arrows.reduce((sum, a) => sum + a[2], 0) > 0, 'the cells swim to the right');
  await page.getByLabel('Flow to the next frame').uncheck();
});

await step('segments are drawn on the time axis, and get their direction on the picture', async () => {
  const at = async (t) => {
    const box = await page.locator('.axis svg').boundingBox(); // the page scrolls to the tools
    return [box.x + (t / 3) * box.width, box.y + 56];
  };
  await drag(await at(0.2), await at(0.8));
  await until(async () => (await marks())?.segments.length === 1, 'a segment');
  let [s] = (await marks()).segments;
  assert.ok(Math.abs(s.from_s - 0.2) < 0.05 && Math.abs(s.to_s - 0.8) < 0.05, JSON.stringify(s));
  assert.equal(s.direction_deg, null);
  await tool('Direction');
  await drag(await place(300, 300), await place(300, 200)); // up
  await until(async () => (await marks()).segments[0].direction_deg === 90, 'up is 90 degrees');
  await drag(await place(300, 300), await place(200, 300));
  await until(async () => (await marks()).segments[0].direction_deg === 180, 'left is 180 degrees');
  await drag(await at(0.8), await at(0.6)); // its end
  [s] = (await marks()).segments;
  assert.ok(Math.abs(s.to_s - 0.6) < 0.05, JSON.stringify(s));
  await shot('video-segments');
});

await step('segments and the reversal are typed, and set by keys', async () => {
  await page.getByLabel('Segment 1: to (s)').fill('0.75');
  await page.getByLabel('Segment 1: direction (°)').fill('-90');
  await page.getByLabel('Segment 1: direction (°)').press('Tab');
  await until(async () => (await marks()).segments[0].direction_deg === 270, 'down is 270 degrees');
  assert.equal((await marks()).segments[0].to_s, 0.75);
  await page.locator('h2').click();
  for (const [t, key] of [['1', 'r'], ['2', '['], ['2.6', ']']]) {
    await page.getByLabel('Position in the video').fill(t);
    await page.getByLabel('Position in the video').evaluate((e) => e.blur());
    await page.keyboard.press(key);
  }
  await until(async () => (await marks()).segments.length === 2, 'two segments');
  const m = await marks();
  assert.ok(Math.abs(m.reversal_s - 1) < 1e-6 && Math.abs(m.segments[1].from_s - 2) < 1e-6 && Math.abs(m.segments[1].to_s - 2.6) < 1e-6, JSON.stringify(m));
  await page.getByRole('button', { name: 'Remove segment 2' }).click();
  await until(async () => (await marks()).segments.length === 1, 'one segment');
});

await step('region of interest, mask and ruler', async () => {
  await tool('Region');
  await drag(await place(100, 50), await place(500, 400));
  await until(async () => (await marks()).roi !== null, 'the region');
  const { roi } = await marks();
  for (const [key, v] of Object.entries({ x: 100, y: 50, width: 400, height: 350 })) assert.ok(Math.abs(roi[key] - v) <= 2, JSON.stringify(roi));
  await page.getByLabel('Region of interest: width (px)').fill('9999');
  await page.getByLabel('Region of interest: width (px)').press('Tab');
  await until(async () => (await marks()).roi.width === 640 - roi.x, 'the region ends at the edge of the picture');
  await tool('Mask');
  for (const q of [[200, 200], [300, 200], [250, 280]]) await page.mouse.click(...(await place(...q)));
  await page.keyboard.press('Enter');
  await until(async () => (await marks()).masks.length === 1, 'the mask');
  assert.equal((await marks()).masks[0].length, 3);
  await tool('Ruler');
  await drag(await place(100, 100), await place(400, 100));
  const [um, px] = (await page.locator('[data-read="ruler"]').textContent()).match(/[\d.]+/g).map(Number);
  assert.ok(Math.abs(px - 300) < 2 && Math.abs(um - 0.9164 * px) < 0.2, `${um} um, ${px} px`);
  await shot('video-marks');
});

await step('the marks are there again after a reload', async () => {
  const before = await marks();
  await page.reload();
  await atFrame(0);
  await page.getByLabel('Segment 1: direction (°)').waitFor();
  assert.equal(await page.getByLabel('Segment 1: direction (°)').inputValue(), '270');
  assert.deepEqual(await marks(), before);
});

await step('damaged files and files that are not videos are explained', async () => {
  await open('cut.avi');
  await atFrame(0);
  await page.getByText('The file is damaged: ').waitFor();
  await page.locator('h2').click();
  await page.keyboard.press('End');
  await until(async () => (await frame()) > 10 && (await frame()) < 44, 'the last frame before the damage');
  for (const [file, why] of [['empty.mp4', 'the file is empty'], ['notes <b>1.mp4', 'cannot be read as a picture or video'], ['absent.mp4', 'not found'], ['../secret.mp4', '..']]) {
    await open(file);
    await page.getByRole('alert').filter({ hasText: why }).waitFor();
    assert.equal(await page.locator('h2 b').count(), 0, 'a file name is text');
  }
  complaints.length = 0; // the browser reports the refused requests
});

const data = option('data');
if (!data || !existsSync(join(data, 'step-response'))) skip('--data has no folder step-response: the steps with recordings');
else {
  cpSync(join(data, 'step-response/rollers.mp4'), join(workspace, 'rollers.mp4'));
  for (const folder of ['suspension', 'drops', 'beads']) cpSync(join(data, folder), join(workspace, folder), { recursive: true });

  await step('micro-rollers: the eight segments are adopted, and their direction is drawn', async () => {
    // Times from the description of the recordings; the program has clockwise directions: 270 up, 90 down.
    const times = [[5.6, 8.5, 270], [12.6, 18.2, 90], [20.5, 23.2, 90], [25.8, 32.3, 270], [35.2, 38.4, 270], [45.2, 58.4, 90], [61, 68.9, 270], [69.5, 73.6, 90]];
    writeFileSync(join(workspace, 'segments.json'), JSON.stringify({ videos: [{ segments: times.map(([t0_s, t1_s, direction_deg]) => ({ t0_s, t1_s, direction_deg })) }] }));
    await open('rollers.mp4');
    await page.getByText('frame 1 of 1037').waitFor();
    await page.locator('input[type="file"]').setInputFiles(join(workspace, 'segments.json'));
    await page.getByRole('button', { name: 'Use the segments found' }).click();
    await page.getByRole('button', { name: 'Go to segment 8' }).click();
    await until(async () => Math.abs((await time()) - 69.5) < 0.08, 'the start of segment 8');
    for (const [i, [, , deg]] of times.entries()) assert.equal(await page.getByLabel(`Segment ${i + 1}: direction (°)`).inputValue(), String(360 - deg));
    assert.equal(await page.locator('.axis [data-segment]').count(), 8);
    await shot('video-rollers');
  });
  await step('suspension and beads are displayed without a scale, and the edge of a drop over its picture', async () => {
    await open('suspension');
    await page.getByText('frame 1 of 25').waitFor();
    await page.getByText('the times are numbers of frames').waitFor();
    await page.locator('h2').click();
    await page.keyboard.press('End');
    await atFrame(24);
    await tool('Ruler');
    await drag(await place(100, 100), await place(200, 100));
    assert.match(await page.locator('[data-read="ruler"]').textContent(), /^(99|100|101)\.\d px$/);
    await open('beads/bulk-water.mov');
    await page.getByText('frame 1 of 480').waitFor();
    await open('drops/00000.tif');
    await page.getByText('518 × 488 px, 16 bit').waitFor();
    const level = await grey(258, 60); // automatic contrast: the dim picture uses the grey scale
    assert.ok(level > 40 && level < 220, `grey level ${level}`);
    await page.getByRole('button', { name: 'Find drop edge' }).click();
    await page.getByLabel('Drop edge', { exact: true }).waitFor();
    await shot('video-drop');
  });
}

await step('narrow windows and both languages', async () => {
  await open('runs/response');
  await atFrame(0);
  for (const [width, height] of [[390, 844], [2560, 1440]]) {
    await page.setViewportSize({ width, height });
    await page.waitForTimeout(200);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `the page is wider than ${width} px`);
    await shot(`video-${width}`);
  }
  await page.setViewportSize({ width: 1280, height: 800 });
  await page.getByLabel('Language').selectOption('pt');
  await page.getByRole('button', { name: 'Adicionar segmento' }).waitFor();
  await page.getByText('quadro 1 de 45').waitFor();
  await page.getByRole('button', { name: 'Tema' }).click();
  await until(() => page.evaluate(() => document.documentElement.dataset.theme === 'dark'), 'the dark theme');
  await shot('video-pt');
});

await finish();
