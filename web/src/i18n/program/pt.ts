// Texts of the program in Portuguese, by the English text. Values of a text are written as {}: the nth {} of the translation is
// the nth value, or {2} the second one; {#} in an English text is a number. The page loads this file when Portuguese is chosen.

import { jobs } from './jobs';
import { names } from './names';
import { reports } from './reports';
import { scenes } from './scenes';
import { schema } from './schema';
import { titles } from './titles';

/** Texts of forms. A title may have another translation than the same words elsewhere. */
export { titles };
/** Texts of reports only. */
export { reports };
export const texts: Record<string, string> = { ...names, ...jobs, ...schema, ...scenes };
