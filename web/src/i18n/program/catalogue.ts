// Translations of the texts of the program: fixed texts, and texts with values, which have {} in the catalogue.

import { micro } from '../../units';
import type { Language } from '..';

type Texts = Record<string, string>;
interface Template {
  english: RegExp;
  /** Whether each value is in quotes: a key, a name or what the user wrote, which has no translation. */
  quoted: boolean[];
  translation: string;
}
export interface Catalogue {
  texts: Texts;
  titles: Texts;
  templates: Template[];
}

const kEmpty: Catalogue = { texts: {}, titles: {}, templates: [] };
const catalogues: Record<Language, Catalogue> = { en: kEmpty, pt: kEmpty };

const literal = (text: string) => text.replace(/[.*+?^${}()|[\]\\]/g, '\\$&');

/** Pattern of a text. A value between spaces has at least one character; other values, such as advice after a text, may be empty. */
function pattern(parts: string[]): RegExp {
  const value = (before: string, after: string) => (/(^|\s)$/.test(before) && /^(\s|$)/.test(after) ? '(.+?)' : '(.*?)');
  const written = parts.map((part, i) => (i ? value(parts[i - 1], part) : '') + literal(part));
  return new RegExp(`^${written.join('')}$`, 's');
}

/** Texts with values, those with the most fixed characters first. */
export function templatesOf(texts: Texts): Template[] {
  const fixed = (english: string) => english.replaceAll('{}', '').length;
  return Object.entries(texts)
    .filter(([english]) => english.includes('{}'))
    .sort(([a], [b]) => fixed(b) - fixed(a))
    .map(([english, translation]) => {
      const parts = english.split('{}');
      const quoted = parts.slice(1).map((after, i) => /["'`]$/.test(parts[i]) && /^["'`]/.test(after));
      return { english: pattern(parts), quoted, translation };
    });
}

/** Loads the texts of a language, which the page does before it shows them. */
export async function loadTexts(language: Language) {
  if (language === 'en' || catalogues[language] !== kEmpty) return;
  const { texts, titles } = await import('./pt');
  catalogues[language] = { texts, titles, templates: templatesOf(texts) };
}

const own = (all: Texts, text: string) => (Object.hasOwn(all, text) ? all[text] : undefined);

/** The translation of the title of a value; undefined without one. */
export const titleIn = (language: Language, title: string) => own(catalogues[language].titles, title);

function byTemplate(catalogue: Catalogue, text: string): string | undefined {
  for (const { english, quoted, translation } of catalogue.templates) {
    const found = english.exec(text);
    if (!found) continue;
    const values = found.slice(1).map((v, i) => (quoted[i] ? v : (translationBy(catalogue, v) ?? micro(v))));
    let next = 0;
    return translation.replace(/\{(\d*)\}/g, (_, n) => values[n ? Number(n) - 1 : next++] ?? '');
  }
  return undefined;
}

/** The translation of a text of several parts; undefined unless all parts have one. A part without words is not translated. */
function inParts(catalogue: Catalogue, text: string): string | undefined {
  for (const separator of [/(; )/, /((?<=[a-z)\]]\.) )(?=[A-Z])/, /( \(|\)$|\); )/]) {
    const parts = text.split(separator);
    if (parts.length === 1) continue;
    const worded = parts.map((part) => /\p{L}{2}/u.test(part));
    const translated = parts.map((part, i) => (worded[i] ? translationBy(catalogue, part) : part));
    if (worded.includes(true) && translated.every((part) => part !== undefined)) return translated.join('');
  }
  return undefined;
}

/** The translation of a text after its place, "file.toml:3: swarm[0].count: text". */
function afterPlace(catalogue: Catalogue, text: string): string | undefined {
  const colon = text.indexOf(': ');
  if (colon < 0) return undefined;
  const place = text.slice(0, colon);
  const rest = translationBy(catalogue, text.slice(colon + 2));
  // A place of one word is a key or a file.
  return rest === undefined ? undefined : `${(place.includes(' ') ? translationBy(catalogue, place) : undefined) ?? place}: ${rest}`;
}

/** The translation of a text by a catalogue, also of the values in it and of its parts; undefined without one. */
export function translationBy(catalogue: Catalogue, text: string): string | undefined {
  const exact = own(catalogue.texts, text);
  if (exact !== undefined) return exact;
  const [, before, core, after] = /^([\s;,]*)(.*?)([\s;,]*)$/s.exec(text)!;
  if (core === '') return undefined;
  if (core !== text) {
    const translation = translationBy(catalogue, core);
    return translation === undefined ? undefined : before + translation + after;
  }
  return byTemplate(catalogue, text) ?? inParts(catalogue, text) ?? afterPlace(catalogue, text);
}
/** The translation of a text of the program; undefined without one. */
export const textIn = (language: Language, text: string) => translationBy(catalogues[language], text);
