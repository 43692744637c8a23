// Results of jobs inside the lab: interactive figures, exports, the command, and the best model and controller in the lab.
//
//   node tests/e2e/results_test.mjs --program build/faba --root . [--pictures FOLDER]

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { address, complaints, context, faba, finish, kJobPatience, page, program, shot, step, until, workspace } from './lab_page.mjs';

const run = (...words) => execFileSync(program, words, { cwd: workspace, stdio: ['ignore', 'ignore', 'ignore'] });
run('run', 'scenes/short-response.toml', '--seed', '3', '--out', 'runs/short-response');
writeFileSync(join(workspace, 'studies/small.toml'), `title = "A small study"
boundary = "drop"
field_strength = "115 uT"
simulations = 100
look = "positions"
[scene]
exclusion = { order = "none" }
[[video]]
file = "../runs/short-response"
[[model]]
name = "dipole"
type = "dipole"
free = { "swarm[0].model.speed" = ["20 um/s", "300 um/s"] }
`);
writeFileSync(join(workspace, 'studies/two.toml'), `title = "Two controllers"
scene = "../scenes/thesis-basic.toml"
seeds = 2
[[controller]]
name = "fuzzy, as published"
type = "fuzzy"
max_output = 5
set = { duration = "4 s" }
[[controller]]
type = "proportional"
max_output = 5
set = { duration = "4 s" }
`);

/** Rows of CSV without line ends in cells. */
const table = (text) => text.trim().split('\n').map((line) => [...line.matchAll(/("(?:[^"]|"")*"|[^,]*)(?:,|$)/g)].map((m) => m[1].replace(/^"|"$/g, '').replaceAll('""', '"')));
const figure = (k) => page.locator('.report figure').filter({ has: page.locator('.plot') }).nth(k);
/** The file that a click downloads, as text. */
async function downloaded(button) {
  const [file] = await Promise.all([page.waitForEvent('download'), button.click()]);
  return { name: file.suggestedFilename(), text: readFileSync(await file.path(), 'latin1') };
}
/** Starts a job and opens its result. */
async function job(kind, values) {
  const id = await page.evaluate(async (b) => {
    const r = await fetch('/api/jobs', { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify(b) });
    return (await r.json()).id;
  }, { kind, values });
  const all = () => page.evaluate(() => fetch('/api/jobs').then((r) => r.json()));
  const find = async () => (await all()).find((j) => j.id === id);
  await page.evaluate((place) => (location.hash = place), `#/result?${new URLSearchParams({ page: (await find()).page, job: String(id) })}`);
  const end = Date.now() + kJobPatience;
  for (let j = await find(); j.state !== 'done'; j = await find()) {
    assert.ok(!['failed', 'cancelled'].includes(j.state), JSON.stringify(j));
    assert.ok(Date.now() < end, `timeout: ${j.title}`);
    await page.waitForTimeout(200);
  }
  await page.locator('.report .plot').first().waitFor();
  return page.evaluate((n) => fetch(`/api/jobs/${n}`).then((r) => r.json()), id);
}
/** The position on the screen of a value of a figure. */
const screen = (k, x, y) =>
  figure(k).locator('.plot').evaluate((plot, at) => {
    const svg = plot.querySelector('svg'), area = svg.querySelector('svg[data-x]');
    const ends = (name) => area.getAttribute(name).split(' ').map(Number), number = (name) => Number(area.getAttribute(name));
    const [x0, x1] = ends('data-x'), [y0, y1] = ends('data-y');
    const p = new DOMPoint(number('x') + (number('width') * (at.x - x0)) / (x1 - x0), number('y') + number('height') * (1 - (at.y - y0) / (y1 - y0)));
    const q = p.matrixTransform(svg.getScreenCTM());
    return [q.x, q.y];
  }, { x, y });
const readout = (k) => figure(k).locator('output').textContent();

/** Times between the frames of a pair, and activities along the direction, as the program writes them. */
let signature;
await step('the result of an activity job is a page of the lab, with its command', async () => {
  await page.goto(address);
  const done = await job('activity', { videos: ['runs/short-response'] });
  run('activity', 'runs/short-response', '--out', 'activity.csv');
  signature = table(readFileSync(join(workspace, 'activity.csv'), 'utf8')).slice(1).map((r) => ({ t: (Number(r[1]) + Number(r[2])) / 2, along: Number(r[4]) }));
  assert.ok(signature.length > 20 && signature.every((s) => Number.isFinite(s.t + s.along)));
  assert.ok((await page.locator('.report h2').textContent()).includes('Activity'));
  assert.ok(await page.locator('.report').getByText('Provenance').isVisible());
  const command = await page.locator('.command code').textContent();
  assert.equal(command, ['faba', ...done.words.filter((w) => w !== '--json')].join(' '));
  assert.ok((await page.getByRole('link', { name: 'Open the video in the viewer' }).getAttribute('href')).startsWith('#/video?file=runs%2Fshort-response'));
  await context.grantPermissions(['clipboard-read', 'clipboard-write']);
  await page.getByRole('button', { name: 'Copy' }).click();
  assert.equal(await page.evaluate(() => navigator.clipboard.readText()), command);
  await shot('result-activity');
});

await step('the exported CSV of a figure has the numbers of the program', async () => {
  const csv = await downloaded(figure(0).getByRole('button', { name: 'CSV' }));
  assert.match(csv.name, /^report-figure-1\.csv$/);
  const rows = table(Buffer.from(csv.text, 'latin1').toString('utf8')), [head, ...body] = rows;
  assert.deepEqual(head.slice(0, 2), ['series', 'time (s)']);
  const own = body.filter((r) => r[0] === 'net flow along the direction');
  assert.equal(own.length, signature.length);
  const most = Math.max(...signature.map((r) => Math.abs(r.along)));
  own.forEach((r, i) => {
    assert.ok(Math.abs(Number(r[1]) - signature[i].t) < 2e-6, `time ${i}: ${r}, the program: ${signature[i].t}`);
    assert.ok(Math.abs(Number(r[2]) - signature[i].along) <= 2e-6 * most, `value ${i}: ${r}, the program: ${signature[i].along}`);
  });
});

await step('hovering reads the value of the nearest point, also after zooming', async () => {
  const { t, along: v } = signature.reduce((best, r) => (Math.abs(r.along) > Math.abs(best.along) ? r : best));
  await figure(0).getByRole('button', { name: /^within/ }).click(); // hides the other curve
  const gaussian = figure(0).getByRole('button', { name: 'Gaussian' });
  if (await gaussian.count()) await gaussian.click();
  const isRead = async () => {
    const text = (await readout(0)).replaceAll('−', '-'), found = /time (\S+) s, .* (-?[\d.e]+) px/.exec(text);
    assert.ok(found, `readout: ${text}`);
    assert.ok(Math.abs(Number(found[1]) - t) < 1e-4 && Math.abs(Number(found[2]) - v) <= 1e-5 * Math.abs(v), `${text}; the program has ${t}, ${v}`);
  };
  await figure(0).locator('.plot').scrollIntoViewIfNeeded();
  await page.mouse.move(...(await screen(0, t, v)));
  await isRead();
  await figure(0).locator('.plot').focus();
  for (let i = 0; i < 4; ++i) await page.keyboard.press('+'); // about the read point
  await isRead();
  await shot('result-zoomed');
  const before = await figure(0).locator('g[data-ticks] text').allTextContents();
  await page.keyboard.press('0');
  assert.notDeepEqual(await figure(0).locator('g[data-ticks] text').allTextContents(), before);
  await page.keyboard.press('Home');
  const first = Number(/time (\S+) s/.exec(await readout(0))[1]);
  assert.ok(Math.abs(first - signature[0].t) < 2e-6, `${first} and ${signature[0].t}`);
});

await step('a drag enlarges a part, the wheel with Ctrl zooms, and a double click resets', async () => {
  const plot = figure(0).locator('.plot'), box = await plot.boundingBox(), reset = figure(0).getByRole('button', { name: 'Reset the zoom' });
  assert.ok(await reset.isDisabled());
  await page.mouse.move(box.x + box.width * 0.4, box.y + box.height * 0.3);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.6, box.y + box.height * 0.6, { steps: 4 });
  await page.mouse.up();
  assert.ok(await reset.isEnabled());
  await plot.dblclick();
  assert.ok(await reset.isDisabled());
  await page.keyboard.down('Control');
  await page.mouse.wheel(0, -200);
  await page.keyboard.up('Control');
  await until(() => reset.isEnabled(), 'the wheel zooms');
  await reset.click();
  assert.ok(await reset.isDisabled());
});

await step('a series is hidden by the keyboard, and is not exported', async () => {
  const button = figure(0).getByRole('button', { name: 'net flow' }), curve = figure(0).locator('g[data-layer] path.s-vermillion');
  assert.ok(await curve.isVisible());
  await button.focus();
  await page.keyboard.press('Enter');
  assert.equal(await button.getAttribute('aria-pressed'), 'false');
  assert.ok(!(await curve.isVisible()));
  const csv = await downloaded(figure(0).getByRole('button', { name: 'CSV' }));
  assert.ok(!csv.text.includes('net flow'));
  await page.keyboard.press('Tab');
  await button.click();
  assert.ok(await curve.isVisible());
});

await step('figures are exported as SVG and PNG', async () => {
  const svg = await downloaded(figure(0).getByRole('button', { name: 'SVG' }));
  assert.ok(svg.text.startsWith('<svg') && svg.text.includes('net flow') && !svg.text.includes('data-pointer'));
  const png = await downloaded(figure(0).getByRole('button', { name: 'PNG' }));
  assert.ok(png.text.startsWith('\x89PNG') && png.text.length > 5000);
});

await step('a report with foreign content is shown without it', async () => {
  writeFileSync(join(workspace, 'runs/foreign.html'), `<!DOCTYPE html><html xmlns:x="http://www.w3.org/1999/xhtml"><body onload="window.ran=1"><main><h1>Foreign</h1>
<script>window.ran=2</script><x:script>window.ran=9</x:script><p onclick="window.ran=3" style="position:fixed">kept</p><img src="/x" onerror="window.ran=4"/><img src="https://example.org/a.png"/>
<a href="javascript:window.ran=5">link</a><iframe srcdoc="&lt;script>parent.ran=6&lt;/script>"></iframe><form action="/api/jobs"><button>send</button></form>
<svg class="faba-plot" viewBox="0 0 9 9" onload="window.ran=7"><foreignObject><body onload="window.ran=8"></body></foreignObject><image href="https://example.org/b.png"/>
<style>@import url(https://example.org/c.css)</style><rect fill="url(https://example.org/d.svg#x)" width="9" height="9"/></svg></main></body></html>`);
  writeFileSync(join(workspace, 'runs/malformed.html'), '<p>a<b></p><script>window.ran=1</script>');
  await page.evaluate(() => (location.hash = '#/result?page=runs/foreign.html'));
  await page.locator('.report').getByText('kept').waitFor();
  await page.waitForTimeout(300);
  assert.equal(await page.evaluate(() => window.ran), undefined);
  const kept = await page.locator('.report').evaluate((r) => [...r.querySelectorAll('*')].map((e) => `${e.localName}[${[...e.attributes].map((a) => a.name).filter((n) => !n.startsWith('class'))}]`).join(' '));
  for (const bad of ['script', 'iframe', 'form', 'foreignObject', 'image', 'style', 'onerror', 'onload', 'onclick', 'href', 'fill']) assert.ok(!kept.includes(bad), `${bad} in ${kept}`);
  assert.deepEqual(complaints, []);
  await page.evaluate(() => (location.hash = '#/result?page=runs/malformed.html'));
  await page.getByText('not well-formed XML').waitFor();
  assert.equal(await page.evaluate(() => window.ran), undefined);
  await page.evaluate(() => (location.hash = '#/result?page=../secret.html'));
  await page.getByText('is outside the folder').waitFor();
  complaints.length = 0; // the refused request, and styles of the browser's description of malformed XML
});

await step('the report of a comparison has figures', async () => {
  run('run', 'scenes/short-response.toml', '--seed', '4', '--out', 'runs/other');
  await job('compare', { reference: 'runs/short-response', videos: ['runs/other'] });
  assert.ok((await page.locator('.report .plot').count()) > 0);
  await shot('result-compare');
});

/** Opens the best scene of the result and waits until the lab runs it. */
async function openBest(button) {
  await page.getByRole('button', { name: button }).click();
  await page.waitForFunction(() => location.hash === '#/lab');
  const ticks = () => page.evaluate(() => document.querySelector('canvas.over')?.lab?.ticks ?? 0);
  await until(async () => (await ticks()) > 0, 'the run has frames');
  const before = await ticks();
  await until(async () => (await ticks()) > before + 3, 'the run advances');
}
await step('the best controller opens in the lab', async () => {
  const done = await job('compare-controllers', { study: 'studies/two.toml' });
  await shot('result-controllers');
  const best = done.result.controllers ?? done.result, combination = best.combinations.find((c) => c.excess_over_best_px === null);
  await page.getByText('Files', { exact: true }).click();
  assert.ok(await page.getByRole('link', { name: 'controllers.csv' }).isVisible());
  await openBest('Open the best controller in the lab');
  const type = combination.controller === 'proportional' ? 'proportional' : 'fuzzy';
  assert.equal(await page.evaluate(() => document.querySelector('canvas.over').lab.scenario.controller.type), type);
  assert.equal(await page.locator('[data-read="title"]').textContent(), `Two controllers: ${combination.controller}`);
});

await step('the best model opens in the lab, and is compared with the video', async () => {
  await job('identify', { study: 'studies/small.toml' });
  await shot('result-identify');
  const result = await page.evaluate(() => location.hash);
  await openBest('Open the best model in the lab');
  assert.match(await page.locator('[data-read="title"]').textContent(), /dipole, identified from/);
  await page.evaluate((h) => (location.hash = h), result);
  await page.getByRole('button', { name: 'Compare the best model with the video' }).click();
  await page.waitForFunction(() => /compared/.test(location.hash), null, { timeout: kJobPatience }); // the result before it has plots, too
  await page.locator('.report .plot').first().waitFor({ timeout: kJobPatience });
});

await finish();
