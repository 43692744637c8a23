// Report pages in a browser window of 1280 px: every table fits, and its headings are aligned with their columns.
//
//   node tests/e2e/report_pages_test.mjs --program build/faba --root .

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const option = (name) => resolve(process.argv[process.argv.indexOf(`--${name}`) + 1]);
const program = option('program'), root = option('root');
const { chromium } = createRequire(join(root, 'web', 'package.json'))('playwright-core');
const folder = mkdtempSync(join(tmpdir(), 'faba-pages-'));
process.on('exit', () => rmSync(folder, { recursive: true, force: true }));
const faba = (...words) => execFileSync(program, words, { cwd: folder, stdio: ['ignore', 'ignore', 'ignore'] });

// A comparison with many columns: two delays and two models need a condition, a route has a cross-track error, coils have an effort,
// and the swarm settles because it starts at its setpoints.
writeFileSync(join(folder, 'study.toml'), `scene = "${join(root, 'scenes/null-route.toml')}"
seeds = 2
delays = [0, 4]
[[controller]]
name = "gradient with feedback"
type = "gradient_feedback"
[[controller]]
name = "gradient without feedback"
type = "gradient"
[[model]]
name = "standard cells"
type = "dipole"
preset = "IT-1"
set = { "duration" = "1 s", "reference.setpoints_px" = [[320, 240], [322, 240]], "reference.hold_frames" = 3 }
[[model]]
name = "slow cells"
type = "dipole"
preset = "IT-1"
speed = "40 um/s"
set = { "duration" = "1 s", "reference.setpoints_px" = [[320, 240], [322, 240]], "reference.hold_frames" = 3 }
`);
faba('compare-controllers', 'study.toml', '--out', 'controllers');
faba('run', join(root, 'scenes/as-seen.toml'), '--seed', '1', '--duration', '3 s', '--out', 'run');
faba('track', 'run', '--report', 'track.html');
faba('activity', 'run', '--report', 'activity.html');

const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: ['--no-sandbox'] });
const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
for (const file of ['controllers/report.html', 'run/report.html', 'track.html', 'activity.html']) {
  await page.goto(pathToFileURL(join(folder, file)).href);
  const tables = await page.evaluate(() => [...document.querySelectorAll('table')].map((table) => {
    const box = table.getBoundingClientRect(), frame = table.closest('.wide') ?? table;
    const head = table.tHead?.rows[0].cells, body = [...table.tBodies[0].rows].map((r) => r.cells).find((c) => c.length === head?.length);
    const aligned = !head || !body || [...head].slice(1).every((h, i) => getComputedStyle(h).textAlign === getComputedStyle(body[i + 1]).textAlign);
    return { columns: head?.length, left: box.left, right: box.right, cut: frame.scrollWidth - frame.clientWidth, aligned };
  }));
  assert.ok(tables.length > 0, `${file} has no table`);
  for (const t of tables) {
    assert.ok(t.left >= 0 && t.right <= 1280 && t.cut <= 0, `${file}: a table is cut off: ${JSON.stringify(t)}`);
    assert.ok(t.aligned, `${file}: headings are not aligned with their columns`);
  }
  if (file.startsWith('controllers')) assert.ok(tables.some((t) => t.columns >= 10), `${file}: columns are missing: ${JSON.stringify(tables)}`);
  console.log(`ok ${file}: ${tables.length} tables`);
}
await browser.close();
