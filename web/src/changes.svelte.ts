// The changes that this page made to a run, so that they can be undone in reverse order.

import { typeOf } from './part_traits';
import { reversal } from './scenario';

type Event = Record<string, any>;
interface Change {
  /** The event that undoes the change; null if a part cannot be restored. */
  back: Event | null;
  event: Event;
  at: number;
}

const kStream = 1000; // ms; changes of the field that follow one another faster are one change: a drag

export class Changes {
  private made = $state.raw<Change[]>([]);

  /** Whether the newest change can be undone. */
  get possible() {
    return this.made.at(-1)?.back != null;
  }
  clear() {
    this.made = [];
  }
  /** Adds an event that was accepted; `before`: the scenario before it. */
  add(before: any, event: Event, now = performance.now()) {
    const last = this.made.at(-1);
    if (last && now - last.at < kStream && sameController(last.event, event)) this.made = [...this.made.slice(0, -1), { ...last, at: now }];
    else this.made = [...this.made, { back: reversal(before, event), event, at: now }];
  }
  /** The event that undoes the newest change. */
  get back(): Event | null {
    return this.made.at(-1)?.back ?? null;
  }
  /** Removes the newest change, which was undone. */
  removeNewest() {
    this.made = this.made.slice(0, -1);
  }
}

// Two values of one controller and of nothing else, such as the fields of a drag; obstacles are drawn one by one.
function sameController(a: Event, b: Event): boolean {
  const only = (e: Event) => (Object.keys(e).length === 1 ? typeOf(e.controller) : undefined);
  const obstacles = (e: Event) => JSON.stringify(e.controller.obstacle);
  return only(a) !== undefined && only(a) === only(b) && obstacles(a) === obstacles(b);
}
