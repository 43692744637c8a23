import { beforeAll, describe, expect, test } from 'vitest';
import { loadTexts, templatesOf, textIn, titleIn, translationBy } from '../src/i18n/program/catalogue';
import { reports, texts, titles } from '../src/i18n/program/pt';

beforeAll(() => loadTexts('pt'));

describe('texts of the program', () => {
  test('are translated; others and English ones have no translation', () => {
    expect(textIn('pt', 'simulating')).toBe('simulando');
    expect(textIn('en', 'simulating')).toBeUndefined();
    expect(textIn('pt', 'constructor')).toBeUndefined();
    expect(titleIn('pt', 'Speed')).toBe('Velocidade');
  });
  test('with values have the values in their places, translated, too', () => {
    const catalogue = { texts: { 'the file': 'o arquivo' }, titles: {}, templates: templatesOf({ '{} is not {}': '{2} não é {1}', '{} is not a {}': '{} não é um {}', '{} (1.5)': '{} [1.5]' }) };
    const say = (text: string) => translationBy(catalogue, text);
    expect(say('the file is not 3 um')).toBe('3 µm não é o arquivo');
    expect(say('x is not a number')).toBe('x não é um number');
    expect(say('x (1.5)')).toBe('x [1.5]');
    expect(say('x (1+5)')).toBeUndefined();
    expect(say('$& is not $1')).toBe('$1 não é $&');
  });
});

describe('the Portuguese catalogue', () => {
  const values = (text: string) => (text.match(/\{[#\d]*\}/g) ?? []).length;
  test.each(Object.entries({ ...texts, ...titles, ...reports }))('%s', (english, translation) => {
    expect(translation.trim()).not.toBe('');
    expect(values(translation)).toBe(values(english));
  });
});
