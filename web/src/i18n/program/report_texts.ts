// Translations of the texts of reports. They have a catalogue of their own, because in a message a word such as "start" can be a
// key. Values are {}, as in the other catalogue, or {#} for numbers. Warnings and notes of a report are messages.

import { micro } from '../../units';
import type { Language } from '..';
import { textIn } from './catalogue';

type Texts = Record<string, string>;
interface Template {
  english: RegExp;
  translation: string;
}

const kValues: Record<string, string> = { '{}': '(.+?)', '{#}': '([-+−]?\\d[\\d.]*(?:e[-+]?\\d+)?)' };
const kSentences = /(?<=[.!?])[ \n](?=[\p{Lu}(±])|(?<=^Figure \d+\.) /u;
const literal = (text: string) => text.replace(/[.*+?^${}()|[\]\\]/g, '\\$&').replaceAll(' ', '[ \\u00a0]');

/** A function that translates texts of reports; undefined without a translation. `message` translates messages. */
export function reportTranslation(texts: Texts, message: (text: string) => string | undefined) {
  const fixed = (english: string) => english.replaceAll(/\{#?\}/g, '').length;
  const pattern = (english: string) => english.split(/(\{#?\})/).map((part) => kValues[part] ?? literal(part)).join('');
  const templates: Template[] = Object.entries(texts)
    .filter(([english]) => /\{#?\}/.test(english))
    .sort(([a], [b]) => fixed(b) - fixed(a))
    .map(([english, translation]) => ({ english: new RegExp(`^${pattern(english)}$`, 's'), translation }));

  function one(text: string): string | undefined {
    if (Object.hasOwn(texts, text)) return texts[text];
    if (!/\p{L}{2}/u.test(text)) return undefined; // a number
    for (const { english, translation } of templates) {
      const values = english.exec(text)?.slice(1).map((v) => one(v) ?? micro(v));
      let next = 0;
      if (values) return translation.replace(/\{(\d*)\}/g, (_, n) => values[n ? Number(n) - 1 : next++] ?? '');
    }
    return message(text);
  }
  // The sentences of a paragraph are translated one by one: a value could also match the end of one and the start of the next.
  return (text: string): string | undefined => {
    const sentences = Object.hasOwn(texts, text) ? [] : text.split(kSentences);
    const all = sentences.length > 1 ? sentences.map(one) : [undefined];
    return all.every((s) => s !== undefined) ? all.join(' ') : one(text);
  };
}

const loaded: Partial<Record<Language, ReturnType<typeof reportTranslation>>> = {};

/** Loads the texts of reports in a language, which a page does before it shows them. */
export async function loadReports(language: Language) {
  if (language === 'en' || loaded[language]) return;
  const { reports } = await import('./reports');
  loaded[language] = reportTranslation(reports, (text) => textIn(language, text));
}

/** The translation of a text of a report; undefined without one. */
export const reportIn = (language: Language, text: string) => loaded[language]?.(text);
