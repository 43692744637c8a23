// Texts of the program in Portuguese, by the English text. Values of a text are written as {}: the nth {} of the translation is
// the nth value, or {2} the second one. The page loads this file when Portuguese is chosen.

import { jobs } from './jobs';
import { names } from './names';
import { refusals } from './refusals';
import { places } from './refusals/system';
import { scenes } from './scenes';
import { schema } from './schema';
import { titles } from './titles';

/** Places of messages, and texts of forms. A title may have another translation than the same words elsewhere. */
export { places, titles };
export const texts: Record<string, string> = { ...refusals, ...names, ...jobs, ...schema, ...scenes };
