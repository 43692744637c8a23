// Drawing of a frame, the overlays, and the marks on a canvas.

import type { Camera } from '../view/camera';
import { unitVector } from './angles';
import { segmentAt, type Point, type Region, type VideoMarks } from './marks';
import { ellipseOf, itemAt, lastNotAfter, type OverlayName, type VideoOverlays } from './overlays';
import type { Picture } from './pictures';

export interface Shown {
  t: number;
  /** Frames per unit of time. */
  rate: number;
  size: Point;
  overlays: VideoOverlays;
  visible: Record<OverlayName, boolean>;
  marks: VideoMarks;
  selected: number; // segment whose arrow is drawn; -1: that at t
  ruler: [Point, Point] | null;
  rulerText: string;
  /** What is being drawn by hand. */
  sketch: { polygon?: Point[]; region?: Region | null };
}

// Readable on dark and bright pictures: colours of Okabe and Ito over a dark line.
const kColours = { edge: '#ffb000', detections: '#56b4e9', tracks: '#00d39a', flow: '#f0e442', swarm: '#e69f00', segment: '#f0e442', mark: '#ff9ad5', ruler: '#ffffff' };
const kHalo = 'rgba(0, 0, 0, 0.65)';
const kTrail = 30; // frames of a track

export class VideoCanvas {
  private buffer = document.createElement('canvas');
  private pixels: ImageData | null = null;
  private loaded: Picture | null = null;

  constructor(
    private g: CanvasRenderingContext2D,
    readonly camera: Camera,
  ) {}

  draw(p: Picture | null, s: Shown, ratio: number) {
    const g = this.g;
    g.setTransform(1, 0, 0, 1, 0, 0);
    g.clearRect(0, 0, g.canvas.width, g.canvas.height);
    g.lineCap = g.lineJoin = 'round';
    if (p) this.picture(p, s);
    if (s.visible.edge && s.overlays.edge) this.edge(s.overlays.edge, ratio);
    if (s.visible.tracks) this.tracks(s, ratio);
    if (s.visible.detections) this.detections(s, ratio);
    if (s.visible.flow) this.flow(s, ratio);
    if (s.visible.swarm) this.swarm(s, ratio);
    this.marks(s, ratio);
    if (s.ruler) this.ruler(s.ruler, s.rulerText, ratio);
  }

  private picture(p: Picture, s: Shown) {
    if (p !== this.loaded) this.load(p);
    const side = Math.max(1, Math.round(s.size[0] / p.width)), [x, y] = this.camera.toCanvas(-0.5, -0.5), k = this.camera.scale * side;
    this.g.imageSmoothingEnabled = k < 3; // single pixels stay visible
    this.g.drawImage(this.buffer, x, y, p.width * k, p.height * k);
  }
  private load(p: Picture) {
    const g = this.buffer.getContext('2d')!;
    if (this.buffer.width !== p.width || this.buffer.height !== p.height || !this.pixels) {
      this.buffer.width = p.width;
      this.buffer.height = p.height;
      this.pixels = g.createImageData(p.width, p.height);
    }
    const rgba = new Uint32Array(this.pixels.data.buffer);
    for (let i = 0; i < p.px.length; ++i) rgba[i] = 0xff000000 | (p.px[i] * 0x010101);
    g.putImageData(this.pixels, 0, 0);
    this.loaded = p;
  }

  /** Strokes the present path with a dark outline. */
  private stroke(colour: string, width: number, dash: number[] = []) {
    const g = this.g;
    g.strokeStyle = kHalo;
    g.lineWidth = 2.2 * width;
    g.stroke();
    g.setLineDash(dash);
    g.strokeStyle = colour;
    g.lineWidth = width;
    g.stroke();
    g.setLineDash([]);
  }
  private edge(e: { x: number; y: number; radius: number }, ratio: number) {
    this.g.beginPath();
    this.g.arc(...this.camera.toCanvas(e.x, e.y), e.radius * this.camera.scale, 0, 2 * Math.PI);
    this.stroke(kColours.edge, 2 * ratio);
  }
  private tracks(s: Shown, ratio: number) {
    const g = this.g, oldest = s.t - kTrail / s.rate;
    g.beginPath();
    for (const track of s.overlays.tracks ?? []) {
      const end = lastNotAfter(track.t_s, s.t);
      if (end < 1 || track.t_s[end] < oldest) continue;
      for (let k = Math.max(0, lastNotAfter(track.t_s, oldest)), first = true; k <= end; ++k, first = false) {
        const at = this.camera.toCanvas(track.x[k], track.y[k]);
        if (first) g.moveTo(...at);
        else g.lineTo(...at);
      }
    }
    this.stroke(kColours.tracks, 1.5 * ratio);
  }
  private detections(s: Shown, ratio: number) {
    const g = this.g, step = 0.6 / s.rate, radius = Math.max(5 * ratio, 3 * this.camera.scale);
    const given = s.overlays.detections && itemAt(s.overlays.detections, s.t, step);
    const spots: Point[] = given ? given.xy : [];
    if (!s.overlays.detections)
      for (const track of s.overlays.tracks ?? []) {
        const k = lastNotAfter(track.t_s, s.t);
        if (k >= 0 && s.t - track.t_s[k] < step) spots.push([track.x[k], track.y[k]]);
      }
    g.beginPath();
    for (const q of spots) {
      const [x, y] = this.camera.toCanvas(...q);
      g.moveTo(x + radius, y);
      g.arc(x, y, radius, 0, 2 * Math.PI);
    }
    this.stroke(kColours.detections, 1.5 * ratio);
  }
  private flow(s: Shown, ratio: number) {
    const field = itemAt(s.overlays.flow ?? [], s.t, 1 / s.rate);
    if (!field) return;
    const kFactor = 5; // length of an arrow, displacements
    this.g.beginPath();
    for (const [x, y, u, v] of field.arrows) this.arrowPath(this.camera.toCanvas(x, y), this.camera.toCanvas(x + kFactor * u, y + kFactor * v), 4 * ratio);
    this.stroke(kColours.flow, ratio);
  }
  private swarm(s: Shown, ratio: number) {
    const row = itemAt(s.overlays.swarm ?? [], s.t, 1 / s.rate);
    if (!row) return;
    const g = this.g, [x, y] = this.camera.toCanvas(row.x, row.y), e = ellipseOf(row), k = this.camera.scale, arm = 8 * ratio;
    g.beginPath();
    g.ellipse(x, y, e.major * k, e.minor * k, e.angle, 0, 2 * Math.PI);
    g.moveTo(x - arm, y);
    g.lineTo(x + arm, y);
    g.moveTo(x, y - arm);
    g.lineTo(x, y + arm);
    this.stroke(kColours.swarm, 2 * ratio);
  }

  private marks(s: Shown, ratio: number) {
    const { marks, sketch } = s, g = this.g;
    const region = sketch.region ?? marks.roi;
    if (region) this.region(region, ratio);
    for (const polygon of marks.masks) this.polygon(polygon, true, ratio);
    if (sketch.polygon) this.polygon(sketch.polygon, false, ratio);
    if (!s.visible.segments) return;
    const by_hand = marks.segments[s.selected >= 0 ? s.selected : segmentAt(marks.segments, s.t)];
    const found = s.overlays.segments ?? [], segment = by_hand ?? found[segmentAt(found, s.t)];
    if (!segment || segment.direction_deg === null) return;
    const [x, y] = this.camera.toCanvas(s.size[0] / 2, s.size[1] / 2), u = unitVector(segment.direction_deg);
    const half = 0.16 * Math.min(s.size[0], s.size[1]) * this.camera.scale;
    g.beginPath();
    this.arrowPath([x - half * u[0], y - half * u[1]], [x + half * u[0], y + half * u[1]], 14 * ratio);
    this.stroke(kColours.segment, 4 * ratio);
    this.words(`${Math.round(segment.direction_deg)}°`, x + (half + 22 * ratio) * u[0], y + (half + 22 * ratio) * u[1], kColours.segment, ratio);
  }
  private region(r: Region, ratio: number) {
    const g = this.g, [x0, y0] = this.camera.toCanvas(r.x - 0.5, r.y - 0.5), [x1, y1] = this.camera.toCanvas(r.x + r.width - 0.5, r.y + r.height - 0.5);
    g.fillStyle = 'rgba(0, 0, 0, 0.35)';
    g.beginPath();
    g.rect(0, 0, g.canvas.width, g.canvas.height);
    g.rect(x0, y0, x1 - x0, y1 - y0);
    g.fill('evenodd');
    g.beginPath();
    g.rect(x0, y0, x1 - x0, y1 - y0);
    this.stroke(kColours.mark, 1.5 * ratio, [6 * ratio, 4 * ratio]);
  }
  private polygon(points: Point[], closed: boolean, ratio: number) {
    const g = this.g;
    g.beginPath();
    points.forEach((q, k) => (k ? g.lineTo(...this.camera.toCanvas(...q)) : g.moveTo(...this.camera.toCanvas(...q))));
    if (closed) {
      g.closePath();
      g.fillStyle = 'rgba(0, 0, 0, 0.55)';
      g.fill();
    }
    this.stroke(kColours.mark, 1.5 * ratio);
  }
  private ruler([a, b]: [Point, Point], text: string, ratio: number) {
    const g = this.g, from = this.camera.toCanvas(...a), to = this.camera.toCanvas(...b);
    const l = Math.hypot(to[0] - from[0], to[1] - from[1]) || 1, n = [(-(to[1] - from[1]) / l) * 6 * ratio, ((to[0] - from[0]) / l) * 6 * ratio];
    g.beginPath();
    g.moveTo(...from);
    g.lineTo(...to);
    for (const [x, y] of [from, to]) {
      g.moveTo(x - n[0], y - n[1]);
      g.lineTo(x + n[0], y + n[1]);
    }
    this.stroke(kColours.ruler, 2 * ratio);
    this.words(text, (from[0] + to[0]) / 2 + n[0] * 3, (from[1] + to[1]) / 2 + n[1] * 3, kColours.ruler, ratio);
  }
  private arrowPath(from: Point, to: Point, head: number) {
    const g = this.g, dx = to[0] - from[0], dy = to[1] - from[1], l = Math.hypot(dx, dy);
    if (l < 1) return;
    const size = Math.min(head, 0.5 * l), ux = dx / l, uy = dy / l;
    g.moveTo(...from);
    g.lineTo(...to);
    g.lineTo(to[0] - size * (ux + 0.6 * uy), to[1] - size * (uy - 0.6 * ux));
    g.moveTo(...to);
    g.lineTo(to[0] - size * (ux - 0.6 * uy), to[1] - size * (uy + 0.6 * ux));
  }
  private words(text: string, x: number, y: number, colour: string, ratio: number) {
    const g = this.g;
    g.font = `600 ${14 * ratio}px system-ui, sans-serif`;
    g.textAlign = 'center';
    g.textBaseline = 'middle';
    g.strokeStyle = kHalo;
    g.lineWidth = 4 * ratio;
    g.strokeText(text, x, y);
    g.fillStyle = colour;
    g.fillText(text, x, y);
  }
}
