// One line about an activity: its phase, the response, and the time left.

import type { Say } from '../i18n';
import { clockText, type Activity } from './state';

export function activityText(a: Activity, say: Say): string {
  const parts: string[] = [];
  if (a.of && a.of > 1) parts.push(say('bench.index', { n: a.index ?? 0, of: a.of }));
  if (a.phase) parts.push(say(`bench.phase_now.${a.phase}`));
  if (a.left_s !== null && a.left_s !== undefined) parts.push(say('bench.left', { t: clockText(a.left_s) }));
  else parts.push(say('bench.since', { t: clockText(a.started_s_ago) }));
  return parts.join(' · ');
}
