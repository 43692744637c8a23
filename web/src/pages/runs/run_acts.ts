// What can be done with a recorded run; the page of the runs provides it to its parts.

export interface RunActs {
  /** This page may change runs. */
  may: boolean;
  /** The run whose curves the live plots show. */
  pinned: string | null;
  pin: (name: string | null) => void;
  /** Starts its scenario in the lab. */
  again: (name: string) => void;
  /** Asks, then deletes. */
  remove: (names: string[]) => void;
  /** Returns an error message, or nothing. */
  rename: (name: string, to: string) => Promise<string>;
  tag: (name: string, tags: string[], note: string) => Promise<string>;
}
