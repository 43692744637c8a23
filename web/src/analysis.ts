// Checks of the forms of the tab Analyse.

import type { Word } from './i18n';

const isNumber = (text: string) => /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(text.trim());

/** Whether the text is a list of numbers, "0.5, -0.5": one current per coil, A. */
export const areCurrents = (text: string) => text.split(',').every(isNumber);

/** A coil system: its file, the number of its coils (0 if unknown), and whether it has default currents. */
export interface CoilSystem {
  file: string;
  coils: number;
  currents: boolean;
}
/** An example of currents for a coil system; empty if the number of its coils is unknown. */
export const exampleCurrents = (coils: number) => Array.from({ length: coils }, (_, k) => (k < 2 ? '0.5' : '0')).join(', ');

function invalidCurrents(text: string, system?: CoilSystem): Word | undefined {
  if (!text.trim() && system?.currents) return undefined; // the default currents
  if (!areCurrents(text)) return 'analyse.current_wrong';
  return system?.coils && text.split(',').length !== system.coils ? 'analyse.current_count' : undefined;
}
const kMostDegrees = 360;
const isDirection = (text: string) => isNumber(text) && Math.abs(Number(text)) <= kMostDegrees;

/** The text about the invalid value of a form, by the name of the value; empty if all are valid. `system`: that of a field map. */
export function invalidValues(values: Record<string, string>, system?: CoilSystem): Record<string, Word> {
  const wrong: Record<string, Word> = {};
  const currents = values.current === undefined ? undefined : invalidCurrents(values.current, system);
  if (currents) wrong.current = currents;
  if (values.direction?.trim() && !isDirection(values.direction)) wrong.direction = 'analyse.direction_wrong';
  return wrong;
}
