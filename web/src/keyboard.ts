// Keys that the focused element uses, which are then not shortcuts of the page.

interface Focus {
  tagName: string;
  type?: string;
  closest?: (selector: string) => unknown;
}
/** All keys in dialogs, text inputs and lists; arrows, Home, End and Page keys in sliders; Space and Enter on buttons and links. */
export function usesKey(target: unknown, key: string): boolean {
  if (!target || typeof target !== 'object' || !('tagName' in target)) return false;
  const focus = target as Focus;
  if (focus.closest?.('dialog')) return true;
  if (focus.tagName === 'INPUT' && focus.type === 'range') return /^(Arrow|Home|End|Page)/.test(key);
  if (focus.tagName === 'INPUT' && focus.type === 'checkbox') return key === ' ';
  if (/^(INPUT|SELECT|TEXTAREA)$/.test(focus.tagName)) return true;
  return /^(BUTTON|SUMMARY|A|LABEL)$/.test(focus.tagName) && (key === ' ' || key === 'Enter');
}
