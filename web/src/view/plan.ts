// What the controller intends, on the picture: predicted path, error of the estimated centroid, obstacles; and the drawing tool.

import type { Frame } from '../frame';
import type { Camera } from './camera';
import { ellipseOfCovariance, kSigmas95 } from './ellipse';
import type { Palette } from './overlay';
import { middle, type Point } from './polygon';

export interface PlanLayers {
  plan: boolean;
  error: boolean;
  obstacles: boolean;
}
/** Obstacles of the controller and the distance that the swarm keeps from them, px. */
export interface Obstacles {
  polygons: Point[][];
  clearance: number;
  selected: number | null;
}
/** Corners of the obstacle that is drawn, and the cross-hair of the keyboard, px. */
export interface ToolMarks {
  corners: Point[];
  cursor: Point | null;
}
export interface PlanTexts {
  error: () => string;
  horizon: (s: number) => string;
}

/** Draws on a picture of the canvas with `ratio` device pixels per CSS pixel. */
export class PlanOverlay {
  constructor(
    private g: CanvasRenderingContext2D,
    private camera: Camera,
    private texts: PlanTexts,
  ) {}

  draw(f: Frame | null, obstacles: Obstacles, tool: ToolMarks | null, layers: PlanLayers, p: Palette, ratio: number) {
    if (layers.obstacles) obstacles.polygons.forEach((polygon, i) => this.obstacle(polygon, i, obstacles, p, ratio));
    if (layers.plan && f?.plan) this.path(f.plan.path, f.plan.step, p, ratio);
    if (layers.error && f?.estimate) this.error(f.estimate, p, ratio);
    if (tool) this.tool(tool, p, ratio);
  }

  private trace(points: Point[], closed: boolean) {
    this.g.beginPath();
    points.forEach((q, i) => (i ? this.g.lineTo(...this.camera.toCanvas(...q)) : this.g.moveTo(...this.camera.toCanvas(...q))));
    if (closed) this.g.closePath();
  }
  private words(text: string, x: number, y: number, colour: string, p: Palette) {
    const g = this.g;
    g.lineJoin = 'round';
    g.lineWidth = 0.25 * Number.parseFloat(g.font);
    g.strokeStyle = p.halo;
    g.strokeText(text, x, y);
    g.fillStyle = colour;
    g.fillText(text, x, y);
  }

  // The points within a distance of a polygon are a stroke of twice this width with round corners.
  private obstacle(polygon: Point[], index: number, { clearance, selected }: Obstacles, p: Palette, ratio: number) {
    const g = this.g;
    this.trace(polygon, true);
    g.lineJoin = 'round';
    g.strokeStyle = g.fillStyle = p.wrong;
    g.globalAlpha = 0.15;
    g.lineWidth = 2 * clearance * this.camera.scale;
    if (clearance > 0) g.stroke();
    g.globalAlpha = 0.3;
    g.fill();
    g.globalAlpha = 1;
    g.lineWidth = (index === selected ? 4 : 2) * ratio;
    g.stroke();
    const [x, y] = this.camera.toCanvas(...middle(polygon));
    g.textAlign = 'center';
    this.words(String(index + 1), x, y + 4 * ratio, p.text, p);
    g.textAlign = 'left';
  }

  // A dot for each predicted position; a ring at the horizon.
  private path(path: Point[], step: number, p: Palette, ratio: number) {
    if (!path.length) return;
    const g = this.g;
    this.trace(path, false);
    g.lineJoin = 'round';
    for (const [colour, width] of [[p.halo, 5], [p.text, 2]] as const) {
      g.strokeStyle = colour;
      g.lineWidth = width * ratio;
      g.setLineDash([0.1, 4.5 * ratio]);
      g.stroke();
    }
    g.setLineDash([]);
    const [x, y] = this.camera.toCanvas(...path[path.length - 1]);
    g.beginPath();
    g.arc(x, y, 5 * ratio, 0, 2 * Math.PI);
    g.stroke();
    this.words(this.texts.horizon(step * (path.length - 1)), x + 9 * ratio, y - 7 * ratio, p.text, p);
  }

  private error({ at, cov }: NonNullable<Frame['estimate']>, p: Palette, ratio: number) {
    const g = this.g, e = ellipseOfCovariance(cov, kSigmas95), [x, y] = this.camera.toCanvas(...at), k = this.camera.scale;
    g.beginPath();
    g.ellipse(x, y, e.major * k, e.minor * k, e.angle, 0, 2 * Math.PI);
    for (const [colour, width] of [[p.halo, 4], [p.text, 1.8]] as const) {
      g.strokeStyle = colour;
      g.lineWidth = width * ratio;
      g.stroke();
    }
    g.textAlign = 'right';
    const text = this.texts.error(), least = g.measureText(text).width + 6 * ratio; // not beyond the left edge
    this.words(text, Math.max(least, x - e.major * k - 8 * ratio), y - e.minor * k - 8 * ratio, p.text, p);
    g.textAlign = 'left';
  }

  private tool({ corners, cursor }: ToolMarks, p: Palette, ratio: number) {
    const g = this.g;
    g.strokeStyle = g.fillStyle = p.wrong;
    g.lineWidth = 2 * ratio;
    g.setLineDash([4 * ratio, 4 * ratio]);
    this.trace(cursor ? [...corners, cursor] : corners, false);
    g.stroke();
    g.setLineDash([]);
    for (const q of corners) {
      g.beginPath();
      g.arc(...this.camera.toCanvas(...q), 4 * ratio, 0, 2 * Math.PI);
      g.fill();
    }
    if (!cursor) return;
    const [x, y] = this.camera.toCanvas(...cursor), r = 12 * ratio;
    g.strokeStyle = p.text;
    g.beginPath();
    for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
      g.moveTo(x + (r / 3) * dx, y + (r / 3) * dy);
      g.lineTo(x + r * dx, y + r * dy);
    }
    g.stroke();
  }
}
