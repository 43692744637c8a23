/** Portuguese texts of the reports. */
import { calibration } from './reports/calibration';
import { common } from './reports/common';
import { control } from './reports/control';
import { identify } from './reports/identify';
import { motion } from './reports/motion';
import { quality } from './reports/quality';
import { run } from './reports/run';
import { tracks } from './reports/tracks';

export const reports: Record<string, string> = { ...common, ...run, ...motion, ...tracks, ...identify, ...control, ...calibration, ...quality };
