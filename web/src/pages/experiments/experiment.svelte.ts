// One experiment in the page: it is saved with every change, and follows the changes of other pages.

import { get, post, remove, RequestError } from '../../connection';
import type { Deleted } from '../runs/UndoBar.svelte';
import { inverse, valueAt, type Change, type Conflict, type Experiment } from './experiment';

interface Answer {
  revision: string;
  experiment: Experiment;
  conflicts?: Conflict[];
}

/** What can be undone: changes of values, or the deletion of a video, by its number in the trash. */
type Done = Change[] | number;

export class OpenExperiment {
  experiment = $state.raw<Experiment | null>(null);
  /** Changes that another page made before: the page asks which value to keep. */
  refused = $state.raw<{ changes: Change[]; conflicts: Conflict[] } | null>(null);
  /** An invalid value: its path, "video[0].exposure", and the reason. */
  trouble = $state.raw<{ where: string; what: string } | null>(null);
  saving = $state(false);
  /** Videos that were deleted with their files. */
  deleted = $state.raw<Deleted[]>([]);
  private done = $state.raw<Done[]>([]);
  readonly mayUndo = $derived(this.done.length > 0);

  constructor(readonly name: string) {}

  private get path() {
    return `/api/experiments/${encodeURIComponent(this.name)}`;
  }
  async load() {
    const [answer, trash] = await Promise.all([get<Answer>(this.path), get<Deleted[]>('/api/trash')]);
    this.deleted = trash.filter((d) => d.name.startsWith(`experiments/${this.name}/`));
    this.take(answer);
  }
  private take(a: Answer) {
    this.experiment = a.experiment;
  }

  /** Sets values; returns whether they were accepted. The values before are added. */
  async change(changes: Change[], undoing = false): Promise<boolean> {
    const e = this.experiment ?? {};
    const complete = changes.map((c) => ({ ...c, from: 'from' in c ? c.from : valueAt(e, c.path) }));
    this.saving = true;
    this.trouble = null;
    try {
      const a = await post<Answer>(this.path, { changes: complete.map(({ path, from, to }) => ({ path, from: from ?? null, to: to ?? null })) });
      this.take(a);
      if (a.conflicts) {
        this.refused = { changes: complete, conflicts: a.conflicts };
        return false;
      }
      if (!undoing) this.done = [...this.done, complete];
      return true;
    } catch (error) {
      if (!(error instanceof RequestError)) throw error;
      this.trouble = { where: error.where.replace(/^experiment\.toml: /, ''), what: error.what };
      return false;
    } finally {
      this.saving = false;
    }
  }
  set(path: string[], to: unknown) {
    return this.change([{ path, to }]);
  }
  /** Sends refused changes again, in place of the values of the other page. */
  async insist() {
    const { changes } = this.refused!;
    this.refused = null;
    await this.change(changes.map(({ path, to }) => ({ path, to })));
  }
  async undo() {
    const last = this.done.at(-1);
    if (!last) return;
    this.done = this.done.slice(0, -1);
    if (typeof last === 'number') await this.restore(last);
    else await this.change(inverse(last), true);
  }

  /** Removes a video and moves its file to the trash. Throws RequestError. */
  async deleteVideo(file: string) {
    const { id } = await remove<Deleted>(`${this.path}/videos?${new URLSearchParams({ file })}`);
    this.done = [...this.done, id];
    await this.load();
  }
  /** Restores a deleted video with its file. Throws RequestError. */
  async restore(id: number) {
    await post(`/api/trash/${id}/undo`, {});
    this.done = this.done.filter((d) => d !== id);
    await this.load();
  }
}
