// View transform: zoom and pan.

export interface Box {
  left: number;
  top: number;
  right: number;
  bottom: number;
}

const kLargest = 60; // canvas px per image px, unless the fitted scale is larger
const kSmallest = 0.2; // relative to the fitted scale

/** Maps image pixels to the canvas: canvas = scale * image + offset. Canvas sizes are in device pixels. */
export class Camera {
  scale = 1;
  x = 0;
  y = 0;
  width = 1;
  height = 1;
  private fitted: Box = { left: 0, top: 0, right: 640, bottom: 480 };
  private untouched = true;

  /** Fits `box` to the canvas; the fit follows resize() until the user zooms or pans. */
  fit(box: Box) {
    this.fitted = box;
    this.untouched = true;
    const w = box.right - box.left, h = box.bottom - box.top;
    this.scale = this.fitting();
    this.x = (this.width - this.scale * w) / 2 - this.scale * box.left;
    this.y = (this.height - this.scale * h) / 2 - this.scale * box.top;
  }
  resize(width: number, height: number) {
    if (width === this.width && height === this.height) return;
    const centre = this.toPicture(this.width / 2, this.height / 2);
    this.width = width;
    this.height = height;
    if (this.untouched) return this.fit(this.fitted);
    this.x = width / 2 - this.scale * centre[0];
    this.y = height / 2 - this.scale * centre[1];
  }
  /** Zooms about a point of the canvas, which does not move. */
  zoom(factor: number, cx: number, cy: number) {
    const fitting = this.fitting();
    const next = Math.min(Math.max(this.scale * factor, kSmallest * fitting), Math.max(kLargest, fitting));
    const k = next / this.scale;
    this.x = cx - k * (cx - this.x);
    this.y = cy - k * (cy - this.y);
    this.scale = next;
    this.untouched = false;
  }
  private fitting(): number {
    const b = this.fitted;
    return Math.min(this.width / (b.right - b.left), this.height / (b.bottom - b.top));
  }
  pan(dx: number, dy: number) {
    this.x += dx;
    this.y += dy;
    this.untouched = false;
  }
  toPicture(cx: number, cy: number): [number, number] {
    return [(cx - this.x) / this.scale, (cy - this.y) / this.scale];
  }
  toCanvas(px: number, py: number): [number, number] {
    return [px * this.scale + this.x, py * this.scale + this.y];
  }
}
