// Texts of the page in English and Brazilian Portuguese, one catalogue for each part of the page; the folder
// program has translations of the texts of the program.

import * as analyse from './analyse';
import * as app from './app';
import * as assistant from './assistant';
import * as bench from './bench';
import * as coils from './coils';
import * as demo from './demo';
import * as experiments from './experiments';
import * as form from './form';
import * as gallery from './gallery';
import * as jobs from './jobs';
import * as lab from './lab';
import * as optics from './optics';
import * as own from './own';
import * as plan from './plan';
import * as quality from './quality';
import * as result from './result';
import * as runs from './runs';
import * as tracks from './tracks';
import * as video from './video';
import * as workbench from './workbench';

const en = {
  ...analyse.en,
  ...app.en,
  ...assistant.en,
  ...bench.en,
  ...coils.en,
  ...demo.en,
  ...experiments.en,
  ...form.en,
  ...gallery.en,
  ...jobs.en,
  ...lab.en,
  ...optics.en,
  ...own.en,
  ...plan.en,
  ...quality.en,
  ...result.en,
  ...runs.en,
  ...tracks.en,
  ...video.en,
  ...workbench.en,
};
const pt = {
  ...analyse.pt,
  ...app.pt,
  ...assistant.pt,
  ...bench.pt,
  ...coils.pt,
  ...demo.pt,
  ...experiments.pt,
  ...form.pt,
  ...gallery.pt,
  ...jobs.pt,
  ...lab.pt,
  ...optics.pt,
  ...own.pt,
  ...plan.pt,
  ...quality.pt,
  ...result.pt,
  ...runs.pt,
  ...tracks.pt,
  ...video.pt,
  ...workbench.pt,
};

export type Word = keyof typeof en;
export type Language = 'en' | 'pt';
export const kWords: Record<Language, Record<Word, string>> = { en, pt };

export function words(language: Language) {
  const say = (key: Word, values: Record<string, string | number> = {}) =>
    kWords[language][key].replace(/\{(\w+)\}/g, (all, name) => (name in values ? String(values[name]) : all));
  return Object.assign(say, { language });
}
export type Say = ReturnType<typeof words>;
