// The values of the simple panel, found in the schema by property and role: the panel works for parts that the page does not know.

import { partTable, variant, type Schema } from './schema';

/** A value of the panel: its key and schema in the table of a part. */
export interface Found {
  key: string;
  schema: Schema;
}

/** The values of the selected part that the panel shows: the first of the roles and properties that it has, of each group. */
export function found(section: Schema | undefined, value: any, wanted: { role?: string; property?: string }[]): Found[] {
  const type = partTable(value).type || (typeof section?.default === 'string' ? section.default : partTable(section?.default).type);
  const properties = (section && variant(section, type)?.properties) ?? {};
  return wanted.flatMap(({ role, property }) => {
    const key = property ?? Object.keys(properties).find((k) => properties[k]['x-role'] === role);
    return key !== undefined && Object.hasOwn(properties, key) ? [{ key, schema: properties[key] }] : [];
  });
}

/** Speed of a model, as it defines it. */
export const kSpeed = [{ role: 'speed' }];
/** Size of an arena. */
export const kSize = [{ property: 'radius_px' }, { property: 'size_px' }];
/** Field of a manual controller. */
export const kManual = [{ property: 'field' }];
/** Setpoints of a reference. */
export const kTarget = [{ property: 'setpoint_px' }, { property: 'setpoints_px' }];
/** Files of a recording. */
export const kRecorded = ['video', 'tracks', 'as_seen', 'flow'];

/** A part with one changed value; undefined: the default. */
export function changed(value: any, key: string, to: any): Record<string, any> {
  const next = { ...partTable(value) };
  if (to === undefined) delete next[key];
  else next[key] = to;
  return next;
}
