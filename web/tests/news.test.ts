import { expect, it } from 'vitest';
import { JobNews } from '../src/jobs/news.svelte';
import type { Job } from '../src/lab.svelte';

const job = (id: number, state: Job['state'], error = '') => ({ id, state, title: `job ${id}`, error }) as Job;

it('reports jobs that end, and not those that had ended before', () => {
  const news = new JobNews();
  expect(news.take([job(1, 'done'), job(2, 'running'), job(3, 'waiting')], false)).toEqual([]);
  expect(news.take([job(1, 'done'), job(2, 'done'), job(3, 'running')], true).map((t) => t.id)).toEqual([2]);
  expect(news.unseen).toBe(1);
  expect(news.take([job(1, 'done'), job(2, 'done'), job(3, 'failed', 'no frames')], false)).toEqual([{ id: 3, title: 'job 3', error: 'no frames' }]);
  expect(news.unseen).toBe(1);
  expect(news.take([job(3, 'failed')], false)).toEqual([]);
  expect(news.take([job(4, 'cancelled')], false)).toEqual([]); // the user did it
  news.close(2);
  expect(news.toasts.map((t) => t.id)).toEqual([3]);
  // Jobs that ended between two messages.
  expect(news.take([job(5, 'done')], false).map((t) => t.id)).toEqual([5]);
  // A failed job was started again: its message replaces the earlier one.
  news.take([job(3, 'running')], false);
  news.take([job(3, 'done')], false);
  expect(news.toasts.filter((t) => t.id === 3).map((t) => t.error)).toEqual(['']);
});
