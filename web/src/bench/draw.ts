// What is drawn over the live picture: edge of the arena, estimate of the swarm, setpoint, scale bar.

import { ellipseOf } from '../video/overlays';
import type { Camera } from '../view/camera';
import type { BenchState } from './state';

export const kLiveLayers = ['estimate', 'edge', 'setpoint', 'scale_bar'] as const;
export type LiveLayer = (typeof kLiveLayers)[number];

// Readable on dark and bright pictures: colours of Okabe and Ito over a dark line, as in the viewer of videos.
const kColours = { edge: '#ffb000', estimate: '#00d39a', setpoint: '#ff9ad5', scale: '#ffffff' };
const kHalo = 'rgba(0, 0, 0, 0.65)';

export function drawLive(g: CanvasRenderingContext2D, camera: Camera, ratio: number, s: BenchState, visible: Record<LiveLayer, boolean>) {
  g.setTransform(1, 0, 0, 1, 0, 0);
  g.clearRect(0, 0, g.canvas.width, g.canvas.height);
  g.lineCap = g.lineJoin = 'round';
  if (visible.edge) edge(g, camera, ratio, s);
  if (visible.setpoint && s.setpoint_px) {
    const at = camera.toCanvas(...s.setpoint_px);
    cross(g, at, 9 * ratio, Math.PI / 4);
    stroke(g, kColours.setpoint, 2 * ratio);
  }
  if (visible.estimate && s.estimate) estimate(g, camera, ratio, s.estimate);
  if (visible.scale_bar && s.size_px) scaleBar(g, camera, ratio, s.um_per_px ?? null);
}

function stroke(g: CanvasRenderingContext2D, colour: string, width: number) {
  g.strokeStyle = kHalo;
  g.lineWidth = 2.2 * width;
  g.stroke();
  g.strokeStyle = colour;
  g.lineWidth = width;
  g.stroke();
}
function cross(g: CanvasRenderingContext2D, [x, y]: [number, number], arm: number, turned = 0) {
  g.beginPath();
  for (const angle of [turned, turned + Math.PI / 2]) {
    const dx = arm * Math.cos(angle), dy = arm * Math.sin(angle);
    g.moveTo(x - dx, y - dy);
    g.lineTo(x + dx, y + dy);
  }
}
function edge(g: CanvasRenderingContext2D, camera: Camera, ratio: number, { outline: o }: BenchState) {
  if (!o) return;
  g.beginPath();
  if ('radius_px' in o) g.arc(...camera.toCanvas(...o.centre_px), o.radius_px * camera.scale, 0, 2 * Math.PI);
  else {
    for (const corner of o.corners_px) g.lineTo(...camera.toCanvas(...corner));
    g.closePath();
  }
  stroke(g, kColours.edge, 2 * ratio);
}
function estimate(g: CanvasRenderingContext2D, camera: Camera, ratio: number, e: NonNullable<BenchState['estimate']>) {
  const at = camera.toCanvas(...e.centroid_px), [xx, xy, yy] = e.covariance_px2;
  const { major, minor, angle } = ellipseOf({ xx, xy, yy });
  cross(g, at, 9 * ratio);
  stroke(g, kColours.estimate, 2 * ratio);
  if (!(major > 0)) return;
  g.beginPath();
  g.ellipse(...at, major * camera.scale, minor * camera.scale, angle, 0, 2 * Math.PI);
  stroke(g, kColours.estimate, 1.5 * ratio);
}

/** A round length of at most `longest`, in the units of the scale. */
export function barLength(longest: number): number {
  const power = 10 ** Math.floor(Math.log10(longest));
  return [5, 2, 1].map((k) => k * power).find((v) => v <= longest) ?? power;
}
function scaleBar(g: CanvasRenderingContext2D, camera: Camera, ratio: number, umPerPx: number | null) {
  const perUnit = camera.scale / (umPerPx ?? 1); // canvas px per um, or per picture px
  const length = barLength((110 * ratio) / perUnit), x = g.canvas.width - 14 * ratio, y = g.canvas.height - 14 * ratio;
  g.beginPath();
  g.moveTo(x - length * perUnit, y);
  g.lineTo(x, y);
  stroke(g, kColours.scale, 3 * ratio);
  const text = umPerPx === null ? `${length} px` : length >= 1000 ? `${length / 1000} mm` : `${length} µm`;
  g.font = `${14 * ratio}px system-ui, sans-serif`;
  g.textAlign = 'right';
  g.lineWidth = 3 * ratio;
  g.strokeStyle = kHalo;
  g.strokeText(text, x, y - 8 * ratio);
  g.fillStyle = kColours.scale;
  g.fillText(text, x, y - 8 * ratio);
}
