// SPDX-License-Identifier: MIT
// Rods by WebGL2: one small rectangle for each, in which its outline is drawn.
import {colour as cssColour} from "/page/dom.js";

const kVertex = `#version 300 es
layout(location = 0) in vec2 corner;
layout(location = 1) in vec4 rod;  // its centre, from the middle of the view [mm]; heading / pi; n_z
layout(location = 2) in float species;
uniform float scale;       // half the view's width is 1 / scale [mm]
uniform vec3 outline[8];   // half length, radius in the middle, radius at the ends [mm]
uniform float director;
uniform int colouring;
uniform sampler2D layers, wheel, tilt;
uniform vec3 speciesColour[3];
out vec2 at;               // along and across the rod [mm]
flat out vec3 shape;
flat out vec3 colour;
const float pi = 3.14159265358979;
void main() {
  vec3 whole = outline[int(species)];
  float nz = rod.w;
  float flatPart = sqrt(max(0.0, 1.0 - nz * nz));
  shape = vec3(whole.x * flatPart, whole.yz);
  float width = max(shape.y, shape.z);
  at = corner * vec2(shape.x + shape.z, width) * 1.02;
  float theta = rod.z * pi;
  vec2 axis = vec2(cos(theta), sin(theta));
  vec2 place = rod.xy + at.x * axis + at.y * vec2(-axis.y, axis.x);
  gl_Position = vec4(place * scale, 0.0, 1.0);
  float turned = (theta - director) / pi;
  turned -= floor(turned + 0.5);
  if (colouring == 0) colour = texture(layers, vec2(turned + 0.5, 0.5)).rgb;
  else if (colouring == 1) colour = texture(wheel, vec2(theta / pi, 0.5)).rgb;
  else if (colouring == 2) colour = texture(tilt, vec2(clamp(nz / 0.6 + 0.5, 0.0, 1.0), 0.5)).rgb;
  if (colouring == 3 || (colouring < 2 && species > 0.5)) colour = speciesColour[min(int(species), 2)];
}`;

const kFragment = `#version 300 es
precision highp float;
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
 * and its species. `view` is {x, y, zoom}; without walls the box is periodic.
 */
export function instancesOf(frame, view) {
  const {n_rods: n, box_side_mm: side} = frame, half = side / 2 / view.zoom;
  const reach = frame.outlines.map(([length, , end]) => length + end);
  const rods = new Float32Array(4 * 9 * n), species = new Uint8Array(9 * n), shifts = frame.walls ? [0] : [0, -side, side];
  let count = 0;
  const placed = (at, middle) => {  // of the centre, from the middle of the view
    const d = (at / 65536 + 0.5 - middle) * side;
    return frame.walls ? d : d - side * Math.round(d / side);
  };
  for (let i = 0; i < n; ++i) {
    const x = placed(frame.x[i], view.x), y = placed(frame.y[i], view.y), most = half + reach[frame.species[i]];
    for (const dx of shifts) {
      if (Math.abs(x + dx) > most) continue;
      for (const dy of shifts) {
        if (Math.abs(y + dy) > most) continue;
        rods.set([x + dx, y + dy, frame.heading[i] / 32768, frame.n_z[i] / 32768], 4 * count);
        species[count++] = frame.species[i];
      }
    }
  }
  return {count, rods: rods.subarray(0, 4 * count), species: species.subarray(0, count)};
}

const kColourings = ["layers", "wheel", "tilt", "species"], kTextures = kColourings.slice(0, 3);
const rgb = (ink) => [ink >> 16 & 255, ink >> 8 & 255, ink & 255];

/**
 * The colouring that suits a frame. Spheres have no axes, and so no S; layers where there is order, the wheel where there
 * is none, and no flicker between: `before` is what was chosen last, if anything was.
 */
export function suitingColouring(frame, before = "") {
  if (frame.order === null) return "species";
  if (frame.order > (before ? 0.6 : 0.5)) return "layers";
  return frame.order < 0.4 || !before ? "wheel" : before;
}

export class RodPainter {
  constructor(canvas, palettes) {
    this.palettes = palettes;
    this.gl = canvas.getContext("webgl2", {antialias: false, preserveDrawingBuffer: true});
    if (!this.gl) throw new Error("this browser has no WebGL2, by which rods are drawn");
    this.makeProgram();
    this.makeBuffers();
    this.makeTextures();
  }

  makeProgram() {
    const {gl} = this, program = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, kVertex], [gl.FRAGMENT_SHADER, kFragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    gl.useProgram(program);
    this.uniforms = Object.fromEntries(["scale", "outline", "director", "colouring", "speciesColour", ...kTextures].map(
      (name) => [name, gl.getUniformLocation(program, name)]));
    kTextures.forEach((name, unit) => gl.uniform1i(this.uniforms[name], unit));
  }

  makeBuffers() {
    const {gl} = this;
    this.vertices = gl.createVertexArray();
    gl.bindVertexArray(this.vertices);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]), gl.STATIC_DRAW);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 2, gl.FLOAT, false, 0, 0);
    [this.rods, this.species] = [[4, gl.FLOAT], [1, gl.UNSIGNED_BYTE]].map(([size, type], i) => {
      const buffer = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.enableVertexAttribArray(i + 1);
      gl.vertexAttribPointer(i + 1, size, type, false, 0, 0);
      gl.vertexAttribDivisor(i + 1, 1);
      return buffer;
    });
  }

  makeTextures() {
    const {gl} = this;
    kTextures.forEach((name, unit) => {
      const colours = this.palettes[name];
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
      gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB8, colours.length, 1, 0, gl.RGB, gl.UNSIGNED_BYTE, new Uint8Array(colours.flatMap(rgb)));
      const filter = name === "wheel" ? gl.NEAREST : gl.LINEAR;
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, filter);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, filter);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, name === "wheel" ? gl.REPEAT : gl.CLAMP_TO_EDGE);
    });
  }

  /** Fills the canvas of `size` pixels: with the ground where `frame` is null. */
  paint(frame, view, size, colouring) {
    const {gl, uniforms} = this;
    gl.viewport(0, 0, size, size);
    const [r, g, b] = rgb(parseInt(cssColour("panel").slice(1), 16));
    gl.clearColor(r / 255, g / 255, b / 255, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    if (!frame) return;
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.uniform1f(uniforms.scale, 2 * view.zoom / frame.box_side_mm);
    gl.uniform3fv(uniforms.outline, frame.outlines.slice(0, 8).flat());
    gl.uniform1f(uniforms.director, frame.director_rad);
    gl.uniform1i(uniforms.colouring, kColourings.indexOf(colouring));
    const ofSpecies = this.palettes[colouring === "species" ? "species" : "others"];
    gl.uniform3fv(uniforms.speciesColour, ofSpecies.flatMap(rgb).map((c) => c / 255));
    const {count, rods, species} = instancesOf(frame, view);
    for (const [buffer, values] of [[this.rods, rods], [this.species, species]]) {
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, values, gl.DYNAMIC_DRAW);
    }
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
  }
}
