// Checks of the forms of the tab Analyse.

import type { Word } from './i18n';

const isNumber = (text: string) => /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(text.trim());

/** Whether the text is a list of numbers, "0.5, -0.5": one current per coil, A. */
export const areCurrents = (text: string) => text.split(',').every(isNumber);

/** The text about the invalid value of a form, by the name of the value; empty if all are valid. */
export function invalidValues(values: Record<string, string>): Record<string, Word> {
  const wrong: Record<string, Word> = {};
  if (values.current !== undefined && !areCurrents(values.current)) wrong.current = 'analyse.current_wrong';
  if (values.direction?.trim() && !isNumber(values.direction)) wrong.direction = 'analyse.direction_wrong';
  return wrong;
}
