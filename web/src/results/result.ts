// Results: pages that jobs and runs have written, and what belongs to them.

import type { Job } from '../lab.svelte';
import { addressOf } from '../router.svelte';
import { quoted } from '../scenario';

export interface ResultFiles {
  files: { file: string; bytes: number }[];
  /** Scenario of the best model or controller; empty: none. */
  scene: string;
  /** Video that a model was identified from, in the folder of the lab; empty: none. */
  video: string;
}

/** The address of the page of a result. */
export const resultAddress = (page: string, job?: number) => addressOf('result', [], { page, ...(job === undefined ? {} : { job: String(job) }) });

/** The job that wrote a page; numbers of jobs may start again with each lab, so that the page decides. */
export function jobOf(jobs: Job[], page: string, id: string | undefined): Job | undefined {
  const writers = jobs.filter((j) => j.page === page);
  return writers.find((j) => String(j.id) === id) ?? writers.at(-1);
}

/** The command of a job for a shell, without the options of its output for programs. */
export const commandOf = (words: string[]) => ['faba', ...words.filter((w) => w !== '--json')].map(quoted).join(' ');

/** The files before the options of a command, without "./". */
export function filesOf(words: string[]): string[] {
  const end = words.findIndex((w) => w.startsWith('--'));
  return words.slice(1, end < 0 ? undefined : end).map((w) => w.replace(/^\.\//, ''));
}

/** The name of the experiment that a result belongs to, or whose videos it uses; undefined without one. */
export function experimentOf(page: string, words: string[] = []): string | undefined {
  for (const path of [page, ...words.map((w) => w.replace(/^\.\//, ''))]) {
    const found = /^experiments\/([^/]+)/.exec(path);
    if (found) return found[1];
  }
  return undefined;
}

/** "runs/study" of "runs/study/report.html". */
export const folderOf = (page: string) => page.slice(0, Math.max(0, page.lastIndexOf('/')));
export const nameOf = (file: string) => file.slice(file.lastIndexOf('/') + 1);
/** The address of a file of the folder of the lab. */
export const fileAddress = (file: string) => '/' + file.split('/').map(encodeURIComponent).join('/');
