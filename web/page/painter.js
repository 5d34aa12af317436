// Rods by WebGL2, from above: one small rectangle for each, in which its outline is drawn.
import {colour as cssColour} from "./dom.js";
import {attribute, fill, kColourOf, makeTextures, newProgram, rgb, useForRods} from "./gl.js";
import {OrbitPainter} from "./orbit.js";
import {halfTurns, kUpright, partOf, periodOf, toNearest} from "./plane.js";

const kVertex = `
layout(location = 0) in vec2 corner;
layout(location = 1) in vec4 rod;  // its centre, from the middle of the view [mm]; heading / pi; n_z
layout(location = 2) in float outlineOf;
uniform float scale;       // half the view's width is 1 / scale [mm]
uniform vec4 outline[27];  // half length, radius in the middle, radius at the ends [mm]; species
out vec2 at;               // along and across the rod [mm]
flat out vec3 shape;
flat out vec3 colour;
${kColourOf}
void main() {
  vec4 whole = outline[int(outlineOf)];
  float nz = rod.w;
  float flatPart = sqrt(max(0.0, 1.0 - nz * nz));
  shape = vec3(whole.x * flatPart, whole.yz);
  float width = max(shape.y, shape.z);
  at = corner * vec2(shape.x + shape.z, width) * 1.02;
  float theta = rod.z * pi;
  vec2 axis = vec2(cos(theta), sin(theta));
  vec2 place = rod.xy + at.x * axis + at.y * vec2(-axis.y, axis.x);
  gl_Position = vec4(place * scale, 0.0, 1.0);
  colour = colourOf(theta, nz, whole.w);
}`;

const kFragment = `
in vec2 at;
flat in vec3 shape;
flat in vec3 colour;
out vec4 ink;
void main() {
  float along = abs(at.x), across = abs(at.y);
  // the radius changes linearly from the middle to the centres of the end beads
  float radius = shape.x > 0.0 ? mix(shape.y, shape.z, min(along / shape.x, 1.0)) : shape.z;
  float inside = along <= shape.x ? radius - across : shape.z - length(vec2(along - shape.x, across));
  float pixel = fwidth(at.x) + fwidth(at.y);
  float cover = clamp(inside / pixel + 0.5, 0.0, 1.0);
  if (cover <= 0.0) discard;
  float round = clamp(1.0 - inside / max(radius, 1e-6), 0.0, 1.0);
  ink = vec4(colour * (0.5 + 0.5 * sqrt(1.0 - round * round)), 1.0) * cover;
}`;

/**
 * The rods of a frame as they are seen, each image of them near the border too: 4 numbers for each, as the shader has them,
 * and which outline it has. `view` is {x, y, zoom}; the box is periodic where it has no walls.
 */
export function instancesOf(frame, view) {
  const {n_rods: n, box_mm: box} = frame, half = Math.max(...box) / 2 / view.zoom;
  const reach = frame.outlines.map(([length, , end]) => length + end);
  const period = periodOf(frame);
  const shifts = period.map((side) => {  // to the images that may be seen
    const most = side > 0 ? Math.max(1, Math.floor((half + Math.max(...reach)) / side + 0.5)) : 0;
    return Array.from({length: 2 * most + 1}, (_, k) => (k - most) * side);
  });
  const images = shifts[0].length * shifts[1].length;
  const rods = new Float32Array(4 * images * n), shape = new Uint8Array(images * n);
  let count = 0;
  // of the centre, from the middle of the view
  const placed = (at, middle, axis) => toNearest((partOf(at) - middle) * box[axis], period[axis]);
  for (let i = 0; i < n; ++i) {
    const x = placed(frame.x[i], view.x, 0), y = placed(frame.y[i], view.y, 1), most = half + reach[frame.shape[i]];
    for (const dx of shifts[0]) {
      if (Math.abs(x + dx) > most) continue;
      for (const dy of shifts[1]) {
        if (Math.abs(y + dy) > most) continue;
        rods.set([x + dx, y + dy, halfTurns(frame.heading[i]), frame.n_z[i] / kUpright], 4 * count);
        shape[count++] = frame.shape[i];
      }
    }
  }
  return {count, rods: rods.subarray(0, 4 * count), shape: shape.subarray(0, count)};
}

/**
 * The colouring that suits a frame. Spheres have no axes, and so no S; layers where there is order, the wheel where there
 * is none, and no flicker between: `before` is what was chosen last, if anything was.
 */
export function suitingColouring(frame, palettes, before = "") {
  if (frame.order === null) return "species";
  const beyond = frame.order - palettes.order_of_layers;
  return before && Math.abs(beyond) <= palettes.order_margin ? before : beyond >= 0 ? "layers" : "wheel";
}

export class RodPainter {
  constructor(canvas, palettes) {
    this.palettes = palettes;
    this.gl = canvas.getContext("webgl2", {antialias: false, preserveDrawingBuffer: true});
    if (!this.gl) throw new Error("this browser has no WebGL2, by which rods are drawn");
    this.program = newProgram(this.gl, kVertex, kFragment);
    this.orbit = null;
    this.makeBuffers();
    makeTextures(this.gl, palettes);
  }

  makeBuffers() {
    const {gl} = this;
    this.vertices = gl.createVertexArray();
    gl.bindVertexArray(this.vertices);
    fill(gl, attribute(gl, 0, 2, gl.FLOAT), new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]));
    this.rods = attribute(gl, 1, 4, gl.FLOAT, true);
    this.shape = attribute(gl, 2, 1, gl.UNSIGNED_BYTE, true);
  }

  /**
   * Fills the canvas of `size` pixels: with the ground where `frame` is null. From above, or as `view.orbit` says; then
   * quicker, and less smooth, where it `isMoving`.
   */
  paint(frame, view, size, colouring, isMoving = false) {
    const {gl, palettes, program} = this;
    gl.viewport(0, 0, size, size);
    const [r, g, b] = rgb(parseInt(cssColour("panel").slice(1), 16));
    gl.clearColor(r / 255, g / 255, b / 255, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    if (!frame) return;
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    if (view.orbit) {
      this.orbit ??= new OrbitPainter(gl, palettes);
      this.orbit.paint(frame, view, size, colouring, isMoving);
      return;
    }
    useForRods(gl, program, palettes, frame, colouring);
    gl.uniform1f(program.at.scale, 2 * view.zoom / Math.max(...frame.box_mm));
    const {count, rods, shape} = instancesOf(frame, view);
    gl.bindVertexArray(this.vertices);
    fill(gl, this.rods, rods);
    fill(gl, this.shape, shape);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
  }
}
