// Search in the form of a scenario, by key, title and description.

import { getContext, setContext } from 'svelte';
import type { Say } from '../i18n';
import { programText } from '../text';
import { variant, type Schema } from './schema';
import { englishTitle, titleOf } from './titles';

/** The words of a search; a value must have all of them. */
export const wordsOf = (query: string) => query.toLowerCase().split(/\s+/).filter(Boolean);

/** Whether key, title or description of a value itself have all the words. */
export function isMatch(words: string[], key: string, schema: Schema, say: Say): boolean {
  const text = [key, englishTitle(key, schema), titleOf(key, schema, say), schema.description ?? '', programText(schema.description ?? '', say)].join(' ').toLowerCase();
  return words.every((w) => text.includes(w));
}

/** Whether a value or one below it matches; `value` selects the parts that are shown. Everything matches no words. */
export function hasMatch(words: string[], key: string, schema: Schema, value: any, say: Say): boolean {
  if (!words.length || isMatch(words, key, schema, say)) return true;
  const below = (properties: Record<string, Schema> | undefined, table: any) =>
    Object.entries(properties ?? {}).some(([k, s]) => k !== 'type' && k !== 'preset' && hasMatch(words, k, s, table?.[k], say));
  if (schema.oneOf) {
    const part = variant(schema, typeof value === 'string' ? value : (value?.type ?? ''));
    return part !== undefined && (isMatch(words, '', part, say) || below(part.properties, value));
  }
  if (schema.items?.properties || schema.items?.oneOf)
    return Array.isArray(value) && value.some((one) => (schema.items!.oneOf ? hasMatch(words, key, schema.items!, one, say) : below(schema.items!.properties, one)));
  return below(schema.properties, value);
}

/** The search of a form, shared by all its inputs. */
export interface Search {
  readonly words: string[];
}
const kKey = Symbol('form search');
export const shareSearch = (search: Search) => setContext(kKey, search);
/** The search of the surrounding form; no words outside of one. */
export const formSearch = (): Search => getContext(kKey) ?? { words: [] };
/** The search inside a section: a section that itself matches shows all its values. */
export function shareSectionSearch(outer: Search, matches: () => boolean) {
  shareSearch({
    get words() {
      return matches() ? [] : outer.words;
    },
  });
}
