/** Portuguese texts of the reports; {#} in an English text is a number. */
import { aspects } from './reports/aspects';
import { calibration } from './reports/calibration';
import { common } from './reports/common';
import { control } from './reports/control';
import { identify } from './reports/identify';
import { motion } from './reports/motion';
import { run } from './reports/run';
import { tracks } from './reports/tracks';
import { values } from './reports/values';

export const reports: Record<string, string> = { ...values, ...aspects, ...common, ...run, ...motion, ...tracks, ...identify, ...control, ...calibration };
