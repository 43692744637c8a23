// Directions on the page: degrees counter-clockwise from the right, as in mathematics: 0 right, 90 up. Pictures have y down.

/** The angle in 0 (inclusive) to 360 degrees (exclusive). */
export function normalised(deg: number): number {
  const turned = ((deg % 360) + 360) % 360;
  return turned === 360 ? 0 : turned + 0; // no negative zero
}
/** The direction of a vector in the picture, y down. */
export const directionOf = (dx: number, dy: number) => normalised((Math.atan2(-dy, dx) * 180) / Math.PI);

/** The unit vector of a direction in the picture, y down. */
export function unitVector(deg: number): [number, number] {
  const a = (deg * Math.PI) / 180;
  return [Math.cos(a), -Math.sin(a)];
}
/** Converts from the convention of the program (clockwise in the picture: 90 down), or to it. */
export const flipped = (deg: number) => normalised(-deg);

/** Rounded to a whole degree, for input by dragging. */
export const wholeDegrees = (deg: number) => normalised(Math.round(deg));
