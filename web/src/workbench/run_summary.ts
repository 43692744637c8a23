// Models and controller of a scenario, as named in the header of the workbench.

import { presetState, variant, type Schema } from '../form/schema';
import type { Say } from '../i18n';
import { defaultPart, handController, isOpenLoop, sectionOf, typeOf } from '../part_traits';
import { lengthText, type LengthUnit } from '../units';

export interface ModelName {
  type: string;
  preset?: string;
}

/** The different models of the swarms, with their presets. */
export function modelsOf(schema: Schema | null, scenario: any): ModelName[] {
  const section = schema?.properties?.swarm?.items?.properties?.model;
  const all: ModelName[] = (scenario.swarm ?? []).map(({ model }: any) => {
    const type = typeOf(model) ?? defaultPart(section), table = typeof model === 'object' ? model : {};
    const preset = type && section ? presetState(variant(section, type), table).preset : '';
    return { type: type ?? '–', ...(preset ? { preset } : {}) };
  });
  return all.filter((m, i) => all.findIndex((o) => o.type === m.type && o.preset === m.preset) === i);
}

/** The controller in charge: manual control of the field, another schedule without feedback, or feedback. */
export function controllerInCharge(schema: Schema | null, scenario: any): { kind: 'by_hand' | 'schedule' | 'feedback'; name: string } {
  const name = typeOf(scenario.controller) ?? defaultPart(sectionOf(schema, 'controller')) ?? '–';
  if (!isOpenLoop(schema, scenario.controller)) return { kind: 'feedback', name };
  return { kind: name === handController(schema) ? 'by_hand' : 'schedule', name };
}

/** Why a setpoint outside the arena, px, was refused. */
export const unreachableText = ({ x, y }: { x: number; y: number }, unit: LengthUnit, say: Say) =>
  say('steer.unreachable', { x: lengthText(x, unit), y: lengthText(y, unit), unit: unit.name });
