// The lab in Portuguese: schemas, scenes, reports and pages have no English text, except names, keys and commands.
//
//   node tests/e2e/portuguese_test.mjs --program build/faba --root . [--pictures FOLDER]

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { address, context, finish, page, program, root, shot, step, workspace } from './lab_page.mjs';
import { kViews, makeViews, visit } from './lab_views.mjs';

// The modules of the page, through vite: their sources are TypeScript.
const web = join(root, 'web'), vitePackage = createRequire(join(web, 'package.json')).resolve('vite/package.json');
const { createServer } = await import(pathToFileURL(join(dirname(vitePackage), 'dist/node/index.js')).href);
const vite = await createServer({ root: web, configFile: false, server: { middlewareMode: true, hmr: false, ws: false }, appType: 'custom', logLevel: 'error', optimizeDeps: { noDiscovery: true } });
const [{ loadTexts, textIn, titleIn }, { loadReports, reportIn }, { texts, titles }, { reports }, { kWords }, { englishTitle }, { sanitised }, { translated }] = await Promise.all(
  ['i18n/program/catalogue', 'i18n/program/report_texts', 'i18n/program/pt', 'i18n/program/reports', 'i18n/index', 'form/titles', 'results/sanitise', 'results/translate'].map((m) => vite.ssrLoadModule(`/src/${m}.ts`)),
);
await loadTexts('pt');
await loadReports('pt');
await vite.close();

const kNotWords = /`[^`]*`|\S*[_/=@\\[\]{}]\S*|\S+\.\w\S*|--\S+|\S*\d\S*/g; // code, keys, files, options, numbers with units
const wordsOf = (text) => text.replaceAll(kNotWords, ' ').toLowerCase().match(/\p{L}{3,}/gu) ?? [];
const portuguese = new Set([...Object.values({ ...texts, ...titles, ...reports }), ...Object.values(kWords.pt)].flatMap(wordsOf));
const run = (...words) => execFileSync(program, [...words, '--quiet'], { cwd: workspace, encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] });
const scenario = JSON.parse(run('schema', 'scenario'));
const below = (schema) => [...(schema.oneOf ?? []), ...Object.values(schema.properties ?? {}), ...(schema.items ? [schema.items] : [])];
const everySchema = (schema) => [schema, ...below(schema).flatMap(everySchema)];
/** Names of parts. */
const parts = new Set(everySchema(scenario).flatMap((s) => s.const ?? []));
/** Words of English texts that no Portuguese text has. */
const english = new Set([...Object.keys({ ...texts, ...titles, ...reports }), ...Object.values(kWords.en)].flatMap(wordsOf).filter((w) => !portuguese.has(w) && !parts.has(w)));
const isEnglish = (text) => wordsOf(text).some((w) => english.has(w));

/** The texts of a JSON Schema, and the titles of its values. */
function schemaTexts(schema, name = '', found = { texts: [], titles: [] }) {
  if (name && !['type', 'preset'].includes(name)) found.titles.push(englishTitle(name, schema));
  const source = schema['x-source'];
  found.texts.push(...[schema.description, schema['x-validity'], ...(typeof source === 'object' ? Object.values(source) : [source])].filter(Boolean));
  for (const [key, one] of Object.entries(schema.properties ?? {})) schemaTexts(one, key, found);
  for (const one of schema.oneOf ?? []) schemaTexts(one, '', found);
  if (schema.items) schemaTexts(schema.items, '', found);
  return found;
}

await step('the words of English texts are recognised', () => {
  assert.ok(english.size > 1000 && portuguese.size > 1000, `${english.size} English and ${portuguese.size} Portuguese words`);
  assert.ok(isEnglish('Distance to the setpoint') && !isEnglish('Distância ao ponto de referência de swarm[0].model.speed, 5 um'));
});

await step('every text of the schemas has a translation', () => {
  for (const kind of ['scenario', 'rig', 'identify', 'calibrate', 'compare-controllers', 'benchmark-control', 'activity', 'moment', 'experiment', 'engine']) {
    const all = schemaTexts(kind === 'scenario' ? scenario : JSON.parse(run('schema', kind)));
    assert.ok(all.texts.length > 5, kind);
    assert.deepEqual([...new Set(all.texts)].filter((t) => textIn('pt', t) === undefined), [], `faba schema ${kind}`);
    if (kind === 'scenario') assert.deepEqual([...new Set(all.titles)].filter((t) => titleIn('pt', t) === undefined), [], 'titles of a scenario');
  }
});

await step('every text of a scene has a translation', async () => {
  await page.goto(address);
  const scenes = await page.evaluate(() => fetch('/api/scenes').then((r) => r.json()));
  assert.ok(scenes.length > 10);
  const all = scenes.flatMap((s) => [s.title, s.summary, s.about]);
  assert.deepEqual(all.filter((t) => !t || textIn('pt', t) === undefined), []);
});

/** Visible texts of the page, names of inputs, and tooltips; without code, what users write, and options that are keys. */
const shownTexts = () => page.evaluate(() => {
  const out = new Set();
  const skipped = (e) => e.closest('code, pre, textarea, [lang="en"], .keys') || (e.localName === 'option' && e.value === e.textContent);
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) if (!skipped(walker.currentNode.parentElement)) out.add(walker.currentNode.nodeValue.trim());
  for (const e of document.querySelectorAll('[aria-label], [placeholder], [title], [alt]'))
    if (!skipped(e)) for (const name of ['aria-label', 'placeholder', 'title', 'alt']) out.add((e.getAttribute(name) ?? '').trim());
  return [...out].filter(Boolean);
});

await step('pages have no English text', async () => {
  await context.addInitScript(() => localStorage.setItem('faba.language', '"pt"'));
  await page.reload();
  await makeViews();
  const found = new Map();
  for (const view of kViews) {
    await visit(view);
    if (view === 'lab') await page.getByRole('button', { name: 'Todos os ajustes' }).click().catch(() => {});
    for (const text of await shownTexts()) if (isEnglish(text) && !found.has(text)) found.set(text, view);
    await shot(`pt-${view.replaceAll(/\W+/g, '-')}`);
  }
  assert.deepEqual([...found], []);
});

/** A parsed report as the page reads it. */
const parsed = (file) => page.evaluate((xml) => {
  const copy = (n) => ({ nodeType: n.nodeType, localName: n.localName, nodeValue: n.nodeValue, attributes: [...(n.attributes ?? [])].map(({ name, value }) => ({ name, value })), childNodes: [...n.childNodes].map(copy) });
  return copy(new DOMParser().parseFromString(xml, 'application/xml'));
}, readFileSync(join(workspace, file), 'utf8'));

/** The texts of a translated report that have English words. */
async function remaining(file) {
  const found = new Set();
  const content = translated(sanitised(await parsed(file), 'runs/x'), (text) => {
    const shown = reportIn('pt', text) ?? text;
    if (isEnglish(shown.replaceAll('responding', ''))) found.add(shown); // a parameter of the study
    return shown;
  });
  assert.ok(JSON.stringify(content).includes('Proveniência'), file);
  return [...found];
}

const kFilm = `title = "F"
duration = "3.2 s"
[arena]
type = "box"
size_px = [160, 120]
[scale]
um_per_px = 1.2
[microscope]
cell_diameter = "2.5 um"
[[swarm]]
count = 60
model = { type = "basic", max_speed = 4 }
start = { type = "edge", direction = "180 deg" }
[controller]
type = "manual"
field = ["69 uT", "0 T"]
[[controller.segment]]
at = "0.6 s"
field = ["-69 uT", "0 T"]
[record]
as_seen = true
lossless = true
`;
const kStudy = `title = "E"
boundary = "box"
look = "positions"
simulations = 150
field_strength = "69 uT"
[[video]]
file = "film"
[[model]]
type = "basic"
free = { "swarm[0].model.max_speed" = [1, 12] }
[[model]]
type = "adapted"
free = { "swarm[0].model.max_speed" = [1, 12] }
`;

await step('reports have no English text', async () => {
  const put = (file, text) => writeFileSync(join(workspace, file), text);
  put('scene.toml', kFilm);
  put('study.toml', kStudy);
  put('calibration.toml', 'title = "C"\nstudy = "study.toml"\nexperiments = 1\nseed = 5\n[[misspecified]]\nname = "X"\nfield_factor = 2\naspects = ["field_strength"]\n');
  put('controllers.toml', `title = "K"\nscene = "scenes/thesis-basic.toml"\nseeds = 2\ndelays = [0, 4]\n[[controller]]\nname = "K1"\ntype = "fuzzy"\nset = { duration = "4 s" }\n
[[controller]]\nname = "K2"\ntype = "proportional"\nset = { duration = "4 s" }\n`);
  put('exposures.toml', '[[video]]\nfile = "film"\nexposure = "10 s"\n[[video]]\nfile = "film2"\nexposure = "100 s"\n');
  run('run', 'scene.toml', '--seed', '3', '--out', 'film');
  run('run', 'scene.toml', '--seed', '4', '--out', 'film2');
  for (const scene of ['steer', 'null-route', 'corner', 'bench']) run('run', `scenes/${scene}.toml`, '--seed', '1', '--duration', '2 s', '--out', `runs/${scene}`);
  run('activity', 'film', '--report', 'activity.html');
  run('activity', 'exposures.toml', '--report', 'exposures.html');
  run('compare', 'film', 'film2', '--report', 'compare.html');
  run('track', 'film', '--report', 'track.html');
  run('compare-controllers', 'controllers.toml', '--out', 'controllers');
  run('identify', 'study.toml', '--out', 'identify');
  run('calibrate', 'calibration.toml', '--out', 'calibrate');
  const files = [...['film', 'runs/steer', 'runs/null-route', 'runs/corner', 'runs/bench', 'controllers'].map((folder) => `${folder}/report.html`), 'activity.html', 'exposures.html', 'compare.html', 'track.html', 'identify/identify.html', 'calibrate/calibration.html'];
  const found = [];
  for (const file of files) for (const text of await remaining(file)) found.push(`${file}: ${text}`);
  assert.deepEqual(found, []);
});

await finish();
