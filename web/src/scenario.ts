// Scenarios as JSON: differences, commands, changes during a run.

type Json = any;

/** Parts that can be exchanged during a run. */
export const kLive = ['controller', 'reference', 'estimator'] as const;

/** Different leaves, as `path=value` for --set; null if --set cannot express the difference and a file is needed. */
export function differences(from: Json, to: Json, path = ''): [string, Json][] | null {
  const out: [string, Json][] = [];
  for (const key of new Set([...Object.keys(from ?? {}), ...Object.keys(to ?? {})])) {
    const a = from?.[key], b = to?.[key], here = path ? `${path}.${key}` : key;
    if (JSON.stringify(a) === JSON.stringify(b)) continue;
    if (b === undefined) return null;
    if (isTable(a) && isTable(b) && a.type === b.type) {
      const below = differences(a, b, here);
      if (!below) return null;
      out.push(...below);
    } else if (Array.isArray(b) && b.some(isTable)) {
      if (!Array.isArray(a) || a.length !== b.length) return null;
      for (let i = 0; i < b.length; ++i) {
        const below = differences(a[i], b[i], `${here}[${i}]`);
        if (!below) return null;
        out.push(...below);
      }
    } else {
      out.push([here, b]);
    }
  }
  return out;
}

const isTable = (v: Json) => typeof v === 'object' && v !== null && !Array.isArray(v);

/** Formats a value as TOML on one line. */
export function inline(v: Json): string {
  if (Array.isArray(v)) return `[${v.map(inline).join(', ')}]`;
  if (isTable(v)) return `{ ${Object.entries(v).map(([k, x]) => `${k} = ${inline(x)}`).join(', ')} }`;
  return JSON.stringify(v);
}

/** A word of a shell command, in quotes if the shell would change it. */
export const quoted = (s: string) => (/^[\w@%+=:,./[\]-]+$/.test(s) && !/[[\]]/.test(s) ? s : `'${s.replaceAll("'", `'\\''`)}'`);

// --set parses TOML values, so a string that is also a TOML value needs quotes. A quantity such as "5 um" does not.
const kQuantity = /^[-+]?[\d.]+(?:[eE][-+]?\d+)? [a-zA-Zµμ%]/;
const isPlain = (s: string) => kQuantity.test(s) || (/^[^\s\d+\-.'"[{#]/.test(s) && !/^(true|false|inf|nan)\b/.test(s));
const setValue = (v: Json) => (typeof v === 'string' && isPlain(v) ? v : inline(v));

/** The place of an error in an event, as a place in the scenario: the model of an event belongs to a swarm. */
export const placeInScenario = (e: Json, where: string) => (where === 'model' || where.startsWith('model.') ? `swarm[${e.swarm ?? 0}].${where}` : where);

/** The equivalent command line; null if a file is needed. */
export function command(file: string, from: Json, to: Json, seed: number): string | null {
  const sets = differences({ ...from, seed: undefined }, { ...to, seed: undefined });
  if (!sets) return null;
  return ['faba run', quoted(file), `--seed ${seed}`, ...sets.map(([p, v]) => `--set ${quoted(`${p}=${setValue(v)}`)}`)].join(' ');
}

/** The events that change a running scenario into another; null if a restart is needed, for example for a removed section. */
export function event(from: Json, to: Json): Json[] | null {
  const events: Json[] = [], parts: Json = {};
  for (const key of new Set([...Object.keys(from), ...Object.keys(to)])) {
    if (key === 'seed' || key === 'event' || JSON.stringify(from[key]) === JSON.stringify(to[key])) continue;
    if (to[key] === undefined) return null;
    if ((kLive as readonly string[]).includes(key)) parts[key] = to[key];
    else if (key === 'swarm' && from.swarm?.length === to.swarm?.length) {
      for (let i = 0; i < to.swarm.length; ++i) {
        const { model: before, ...restBefore } = from.swarm[i], { model: after, ...restAfter } = to.swarm[i];
        if (JSON.stringify(restBefore) !== JSON.stringify(restAfter)) return null;
        if (JSON.stringify(before) !== JSON.stringify(after)) events.push({ swarm: i, model: after });
      }
    } else return null;
  }
  if (Object.keys(parts).length) events.unshift(parts);
  return events;
}

/** The event that restores the parts that an event replaces in a scenario; null if a part is not in the scenario. */
export function reversal(before: Json, e: Json): Json | null {
  const back: Json = {};
  for (const key of Object.keys(e)) {
    if (key === 'swarm') back.swarm = e.swarm;
    else if (key === 'model') back.model = before.swarm?.[e.swarm ?? 0]?.model;
    else back[key] = before[key];
    if (back[key] === undefined) return null;
  }
  return back;
}
