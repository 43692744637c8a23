// Titles of the values of a scenario: that of the schema, or made from the key.

import type { Say } from '../i18n';
import { titleIn } from '../i18n/program/catalogue';
import { capitalised, programText } from '../text';
import type { Schema } from './schema';

// Units in keys, which the value shows, and abbreviations.
const kUnit = / (px|um|ms|sd)$/;
const kWords: Record<string, string> = {
  sd: 'standard deviation', px: '', psf: 'PSF', um: 'µm', fps: 'frames/s', places: 'positions', motility: 'motility law', alpha2: 'smoothness α²', rms: 'RMS',
};

/** "Speed, standard deviation" for speed_sd: the title if the schema and the key do not give a better one. */
function fromKey(key: string): string {
  const words = key.replaceAll('_', ' ');
  const ending = kUnit.exec(words)?.[1];
  const rest = (ending ? words.replace(kUnit, '') : words).split(' ').map((w) => (Object.hasOwn(kWords, w) ? kWords[w] : w)).join(' ');
  const text = ending === 'sd' ? `${rest}, ${kWords.sd}` : rest;
  return capitalised(text);
}

/** The English title of a value; sections and parts have their key as the title in the schema. */
export const englishTitle = (key: string, schema: Schema = {}) => (schema.title && !schema.oneOf && !schema.properties ? schema.title : fromKey(key));

/** The title in the language of the page, and whether it is a translation. */
export function titleOf(key: string, schema: Schema, say: Say): string {
  const english = englishTitle(key, schema);
  return titleIn(say.language, english) ?? english;
}

/** The title of a value of a study file: its key, which has a translation with the texts of the program. */
export const studyTitle = (key: string, say: Say) => capitalised(programText(key.replaceAll('_', ' '), say));
