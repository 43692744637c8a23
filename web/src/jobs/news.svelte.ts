// Messages about the end of jobs: in the page on any tab, in its title, and outside the browser if the user has permitted it.

import type { Job } from '../lab.svelte';

export interface Toast {
  id: number;
  title: string;
  error: string;
}
const kShown = 4;

export class JobNews {
  toasts = $state.raw<Toast[]>([]);
  /** Number of jobs that ended while the page was hidden. */
  unseen = $state(0);
  private before: Map<number, Job['state']> | null = null;

  /** Takes the list of jobs; returns those that ended since the last one. Jobs of the first list are old. */
  take(jobs: Job[], hidden: boolean): Toast[] {
    const before = this.before;
    this.before = new Map(jobs.map((j) => [j.id, j.state]));
    if (!before) return [];
    const active = (s?: string) => s === 'running' || s === 'waiting' || s === undefined;
    const ended = jobs.filter((j) => (j.state === 'done' || j.state === 'failed') && active(before.get(j.id))).map((j) => ({ id: j.id, title: j.title, error: j.state === 'failed' ? j.error || '?' : '' }));
    // A job that was started again replaces its earlier message.
    const others = this.toasts.filter((t) => !ended.some((e) => e.id === t.id));
    if (ended.length) this.toasts = [...others, ...ended].slice(-kShown);
    if (hidden) this.unseen += ended.length;
    return ended;
  }
  close(id: number) {
    this.toasts = this.toasts.filter((t) => t.id !== id);
  }
}
