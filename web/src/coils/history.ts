// Undo and redo: the states before and after the present one. A gesture, such as a drag, is one step.

const kMost = 100;

export class History<T> {
  private past: T[] = [];
  private future: T[] = [];
  /** The state at the start of the present gesture. */
  private open: { state: T } | null = null;

  get canUndo() {
    return this.past.length > 0;
  }
  get canRedo() {
    return this.future.length > 0;
  }
  /** A gesture begins at this state. */
  begin(now: T) {
    this.open ??= { state: now };
  }
  /** The gesture ends; a gesture without a change is not recorded. */
  end(now: T) {
    const before = this.open;
    this.open = null;
    if (before && before.state !== now) this.step(before.state);
  }
  /** A change outside of a gesture. */
  step(before: T) {
    if (this.open) return;
    this.past = [...this.past, before].slice(-kMost);
    this.future = [];
  }
  undo(now: T): T {
    const to = this.past.pop();
    if (to === undefined) return now;
    this.future.push(now);
    return to;
  }
  redo(now: T): T {
    const to = this.future.pop();
    if (to === undefined) return now;
    this.past.push(now);
    return to;
  }
}
