// The coils in the two views: the plane of the sample from above (x to the right, y up), and from the side (x, z). Lengths in m.

import { changed, placed, tidy, type Coil, type System, type Vec } from './system';

export type Plane = 'top' | 'side';
export type Point = [number, number];
/** The coordinates of a plane. */
export const kAxes: Record<Plane, [number, number]> = { top: [0, 1], side: [0, 2] };

export const seen = (v: Vec, plane: Plane): Point => [v[kAxes[plane][0]], v[kAxes[plane][1]]];
const with2 = (v: Vec, plane: Plane, [a, b]: Point): Vec => {
  const to: Vec = [...v];
  to[kAxes[plane][0]] = a;
  to[kAxes[plane][1]] = b;
  return to;
};
export const direction = (axis: Vec): Vec => {
  const length = Math.hypot(...axis) || 1;
  return axis.map((v) => v / length) as Vec;
};

/** A multiple of the step; 0: any value. */
export const snapped = (v: number, step: number) => (step > 0 ? Number((Math.round(v / step) * step).toFixed(9)) + 0 : v);

/** A cylinder about the axis: its middle along the axis, radius, and half its length. */
export interface Body {
  at: number;
  radius: number;
  half: number;
}
export function bodies({ type, size }: Coil): Body[] {
  switch (type) {
    case 'solenoid': return [{ at: 0, radius: size.radius, half: size.length / 2 }];
    case 'thick_coil': return [{ at: 0, radius: size.outer_radius, half: size.length / 2 }];
    case 'helmholtz': return [-1, 1].map((side) => ({ at: (side * size.distance) / 2, radius: size.radius, half: 0 }));
    default: return [{ at: 0, radius: size.radius, half: 0 }];
  }
}
/** Half the length along the axis. */
export const reach = (c: Coil) => Math.max(...bodies(c).map((b) => b.at + b.half));
export const radius = (c: Coil) => Math.max(...bodies(c).map((b) => b.radius));

const cross = (a: Vec, b: Vec): Vec => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const kCorners = 48;

/** Two unit vectors perpendicular to a direction. */
function across(d: Vec): [Vec, Vec] {
  const least = d.map(Math.abs).indexOf(Math.min(...d.map(Math.abs)));
  const other: Vec = [0, 0, 0];
  other[least] = 1;
  const u = direction(cross(d, other));
  return [u, cross(d, u)];
}

/** The outlines of a coil in a view: the convex hulls of its cylinders. */
export function outlines(c: Coil, plane: Plane): Point[][] {
  const d = direction(c.axis), [u, v] = across(d);
  return bodies(c).map((b) => {
    const rims: Point[] = [];
    for (const end of b.half > 0 ? [b.at - b.half, b.at + b.half] : [b.at])
      for (let i = 0; i < kCorners; ++i) {
        const cos = b.radius * Math.cos((2 * Math.PI * i) / kCorners), sin = b.radius * Math.sin((2 * Math.PI * i) / kCorners);
        rims.push(seen(c.position.map((p, k) => p + end * d[k] + cos * u[k] + sin * v[k]) as Vec, plane));
      }
    return hull(rims);
  });
}

/** The convex hull, counter-clockwise (Andrew's monotone chain). */
export function hull(points: Point[]): Point[] {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const half = (list: Point[]) => {
    const chain: Point[] = [];
    for (const p of list) {
      for (let n = chain.length; n > 1; --n) {
        const [a, b] = [chain[n - 2], chain[n - 1]];
        if ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0) break;
        chain.pop();
      }
      chain.push(p);
    }
    return chain.slice(0, -1);
  };
  return [...half(sorted), ...half(sorted.reverse())];
}

/** The axis in a view: its direction, and its length, from 0 (towards the viewer) to 1. */
export function seenAxis(c: Coil, plane: Plane): { unit: Point; length: number } {
  const [a, b] = seen(direction(c.axis), plane), length = Math.hypot(a, b);
  return length < 1e-6 ? { unit: [1, 0], length: 0 } : { unit: [a / length, b / length], length };
}

export interface Handles {
  /** Turns the axis in the plane. */
  turn: Point;
  /** Changes radius and length; null if the axis is inclined to the plane. */
  size: Point | null;
}
/** `gap`: distance of the turning handle from the coil, m. */
export function handles(c: Coil, plane: Plane, gap: number): Handles {
  const { unit, length } = seenAxis(c, plane), [x, y] = seen(c.position, plane), [h, r] = [reach(c), radius(c)];
  const far = h * length + r * Math.sqrt(1 - length * length) + gap;
  const corner = (along: number, side: number): Point => [x + along * unit[0] - side * unit[1], y + along * unit[1] + side * unit[0]];
  return { turn: corner(far, 0), size: length > 0.999 ? corner(h, r) : length < 0.001 ? corner(0, r) : null };
}

export const movedTo = (s: System, c: Coil, plane: Plane, to: Point, step: number): System =>
  changed(s, c.id, { position: placed(with2(c.position, plane, [snapped(to[0], step), snapped(to[1], step)])) });

/** The axis turned towards a point of the view, in steps of `step` degrees; its part out of the plane remains. */
export function turnedTo(s: System, c: Coil, plane: Plane, to: Point, step: number): System {
  const [x, y] = seen(c.position, plane);
  return turnedBy(s, c, plane, Math.atan2(to[1] - y, to[0] - x), step);
}
/** The axis at an angle in the view, rad. */
export function turnedBy(s: System, c: Coil, plane: Plane, angle: number, step: number): System {
  const length = seenAxis(c, plane).length || 1, turn = (snapped((angle * 180) / Math.PI, step) * Math.PI) / 180;
  const from: Vec = seenAxis(c, plane).length ? direction(c.axis) : [0, 0, 0];
  return changed(s, c.id, { axis: with2(from, plane, [length * Math.cos(turn), length * Math.sin(turn)]).map(tidy) as Vec });
}
export const angleOf = (c: Coil, plane: Plane) => Math.atan2(seenAxis(c, plane).unit[1], seenAxis(c, plane).unit[0]);

/** Radius and length so that a corner is at a point of the view. */
export function resizedTo(s: System, c: Coil, plane: Plane, to: Point, step: number): System {
  const { unit, length } = seenAxis(c, plane), [x, y] = seen(c.position, plane), [u, v] = [to[0] - x, to[1] - y];
  const least = step > 0 ? step : 1e-4;
  const size = { ...c.size };
  const along = 2 * Math.abs(u * unit[0] + v * unit[1]), away = length < 0.001 ? Math.hypot(u, v) : Math.abs(v * unit[0] - u * unit[1]);
  const r = Math.max(least, snapped(away, step));
  if ('outer_radius' in size) size.outer_radius = Math.max(r, size.inner_radius + least);
  else size.radius = r;
  for (const key of ['length', 'distance']) if (key in size && length > 0.999) size[key] = Math.max(least, snapped(along, step));
  return changed(s, c.id, { size });
}
