// Measures the live lab: pictures per second in a browser, bytes per picture, slowdown of a run by clients, latency of a
// click. Writes bench/results/lab.md.
//
//   node bench/lab.mjs --program build/faba --root . [--out bench/results/lab.md]

import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { cpus, tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { gzipSync } from 'node:zlib';
import { Client, serve, wait } from './lab_client.mjs';

const option = (name) => {
  const i = process.argv.indexOf(`--${name}`);
  return i < 0 ? null : resolve(process.argv[i + 1]);
};
const program = option('program'), root = option('root'), out = option('out');
const { chromium } = createRequire(join(root, 'web', 'package.json'))('playwright-core');
const folder = mkdtempSync(join(tmpdir(), 'faba-lab-bench-'));
cpSync(join(root, 'scenes'), join(folder, 'scenes'), { recursive: true });
const median = (v) => [...v].sort((a, b) => a - b)[v.length >> 1];
const scene = (cells) => ({
  camera: { rate: '60 Hz' }, arena: { type: 'drop', radius_px: 600 },
  swarm: [{ count: cells, model: { type: 'dipole', preset: 'IT-1' } }], controller: { type: 'manual', field: ['0.1 mT', '0 T'] },
});
const lines = [], say = (l) => (lines.push(l), console.log(l));
const ghz = () => (Math.max(...[...readFileSync('/proc/cpuinfo', 'utf8').matchAll(/cpu MHz\s*: ([\d.]+)/g)].map((m) => Number(m[1]))) / 1000).toFixed(2);
/** The number of the present frame of the run of a server, and its time. */
const frameNow = async (server) => {
  const c = await Client.open(server);
  while (!c.news.state) await wait(1);
  const at = [c.news.state.frame, performance.now()];
  c.close();
  return at;
};
/** Frames per second of the run in the next `seconds`, without a page that this function opens. */
const rate = async (server, seconds) => {
  const [f0, t0] = await frameNow(server);
  await wait(seconds * 1000);
  const [f1, t1] = await frameNow(server);
  return ((f1 - f0) / (t1 - t0)) * 1000;
};
const browser = () => chromium.launch({ executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: ['--no-sandbox'] });

say(`# The live lab\n\n\`node bench/lab.mjs --program build/faba --root .\` on ${cpus().length} cores (${cpus()[0].model.trim()}, ${ghz()} GHz at the start).`);

// Time from the command to the first picture.
{
  const times = [];
  for (let i = 0; i < 3; ++i) {
    const b = await browser(), page = await b.newPage(), began = performance.now();
    const s = await serve(program, folder, join(folder, 'scenes/steer.toml'));
    await page.goto(s.address);
    await page.waitForFunction(() => document.querySelector('canvas.over')?.seen?.frames > 0);
    times.push(performance.now() - began);
    await b.close();
    s.lab.kill();
  }
  say(`\nTime from \`faba lab scenes/steer.toml\` to the first picture in an open browser: ${(median(times) / 1000).toFixed(2)} s (median of ${times.length}; goal 2 s).`);
}

// Pictures per second.
say(`\n## Pictures in the page\n\nChromium without a graphics card: the page draws the cells pixel by pixel on the processor.\n\n| cells | pictures/s in the page | frames/s of the run | frames/s without a page | drawing, ms | bytes per frame | bytes per cell |\n|---|---|---|---|---|---|---|`);
for (const cells of [1e3, 1e4, 1e5]) {
  const s = await serve(program, folder), c = await Client.open(s);
  assert.ok((await c.ask('start', { scenario: scene(cells), seed: 1 })).ok);
  c.close();
  await wait(2000);
  const alone = await rate(s, 5);
  const b = await browser(), page = await b.newPage({ viewport: { width: 1280, height: 800 } });
  await page.goto(s.address);
  await page.waitForFunction(() => document.querySelector('canvas.over')?.seen?.frames > 0);
  await wait(2000);
  const seen = () => page.evaluate(() => ({ ...document.querySelector('canvas.over').seen, at: performance.now(), bytes: document.querySelector('canvas.over').lab.frame.bytes, frame: document.querySelector('canvas.over').lab.frame.frame, cells: document.querySelector('canvas.over').lab.frame.cells }));
  const a = await seen();
  await wait(5000);
  const z = await seen(), seconds = (z.at - a.at) / 1000;
  assert.equal(z.cells, cells);
  say(`| ${cells} | ${((z.frames - a.frames) / seconds).toFixed(1)} | ${((z.frame - a.frame) / seconds).toFixed(1)} | ${alone.toFixed(1)} | ${((z.milliseconds - a.milliseconds) / (z.frames - a.frames)).toFixed(1)} | ${z.bytes} | ${(z.bytes / cells).toFixed(2)} |`);
  await b.close();
  s.lab.kill();
}

// Slowdown of a run at full speed by connected pages.
say(`\n## Slowdown of the run by pages\n\n10 000 cells at speed factor 32, which is faster than the machine can simulate. Frames per second of the run; each measurement is compared with one before and one after it without a page.\n\n| connected | frames/s | slowdown |\n|---|---|---|`);
{
  const s = await serve(program, folder, '--threads', '1');
  const first = await Client.open(s);
  assert.ok((await first.ask('start', { scenario: scene(1e4), seed: 1 })).ok);
  await first.ask('speed', { factor: 32 });
  first.close();
  await wait(1000);
  for (const [who, pages, stalled] of [['1 page', 1, false], ['4 pages', 4, false], ['1 page that reads nothing', 1, true], ['4 pages that read nothing', 4, true]]) {
    const before = [], during = [];
    for (let i = 0; i < 9; ++i) {
      before.push(await rate(s, 2));
      const all = [];
      for (let k = 0; k < pages; ++k) all.push(await Client.open(s));
      if (stalled) (await wait(300), all.forEach((c) => c.stall()), await wait(1000));
      during.push(await rate(s, 2));
      all.forEach((c) => c.close());
      await wait(300);
    }
    before.push(await rate(s, 2));
    const loss = during.map((d, i) => 1 - d / ((before[i] + before[i + 1]) / 2));
    say(`| ${who} | ${median(during).toFixed(0)} | ${(100 * median(loss)).toFixed(1)} % |`);
  }
  s.lab.kill();
}

// Latency of a click while all cores are busy.
{
  const s = await serve(program, folder), c = await Client.open(s);
  assert.ok((await c.ask('start', { scenario: scene(1e5), seed: 1 })).ok);
  const b = await browser(), page = await b.newPage({ viewport: { width: 1280, height: 800 } });
  c.close();
  await page.goto(s.address);
  await page.waitForFunction(() => document.querySelector('canvas.over')?.seen?.frames > 0);
  const busy = cpus().map(() => spawn('sh', ['-c', 'while :; do :; done']));
  await wait(1000);
  const times = [], marks = [];
  for (let i = 0; i < 40; ++i) {
    const [taken, marked] = await page.evaluate(async (k) => {
      const c = document.querySelector('canvas.over'), r = c.getBoundingClientRect(), began = performance.now();
      const before = c.lab.scene.setpoints.flat().join();
      const e = (type) => c.dispatchEvent(new PointerEvent(type, { pointerId: 1, clientX: r.left + r.width / 2 + k, clientY: r.top + r.height / 2, bubbles: true }));
      c.setPointerCapture = () => {};
      e('pointerdown');
      e('pointerup');
      while (c.lab.scene.setpoints.flat().join() === before) await new Promise((give) => setTimeout(give, 0));
      return [performance.now() - began, c.seen.answered - began];
    }, i);
    times.push(taken);
    if (marked > 0) marks.push(marked);
    await wait(100);
  }
  busy.forEach((p) => p.kill());
  const spread = (v) => `median ${median(v).toFixed(0)} ms, 95th percentile ${[...v].sort((x, y) => x - y)[Math.floor(0.95 * v.length)].toFixed(0)} ms`;
  say(`\n## Latency of a click\n\n100 000 cells, all cores busy with other work. Time from the click to the ring that confirms it on the page: ${spread(marks)} (goal 100 ms). Time to the new setpoint of the run, which changes between two frames: ${spread(times)}.`);
  await b.close();
  s.lab.kill();
}

const packed = ['index.html', 'app.js', 'app.css'].map((f) => gzipSync(readFileSync(join(root, 'web/dist', f))).length);
say(`\nSize of the page: ${(packed.reduce((a, n) => a + n) / 1000).toFixed(1)} kB with gzip (goal 200 kB).`);
if (out) writeFileSync(out, lines.join('\n') + '\n');
rmSync(folder, { recursive: true, force: true });
