// Which key does what in the workbench.

import { usesKey } from '../keyboard';

export type KeyAction = 'arrow' | 'pause' | 'step' | 'reverse' | 'stop' | 'in' | 'out' | 'fit' | 'undo' | 'help';

const kActions: Record<string, KeyAction> = { ' ': 'pause', '.': 'step', r: 'reverse', '0': 'stop', '+': 'in', '-': 'out', f: 'fit', '?': 'help' };
/** Actions that do not change the run, for pages without control. */
const kFree: KeyAction[] = ['in', 'out', 'fit', 'help'];

/** The action of a key; null if the key has none, if the focused element uses it, or if the page may not change the run. */
export function keyAction(e: Pick<KeyboardEvent, 'key' | 'ctrlKey' | 'metaKey' | 'altKey' | 'shiftKey'> & { target: unknown }, steers: boolean): KeyAction | null {
  if (e.altKey || usesKey(e.target, e.key)) return null;
  const modified = e.ctrlKey || e.metaKey;
  const action = modified ? (e.key.toLowerCase() === 'z' && !e.shiftKey ? 'undo' : null) : e.key.startsWith('Arrow') ? 'arrow' : (kActions[e.key] ?? null);
  return action && (steers || kFree.includes(action)) ? action : null;
}
