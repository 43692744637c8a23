// Polygons in the picture: obstacles of a controller.

export type Point = [number, number];

/** Whether a point is inside a polygon, by the even-odd rule. */
export function inside(polygon: Point[], [x, y]: Point): boolean {
  let odd = false;
  polygon.forEach(([ax, ay], i) => {
    const [bx, by] = polygon[(i + 1) % polygon.length];
    if (ay > y !== by > y && x < ax + ((y - ay) / (by - ay)) * (bx - ax)) odd = !odd;
  });
  return odd;
}

/** The last polygon with the point inside, which is drawn on top; otherwise null. */
export function polygonAt(polygons: Point[][], p: Point): number | null {
  for (let i = polygons.length - 1; i >= 0; --i) if (inside(polygons[i], p)) return i;
  return null;
}

/** The mean of the corners. */
export const middle = (polygon: Point[]): Point => [0, 1].map((k) => polygon.reduce((sum, q) => sum + q[k], 0) / polygon.length) as Point;

const side = (a: Point, b: Point, c: Point) => Math.sign((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));

/** Whether two edges of a polygon cross, so that it has no inside. */
export function crossesItself(polygon: Point[]): boolean {
  const n = polygon.length, edge = (i: number): [Point, Point] => [polygon[i], polygon[(i + 1) % n]];
  for (let i = 0; i < n; ++i)
    for (let j = i + 2; j < n; ++j) {
      if (i === 0 && j === n - 1) continue; // neighbours
      const [a, b] = edge(i), [c, d] = edge(j);
      if (side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0) return true;
    }
  return false;
}
