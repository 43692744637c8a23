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
    const untranslated = Object.keys(templates).filter((english) => translationBy(catalogue, english.replaceAll('{}', '17')) === undefined);
    expect(untranslated).toEqual([]);
  });
  test('translations of other texts were removed', () => {
    const stale = Object.keys(refusals).filter((english) => !Object.hasOwn(system, english) && !Object.hasOwn(templates, english));
    expect(stale).toEqual([]);
  });
});
