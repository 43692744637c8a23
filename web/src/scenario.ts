// A scenario as JSON: differences, commands, what can change while it runs.

type Json = any;

/** Parts that may be exchanged while a run goes on. */
export const kLive = ['controller', 'reference', 'estimator'] as const;

/** Leaves that differ, as `path=value` of --set; null when a list has another length: then only a file will do. */
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

/** As TOML has it on one line. */
export function inline(v: Json): string {
  if (Array.isArray(v)) return `[${v.map(inline).join(', ')}]`;
  if (isTable(v)) return `{ ${Object.entries(v).map(([k, x]) => `${k} = ${inline(x)}`).join(', ')} }`;
  return JSON.stringify(v);
}

const quoted = (s: string) => (/^[\w@%+=:,./[\]-]+$/.test(s) && !/[[\]]/.test(s) ? s : `'${s.replaceAll("'", `'\\''`)}'`);

// --set takes whatever is a TOML value as that value, so a string that could be one needs quotes. A quantity such as "5 um" is none.
const kQuantity = /^[-+]?[\d.]+(?:[eE][-+]?\d+)? [a-zA-Zµμ%]/;
const isPlain = (s: string) => kQuantity.test(s) || (/^[^\s\d+\-.'"[{#]/.test(s) && !/^(true|false|inf|nan)\b/.test(s));
const setValue = (v: Json) => (typeof v === 'string' && isPlain(v) ? v : inline(v));

/** The line that does the same in a terminal; null when it takes a file of its own. */
export function command(file: string, from: Json, to: Json, seed: number): string | null {
  const sets = differences({ ...from, seed: undefined }, { ...to, seed: undefined });
  if (!sets) return null;
  return ['faba run', quoted(file), `--seed ${seed}`, ...sets.map(([p, v]) => `--set ${quoted(`${p}=${setValue(v)}`)}`)].join(' ');
}

/** The events that take one scenario to another while it runs; null when only a restart does, as when a section is removed. */
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
