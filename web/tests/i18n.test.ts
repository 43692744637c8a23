import { describe, expect, test } from 'vitest';
import { kWords, words, type Language, type Word } from '../src/i18n';

const kLanguages = Object.keys(kWords) as Language[];
const kKeys = Object.keys(kWords.en) as Word[];
const placeholders = (text: string) => [...text.matchAll(/\{(\w+)\}/g)].map((m) => m[1]).sort();
const sources = Object.entries(import.meta.glob<string>('../src/**/*.{ts,svelte}', { query: '?raw', import: 'default', eager: true })).filter(
  ([path]) => !path.includes('/i18n/'),
);
const text = sources.map(([, source]) => source).join('\n');
/** Prefixes of composed keys, as in say(`tab.${t}`). */
const prefixes = [...new Set([...text.matchAll(/`([a-z_]+(?:\.[a-z_]+)*\.)\$\{/g)].map((m) => m[1]))];

describe('both languages', () => {
  test('have the same keys', () => {
    for (const l of kLanguages) {
      expect(Object.keys(kWords[l]).sort(), l).toEqual([...kKeys].sort());
    }
  });
  test('have a trimmed text for each key', () => {
    for (const l of kLanguages) {
      for (const key of kKeys) {
        expect(kWords[l][key], `${l} ${key}`).not.toBe('');
        expect(kWords[l][key], `${l} ${key}`).toBe(kWords[l][key].trim());
      }
    }
  });
  test('have the same placeholders', () => {
    for (const l of kLanguages) {
      for (const key of kKeys) {
        expect(placeholders(kWords[l][key]), `${l} ${key}`).toEqual(placeholders(kWords.en[key]));
      }
    }
  });
  test('all sentences are translated', () => {
    const sentences = kKeys.filter((key) => kWords.en[key].split(' ').length > 2);
    expect(sentences.length).toBeGreaterThan(30);
    expect(sentences.filter((key) => kWords.pt[key] === kWords.en[key])).toEqual([]);
  });
});

describe('the sources', () => {
  test('are read', () => {
    expect(sources.length).toBeGreaterThan(20);
    expect(prefixes).toContain('tab.');
  });
  test('use only keys that exist', () => {
    const used = [...text.matchAll(/\bsay\(\s*'([^']+)'/g)].map((m) => m[1]);
    expect(used.length).toBeGreaterThan(100);
    expect(used.filter((key) => !(kKeys as string[]).includes(key))).toEqual([]);
  });
  test('use every key', () => {
    const unused = kKeys.filter((key) => !text.includes(`'${key}'`) && !prefixes.some((b) => key.startsWith(b)));
    expect(unused).toEqual([]);
  });
  test('composed keys exist', () => {
    const states = ['waiting', 'running', 'done', 'failed', 'cancelled'].map((s) => `job.${s}`);
    const layers = /kLayers = \[([^\]]+)\]/.exec(text)![1].match(/\w+/g)!.map((l) => `layer.${l}`);
    const tabs = /kTabs = \[([^\]]+)\]/.exec(text)![1].match(/\w+/g)!.map((t) => `tab.${t}`);
    const panels = /kPanels = \[([^\]]+)\]/.exec(text)![1].match(/\w+/g)!;
    const plots = [...text.matchAll(/\{ key: '(\w+)', unit/g)].map((m) => `plot.${m[1]}`);
    expect(plots.length).toBeGreaterThan(3);
    expect([...states, ...layers, ...tabs, ...panels, ...plots].filter((key) => !(kKeys as string[]).includes(key))).toEqual([]);
  });
});

describe('filling in', () => {
  test('placeholders accept numbers and strings; unknown ones are unchanged', () => {
    const say = words('en');
    expect(say('form.range', { low: 1, high: '2 m' })).toBe('from 1 to 2 m');
    expect(say('form.range', { low: 1 })).toBe('from 1 to {high}');
    expect(say('form.range')).toBe('from {low} to {high}');
  });
  test('values are not read as placeholders or patterns', () => {
    expect(words('en')('form.range', { low: '{high}', high: '$&' })).toBe('from {high} to $&');
  });
  test('in the requested language', () => {
    expect(words('pt')('run.pause')).toBe(kWords.pt['run.pause']);
    expect(words('pt')('run.pause')).not.toBe(words('en')('run.pause'));
  });
});
