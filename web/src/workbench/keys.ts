// Which key does what in the workbench.

export type KeyAction = 'arrow' | 'pause' | 'step' | 'reverse' | 'stop' | 'in' | 'out' | 'fit' | 'undo' | 'help';

const kActions: Record<string, KeyAction> = { ' ': 'pause', '.': 'step', r: 'reverse', '0': 'stop', '+': 'in', '-': 'out', f: 'fit', '?': 'help' };
/** Actions that do not change the run, for pages without control. */
const kFree: KeyAction[] = ['in', 'out', 'fit', 'help'];

/** What the focused element uses: all keys in inputs, lists and sliders; the space bar on buttons and links. */
interface Focus {
  tagName: string;
  type?: string;
}
function usedBy(focus: Focus | null, key: string): boolean {
  if (!focus) return false;
  if (/^(SELECT|TEXTAREA)$/.test(focus.tagName)) return true;
  if (focus.tagName === 'INPUT') return focus.type !== 'checkbox' || key === ' ';
  return key === ' ' && /^(BUTTON|SUMMARY|A)$/.test(focus.tagName);
}

/** The action of a key; null if the key has none, if the focused element uses it, or if the page may not change the run. */
export function keyAction(e: Pick<KeyboardEvent, 'key' | 'ctrlKey' | 'metaKey' | 'altKey' | 'shiftKey'> & { target: unknown }, steers: boolean): KeyAction | null {
  const focus = e.target && typeof e.target === 'object' && 'tagName' in e.target ? (e.target as Focus) : null;
  if (e.altKey || usedBy(focus, e.key)) return null;
  const modified = e.ctrlKey || e.metaKey;
  const action = modified ? (e.key.toLowerCase() === 'z' && !e.shiftKey ? 'undo' : null) : e.key.startsWith('Arrow') ? 'arrow' : (kActions[e.key] ?? null);
  return action && (steers || kFree.includes(action)) ? action : null;
}
