import { expect, test } from 'vitest';
import { bySection, firstSentence, hasMore, isHeavy, kHeavy, summaryOf, titleOfScene, type SceneCard } from '../src/gallery';
import { words } from '../src/i18n';
import { loadTexts } from '../src/i18n/program/catalogue';

const en = words('en'), pt = words('pt');
const summary = (s: SceneCard, say: typeof en) => summaryOf(s, say).map((p) => p.text).join('');
const card = (name: string, more: Partial<SceneCard> = {}): SceneCard => ({ name, file: `scenes/${name}.toml`, title: name, ...more });

test('sections have a fixed order; scenes without a purpose are those of the user', () => {
  const sections = bySection([card('mine'), card('c', { purpose: 'coils' }), card('s', { purpose: 'start' }), card('odd', { purpose: 'unknown' })]);
  expect(sections.map((s) => [s.purpose, s.scenes.map((c) => c.name)])).toEqual([['start', ['s']], ['coils', ['c']], ['yours', ['mine', 'odd']]]);
});
test('texts are in the language of the page if they have a translation', async () => {
  await loadTexts('pt');
  const c = card('a', { summary: 'At 23 uT.', title: 'A million cells' });
  expect([titleOfScene(c, en), titleOfScene(c, pt)]).toEqual(['A million cells', 'Um milhão de células']);
  expect([summary(c, en), summary(c, pt)]).toEqual(['At 23 µT.', 'At 23 µT.']);
  expect(titleOfScene(card('b', { title: '' }), pt)).toBe('b');
});
test('a scene that is not in the index shows the first sentence of its comment', () => {
  expect(firstSentence('Fig. 4.17 of the thesis by L. F. M. Diniz, 2016: a swarm is driven. The cells are south-seeking.')).toBe('Fig. 4.17 of the thesis by L. F. M. Diniz, 2016: a swarm is driven.');
  expect(firstSentence('It is 1.5 s long, see Figs. A and B. More.')).toBe('It is 1.5 s long, see Figs. A and B.');
  expect(firstSentence('No stop')).toBe('No stop');
  expect(summary(card('a'), en)).toBe('');
  expect(['One. Two.', 'One.', ''].map((about) => hasMore(card('a', { about })))).toEqual([true, false, false]);
});
test('a scene with more cells than run in real time is heavy', () => {
  expect([kHeavy, kHeavy + 1].map((cells) => isHeavy(card('a', { cells })))).toEqual([false, true]);
});
