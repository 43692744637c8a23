// Drawing on the picture by pointer and keyboard: obstacles of the controller, and the path of the reference.

import { partTable } from './form/schema';
import type { Word } from './i18n';
import type { Lab } from './lab.svelte';
import { curveReference, hasProperty, obstacleController, sectionOf, typeOf } from './part_traits';
import type { Steering } from './steering.svelte';
import { crossesItself, polygonAt, type Point } from './view/polygon';

export type Tool = 'obstacle' | 'path';
const kLeastCorners = 3, kLeastPoints = 2;
const kStep = 10, kFineStep = 1; // px, of the cross-hair
const kArrows: Record<string, Point> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

const rounded = ([x, y]: Point): Point => [Math.round(x * 10) / 10, Math.round(y * 10) / 10];
const distance = (a: Point, b: Point) => Math.hypot(a[0] - b[0], a[1] - b[1]);

/** The polygons in px of a controller in a scenario. */
export const polygonsOf = (controller: any): Point[][] => (controller?.obstacle ?? []).map((o: any) => o.corners_px as Point[]);

export class Drawing {
  tool = $state.raw<Tool | null>(null);
  /** Corners of the obstacle that is drawn, px. */
  corners = $state.raw<Point[]>([]);
  /** The cross-hair that the arrow keys move, px. */
  cursor = $state.raw<Point | null>(null);
  /** Index of the selected obstacle. */
  selected = $state.raw<number | null>(null);
  /** Why the figure was not completed. */
  problem = $state.raw<Word | null>(null);
  /** A path is one curve, if the program has a reference for it; otherwise separate setpoints. */
  asCurve = $state(true);
  /** A complete obstacle that the present controller would not avoid: the page asks. */
  waiting = $state.raw<Point[] | null>(null);

  constructor(
    private lab: Lab,
    private steering: Steering,
  ) {}

  /** Whether the program has a controller that avoids obstacles. */
  get mayAvoid() {
    return obstacleController(this.lab.schema) !== undefined;
  }
  /** The points of the present figure. */
  get points(): Point[] {
    return this.tool === 'path' ? this.steering.sketch : this.corners;
  }
  /** Whether the newest point is in the upper half of the view. */
  get isHigh(): boolean {
    const at = this.cursor ?? this.points.at(-1);
    return at !== undefined && at[1] < (this.lab.scene?.view.height ?? 0) / 2;
  }
  begin() {
    this.end();
    this.waiting = null;
  }
  start(tool: Tool) {
    this.begin();
    this.tool = tool;
  }
  private end() {
    this.tool = this.cursor = this.selected = this.problem = null;
    this.corners = [];
  }
  /** Discards the figure. */
  cancel() {
    if (this.tool === 'path') this.steering.sketch = [];
    this.begin();
  }

  /** Adds a point, or selects the obstacle there. `reach`: distance within which two points are the same, px. */
  place(at: Point, reach = 0.5) {
    const points = this.points, last = points.at(-1);
    this.problem = null;
    if (last && distance(last, at) < reach) return; // the second click of a double click
    if (this.tool === 'path') return this.steering.point(at, null);
    if (points.length >= kLeastCorners && distance(points[0], at) < reach) return void this.finish();
    const hit = points.length ? null : polygonAt(polygonsOf(this.lab.scenario.controller), at);
    this.selected = hit;
    if (hit === null) this.corners = [...points, rounded(at)];
  }
  removeLast() {
    if (this.tool === 'path') this.steering.sketch = this.steering.sketch.slice(0, -1);
    else this.corners = this.corners.slice(0, -1);
    this.problem = null;
  }
  async finish() {
    const points = this.points;
    if (this.tool === 'path') {
      if (points.length < kLeastPoints) return void (this.problem = 'draw.few_points');
      if (await this.steering.route(this.asCurve && curveReference(this.lab.schema) !== undefined)) this.end();
      return;
    }
    if (points.length < kLeastCorners) return void (this.problem = 'draw.few_corners');
    if (crossesItself(points)) return void (this.problem = 'draw.crosses');
    this.end();
    await this.add(points);
  }

  // The present controller, or that before manual control, with the estimator; null if it does not avoid obstacles.
  private avoiding(): Record<string, any> | null {
    const parts: Record<string, any> = this.steering.feedback();
    const controller = partTable(parts.controller ?? this.lab.scenario.controller);
    return hasProperty(sectionOf(this.lab.schema, 'controller'), controller.type, 'obstacle') ? { ...parts, controller } : null;
  }
  private async add(corners: Point[]) {
    const parts = this.avoiding();
    if (!parts) return void (this.waiting = corners);
    await this.lab.exchange({ ...parts, controller: { ...parts.controller, obstacle: [...(parts.controller.obstacle ?? []), { corners_px: corners }] } });
  }
  /** Replaces the controller by one that avoids the obstacle that waits, with its default values: those of another law need not suit it. */
  async switchController() {
    const type = obstacleController(this.lab.schema), corners = this.waiting;
    if (type === undefined || !corners) return;
    this.waiting = null;
    await this.lab.exchange({ ...this.steering.feedback(), controller: { type, obstacle: [{ corners_px: corners }] } });
  }
  async remove(index: number) {
    const controller = this.lab.scenario.controller;
    if (typeOf(controller) === undefined || !controller.obstacle?.[index]) return;
    this.selected = null;
    await this.lab.exchange({ controller: { ...controller, obstacle: controller.obstacle.filter((_: unknown, i: number) => i !== index) } });
  }

  private move(by: Point, fine: boolean) {
    const scene = this.lab.scene;
    if (!scene) return;
    const { box, view } = scene, step = fine ? kFineStep : kStep;
    const [x, y] = this.cursor ?? this.points.at(-1) ?? [view.width / 2, view.height / 2];
    this.cursor = [Math.min(box.right, Math.max(box.left, x + step * by[0])), Math.min(box.bottom, Math.max(box.top, y + step * by[1]))];
  }
  /** A key while a tool is active; returns whether the tool uses it. */
  key(e: Pick<KeyboardEvent, 'key' | 'shiftKey' | 'ctrlKey' | 'metaKey' | 'altKey'>): boolean {
    if (!this.tool || e.ctrlKey || e.metaKey || e.altKey) return false;
    const arrow = kArrows[e.key];
    if (arrow) this.move(arrow, e.shiftKey);
    else if (e.key === ' ') this.cursor ? this.place(this.cursor) : this.move([0, 0], true);
    else if (e.key === 'Enter') void this.finish();
    else if (e.key === 'Escape') this.cancel();
    else if (e.key === 'Backspace') this.removeLast();
    else if (e.key === 'Delete' && this.selected !== null) void this.remove(this.selected);
    else return false;
    return true;
  }
}
