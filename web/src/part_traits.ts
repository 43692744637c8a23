// Finds parts in the JSON Schema of a scenario by traits and properties; the page does not depend on names of parts.

import { variant, variants, type Schema } from './form/schema';

/** Required trait, property, or both. */
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

/** The part used if a scenario does not give the section. */
export const defaultPart = (section: Schema | undefined): string | undefined => typeOf(section?.default);

function matches(part: Schema | undefined, wanted: Wanted): boolean {
  if (!part) return false;
  if (wanted.trait !== undefined && !part['x-traits']?.includes(wanted.trait)) return false;
  return wanted.property === undefined || Object.hasOwn(part.properties ?? {}, wanted.property);
}

/** The first part that matches; undefined if not found. */
export function findPart(section: Schema | undefined, wanted: Wanted): string | undefined {
  if (!section) return undefined;
  return variants(section).find((name) => matches(variant(section, name), wanted));
}

/** Whether the part in `value`, or the default part if undefined, has the trait. */
export function hasTrait(section: Schema | undefined, value: any, trait: string): boolean {
  const type = value === undefined ? defaultPart(section) : typeOf(value);
  return section !== undefined && type !== undefined && matches(variant(section, type), { trait });
}

/** Whether a part of a section has a property. */
export const hasProperty = (section: Schema | undefined, type: string | undefined, property: string) =>
  section !== undefined && type !== undefined && matches(variant(section, type), { property });

/** Whether a controller is open-loop: a schedule or manual control. */
export const isOpenLoop = (schema: Schema | null, controller: any) => hasTrait(sectionOf(schema, 'controller'), controller, 'open_loop');

/** The controller for manual control of the field. */
export const handController = (schema: Schema | null) => findPart(sectionOf(schema, 'controller'), { trait: 'open_loop', property: 'field' });

/** The controller that keeps the swarm away from obstacles. */
export const obstacleController = (schema: Schema | null) => findPart(sectionOf(schema, 'controller'), { property: 'obstacle' });

/** The reference with a curve through points. */
export const curveReference = (schema: Schema | null) => findPart(sectionOf(schema, 'reference'), { property: 'points_px' });

/** The reference with one setpoint. */
export const setpointReference = (schema: Schema | null) => findPart(sectionOf(schema, 'reference'), { property: 'setpoint_px' });

/** The reference with a list of setpoints. */
export const routeReference = (schema: Schema | null) => findPart(sectionOf(schema, 'reference'), { property: 'setpoints_px' });
