// What the console reads of the open scene, and the parts of the console.

import { amount, degrees } from '../form/schema';
import type { Say } from '../i18n';
import { programText } from '../text';
import { flipped } from '../video/angles';
import type { ResponseForm } from './schedule';

export const kParts = ['camera', 'capture', 'response', 'run', 'jog', 'scale', 'assistant'] as const;
export type BenchPart = (typeof kParts)[number];
/** The part that an address names; without a known name, the camera. */
export const partOf = (name: string | undefined): BenchPart => kParts.find((p) => p === name) ?? 'camera';

/** A scene as the program sends it. */
export interface BenchScene {
  name: string;
  toml: string;
  /** Resolved. */
  scenario: any;
}

/** The values of `[rig.step_response]`; directions of a scene count clockwise. */
export function responseDefaults(scenario: any): Partial<ResponseForm> {
  const r = scenario.rig?.step_response ?? {}, out: Partial<ResponseForm> = {};
  const text = (v: any, unit: string, factor = 1) => {
    const value = amount(v, unit);
    return value === null ? undefined : String(Number((value * factor).toPrecision(6)));
  };
  const direction = degrees(r.direction);
  const values = { repeat: r.repeat === undefined ? undefined : String(r.repeat), every: text(r.every, 's'), field: text(r.field, 'T', 1e6), gather: text(r.gather, 's'), before: text(r.before, 's'), record: text(r.record, 's'), direction: direction === undefined ? undefined : flipped(direction) };
  for (const [key, v] of Object.entries(values)) if (v !== undefined) Object.assign(out, { [key]: v });
  return out;
}

/** One sentence about the control loop: the controller, and the setpoint if it is fixed. */
export function controlText(scenario: any, say: Say): string {
  const controller = scenario.controller?.type ?? scenario.controller, at = scenario.reference?.setpoint_px;
  if (!controller) return '';
  const name = programText(String(controller), say);
  return at ? say('bench.run.setpoint', { controller: name, x: at[0], y: at[1] }) : say('bench.run.controller', { controller: name });
}
