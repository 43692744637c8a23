// Finds parts in the JSON Schema of a scenario by their traits and properties, so that the page knows no part by its name.

import { variant, variants, type Schema } from './form/schema';

/** What a part must have: a trait, a property, or both. */
export interface Wanted {
  trait?: string;
  property?: string;
}

/** The schema of a section such as "controller"; it has one variant for each part. */
export const sectionOf = (schema: Schema | null, kind: string): Schema | undefined => schema?.properties?.[kind];

/** The type of a part as a scenario gives it: `controller = "x"` is short for `controller = { type = "x" }`. */
export function typeOf(value: any): string | undefined {
  const type = typeof value === 'string' ? value : value?.type;
  return typeof type === 'string' ? type : undefined;
}

/** The part that the program takes when a scenario does not give the section. */
export const defaultPart = (section: Schema | undefined): string | undefined => typeOf(section?.default);

function matches(part: Schema | undefined, wanted: Wanted): boolean {
  if (!part) return false;
  if (wanted.trait !== undefined && !part['x-traits']?.includes(wanted.trait)) return false;
  return wanted.property === undefined || Object.hasOwn(part.properties ?? {}, wanted.property);
}

/** The first part that has everything that is wanted; undefined when there is none. */
export function findPart(section: Schema | undefined, wanted: Wanted): string | undefined {
  if (!section) return undefined;
  return variants(section).find((name) => matches(variant(section, name), wanted));
}

/** Whether the part in `value`, or the default when the scenario gives none, has the trait. */
export function hasTrait(section: Schema | undefined, value: any, trait: string): boolean {
  const type = value === undefined ? defaultPart(section) : typeOf(value);
  return section !== undefined && type !== undefined && matches(variant(section, type), { trait });
}

/** Whether a controller follows a schedule or the hand, without feedback. */
export const isOpenLoop = (schema: Schema | null, controller: any) => hasTrait(sectionOf(schema, 'controller'), controller, 'open_loop');

/** The controller that applies the field which the hand gives. */
export const handController = (schema: Schema | null) => findPart(sectionOf(schema, 'controller'), { trait: 'open_loop', property: 'field' });

/** The reference with one setpoint. */
export const setpointReference = (schema: Schema | null) => findPart(sectionOf(schema, 'reference'), { property: 'setpoint_px' });

/** The reference with a list of setpoints. */
export const routeReference = (schema: Schema | null) => findPart(sectionOf(schema, 'reference'), { property: 'setpoints_px' });
