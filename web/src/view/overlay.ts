// Overlay on the cells: edge, field, crosses, route, scale bar, clock.

import { swarmColumn } from '../series';
import type { Frame } from '../frame';
import type { Box, Camera } from './camera';
import { correlation, ellipseOf } from './ellipse';

export interface Scene {
  /** um_per_px is null if the scale is not known; the nominal one is then that of the simulation. */
  view: { width: number; height: number; um_per_px: number | null; nominal_um_per_px?: number | null };
  outline: { centre_px: [number, number]; radius_px: number };
  box: Box;
  /** Setpoints in pixels; a route when there are several. */
  setpoints: [number, number][];
}
export interface Layers {
  edge: boolean;
  field: boolean;
  swarm: boolean;
  route: boolean;
  scale: boolean;
}
export interface Marks {
  centroid: [number, number] | null;
  sigma: [number, number] | null;
  setpoint: [number, number] | null;
  /** Requested setpoint without an answer yet. */
  asked: [number, number] | null;
  /** Points of the route in the editor, px. */
  sketch: [number, number][];
  /** Refused setpoint outside the arena. */
  refused?: [number, number] | null;
}
/** The marks of one row of a series; `of` returns the value of a column. */
export function recordedMarks(of: (name: string) => number): Pick<Marks, 'centroid' | 'sigma' | 'setpoint'> {
  const pair = (x: string, y: string): [number, number] | null => (Number.isFinite(of(x)) && Number.isFinite(of(y)) ? [of(x), of(y)] : null);
  const swarm = (quantity: string) => swarmColumn(quantity, (name) => Number.isFinite(of(name)));
  return { centroid: pair(swarm('centroid_x_px'), swarm('centroid_y_px')), sigma: pair(swarm('sigma_x_px'), swarm('sigma_y_px')), setpoint: pair('setpoint_x_px', 'setpoint_y_px') };
}
export interface Palette {
  edge: string;
  outside: string;
  text: string;
  field: string;
  swarm: string;
  target: string;
  wrong: string;
  /** Outline of text, for contrast on any image. */
  halo: string;
}

export class Overlay {
  /** `most`: the word before the maximum of the field; `outside`: the text at a refused setpoint. */
  constructor(
    private g: CanvasRenderingContext2D,
    private most: () => string,
    private outside: () => string = () => '',
  ) {}

  /** `keep`: draws over the present picture of the canvas. */
  draw(scene: Scene, f: Frame | null, camera: Camera, layers: Layers, marks: Marks, p: Palette, ratio: number, keep = false) {
    const g = this.g;
    g.setTransform(1, 0, 0, 1, 0, 0);
    if (!keep) g.clearRect(0, 0, g.canvas.width, g.canvas.height);
    g.lineCap = 'round';
    g.font = `${12 * ratio}px system-ui, sans-serif`;
    if (layers.edge) this.edge(scene, camera, p, ratio);
    if (layers.field && f) this.field(scene, f, camera, p, ratio);
    if (layers.route) this.route(scene, camera, marks, p, ratio);
    if (layers.swarm) this.swarm(f, camera, marks, p, ratio);
    if (marks.refused) this.refused(camera, marks.refused, p, ratio);
    if (layers.scale) this.scaleBar(scene, f, camera, p, ratio);
  }

  // Edge of the arena, and view of the camera; the region outside the view is shaded.
  private edge(scene: Scene, camera: Camera, p: Palette, ratio: number) {
    const g = this.g, w = g.canvas.width, h = g.canvas.height, o = scene.outline;
    const [x0, y0] = camera.toCanvas(-0.5, -0.5);
    const [x1, y1] = camera.toCanvas(scene.view.width - 0.5, scene.view.height - 0.5);
    g.fillStyle = p.outside;
    g.beginPath();
    g.rect(0, 0, w, h);
    g.rect(x0, y0, x1 - x0, y1 - y0);
    g.fill('evenodd');
    g.strokeStyle = p.edge;
    g.lineWidth = ratio;
    g.setLineDash([5 * ratio, 4 * ratio]);
    g.strokeRect(x0, y0, x1 - x0, y1 - y0);
    g.setLineDash([]);
    g.lineWidth = 2 * ratio;
    if (o.radius_px > 0) {
      const [cx, cy] = camera.toCanvas(...o.centre_px);
      g.beginPath();
      g.arc(cx, cy, o.radius_px * camera.scale, 0, 2 * Math.PI);
      g.stroke();
    } else {
      const [a, b] = camera.toCanvas(scene.box.left, scene.box.top);
      const [c, d] = camera.toCanvas(scene.box.right, scene.box.bottom);
      g.strokeRect(a, b, c - a, d - b);
    }
  }

  private field(scene: Scene, f: Frame, camera: Camera, p: Palette, ratio: number) {
    const { columns, rows, xy } = f.field, g = this.g;
    let most = 0;
    for (let i = 0; i < columns * rows; ++i) most = Math.max(most, Math.hypot(xy[2 * i], xy[2 * i + 1]));
    if (!(most > 0)) return;
    g.strokeStyle = g.fillStyle = p.field;
    if (columns * rows === 1) {
      // Homogeneous field: one arrow in the corner, with the field strength.
      const at = 40 * ratio, length = 24 * ratio;
      this.arrow(at, at, (xy[0] / most) * length, (xy[1] / most) * length, 2 * ratio);
      this.words(p, tesla(most), 2 * at, at + 4 * ratio);
      return;
    }
    const cellX = (scene.view.width - 1) / (columns - 1), cellY = (scene.view.height - 1) / (rows - 1);
    const length = 0.42 * Math.min(cellX, cellY) * camera.scale;
    for (let r = 0; r < rows; ++r)
      for (let c = 0; c < columns; ++c) {
        const i = r * columns + c, b = Math.hypot(xy[2 * i], xy[2 * i + 1]);
        if (!(b > 0)) continue;
        // Square root, because the field of coils spans orders of magnitude.
        const k = (length * Math.sqrt(b / most)) / b;
        const [x, y] = camera.toCanvas(c * cellX, r * cellY);
        g.globalAlpha = 0.35 + 0.45 * Math.sqrt(b / most);
        this.arrow(x, y, xy[2 * i] * k, xy[2 * i + 1] * k, ratio);
      }
    g.globalAlpha = 1;
    this.words(p, `${this.most()} ${tesla(most)}`, 12 * ratio, 20 * ratio);
    for (const [x, y] of zeros(f)) {
      const [cx, cy] = camera.toCanvas(x * cellX, y * cellY);
      g.lineWidth = 2 * ratio;
      g.beginPath();
      g.arc(cx, cy, 7 * ratio, 0, 2 * Math.PI);
      g.moveTo(cx - 10 * ratio, cy);
      g.lineTo(cx + 10 * ratio, cy);
      g.moveTo(cx, cy - 10 * ratio);
      g.lineTo(cx, cy + 10 * ratio);
      g.stroke();
    }
  }

  private words(p: Palette, text: string, x: number, y: number) {
    const g = this.g, stroke = g.strokeStyle;
    g.strokeStyle = p.halo;
    g.lineWidth = 0.25 * Number.parseFloat(g.font);
    g.lineJoin = 'round';
    g.strokeText(text, x, y);
    g.strokeStyle = stroke;
    g.fillText(text, x, y);
  }

  private arrow(x: number, y: number, dx: number, dy: number, width: number) {
    const g = this.g, l = Math.hypot(dx, dy);
    if (l < 2) return;
    const head = Math.min(0.4 * l, 5 * width), ux = dx / l, uy = dy / l;
    g.lineWidth = width;
    g.beginPath();
    g.moveTo(x - dx / 2, y - dy / 2);
    g.lineTo(x + dx / 2, y + dy / 2);
    g.lineTo(x + dx / 2 - head * (ux + 0.6 * uy), y + dy / 2 - head * (uy - 0.6 * ux));
    g.moveTo(x + dx / 2, y + dy / 2);
    g.lineTo(x + dx / 2 - head * (ux - 0.6 * uy), y + dy / 2 - head * (uy + 0.6 * ux));
    g.stroke();
  }

  private route(scene: Scene, camera: Camera, marks: Marks, p: Palette, ratio: number) {
    const g = this.g;
    const line = (points: [number, number][], dash: number[]) => {
      if (points.length < 2) return;
      g.setLineDash(dash);
      g.beginPath();
      points.forEach((q, i) => (i ? g.lineTo(...camera.toCanvas(...q)) : g.moveTo(...camera.toCanvas(...q))));
      g.stroke();
      g.setLineDash([]);
    };
    g.strokeStyle = g.fillStyle = p.target;
    g.lineWidth = 1.5 * ratio;
    line(scene.setpoints, []);
    if (scene.setpoints.length > 1)
      for (const q of scene.setpoints) {
        g.beginPath();
        g.arc(...camera.toCanvas(...q), 3 * ratio, 0, 2 * Math.PI);
        g.fill();
      }
    line(marks.sketch, [4 * ratio, 4 * ratio]);
    for (const q of marks.sketch) {
      g.beginPath();
      g.arc(...camera.toCanvas(...q), 4 * ratio, 0, 2 * Math.PI);
      g.stroke();
    }
    if (marks.asked) {
      g.lineWidth = 2 * ratio;
      g.beginPath();
      g.arc(...camera.toCanvas(...marks.asked), 9 * ratio, 0, 2 * Math.PI);
      g.stroke();
    }
    if (marks.setpoint) this.cross(camera.toCanvas(...marks.setpoint), 9 * ratio, 2.5 * ratio);
  }

  private swarm(f: Frame | null, camera: Camera, marks: Marks, p: Palette, ratio: number) {
    if (!marks.centroid) return;
    const g = this.g, at = camera.toCanvas(...marks.centroid);
    g.strokeStyle = p.swarm;
    this.cross(at, 9 * ratio, 2.5 * ratio);
    if (!marks.sigma) return;
    const e = ellipseOf(...marks.sigma, f ? correlation(f) : 0);
    g.lineWidth = 1.5 * ratio;
    g.beginPath();
    g.ellipse(at[0], at[1], e.major * camera.scale, e.minor * camera.scale, e.angle, 0, 2 * Math.PI);
    g.stroke();
  }

  // A crossed ring, at the border of the canvas if the point is outside of it.
  private refused(camera: Camera, at: [number, number], p: Palette, ratio: number) {
    const g = this.g, r = 9 * ratio, margin = 2 * r, [px, py] = camera.toCanvas(...at);
    const x = Math.max(margin, Math.min(g.canvas.width - margin, px)), y = Math.max(margin, Math.min(g.canvas.height - margin, py));
    g.strokeStyle = g.fillStyle = p.wrong;
    g.lineWidth = 2.5 * ratio;
    g.beginPath();
    g.arc(x, y, r, 0, 2 * Math.PI);
    g.moveTo(x - 0.7 * r, y - 0.7 * r);
    g.lineTo(x + 0.7 * r, y + 0.7 * r);
    g.stroke();
    g.textAlign = x > g.canvas.width / 2 ? 'right' : 'left';
    this.words(p, this.outside(), x + (g.textAlign === 'right' ? -1.6 : 1.6) * r, y + 4 * ratio);
    g.textAlign = 'left';
  }

  private cross(at: [number, number], size: number, width: number) {
    const g = this.g;
    g.lineWidth = width;
    g.beginPath();
    g.moveTo(at[0] - size, at[1]);
    g.lineTo(at[0] + size, at[1]);
    g.moveTo(at[0], at[1] - size);
    g.lineTo(at[0], at[1] + size);
    g.stroke();
  }

  private scaleBar(scene: Scene, f: Frame | null, camera: Camera, p: Palette, ratio: number) {
    const g = this.g, known = scene.view.um_per_px, perPixel = camera.scale / (known ?? 1); // canvas px per um, or per image px
    const wanted = (120 * ratio) / perPixel, power = 10 ** Math.floor(Math.log10(wanted));
    const um = [5, 2, 1].map((k) => k * power).find((v) => v <= wanted) ?? power;
    const length = um * perPixel, x = g.canvas.width - 16 * ratio, y = g.canvas.height - 16 * ratio;
    g.fillStyle = p.text;
    g.fillRect(x - length, y, length, 3 * ratio);
    g.textAlign = 'right';
    this.words(p, known === null ? `${um} px` : um >= 1000 ? `${um / 1000} mm` : `${um} µm`, x, y - 6 * ratio);
    g.textAlign = 'left';
    if (f) this.words(p, `${f.t.toFixed(2)} s`, 12 * ratio, g.canvas.height - 14 * ratio);
  }
}

const kTeslas: [number, string][] = [[1e9, 'nT'], [1e6, 'µT'], [1e3, 'mT'], [1, 'T']];

/** Field strength with three digits, in the smallest unit in which it is below 1000. */
export function tesla(b: number): string {
  for (const [k, unit] of kTeslas) {
    const digits = (b * k).toPrecision(3);
    if (Number(digits) < 1000) return `${digits} ${unit}`;
  }
  return `${Math.round(b)} T`;
}

// Zeros of a field that is linear within each triangle of its grid, in columns and rows.
export function zeros(f: Frame): [number, number][] {
  const { columns, rows, xy } = f.field, found: [number, number][] = [];
  const at = (c: number, r: number) => [xy[2 * (r * columns + c)], xy[2 * (r * columns + c) + 1]];
  const triangle = (a: [number, number], b: [number, number], c: [number, number]) => {
    const [fa, fb, fc] = [a, b, c].map((q) => at(q[0], q[1]));
    const m = [fb[0] - fa[0], fc[0] - fa[0], fb[1] - fa[1], fc[1] - fa[1]];
    const det = m[0] * m[3] - m[1] * m[2];
    if (det === 0) return;
    const u = (-fa[0] * m[3] + fa[1] * m[1]) / det, v = (-fa[1] * m[0] + fa[0] * m[2]) / det;
    if (u < 0 || v < 0 || u + v > 1) return;
    const q: [number, number] = [a[0] + u * (b[0] - a[0]) + v * (c[0] - a[0]), a[1] + u * (b[1] - a[1]) + v * (c[1] - a[1])];
    if (!found.some((o) => Math.hypot(o[0] - q[0], o[1] - q[1]) < 0.5)) found.push(q);
  };
  for (let r = 0; r + 1 < rows; ++r)
    for (let c = 0; c + 1 < columns; ++c) {
      triangle([c, r], [c + 1, r], [c, r + 1]);
      triangle([c + 1, r + 1], [c, r + 1], [c + 1, r]);
    }
  return found;
}
