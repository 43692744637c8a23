// Translations of the texts of the program: fixed texts, and texts with values, which have {} in the catalogue.

import { micro } from '../../units';
import type { Language } from '..';

type Texts = Record<string, string>;
interface Template {
  /** The longest fixed part, without which a text does not match. */
  fixed: string;
  english: RegExp;
  /** Whether each value is in quotes: a key, a name or what the user wrote, which has no translation. */
  quoted: boolean[];
  /** Part of a message, such as "in {}": it translates values only, because other texts, such as "in vitro.mp4", match it, too. */
  part: boolean;
  translation: string;
}
export interface Catalogue {
  texts: Texts;
  titles: Texts;
  /** Words for the place of a message that is neither a key nor a file. */
  places?: Texts;
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

const kJoining = new Set(['and', 'as', 'at', 'by', 'for', 'from', 'in', 'of', 'or', 'such', 'to', 'with']);

/** Texts with values, those with the most fixed characters first. */
export function templatesOf(texts: Texts): Template[] {
  const fixed = (english: string) => english.replaceAll('{}', '').length;
  const withValues = Object.entries(texts).filter(([english]) => english.includes('{}'));
  // What follows "{}; " can also follow another text.
  const following = withValues.filter((texts) => texts.every((text) => text.startsWith('{}; '))).map((texts) => texts.map((text) => text.slice(4)));
  return [...withValues, ...following]
    .sort(([a], [b]) => fixed(b) - fixed(a))
    .map(([english, translation]) => {
      const parts = english.split('{}');
      const quoted = parts.slice(1).map((after, i) => /["'`]$/.test(parts[i]) && /^["'`]/.test(after));
      const fixed = parts.reduce((longest, part) => (part.length > longest.length ? part : longest), '');
      const words = english.match(/\p{L}+/gu) ?? [];
      const part = words.length > 0 && words.every((word) => kJoining.has(word));
      return { fixed, english: pattern(parts), quoted, part, translation };
    });
}

/** Loads the texts of a language, which the page does before it shows them. */
export async function loadTexts(language: Language) {
  if (language === 'en' || catalogues[language] !== kEmpty) return;
  const { texts, titles, places } = await import('./pt');
  catalogues[language] = { texts, titles, places, templates: templatesOf(texts) };
}

const own = (all: Texts, text: string) => (Object.hasOwn(all, text) ? all[text] : undefined);

/** The place of a message; a key and a file have no translation. */
export const placeIn = (language: Language, place: string) => own(catalogues[language].places ?? {}, place) ?? place;

/** The translation of the title of a value; undefined without one. */
export const titleIn = (language: Language, title: string) => own(catalogues[language].titles, title);

interface Translated {
  text: string;
  /** Whether all words are translated; a file name or a key is not. */
  complete: boolean;
}
/** Whether a text has words; a number with a unit has none. */
const worded = (text: string) => /\p{L}{2}/u.test(text) && !/^[-+]?[\d.][\d.e+-]*( ?(\S{1,3}|\S+\/\S+))?$/i.test(text);
const unchanged = (text: string): Translated => ({ text, complete: !worded(text) });

/** By the first template all of whose values are translated, or else by the first. */
function byTemplate(catalogue: Catalogue, text: string, isValue: boolean): Translated | undefined {
  let first: Translated | undefined;
  for (const { fixed, english, quoted, part, translation } of catalogue.templates) {
    const found = text.includes(fixed) && (isValue || !part) ? english.exec(text) : null;
    if (!found) continue;
    const values = found.slice(1).map((v, i) => (quoted[i] ? { text: v, complete: true } : (translated(catalogue, v, true) ?? unchanged(micro(v)))));
    let next = 0;
    const filled = translation.replace(/\{(\d*)\}/g, (_, n) => values[n ? Number(n) - 1 : next++]?.text ?? '');
    const complete = values.every((v) => v.complete);
    if (complete) return { text: filled, complete };
    first ??= { text: filled, complete };
  }
  return first;
}

const kComma = /(, )/;
const kSeparators = [/(; )/, /((?<=[a-z)\]]\.) )(?=[A-Z])/, /( \(|\)$|\); )/, kComma];

/** A text of several parts; undefined unless all parts have a translation. A part without words has none. */
function inParts(catalogue: Catalogue, text: string): Translated | undefined {
  for (const separator of kSeparators) {
    const parts = text.split(separator);
    if (parts.length === 1 || !parts.some(worded)) continue;
    if (separator === kComma && !parts.every((part, i) => i % 2 || part.includes(' '))) continue; // a list of keys
    const all = parts.map((part) => (worded(part) ? translated(catalogue, part, false) : unchanged(part)));
    if (all.every((part) => part !== undefined)) return { text: all.map((part) => part.text).join(''), complete: all.every((part) => part.complete) };
  }
  return undefined;
}

/** A text after its place, "file.toml:3: swarm[0].count: text". A place of one word is a key or a file. */
function afterPlace(catalogue: Catalogue, text: string): Translated | undefined {
  const colon = text.indexOf(': ');
  if (colon < 0) return undefined;
  const place = text.slice(0, colon);
  const rest = translated(catalogue, text.slice(colon + 2), false);
  return rest && { ...rest, text: `${(place.includes(' ') ? own(catalogue.texts, place) : undefined) ?? place}: ${rest.text}` };
}

function translated(catalogue: Catalogue, text: string, isValue: boolean): Translated | undefined {
  const exact = own(catalogue.texts, text);
  if (exact !== undefined) return { text: exact, complete: true };
  if (!worded(text)) return undefined;
  const [, before, core, after] = /^([\s;,]*)(.*?)([\s;,]*)$/s.exec(text)!;
  if (core !== text) {
    const inside = translated(catalogue, core, isValue);
    return inside && { ...inside, text: before + inside.text + after };
  }
  const matched = byTemplate(catalogue, text, isValue);
  if (matched?.complete) return matched;
  const found = [matched, inParts(catalogue, text), afterPlace(catalogue, text)].filter((one) => one !== undefined);
  return found.find((one) => one.complete) ?? found[0];
}

/** The translation of a text by a catalogue, also of the values in it and of its parts; undefined without one. */
export const translationBy = (catalogue: Catalogue, text: string, isValue = false) => translated(catalogue, text, isValue)?.text;
/** The translation of a text of the program; undefined without one. */
export const textIn = (language: Language, text: string) => translationBy(catalogues[language], text);
