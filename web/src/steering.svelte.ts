// Manual control: field by pointer, keys and gamepad; setpoints and routes.

import { Drawing } from './drawing.svelte';
import { amount } from './form/schema';
import type { Lab } from './lab.svelte';
import type { Scene } from './view/overlay';
import { curveReference, defaultPart, handController, isOpenLoop, routeReference, sectionOf, setpointReference } from './part_traits';

export const kWeakest = 5e-6, kStrongest = 5e-3; // T

const rounded = ([x, y]: [number, number]): [number, number] => [Math.round(x * 10) / 10, Math.round(y * 10) / 10];

/** Whether a point in pixels is in the view of the camera; (0, 0) is the centre of the first pixel. */
export const inView = ([x, y]: [number, number], view: { width: number; height: number }) => x >= -0.5 && y >= -0.5 && x < view.width - 0.5 && y < view.height - 0.5;

/** Whether a point in pixels is in the arena: in its circle, or in its box if it has no circular edge. */
export const inArena = ([x, y]: [number, number], { outline: o, box: b }: Pick<Scene, 'outline' | 'box'>) =>
  o.radius_px > 0 ? Math.hypot(x - o.centre_px[0], y - o.centre_px[1]) <= o.radius_px : x >= b.left && x <= b.right && y >= b.top && y <= b.bottom;

export class Steering {
  /** Field strength at full deflection, T. */
  strength = $state(115e-6);
  /** Points of the route in the editor, px. */
  sketch = $state.raw<[number, number][]>([]);
  /** Present swimming direction under manual control, image axes, length 0 to 1. */
  direction = $state.raw<[number, number]>([0, 0]);
  /** Requested setpoint without an answer yet, px. */
  asked = $state.raw<[number, number] | null>(null);
  /** The first requested setpoint outside the camera view, and the size of the view, px; the page shows a note. */
  outside = $state.raw<{ x: number; y: number; width: number; height: number } | null>(null);
  /** The setpoint that was refused because it is outside the arena, px; it is marked on the picture and at its control. */
  unreachable = $state.raw<{ x: number; y: number } | null>(null);
  /** Controller and estimator before manual control. */
  private before: Record<string, any> | null = null;
  readonly drawing: Drawing;
  private sending = false;
  private wanted: [number, number] | null = null;

  constructor(private lab: Lab) {
    this.drawing = new Drawing(lab, this);
  }

  /** Whether the present controller is open-loop, without feedback. */
  get byHand() {
    return isOpenLoop(this.lab.schema, this.lab.scenario.controller);
  }
  /** Whether the program has parts for manual control, setpoints and routes. False without a schema. */
  get mayPull() {
    return handController(this.lab.schema) !== undefined;
  }
  get mayHold() {
    return setpointReference(this.lab.schema) !== undefined;
  }
  get mayRoute() {
    return routeReference(this.lab.schema) !== undefined;
  }

  /** A drag in the image, px: a third of the view height is full deflection. */
  drag(pull: [number, number] | null) {
    if (!pull) return; // the field does not change at the end of a drag
    const size = (this.lab.scene?.view.height ?? 480) / 3, l = Math.hypot(...pull) / size;
    const k = l > 1 ? 1 / (l * size) : 1 / size;
    this.pull([pull[0] * k, pull[1] * k]);
  }
  /** While a request is pending, only the newest direction is kept. */
  pull(direction: [number, number]) {
    const hand = handController(this.lab.schema);
    if (hand === undefined) return;
    this.direction = direction;
    this.wanted = direction;
    if (!this.sending) void this.send(hand);
  }
  private async send(hand: string) {
    this.sending = true;
    if (!this.byHand) {
      const { controller, estimator } = this.lab.scenario;
      this.before = { controller, ...(estimator ? { estimator } : {}) };
    }
    while (this.wanted) {
      const [x, y] = this.wanted;
      this.wanted = null;
      // The field is along the swimming direction for north-seeking cells and against it for south-seeking cells. The
      // world y axis points up.
      const b = this.strength * this.lab.polarity;
      await this.lab.exchange({ controller: { type: hand, field: [`${(b * x).toPrecision(6)} T`, `${(-b * y).toPrecision(6)} T`] } });
    }
    this.sending = false;
  }
  stop() {
    this.pull([0, 0]);
  }
  /** Field reversal. */
  reverse() {
    this.pull([-this.direction[0], -this.direction[1]]);
  }

  /** Resets the state for a new run. */
  begin() {
    this.direction = [0, 0];
    this.sketch = [];
    this.drawing.begin();
    this.before = null;
    this.outside = this.unreachable = null;
  }
  /** Whether setpoints can be sent: all are in the arena. Those outside the camera view are reported only. */
  private accepts(points: [number, number][]): boolean {
    const scene = this.lab.scene, view = scene?.view;
    const beyond = scene && points.find((q) => !inArena(q, scene));
    this.unreachable = beyond ? { x: beyond[0], y: beyond[1] } : null;
    const unseen = beyond ? undefined : view && points.find((q) => !inView(q, view));
    this.outside = view && unseen ? { x: unseen[0], y: unseen[1], width: view.width, height: view.height } : null;
    return !beyond;
  }

  /** Parts that replace manual control: those before it, or the default controller. */
  feedback(): Record<string, any> {
    if (!this.byHand) return {};
    return this.before ?? { controller: { type: defaultPart(sectionOf(this.lab.schema, 'controller')) } };
  }
  async goal(at: [number, number]) {
    const type = setpointReference(this.lab.schema);
    if (type === undefined) return;
    const setpoint_px = rounded(at);
    if (!this.accepts([setpoint_px])) return;
    this.direction = [0, 0];
    this.asked = at;
    await this.lab.exchange({ ...this.feedback(), reference: { type, setpoint_px } });
    if (this.asked === at) this.asked = null;
  }
  point(at: [number, number], index: number | null) {
    const q = rounded(at);
    if (!this.accepts([q])) return;
    this.sketch = index === null ? [...this.sketch, q] : this.sketch.map((p, i) => (i === index ? q : p));
  }
  /** Sends the points of the editor, as separate setpoints or as one curve; returns whether the program accepted them. */
  async route(asCurve = false): Promise<boolean> {
    const type = asCurve ? curveReference(this.lab.schema) : routeReference(this.lab.schema);
    if (type === undefined || !this.accepts(this.sketch)) return false;
    const a = await this.lab.exchange({ ...this.feedback(), reference: { type, [asCurve ? 'points_px' : 'setpoints_px']: this.sketch } });
    if (a.ok) this.sketch = [];
    return a.ok;
  }

  /** Undoes the newest change; the direction is then that of the manual field, or none. */
  async undo() {
    await this.lab.undo();
    const field = this.byHand ? (this.lab.scenario.controller?.field ?? []) : [];
    const [x, y] = [0, 1].map((k) => ((amount(field[k], 'T') ?? 0) / this.strength) * this.lab.polarity);
    this.direction = [x || 0, -y || 0];
    this.wanted = null;
  }

  private keys = new Set<string>();
  /** Arrow keys; returns whether the key was one of them. */
  key(e: KeyboardEvent, down: boolean): boolean {
    if (!e.key.startsWith('Arrow')) return false;
    if (down === this.keys.has(e.key)) return true;
    if (down) this.keys.add(e.key);
    else this.keys.delete(e.key);
    const on = (k: string) => (this.keys.has(k) ? 1 : 0);
    const x = on('ArrowRight') - on('ArrowLeft'), y = on('ArrowDown') - on('ArrowUp'), l = Math.hypot(x, y) || 1;
    this.pull([x / l, y / l]);
    return true;
  }
  private stick: [number, number] = [0, 0];
  /** Reads the left stick of the first gamepad; called periodically. */
  poll() {
    const pad = navigator.getGamepads?.().find((g) => g?.connected);
    if (!pad) return;
    const dead = (v: number) => (Math.abs(v) < 0.15 ? 0 : v);
    const s: [number, number] = [dead(pad.axes[0] ?? 0), dead(pad.axes[1] ?? 0)], l = Math.max(1, Math.hypot(...s));
    if (Math.hypot(s[0] - this.stick[0], s[1] - this.stick[1]) < 0.03) return;
    this.stick = s;
    this.pull([s[0] / l, s[1] / l]);
  }
}
