// Portuguese texts of the messages of the program, by the English templates that tools/message_templates.py lists: one file
// for each part of the program. A test compares them with that list.

import { bench } from './bench';
import { coils } from './coils';
import { files } from './files';
import { lab } from './lab';
import { measurements } from './measurements';
import { optics } from './optics';
import { scenario } from './scenario';
import { studies } from './studies';
import { system } from './system';
import { tracks } from './tracks';

export const refusals: Record<string, string> = { ...system, ...bench, ...coils, ...files, ...lab, ...measurements, ...optics, ...scenario, ...studies, ...tracks };
