// A live lab in a temporary folder, and a browser with its page, for the browser tests, which end with finish(). With --www FOLDER
// the page is read from a folder, for development.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { once } from 'node:events';
import { cpSync, mkdirSync, mkdtempSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { serve } from '../../bench/lab_client.mjs';

export const option = (name) => {
  const i = process.argv.indexOf(`--${name}`);
  return i < 0 ? null : resolve(process.argv[i + 1]);
};
/** Factor on all waiting times, for programs with sanitizers. */
const slowness = process.argv.includes('--slow') ? 10 : 1;
export const program = option('program'), root = option('root'), pictures = option('pictures');
const { chromium } = createRequire(join(root, 'web', 'package.json'))('playwright-core');
const kPatience = 30000 * slowness; // ms; long enough for a busy machine
/** For a job of the lab, ms. */
export const kJobPatience = 120000 * slowness;

export const workspace = mkdtempSync(join(tmpdir(), 'faba-lab-test-'));
for (const folder of ['scenes', 'rigs', 'studies']) cpSync(join(root, folder), join(workspace, folder), { recursive: true });
if (pictures) mkdirSync(pictures, { recursive: true });

export const faba = (...words) => JSON.parse(execFileSync(program, [...words, '--json'], { cwd: workspace, encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] }));

/** Files of the page from a folder, for development: --www FOLDER. */
const www = option('www') ? ['--www', option('www')] : [];
/** The process of the server and its address; serveAgain() starts another server. */
export let { lab, address } = await serve(program, workspace, ...www);
export async function serveAgain(...more) {
  ({ lab, address } = await serve(program, workspace, ...www, ...more));
}
process.on('exit', () => lab.kill('SIGKILL')); // also after a failure
export const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: ['--no-sandbox'] });
export const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, locale: 'en-GB', colorScheme: 'light', acceptDownloads: true });
// The steps read positions in pixels, as those of the picture; the step on units uses micrometres.
await context.addInitScript(() => localStorage.getItem('faba.unit') ?? localStorage.setItem('faba.unit', '"px"'));
export const page = await context.newPage();
page.setDefaultTimeout(kPatience);
/** Errors that the page reported on the console. */
export const complaints = [];
/** Requests to other machines. */
export const elsewhere = [];
const expected = /WebSocket connection|ERR_CONNECTION_REFUSED|401/; // while the server is stopped
page.on('console', (m) => m.type() === 'error' && !expected.test(m.text()) && complaints.push(m.text()));
page.on('pageerror', (e) => complaints.push(String(e)));
page.on('request', (r) => /^(data|blob):/.test(r.url()) || new URL(r.url()).hostname === '127.0.0.1' || elsewhere.push(r.url()));

/** Exit code of a test with a skipped check and no failure, as in tests/skip.h. */
const kSkipped = 77;
const skipped = [];
/** Marks the test as skipped: ctest does not list it as passed. Other checks still count. */
export function skip(why) {
  console.log(`SKIPPED: ${why}`);
  skipped.push(why);
}
/** The end of a test: ends the browser and the server, and removes the workspace. */
export async function finish() {
  assert.deepEqual(elsewhere, [], 'requests to other machines');
  await browser.close();
  if (lab.exitCode === null && lab.signalCode === null) {
    const ended = once(lab, 'exit');
    lab.kill('SIGTERM');
    await ended; // until then it writes in the workspace
  }
  rmSync(workspace, { recursive: true, force: true });
  if (skipped.length) process.exitCode = kSkipped;
  console.log(skipped.length ? `all other steps passed; SKIPPED: ${skipped.join('; ')}` : 'all steps passed');
}

export const shot = async (name) => pictures && page.screenshot({ path: join(pictures, `${name}.png`) });
export const step = async (what, does) => {
  const began = Date.now();
  try {
    await does();
  } catch (e) {
    await page.screenshot({ path: join(tmpdir(), 'faba-lab-test-failed.png') }).catch(() => {});
    console.error(`FAILED: ${what}`);
    throw e;
  }
  assert.deepEqual(complaints, [], `the page reported errors: ${what}`);
  console.log(`ok ${what} (${((Date.now() - began) / 1000).toFixed(1)} s)`);
};
export const tab = (name) => page.locator('nav').getByRole('link', { name: new RegExp(`^${name}`) }).click();
/** Shows a panel of the workbench: in a wide window some have no tab, because they are always visible. */
export const panel = async (name) => {
  const one = page.getByRole('tab', { name: new RegExp(`^${name}`) });
  if (await one.count()) await one.click();
};
/** The numbers in an element of the page, where a narrow space groups the digits of large ones. */
export const read = async (what) => (await page.locator(`[data-read="${what}"]`).textContent()).replaceAll('\u202f', '').match(/-?[\d.]+/g)?.map(Number) ?? [];
export async function until(holds, what) {
  const end = Date.now() + kPatience;
  while (Date.now() < end) {
    if (await holds()) return;
    await page.waitForTimeout(50);
  }
  assert.fail(`timeout: ${what}`);
}
/** The canvas position of a point of the picture, px, computed by the page. */
export async function place(x, y) {
  const box = await page.locator('.stage canvas.over').boundingBox();
  const [cx, cy, ratio] = await page.evaluate(([px, py]) => {
    const c = document.querySelector('.stage canvas.over');
    return [...c.toCanvas(px, py), c.width / c.getBoundingClientRect().width];
  }, [x, y]);
  return [box.x + cx / ratio, box.y + cy / ratio];
}
