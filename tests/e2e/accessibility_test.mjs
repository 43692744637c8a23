// Accessibility of every page of the lab: axe-core finds no serious or critical violation in both themes.
//
//   node tests/e2e/accessibility_test.mjs --program build/faba --root .

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { finish, page, root, step } from './lab_page.mjs';
import { kViews, makeViews, visit } from './lab_views.mjs';

const axe = readFileSync(join(root, 'web/node_modules/axe-core/axe.min.js'), 'utf8');

await makeViews();

for (const theme of ['light', 'dark']) {
  await step(`no serious violation in the ${theme} theme`, async () => {
    assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), theme);
    const found = [];
    for (const place of kViews) {
      await visit(place);
      await page.evaluate(axe);
      const violations = await page.evaluate(async () => (await window.axe.run(document, { resultTypes: ['violations'] })).violations);
      for (const v of violations.filter((one) => ['serious', 'critical'].includes(one.impact))) found.push(`${place}: ${v.id}: ${v.nodes[0].html.slice(0, 200)}`);
    }
    assert.deepEqual(found, []);
    await page.getByLabel('Light or dark theme').click();
  });
}

await finish();
