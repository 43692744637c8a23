// The command of the program that gives the state hash of a run.

import type { HashNews } from '../lab.svelte';
import { command } from '../scenario';

type Scenario = Record<string, any>;

const kDigits = 9; // of a duration: enough to find its frame

/** The command for a run of `scenario`, which was a scene of a file; null if the scenario must be saved as a file. */
export function reproduction(origin: { file: string; scenario: Scenario }, scenario: Scenario, seed: number, hash: HashNews): string | null {
  // The scenario of a run has no events: they are those of the file, unless the form has replaced the scenario.
  const line = command(origin.file, { ...origin.scenario, event: undefined }, { ...scenario, event: undefined }, seed);
  if (!line || (origin.scenario.event?.length && line.includes(' --set '))) return null;
  const duration = hash.end ? '' : ` --duration '${Number(hash.t.toPrecision(kDigits))} s'`;
  return `${line}${duration} --json`;
}
