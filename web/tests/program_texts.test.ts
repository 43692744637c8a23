import { beforeAll, describe, expect, test } from 'vitest';
import { loadTexts, templatesOf, textIn, titleIn, translationBy } from '../src/i18n/program/catalogue';
import { texts, titles } from '../src/i18n/program/pt';

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
    expect(say('axis (1.5)')).toBe('axis [1.5]');
    expect(say('axis (1+5)')).toBeUndefined();
    expect(say('$& is not $1')).toBe('$1 não é $&');
  });
});

describe('messages of several parts', () => {
  const texts = {
    'file not found': 'arquivo não encontrado',
    'unknown key{}': 'chave desconhecida{}',
    'did you mean "{}"?': 'você quis dizer "{}"?',
    speed: 'velocidade',
    'check the name': 'verifique o nome',
    'The run is long.': 'A execução é longa.',
    'It has {} frames.': 'Tem {} quadros.',
    'few marks': 'poucas marcas',
    '{} marks': '{} marcas',
    'two files': 'dois arquivos',
  };
  const catalogue = { texts, titles: {}, templates: templatesOf(texts) };
  const say = (text: string) => translationBy(catalogue, text);
  test('have the translations of their parts', () => {
    expect(say('file not found; check the name')).toBe('arquivo não encontrado; verifique o nome');
    expect(say('The run is long. It has 3 frames.')).toBe('A execução é longa. Tem 3 quadros.');
    expect(say('few marks (3 marks); check the name')).toBe('poucas marcas (3 marcas); verifique o nome');
    expect(say('unknown key; did you mean "x"?; check the name')).toBe('chave desconhecida; você quis dizer "x"?; verifique o nome');
  });
  test('have none if a part has none', () => {
    expect(say('file not found; try again')).toBeUndefined();
    expect(say('1; 2')).toBeUndefined();
    expect(say('')).toBeUndefined();
    expect(say('; ')).toBeUndefined();
  });
  test('have their place before them, which is translated unless it is a key', () => {
    expect(say('a.toml:3: speed: few marks')).toBe('a.toml:3: speed: poucas marcas');
    expect(say('two files: few marks')).toBe('dois arquivos: poucas marcas');
  });
  test('have parts that are not texts of their own', () => {
    const parts = { ...catalogue, templates: templatesOf({ ...texts, 'in {}': 'em {}' }) };
    expect(translationBy(parts, 'unknown key in vitro')).toBe('chave desconhecida em vitro');
    expect(translationBy(parts, 'in vitro')).toBeUndefined();
  });
  test('have empty values, and quoted values as they are', () => {
    expect(say('unknown key')).toBe('chave desconhecida');
    expect(say('did you mean "speed"?')).toBe('você quis dizer "speed"?');
  });
});

describe('the Portuguese catalogue', () => {
  const values = (text: string) => (text.match(/\{\d*\}/g) ?? []).length;
  test.each(Object.entries({ ...texts, ...titles }))('%s', (english, translation) => {
    expect(translation.trim()).not.toBe('');
    expect(values(translation)).toBe(values(english));
  });
});
