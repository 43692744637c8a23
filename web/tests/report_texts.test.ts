import { describe, expect, test } from 'vitest';
import { reportTranslation } from '../src/i18n/program/report_texts';
import { reports } from '../src/i18n/program/reports';
import { translated } from '../src/results/translate';
import type { Clean } from '../src/results/sanitise';

describe('texts of reports', () => {
  const say = reportTranslation(
    { 'the end': 'o fim', 'The swarm was at {}.': 'O enxame estava em {}.', 'Grey: {}.': 'Cinza: {}.', '{#} of {#}': '{} de {}', 'start': 'início', 'Figure {#}.': 'Figura {}.', '{} has the smallest error, {}.': 'O menor erro, {2}, é de {1}.' },
    (text) => (text === 'a message' ? 'uma mensagem' : undefined),
  );
  test.each([
    ['start', 'início'],
    ['The swarm was at the end.', 'O enxame estava em o fim.'],
    ['The swarm was at the end. Grey: 3 um.', 'O enxame estava em o fim. Cinza: 3 µm.'],
    ['Figure 2. Grey: start.', 'Figura 2. Cinza: início.'],
    ['3 of 12', '3 de 12'],
    ['band\u00a0of 12', undefined],
    ['A has the smallest error, 3.', 'O menor erro, 3, é de A.'],
    ['a message', 'uma mensagem'],
    ['Grey: a message.', 'Cinza: uma mensagem.'],
    ['constructor', undefined],
  ])('%s', (english, translation) => {
    expect(say(english)).toBe(translation);
  });
  test('match spaces that do not break', () => {
    expect(reportTranslation({ 'over {#} s': 'em {} s' }, () => undefined)('over 3\u00a0s')).toBe('em 3 s');
  });
});

test.each(Object.entries(reports))('the translation of %s has its values', (english, translation) => {
  const values = (text: string) => (text.match(/\{[#\d]*\}/g) ?? []).length;
  expect(translation.trim()).not.toBe('');
  expect(values(translation)).toBe(values(english));
});

describe('a translated report', () => {
  const words: Record<string, string> = { a: 'uma palavra longa', 'speed of the cells': 'velocidade das células', code: 'código', b: 'b' };
  const translate = (text: string) => words[text] ?? text;
  const element = (tag: string, attributes: Record<string, string> = {}, ...children: (Clean | string)[]): Clean => ({ tag, svg: true, attributes: Object.entries(attributes), children });
  const entry = (index: number, x: number, label: string) => element('g', { 'data-legend': String(index) }, element('g', { transform: `translate(${x}.0 9.0)` }), element('text', { x: String(x + 15), y: '13.0' }, label));
  test('keeps code and the white space around a text', () => {
    expect(translated([element('p', { 'aria-label': 'a' }, ' a ', element('code', {}, 'code'))], translate)).toEqual([element('p', { 'aria-label': 'uma palavra longa' }, ' uma palavra longa ', element('code', {}, 'code'))]);
  });
  test('has a label in two lines again in two lines', () => {
    const label = (text: string) => element('text', { 'data-axis': 'y' }, text);
    expect(translated([element('g', {}, label('speed of'), label('the cells'))], translate)).toEqual([element('g', {}, label('velocidade'), label('das células'))]);
  });
  test('has entries of the legend side by side, and in a new row if they are too long', () => {
    const drawing = (width: number) => translated([element('svg', { viewBox: `0 0 ${width} 100` }, entry(0, 10, 'a'), entry(1, 60, 'b'))], translate)[0] as Clean;
    const place = (svg: Clean, i: number) => ((svg.children[i] as Clean).children[0] as Clean).attributes[0][1];
    expect(place(drawing(300), 1)).toBe('translate(163.2 9.0)');
    const narrow = drawing(150);
    expect(narrow.attributes).toEqual([['viewBox', '0 -18 150 118']]);
    expect([place(narrow, 0), place(narrow, 1)]).toEqual(['translate(10.0 -9.0)', 'translate(10.0 9.0)']);
  });
});
