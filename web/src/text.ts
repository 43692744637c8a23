// Texts of the program as the page shows them: units with the letter µ, and Portuguese where the page has a translation.

import { RequestError } from './connection';
import type { Say, Word } from './i18n';
import { placeIn, textIn } from './i18n/program/catalogue';
import { reportIn } from './i18n/program/report_texts';
import { micro, microAfterNumber } from './units';

/**
 * A text of the program in the language of the page. A text without a translation may be Portuguese, in which "um" is a unit only
 * after a number.
 */
export const programText = (text: string, say: Say) => textIn(say.language, text) ?? withMicro(text, say);
/** Likewise, a text of a report. */
export const reportText = (text: string, say: Say) => reportIn(say.language, text) ?? withMicro(text, say);
const withMicro = (text: string, say: Say) => (say.language === 'en' ? micro(text) : microAfterNumber(text));

/** With a capital letter at the start; the sign µ remains. */
export const capitalised = (text: string) => text.replace(/^[a-zà-ÿ]/, (c) => c.toUpperCase());

/** The title of a job, "activity: file": its verb in the language of the page. */
export function jobTitle(title: string, say: Say): string {
  const colon = title.indexOf(': ');
  const verb = colon < 0 ? undefined : textIn(say.language, title.slice(0, colon));
  return verb === undefined ? title : verb + title.slice(colon);
}

/** A failure as one line: its place, and the reason. */
export function failureText(t: { where?: string; what?: string; word?: Word }, say: Say): string {
  const what = t.word ? say(t.word) : programText(t.what ?? '', say);
  return t.where ? `${placeIn(say.language, t.where)}: ${what}` : what;
}

/** An exception as a negative answer of the program. */
export function failure(e: unknown): { ok: false; where: string; what: string; word?: Word } {
  if (e instanceof RequestError) return { ok: false, where: e.where, what: e.what, word: e.word };
  return { ok: false, where: '', what: (e as Error).message };
}
/** An exception as one line. */
export const reason = (e: unknown, say: Say) => failureText(failure(e), say);

/** The place of an error in an imported file: it names the file once. */
export const placeInFile = (file: string, where: string) => (where === file || where.startsWith(`${file}:`) ? where : where ? `${file}: ${where}` : file);

/** An integer with narrow spaces between groups of three digits: "1 000 000"; numbers of four digits have none. */
export const grouped = (n: number) => (n < 10000 ? String(n) : String(n).replace(/\B(?=(\d{3})+$)/g, '\u202f'));

export interface TextPart {
  text: string;
  code: boolean;
}
/** A description in the language of the page as text and code, which is in `backticks`. */
export function withCode(text: string, say: Say): TextPart[] {
  const translation = textIn(say.language, text), parts = (translation ?? text).split('`');
  const shown = (part: string) => (translation === undefined ? withMicro(part, say) : part);
  // Without a closing backtick the last one is a character.
  if (parts.length % 2 === 0) parts.splice(-2, 2, parts.slice(-2).join('`'));
  return parts.map((part, i) => ({ text: i % 2 ? part : shown(part), code: i % 2 === 1 })).filter((part) => part.text !== '');
}
