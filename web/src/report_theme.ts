// The theme of a report in a frame. Reports follow the browser (prefers-color-scheme); in the lab they follow the lab.

/** What this file needs of a document and its style sheets. */
export interface Styled {
  documentElement: { style: { colorScheme: string } };
  styleSheets: ArrayLike<{ cssRules: ArrayLike<{ media?: { mediaText: string } }> }>;
}

const kDarkRule = /prefers-color-scheme:\s*dark/;
const kDark = 'screen', kLight = 'not all'; // a printed report is light

/** Rules for dark screens that were changed; their media query has no longer the preference. */
const changed = new WeakSet<object>();

/** Shows a report dark or light, independent of the preference of the browser. */
export function setReportTheme(report: Styled, dark: boolean) {
  report.documentElement.style.colorScheme = dark ? 'dark' : 'light';
  for (const sheet of Array.from(report.styleSheets))
    for (const rule of Array.from(sheet.cssRules)) {
      if (!rule.media || (!changed.has(rule) && !kDarkRule.test(rule.media.mediaText))) continue;
      changed.add(rule);
      rule.media.mediaText = dark ? kDark : kLight;
    }
}
