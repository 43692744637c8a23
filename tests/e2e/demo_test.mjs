// The demonstration in a browser, opened from its folder and from a static file server: the state hashes of the program,
// real time, size, no request to a server, accessibility. `make test-demo` builds and runs it.
//
//   node tests/e2e/demo_test.mjs --program build/faba --root . --demo build/demo [--pictures FOLDER]

import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import { createReadStream, cpSync, existsSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { gzipSync } from 'node:zlib';

const option = (name) => {
  const i = process.argv.indexOf(`--${name}`);
  return i < 0 ? null : resolve(process.argv[i + 1]);
};
const program = option('program'), root = option('root'), demo = option('demo'), pictures = option('pictures');
const { chromium } = createRequire(join(root, 'web', 'package.json'))('playwright-core');
const kPatience = 60000; // ms; long enough for a busy machine
const kSkipped = 77; // exit code, as in tests/skip.h
const kMostBytes = 1.5e6; // compressed

if (!existsSync(join(demo, 'index.html'))) {
  console.log(`SKIPPED: ${demo}/index.html not found; "make demo" builds it, with Emscripten`);
  process.exit(kSkipped);
}
if (pictures) mkdirSync(pictures, { recursive: true });
const workspace = mkdtempSync(join(tmpdir(), 'faba-demo-test-'));
for (const folder of ['scenes', 'rigs']) cpSync(join(root, folder), join(workspace, folder), { recursive: true });

const step = async (what, does) => {
  const began = Date.now();
  await does().catch((e) => {
    console.error(`FAILED: ${what}`);
    throw e;
  });
  assert.deepEqual(complaints, [], `the page reported errors: ${what}`);
  console.log(`ok ${what} (${((Date.now() - began) / 1000).toFixed(1)} s)`);
};

const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: ['--no-sandbox'] });
process.on('exit', () => rmSync(workspace, { recursive: true, force: true }));
const complaints = [], requests = [];
async function open(address, { width = 1440, theme = 'light', locale = 'en-GB' } = {}) {
  const context = await browser.newContext({ viewport: { width, height: 900 }, locale, colorScheme: theme, acceptDownloads: true });
  const page = await context.newPage();
  page.setDefaultTimeout(kPatience);
  page.on('console', (m) => m.type() === 'error' && complaints.push(m.text()));
  page.on('pageerror', (e) => complaints.push(String(e)));
  page.on('request', (r) => /^(data|blob):/.test(r.url()) || requests.push(r.url()));
  await page.goto(address);
  await page.locator('[data-read="title"]').waitFor();
  return page;
}
/** The hash that the page shows after `does`; the run pauses. */
async function hashAfter(page, does) {
  await page.locator('[data-read="hash"]').waitFor({ state: 'hidden' });
  await does();
  await page.locator('[data-read="hash"]').waitFor();
  return page.locator('[data-read="hash"]').textContent();
}
/** The hash of the program for the command that the page shows. */
async function hashOfCommand(page) {
  const line = await page.locator('[data-read="command"] code').textContent();
  assert.match(line, /^faba run scenes\/[a-z0-9-]+\.toml --seed \d+.* --json$/);
  const command = line.replace(/^faba/, `'${program}'`);
  return JSON.parse(execFileSync('sh', ['-c', command], { cwd: workspace, encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] })).state_hash;
}
const finish = (page) => page.locator('[data-do="finish"]').click();
/** Imports a scenario by the form. */
const load = (page, toml, name) => page.locator('input[type="file"]').first().setInputFiles({ name, mimeType: 'application/toml', buffer: Buffer.from(toml) });
/** The position of a point of the picture on the page. */
async function place(page, x, y) {
  const box = await page.locator('.stage canvas.over').boundingBox();
  const [cx, cy, ratio] = await page.evaluate(([px, py]) => {
    const c = document.querySelector('.stage canvas.over');
    return [...c.toCanvas(px, py), c.width / c.getBoundingClientRect().width];
  }, [x, y]);
  return [box.x + cx / ratio, box.y + cy / ratio];
}

const folder = pathToFileURL(join(demo, 'index.html')).href;

await step(`the page loads less than ${kMostBytes / 1e6} MB, compressed`, async () => {
  const bytes = readdirSync(demo).filter((name) => !name.startsWith('LICENSE')).reduce((sum, name) => sum + gzipSync(readFileSync(join(demo, name))).length, 0);
  console.log(`   ${(bytes / 1000).toFixed(0)} kB`);
  assert.ok(bytes < kMostBytes, `${bytes} bytes`);
});

for (const scene of ['thesis-basic', 'thesis-adapted', 'steer'])
  await step(`from a folder, ${scene} has the state hash of the program`, async () => {
    const page = await open(`${folder}#${scene}`);
    const hash = await hashAfter(page, () => finish(page));
    assert.equal(hash, await hashOfCommand(page));
    console.log(`   ${hash}`);
    await page.context().close();
  });

const page = await open(`${folder}#steer`);

await step('a run that is paused, and one with another seed, has the hash of the program for its duration', async () => {
  const pause = page.locator('.transport button.main');
  await page.waitForTimeout(1500);
  assert.equal(await hashAfter(page, () => pause.click()), await hashOfCommand(page));
  assert.match(await page.locator('[data-read="command"]').textContent(), /--duration/);
  await page.locator('[data-choice="seed"]').fill('77');
  await page.getByRole('button', { name: 'Start', exact: true }).click();
  assert.equal(await hashAfter(page, () => finish(page)), await hashOfCommand(page));
  assert.match(await page.locator('[data-read="command"]').textContent(), /--seed 77/);
});

await step('every scene has the hash of the program where it is paused', async () => {
  const scenes = await page.locator('[data-choice="scene"] option').evaluateAll((all) => all.map((one) => one.value));
  assert.ok(scenes.length > 20);
  for (const scene of scenes.filter((name) => name !== 'million')) { // slower than real time
    await page.locator('[data-choice="scene"]').selectOption(scene);
    await page.waitForFunction((name) => location.hash === `#${name}`, scene);
    await page.waitForTimeout(400);
    assert.equal(await hashAfter(page, () => page.locator('.transport button.main').click()), await hashOfCommand(page), scene);
    await page.locator('.transport button.main').click();
  }
});

await step('a drag steers by hand, a click sets the setpoint; the page says that the hash is another one', async () => {
  await page.getByRole('button', { name: 'Start', exact: true }).click();
  const [x, y] = await place(page, 320, 240);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x - 60, y + 20, { steps: 5 });
  await page.mouse.up();
  await page.waitForFunction(() => document.querySelector('[data-read="controller"]').textContent.includes('manual'));
  await page.mouse.click(...(await place(page, 200, 200)));
  await page.waitForFunction(() => !document.querySelector('[data-read="controller"]').textContent.includes('manual'));
  await hashAfter(page, () => page.locator('.transport button.main').click());
  await page.locator('[data-read="changed"]').waitFor();
  assert.equal(await page.locator('[data-read="command"]').count(), 0);
});

await step('the messages of the engine are those of the program', async () => {
  const toml = 'duration = "2 s"\n[[swarm]]\ncount = -3\n';
  writeFileSync(join(workspace, 'wrong.toml'), toml);
  const refused = spawnSync(program, ['run', 'wrong.toml'], { cwd: workspace, encoding: 'utf8' }).stderr.trim();
  await load(page, toml, 'wrong.toml');
  const shown = page.locator('.banner.wrong');
  await shown.waitFor();
  const text = (await shown.textContent()).replace('✕', '').trim();
  assert.ok(refused.includes(text), `${refused}\n${text}`);
});

await step('1000 cells: at least real time, drawing included', async () => {
  // A frame of 1000 cells lasts 16.7 ms and takes the engine 1 to 3 ms. At a speed of 32 the engine and the drawing use all of the
  // machine, so that the measured factor is the largest; the page promises that it is at least 1.
  const toml = readFileSync(join(root, 'scenes/steer.toml'), 'utf8').replace('count = 400', 'count = 1000').replace('duration = "12 s"', 'duration = "10 min"');
  await load(page, toml, 'thousand.toml');
  await page.waitForFunction(() => /\b1000$/.test(document.querySelector('[data-read="responding"]')?.textContent ?? ''));
  await page.locator('.transport select').selectOption('32');
  const state = () => page.evaluate(() => {
    const { lab, seen } = document.querySelector('.stage canvas.over');
    return { wall: performance.now() / 1000, simulated: lab.frame.t, drawn: seen.frames };
  });
  await page.waitForTimeout(1000);
  const began = await state();
  await page.waitForTimeout(4000);
  const ended = await state();
  const wall = ended.wall - began.wall, factor = (ended.simulated - began.simulated) / wall, drawn = (ended.drawn - began.drawn) / wall;
  console.log(`   ${factor.toFixed(1)} simulated seconds per second, where the choice of the speed permits 32; ${drawn.toFixed(0)} pictures per second`);
  assert.ok(drawn >= 1, 'the pictures are drawn');
  assert.ok(factor >= 1, `${factor}`);
  await page.context().close();
});

await step('only files of the folder were requested', async () => {
  assert.deepEqual(requests.filter((r) => !r.startsWith(pathToFileURL(demo).href)), []);
});

await step('from a static file server', async () => {
  const kinds = { html: 'text/html', js: 'text/javascript', css: 'text/css', svg: 'image/svg+xml' };
  const server = createServer((request, response) => {
    const file = join(demo, request.url === '/' ? 'index.html' : request.url);
    response.writeHead(existsSync(file) ? 200 : 404, { 'Content-Type': kinds[file.split('.').pop()] ?? 'text/plain' });
    existsSync(file) ? createReadStream(file).pipe(response) : response.end();
  }).listen(0, '127.0.0.1');
  await new Promise((ready) => server.on('listening', ready));
  const address = `http://127.0.0.1:${server.address().port}/`;
  requests.length = 0;
  const other = await open(`${address}#thesis-basic`);
  assert.equal(await hashAfter(other, () => finish(other)), await hashOfCommand(other));
  assert.deepEqual([...new Set(requests.map((r) => new URL(r).pathname))].sort(), ['/', '/demo.css', '/demo.js', '/icon.svg'].filter((f) => f !== '/icon.svg' || requests.some((r) => r.endsWith(f))));
  await other.context().close();
  server.close();
});

// preload: false, because axe would fetch the style sheet, which is not possible from a folder.
const axe = readFileSync(join(root, 'web/node_modules/axe-core/axe.min.js'), 'utf8');
for (const width of [390, 1440])
  for (const [theme, locale] of [['light', 'en-GB'], ['dark', 'pt-BR']])
    await step(`no serious violation of accessibility: ${width} px, ${theme}, ${locale}`, async () => {
      const one = await open(`${folder}#thesis-basic`, { width, theme, locale });
      await one.waitForTimeout(1500);
      await one.locator('.transport button.main').click();
      await one.locator('[data-read="hash"]').waitFor();
      await one.evaluate(axe);
      const violations = await one.evaluate(async () => (await window.axe.run(document, { resultTypes: ['violations'], preload: false })).violations);
      assert.deepEqual(violations.filter((v) => ['serious', 'critical'].includes(v.impact)).map((v) => `${v.id}: ${v.nodes[0].html.slice(0, 200)}`), []);
      assert.ok(await one.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth), 'the page is wider than the window');
      if (pictures) await one.screenshot({ path: join(pictures, `demo-${width}-${theme}-${locale}.png`), fullPage: width < 1000 });
      await one.context().close();
    });

await browser.close();
console.log('all steps passed');
