// The gallery: scenes in sections by their purpose.

import type { Say, Word } from './i18n';
import { programText, withCode, type TextPart } from './text';

export const kPurposes = ['start', 'steer', 'step-response', 'coils', 'thesis', 'yours'] as const;
export type Purpose = (typeof kPurposes)[number];

/** A scene as the server lists it. */
export interface SceneCard {
  name: string;
  file: string;
  title: string;
  /** The comment at the top of the file. */
  about?: string;
  cells?: number;
  duration_s?: number;
  models?: string[];
  controller?: string;
  /** The scene has a bench. */
  bench?: boolean;
  error?: string;
  /** Of scenes in the index of the gallery; the others are those of the user. */
  purpose?: string;
  summary?: string;
}

export interface Section {
  purpose: Purpose;
  title: Word;
  scenes: SceneCard[];
}

/** The sections that have scenes, in their order. */
export function bySection(scenes: SceneCard[]): Section[] {
  const purposeOf = (s: SceneCard): Purpose => kPurposes.find((p) => p === s.purpose) ?? 'yours';
  return kPurposes.map((purpose) => ({ purpose, title: `gallery.${purpose}` as Word, scenes: scenes.filter((s) => purposeOf(s) === purpose) })).filter((s) => s.scenes.length > 0);
}

export const titleOfScene = (s: SceneCard, say: Say) => programText(s.title, say) || s.name;

/** One sentence: that of the index, or the first one of the comment. */
export const summaryOf = (s: SceneCard, say: Say): TextPart[] => withCode(s.summary || firstSentence(s.about ?? ''), say);
/** Whether the comment of a scene has more than its card shows. */
export const hasMore = (s: SceneCard) => !!s.about && s.about !== (s.summary || firstSentence(s.about));
/** The text up to the first full stop before a capital letter; a stop after an initial or an abbreviation does not end a sentence. */
export function firstSentence(text: string): string {
  const end = /(?<!\b(?:Figs?|eqs?|approx|(?<!\b(?:and|or) )\p{Lu}))[.!?](?=\s+\p{Lu})/u.exec(text);
  return end ? text.slice(0, end.index + 1) : text;
}

/** Cells above which a scene is slower than real time on most computers. */
export const kHeavy = 20_000;
export const isHeavy = (s: SceneCard) => (s.cells ?? 0) > kHeavy;
