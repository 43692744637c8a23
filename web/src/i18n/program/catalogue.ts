// Translations of the texts of the program: fixed texts, and texts with values, which have {} in the catalogue, or {#} for numbers.

import { micro } from '../../units';
import type { Language } from '..';

type Texts = Record<string, string>;
interface Template {
  english: RegExp;
  translation: string;
}
export interface Catalogue {
  texts: Texts;
  titles: Texts;
  templates: Template[];
}

const kEmpty: Catalogue = { texts: {}, titles: {}, templates: [] };
const catalogues: Record<Language, Catalogue> = { en: kEmpty, pt: kEmpty };
/** Those of reports: in a message, a word such as "start" can be a key. */
const reportCatalogues: Record<Language, Catalogue> = { en: kEmpty, pt: kEmpty };

const kValues: Record<string, string> = { '{}': '(.+?)', '{#}': '([-+−]?\\d[\\d.]*(?:e[-+]?\\d+)?)' };
const literal = (text: string) => text.replace(/[.*+?^${}()|[\]\\]/g, '\\$&').replaceAll(' ', '[ \\u00a0]');

/** Texts with values, those with the most fixed characters first. */
export function templatesOf(texts: Texts): Template[] {
  const fixed = (english: string) => english.replaceAll(/\{#?\}/g, '').length;
  const pattern = (english: string) => english.split(/(\{#?\})/).map((part) => kValues[part] ?? literal(part)).join('');
  return Object.entries(texts)
    .filter(([english]) => /\{#?\}/.test(english))
    .sort(([a], [b]) => fixed(b) - fixed(a))
    .map(([english, translation]) => ({ english: new RegExp(`^${pattern(english)}$`, 's'), translation }));
}

/** Loads the texts of a language, which the page does before it shows them. */
export async function loadTexts(language: Language) {
  if (language === 'en' || catalogues[language] !== kEmpty) return;
  const { reports, texts, titles } = await import('./pt');
  catalogues[language] = { texts, titles, templates: templatesOf(texts) };
  const all = { ...texts, ...reports };
  reportCatalogues[language] = { texts: all, titles, templates: templatesOf(all) };
}

const own = (all: Texts, text: string) => (Object.hasOwn(all, text) ? all[text] : undefined);

/** The translation of the title of a value; undefined without one. */
export const titleIn = (language: Language, title: string) => own(catalogues[language].titles, title);

/** The translation of a text by a catalogue, also of the values in it; `plain` gives those without a translation. Undefined without one. */
export function translationBy(catalogue: Catalogue, text: string, plain = micro): string | undefined {
  const exact = own(catalogue.texts, text);
  if (exact !== undefined) return exact;
  for (const { english, translation } of catalogue.templates) {
    const found = english.exec(text);
    if (!found) continue;
    const values = found.slice(1).map((v) => translationBy(catalogue, v, plain) ?? plain(v));
    let next = 0;
    return translation.replace(/\{(\d*)\}/g, (_, n) => values[n ? Number(n) - 1 : next++] ?? '');
  }
  return undefined;
}
/** The translation of a text of the program; undefined without one. */
export const textIn = (language: Language, text: string) => translationBy(catalogues[language], text);

const kBetweenSentences = /(?<=[.!?])[ \n](?=[\p{Lu}(±])|(?<=^Figure \d+\.) /u;

/** The translation of a text of a report, which can be several sentences; undefined without one. */
export function reportIn(language: Language, text: string, plain = micro): string | undefined {
  const catalogue = reportCatalogues[language], sentences = text.split(kBetweenSentences);
  if (own(catalogue.texts, text) === undefined && sentences.length > 1) {
    const all = sentences.map((s) => translationBy(catalogue, s, plain));
    if (all.every((s) => s !== undefined)) return all.join(' ');
  }
  return translationBy(catalogue, text, plain);
}
