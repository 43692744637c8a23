// Accessibility of every page of the lab: axe-core finds no serious or critical violation in both themes.
//
//   node tests/e2e/accessibility_test.mjs --program build/faba --root .

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { address, faba, finish, page, root, step } from './lab_page.mjs';

const axe = readFileSync(join(root, 'web/node_modules/axe-core/axe.min.js'), 'utf8');
const kSettle = 1000; // ms for a page to load its content; pages that poll are never idle
const kPlaces = [
  'lab', 'gallery', 'experiments', 'experiments/x', 'experiments/x?measure=identify', 'runs', 'runs/seen', 'analyse', 'analyse/track', 'analyse/identify',
  'analyse/compare-controllers', 'analyse/sweep', 'analyse/field-map', 'jobs', 'bench', 'own', 'video', 'video?file=runs%2Fseen', 'video?file=runs%2Fseen&experiment=x', 'tracks',
  'tracks?file=runs%2Fseen', 'result?page=runs%2Fseen%2Freport.html',
];

faba('run', 'scenes/as-seen.toml', '--as-seen', '--duration', '3 s', '--out', 'runs/seen', '--seed', '3');
await page.goto(address);
await page.getByRole('heading', { name: 'Scenes' }).waitFor();
const send = (path, body) => page.evaluate(([p, b]) => fetch(p, { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify(b) }), [path, body]);
await send('/api/experiments', { title: 'x' });
await send('/api/experiments/x/videos', { file: 'runs/seen' });
await send('/api/experiments/x', { changes: [{ path: ['drop', 'A'], to: {} }] });
await page.locator('.cards button').first().click();
await page.locator('[data-read="swarm"]').waitFor();

for (const theme of ['light', 'dark']) {
  await step(`no serious violation in the ${theme} theme`, async () => {
    assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), theme);
    const found = [];
    for (const place of kPlaces) {
      await page.evaluate((h) => (location.hash = h), `#/${place}`);
      await page.waitForTimeout(kSettle);
      await page.evaluate(axe);
      const violations = await page.evaluate(async () => (await window.axe.run(document, { resultTypes: ['violations'] })).violations);
      for (const v of violations.filter((one) => ['serious', 'critical'].includes(one.impact))) found.push(`${place}: ${v.id}: ${v.nodes[0].html.slice(0, 200)}`);
    }
    assert.deepEqual(found, []);
    await page.getByLabel('Light or dark theme').click();
  });
}

await finish();
