// Draws cells as dots: with WebGL2, or pixel by pixel if WebGL is rendered in software.

import { type Frame, responds, type Sites } from '../frame';
import type { Box, Camera } from './camera';
import { drawSites } from './sites';
import { densityColours, kSteps, squareOf, type Density } from './density';

export type Rgb = [number, number, number];
export interface Style {
  /** Colours of the swarms; `mute`: colour of unresponsive cells. */
  colours: Rgb[];
  mute: Rgb;
  ground: Rgb;
  /** Radius of a dot, image px. */
  radius: number;
  trails: boolean;
  /** Each cell has the colour of the density at its position; null: that of its swarm. */
  density?: Density | null;
  dark?: boolean;
}
export interface CellView {
  /** `ends`: index of the first cell after each swarm. */
  draw(f: Frame, ends: number[], box: Box, camera: Camera, style: Style): void;
  readonly name: string;
  /** Whether it draws occupancy grids. */
  readonly drawsSites: boolean;
  /** The canvas that is drawn to. */
  readonly canvas: HTMLCanvasElement;
  /** Clears the trails. */
  clear(): void;
}

/**
 * Software rasterisers of WebGL draw points slower than a loop over pixels does (16 against 60 frames per second for 1e5 cells).
 * `over`: canvas for the loop over pixels, which may be that of the overlay: the browser then composes one canvas instead of two.
 */
export function makeCellView(canvas: HTMLCanvasElement, choice: 'auto' | 'webgl' | 'pixels' = 'auto', over = canvas): CellView {
  if (choice !== 'pixels' && (choice === 'webgl' || hasGpu())) {
    const gl = canvas.getContext('webgl2', { alpha: false, antialias: false, preserveDrawingBuffer: true });
    if (gl) return new WebglCells(gl);
  }
  return new PixelCells(over.getContext('2d', { alpha: false })!);
}

function hasGpu(): boolean {
  const gl = document.createElement('canvas').getContext('webgl2');
  if (!gl) return false;
  const info = gl.getExtension('WEBGL_debug_renderer_info');
  const name = String(info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : '');
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return !/swiftshader|llvmpipe|software|basic render/i.test(name);
}

// From coordinates of a message to device pixels: d = k * v + o.
function placing(f: Frame, box: Box, camera: Camera) {
  const q = f.xy instanceof Uint16Array;
  const kx = q ? (box.right - box.left) / 65535 : 1, ky = q ? (box.bottom - box.top) / 65535 : 1;
  return {
    kx: kx * camera.scale, ky: ky * camera.scale,
    ox: (q ? box.left : 0) * camera.scale + camera.x, oy: (q ? box.top : 0) * camera.scale + camera.y,
  };
}

/** Headings are visible only for large dots, and are drawn only for a limited number of cells. */
const shownAsRods = (f: Frame, radius: number) => radius >= 1.7 && f.cells <= 20000;
const kTrail = 0.82; // decay factor of trails per frame

class PixelCells implements CellView {
  readonly name = 'pixels';
  readonly drawsSites = true;
  private image: ImageData | null = null;
  private px = new Uint32Array(0);
  private stale = true;

  constructor(private g: CanvasRenderingContext2D) {}
  get canvas() {
    return this.g.canvas;
  }
  clear() {
    this.stale = true;
  }

  draw(f: Frame, ends: number[], box: Box, camera: Camera, style: Style) {
    const canvas = this.g.canvas;
    const w = canvas.width, h = canvas.height;
    if (!this.image || this.image.width !== w || this.image.height !== h) {
      this.image = this.g.createImageData(w, h);
      this.px = new Uint32Array(this.image.data.buffer);
      this.stale = true;
    }
    const px = this.px, ground = word(style.ground);
    if (style.trails && !this.stale) this.fade(style.ground);
    else px.fill(ground);
    this.stale = false;
    if (f.sites) this.sites(f.sites, box, camera, style);
    else this.dots(f, ends, box, camera, style);
    this.g.putImageData(this.image, 0, 0);
  }

  // Fades towards the background; processes two bytes at once, because this loop visits all pixels.
  private fade(ground: Rgb) {
    const px = this.px, keep = Math.round(kTrail * 256), rest = 256 - keep;
    const rb = (ground[0] | (ground[2] << 16)) >>> 0, g = ground[1];
    for (let i = 0; i < px.length; ++i) {
      const v = px[i];
      const a = (((v & 0xff00ff) * keep + rb * rest) >>> 8) & 0xff00ff;
      const b = (((v >>> 8) & 0xff) * keep + g * rest) >>> 8;
      px[i] = (0xff000000 | a | (b << 8)) >>> 0;
    }
  }

  private sites(s: Sites, box: Box, camera: Camera, style: Style) {
    const { width, height } = this.image!, size = Math.round(2 * Math.max(1, style.radius * camera.scale));
    const colours = s.planes.map((_, p) => word(p % 2 ? style.mute : style.colours[(p >> 1) % style.colours.length]));
    const density = style.density ? { density: style.density, tints: densityColours(style.dark ?? false).map(word) } : null;
    drawSites({ px: this.px, width, height }, s, box, camera, { colours, size, density });
  }

  private dots(f: Frame, ends: number[], box: Box, camera: Camera, style: Style) {
    const { kx, ky, ox, oy } = placing(f, box, camera);
    const px = this.px, w = this.image!.width, h = this.image!.height, xy = f.xy;
    const r = Math.max(1, style.radius * camera.scale), size = Math.round(2 * r), oriented = f.headings && shownAsRods(f, r);
    const mute = word(style.mute), half = size >> 1, tints = style.density ? densityColours(style.dark ?? false).map(word) : [];
    const d = style.density, square = d ? squareOf(f, box, d) : () => 0;
    let i = 0;
    for (let s = 0; s < ends.length; ++s) {
      const colour = word(style.colours[s % style.colours.length]);
      for (; i < ends[s]; ++i) {
        const x = (xy[2 * i] * kx + ox) | 0, y = (xy[2 * i + 1] * ky + oy) | 0;
        if (x < half || y < half || x >= w - half - 1 || y >= h - half - 1) continue;
        const c = d ? tints[d.shades[square(i)]] : responds(f, i) ? colour : mute;
        if (oriented) {
          this.rod(x, y, (f.headings![i] / 255) * 2 * Math.PI, r, c);
          continue;
        }
        let at = (y - half) * w + x - half;
        if (size === 2) {
          px[at] = px[at + 1] = px[at + w] = px[at + w + 1] = c; // the typical size in large swarms, without a loop
          continue;
        }
        for (let b = 0; b < size; ++b, at += w) for (let a = 0; a < size; ++a) px[at + a] = c;
      }
    }
  }

  // A short line, thicker at the front.
  private rod(x: number, y: number, angle: number, r: number, colour: number) {
    const w = this.image!.width, h = this.image!.height, px = this.px;
    const c = Math.cos(angle), s = -Math.sin(angle), length = 2 * r, n = Math.ceil(2 * length);
    for (let k = -n; k <= n; ++k) {
      const thick = k > n * 0.4 ? 2 : 1;
      const cx = Math.round(x + (c * k * length) / n), cy = Math.round(y + (s * k * length) / n);
      for (let b = 0; b < thick; ++b)
        for (let a = 0; a < thick; ++a)
          if (cx + a >= 0 && cx + a < w && cy + b >= 0 && cy + b < h) px[(cy + b) * w + cx + a] = colour;
    }
  }
}

const word = (c: Rgb) => (0xff000000 | (c[2] << 16) | (c[1] << 8) | c[0]) >>> 0;

const kVertex = `#version 300 es
in vec2 place; in float heading; in float shade;
uniform vec4 put; uniform vec2 size; uniform float radius; uniform bool headed; uniform bool shaded; uniform vec3 colour; uniform vec3 shades[${kSteps}];
flat out float angle; flat out vec3 tint;
void main() {
  tint = shaded ? shades[int(shade)] : colour;
  vec2 d = place * put.xy + put.zw;
  gl_Position = vec4(d.x / size.x * 2. - 1., 1. - d.y / size.y * 2., 0, 1);
  gl_PointSize = headed ? 5. * radius : 2. * radius;
  angle = heading * 6.2831853;
}`;
const kFragment = `#version 300 es
precision mediump float;
flat in float angle; flat in vec3 tint; uniform bool headed; out vec4 o;
void main() {
  vec2 p = gl_PointCoord * 2. - 1.;
  if (headed) {
    float c = cos(angle), s = -sin(angle);
    vec2 q = vec2(c * p.x + s * p.y, -s * p.x + c * p.y);
    float thick = q.x > .3 ? .34 : .2;
    if (abs(q.y) > thick || abs(q.x) > .85) discard;
  } else if (dot(p, p) > 1.) discard;
  o = vec4(tint, 1);
}`;
const kCover = `#version 300 es
const vec2 p[3] = vec2[](vec2(-1, -1), vec2(3, -1), vec2(-1, 3));
void main() { gl_Position = vec4(p[gl_VertexID], 0, 1); }`;
const kPlain = `#version 300 es
precision mediump float; uniform vec4 colour; out vec4 o;
void main() { o = colour; }`;

class WebglCells implements CellView {
  readonly name = 'webgl';
  readonly drawsSites = false;
  private dots: WebGLProgram;
  private cover: WebGLProgram;
  private positionBuffer: WebGLBuffer;
  private headings: WebGLBuffer;
  private shades: WebGLBuffer;
  private order: WebGLBuffer;
  private empty: WebGLVertexArrayObject;
  private stale = true;
  private at = new Map<string, WebGLUniformLocation | null>();

  constructor(private gl: WebGL2RenderingContext) {
    this.dots = program(gl, kVertex, kFragment);
    this.cover = program(gl, kCover, kPlain);
    this.positionBuffer = gl.createBuffer()!;
    this.headings = gl.createBuffer()!;
    this.shades = gl.createBuffer()!;
    this.order = gl.createBuffer()!;
    this.empty = gl.createVertexArray()!;
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  }
  get canvas() {
    return this.gl.canvas as HTMLCanvasElement;
  }
  clear() {
    this.stale = true;
  }
  private uniform(p: WebGLProgram, name: string) {
    const key = (p === this.dots ? 'd' : 'c') + name;
    if (!this.at.has(key)) this.at.set(key, this.gl.getUniformLocation(p, name));
    return this.at.get(key)!;
  }

  draw(f: Frame, ends: number[], box: Box, camera: Camera, style: Style) {
    const gl = this.gl, w = gl.canvas.width, h = gl.canvas.height;
    const part = (c: Rgb) => [c[0] / 255, c[1] / 255, c[2] / 255] as const;
    gl.viewport(0, 0, w, h);
    gl.useProgram(this.cover);
    gl.bindVertexArray(this.empty);
    const alpha = style.trails && !this.stale ? 1 - kTrail : 1;
    gl.uniform4f(this.uniform(this.cover, 'colour'), ...part(style.ground), alpha);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    this.stale = false;
    gl.bindVertexArray(null);

    const { kx, ky, ox, oy } = placing(f, box, camera);
    const r = Math.max(1, style.radius * camera.scale), headed = !!f.headings && shownAsRods(f, r);
    gl.useProgram(this.dots);
    gl.uniform4f(this.uniform(this.dots, 'put'), kx, ky, ox, oy);
    gl.uniform2f(this.uniform(this.dots, 'size'), w, h);
    gl.uniform1f(this.uniform(this.dots, 'radius'), r);
    gl.uniform1i(this.uniform(this.dots, 'headed'), headed ? 1 : 0);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.positionBuffer);
    gl.bufferData(gl.ARRAY_BUFFER, f.xy, gl.DYNAMIC_DRAW);
    this.attribute('place', 2, f.xy instanceof Uint16Array ? gl.UNSIGNED_SHORT : gl.FLOAT, false);
    if (headed) {
      gl.bindBuffer(gl.ARRAY_BUFFER, this.headings);
      gl.bufferData(gl.ARRAY_BUFFER, f.headings!, gl.DYNAMIC_DRAW);
      this.attribute('heading', 1, gl.UNSIGNED_BYTE, true);
    } else {
      this.constant('heading');
    }
    this.shade(f, box, style);
    // One draw call per swarm for responsive and unresponsive cells: an index list is faster than a test per dot.
    let from = 0;
    ends.forEach((end, s) => {
      const [on, off] = sorted(f, from, end);
      from = end;
      for (const [list, colour] of [[off, style.mute], [on, style.colours[s % style.colours.length]]] as const) {
        if (!list.length) continue;
        gl.uniform3f(this.uniform(this.dots, 'colour'), ...part(colour));
        gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.order);
        gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, list, gl.DYNAMIC_DRAW);
        gl.drawElements(gl.POINTS, list.length, gl.UNSIGNED_INT, 0);
      }
    });
  }
  private shade(f: Frame, box: Box, { density: d, dark }: Style) {
    const gl = this.gl;
    gl.uniform1i(this.uniform(this.dots, 'shaded'), d ? 1 : 0);
    if (!d) return this.constant('shade');
    const square = squareOf(f, box, d), shades = new Uint8Array(f.cells);
    for (let i = 0; i < f.cells; ++i) shades[i] = d.shades[square(i)];
    gl.uniform3fv(this.uniform(this.dots, 'shades'), densityColours(dark ?? false).flat().map((c) => c / 255));
    gl.bindBuffer(gl.ARRAY_BUFFER, this.shades);
    gl.bufferData(gl.ARRAY_BUFFER, shades, gl.DYNAMIC_DRAW);
    this.attribute('shade', 1, gl.UNSIGNED_BYTE, false);
  }
  private attribute(name: string, size: number, type: number, normalised: boolean) {
    const at = this.gl.getAttribLocation(this.dots, name);
    if (at < 0) return;
    this.gl.enableVertexAttribArray(at);
    this.gl.vertexAttribPointer(at, size, type, normalised, 0, 0);
  }
  private constant(name: string) {
    const at = this.gl.getAttribLocation(this.dots, name);
    if (at >= 0) this.gl.disableVertexAttribArray(at);
  }
}

function sorted(f: Frame, from: number, end: number): [Uint32Array, Uint32Array] {
  const on = new Uint32Array(end - from), off = new Uint32Array(end - from);
  let a = 0, b = 0;
  for (let i = from; i < end; ++i)
    if (responds(f, i)) on[a++] = i;
    else off[b++] = i;
  return [on.subarray(0, a), off.subarray(0, b)];
}

function program(gl: WebGL2RenderingContext, vertex: string, fragment: string): WebGLProgram {
  const p = gl.createProgram()!;
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]] as const) {
    const s = gl.createShader(kind)!;
    gl.shaderSource(s, text);
    gl.compileShader(s);
    if (!gl.getShaderParameter(s, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(s) ?? 'shader');
    gl.attachShader(p, s);
  }
  gl.linkProgram(p);
  return p;
}
