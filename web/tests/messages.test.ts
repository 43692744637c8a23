// Each message of the program has a Portuguese translation. The messages come from the C++ sources.

import { execFileSync } from 'node:child_process';
import { existsSync } from 'node:fs';
import { describe, expect, test } from 'vitest';
import { templatesOf, translationBy } from '../src/i18n/program/catalogue';
import { texts } from '../src/i18n/program/pt';
import { refusals } from '../src/i18n/program/refusals';
import { system } from '../src/i18n/program/refusals/system';

const kPython = '/usr/bin/python3';
const kTool = new URL('../../tools/message_templates.py', import.meta.url).pathname;
const catalogue = { texts, titles: {}, templates: templatesOf(texts) };

describe.skipIf(!existsSync(kPython))('the messages of the program', () => {
  const templates: Record<string, string> = JSON.parse(execFileSync(kPython, [kTool], { encoding: 'utf8', maxBuffer: 1 << 24 }));

  test('are found in the sources', () => {
    expect(Object.keys(templates).length).toBeGreaterThan(1000);
    expect(Object.keys(templates)).toContain('{} is out of range; it must be {}');
  });
  test('all have a translation in web/src/i18n/program', () => {
    const missing = Object.entries(templates).filter(([english]) => !Object.hasOwn(texts, english));
    expect(missing).toEqual([]);
  });
  test('are translated with values in their places', () => {
    const untranslated = Object.keys(templates).filter((english) => translationBy(catalogue, english.replaceAll('{}', '17'), true) === undefined);
    expect(untranslated).toEqual([]);
  });
  test('have no English words left', () => {
    const words = /\b(the|is|are|was|were|must|not|with|and|of|this|that|has|have|give|it|its|cannot|an)\b/;
    // Quoted texts, options, keys and commands are not translated.
    const plain = (text: string) => text.replace(/"[^"]*"|`[^`]*`|--?\S+|\b\w+[._]\w+/g, '');
    expect(Object.entries(refusals).filter(([, translation]) => words.test(plain(translation)))).toEqual([]);
  });
  test('translations of other texts were removed', () => {
    const stale = Object.keys(refusals).filter((english) => !Object.hasOwn(system, english) && !Object.hasOwn(templates, english));
    expect(stale).toEqual([]);
  });
});

describe('messages as the program prints them', () => {
  test.each([
    ['unknown key; did you mean "duration"?', 'chave desconhecida; você quis dizer "duration"?'],
    ['"3 kg" is a quantity in kg; expected a current such as "1 A"', '"3 kg" é uma grandeza de outro tipo (grandeza em kg); espera-se corrente como "1 A"'],
    ['expected a speed such as "1 m/s", got true', 'espera-se uma grandeza (velocidade) como "1 m/s", mas o valor é true'],
    ['-3 A is out of range; it must be between 0 A and 1000 A', '-3 A está fora do intervalo permitido; deve estar entre 0 A e 1000 A'],
    ['expected a comment or whitespace, saw \'H\'; text and quantities with a unit need quotes, such as "60 Hz"', 'espera-se um comentário ou espaço em branco, encontrou-se \'H\'; textos e grandezas com unidade precisam de aspas, como "60 Hz"'],
    ['"a" is not a number; it must be a number between 0.001 mm and 1000 mm', '"a" não é um número; deve ser um número entre 0.001 mm e 1000 mm'],
    ['nope.mp4: file not found in the folder in which the lab was started', 'nope.mp4: arquivo não encontrado na pasta em que o laboratório foi iniciado'],
    ['r3.csv: has one reading, all of the width 10 um; at least three readings of at least two widths are needed', 'r3.csv: tem uma leitura, todas da largura 10 um; são necessárias pelo menos três leituras de pelo menos duas larguras'],
    ['runs/a: cannot be written: No space left on device; free some space or choose another disk', 'runs/a: não pode ser gravado: não há espaço livre no disco; libere espaço ou escolha outro disco'],
    ['a.toml:3: camera.delay_frames is 9, but the run has 3 frames: the controller gets only the first picture; reduce the delay or increase the duration', 'a.toml:3: camera.delay_frames é 9, mas a execução tem 3 quadros: o controlador só recebe a primeira imagem; reduza o atraso ou aumente a duração'],
  ])('%s', (english, translation) => {
    expect(translationBy(catalogue, english)).toBe(translation);
  });
});
