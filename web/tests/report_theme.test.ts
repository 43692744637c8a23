import { expect, test } from 'vitest';
import { setReportTheme } from '../src/report_theme';

const kPreference = 'screen and (prefers-color-scheme: dark)';
const media = (mediaText: string) => ({ media: { mediaText } });

test('a report follows the theme of the lab, and its print rules do not change', () => {
  const page: { media?: { mediaText: string } }[] = [{}, media(kPreference), media('print'), media('screen and (max-width: 720px)')], plot = [media('screen and (prefers-color-scheme:dark)')];
  const report = { documentElement: { style: { colorScheme: '' } }, styleSheets: [{ cssRules: page }, { cssRules: plot }] };
  const queries = () => [...page, ...plot].map((r) => r.media?.mediaText ?? '');
  setReportTheme(report, true);
  expect(queries()).toEqual(['', 'screen', 'print', 'screen and (max-width: 720px)', 'screen']);
  expect(report.documentElement.style.colorScheme).toBe('dark');
  setReportTheme(report, false);
  expect(queries()).toEqual(['', 'not all', 'print', 'screen and (max-width: 720px)', 'not all']);
  expect(report.documentElement.style.colorScheme).toBe('light');
  setReportTheme(report, true);
  expect(queries()[1]).toBe('screen');
});
