// Every page of the lab with content, for the tests that visit all of them: a recorded run, an experiment with a video, and a run
// in the lab.

import { address, faba, page } from './lab_page.mjs';

const kSettle = 1000; // ms for a page to load its content; pages that poll are never idle
export const kViews = [
  'lab', 'gallery', 'experiments', 'experiments/x', 'experiments/x?measure=identify', 'runs', 'runs/r1', 'analyse', 'analyse/track', 'analyse/identify',
  'analyse/compare-controllers', 'analyse/sweep', 'analyse/field-map', 'optics', 'optics?preset=100x&frame_rate=60+Hz', 'coils', 'coils/rigs/thesis-four-coils.toml', 'jobs', ...['', '/capture', '/response', '/run', '/jog', '/scale', '/assistant'].map((part) => `bench${part}`), 'own', 'video', 'video?file=runs%2Fr1', 'video?file=runs%2Fr1&experiment=x', 'tracks',
  'tracks?file=runs%2Fr1', 'result?page=runs%2Fr1%2Freport.html',
];

/** Makes the content of the pages; afterwards the lab runs the first scene of the gallery. */
export async function makeViews() {
  faba('run', 'scenes/as-seen.toml', '--as-seen', '--duration', '3 s', '--out', 'runs/r1', '--seed', '3');
  await page.goto(address);
  await page.locator('.cards button').first().waitFor();
  const send = (path, body) => page.evaluate(([p, b]) => fetch(p, { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify(b) }), [path, body]);
  await send('/api/experiments', { title: 'x' });
  await send('/api/experiments/x/videos', { file: 'runs/r1' });
  await send('/api/experiments/x', { changes: [{ path: ['drop', 'A'], to: {} }] });
  await page.locator('.cards button').first().click();
  await page.locator('[data-read="swarm"]').waitFor();
}

/** Opens the simulated bench, unless it is open: without requests of a page it closes after some time. */
const openBench = () =>
  page.evaluate(async () => {
    if ((await (await fetch('/api/bench')).json()).open) return;
    await fetch('/api/bench/open', { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify({ scene: 'bench' }) });
  });

export async function visit(view) {
  if (view.startsWith('bench')) await openBench();
  await page.evaluate((h) => (location.hash = h), `#/${view}`);
  await page.waitForTimeout(kSettle);
}
