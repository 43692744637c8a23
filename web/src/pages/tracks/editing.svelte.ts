// The result of a tracking in the page: measured tracks, cuts and edits, which the program stores.

import { get, post } from '../../connection';
import { fatesOf, loadPoints, loadResult, Newest, used, withCut, type Cut, type Edit, type EditedTracks, type Edits, type Fate, type Points, type Result } from './tracks';

export class TrackEditing {
  result = $state.raw<Result | null>(null);
  points = $state.raw<Points | null>(null);
  /** Cuts as they are on the page; the program has those of `result` until they are saved. */
  cuts = $state.raw<Cut[]>([]);
  /** Motion of the used tracks. */
  motion = $state.raw<Record<string, any> | null>(null);
  unsaved = $state(false);
  trouble = $state.raw<unknown>(null);
  readonly fates = $derived<Fate[]>(this.result ? fatesOf(this.result.features, this.result.tracks, this.cuts) : []);
  readonly isUsed = $derived(this.fates.map(used));
  readonly count = $derived(this.isUsed.filter(Boolean).length);
  private saving = new Newest();
  private summing = new Newest();
  private timer = 0;

  async load(folder: string) {
    try {
      const result = await loadResult(folder), points = await loadPoints(folder, result.tracks);
      this.points = points;
      this.take(result);
      this.sum();
    } catch (e) {
      this.trouble = e;
    }
  }
  private take(result: Result) {
    this.result = result;
    this.cuts = result.edits.cut ?? [];
    this.unsaved = false;
  }
  get edits(): Edit[] {
    return this.result?.edits.edit ?? [];
  }
  /** Changes a cut: at once on the page, a little later in the file. */
  cut(cut: Cut) {
    this.cuts = withCut(this.cuts, cut);
    this.unsaved = true;
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.saving.run(() => this.save({ cut: this.cuts, edit: this.edits })), 400);
  }
  edit(edit: Edit) {
    this.saving.run(() => this.save({ cut: this.cuts, edit: [...this.edits, edit] }));
  }
  /** Takes back one edit. */
  takeBack(index: number) {
    this.saving.run(() => this.save({ cut: this.cuts, edit: this.edits.filter((_, i) => i !== index) }));
  }
  private async save(edits: Edits) {
    const before = this.result;
    if (!before) return;
    try {
      const after = await post<EditedTracks>('/api/tracks/edits', { folder: before.folder, revision: before.revision, edits });
      const moved = after.tracks.length !== before.tracks.length || after.tracks.some((t, i) => t.number !== before.tracks[i].number || t.points !== before.tracks[i].points);
      if (moved) this.points = await loadPoints(before.folder, after.tracks);
      const cuts = this.cuts;
      this.take({ ...before, ...after });
      if (cuts !== edits.cut) this.cuts = cuts; // changed in the meantime, saved next
      this.trouble = null;
      this.sum();
    } catch (e) {
      await this.load(before.folder);
      this.trouble = e;
    }
  }
  private sum() {
    this.summing.run(async () => {
      try {
        this.motion = await get(`/api/tracks/edited?${new URLSearchParams({ folder: this.result!.folder })}`);
      } catch (e) {
        this.trouble = e;
      }
    });
  }
}
