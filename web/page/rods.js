// SPDX-License-Identifier: MIT
// Rods on a canvas by WebGL2: one small rectangle for each, in which its outline is drawn.
import {colour as cssColour, onTheme} from "/page/dom.js";

/** A frame out of the bytes of docs/web.md. Throws where they contradict themselves. */
export function unpack(buffer) {
  const sizes = new DataView(buffer), size = sizes.getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, size)));
  const n = head.n_rods, begin = 4 + size;
  const array = (k) => new Int16Array(buffer, begin + 2 * n * k, n);
  const many = head.outlines.length > 1;
  return {...head, x: array(0), y: array(1), heading: array(2), n_z: array(3),
          species: many ? new Uint8Array(buffer, begin + 8 * n, n) : new Uint8Array(n)};
}

export function unpackText(text) {
  return unpack(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
}

/** The angle of rod i to the director, in (-90, 90] degrees. */
export function angleToDirector(frame, i) {
  const angle = frame.heading[i] / 32768 * 180 - frame.director_rad * 180 / Math.PI;
  return angle - 180 * Math.round(angle / 180);
}

/** The rod at (x, y) [mm from the middle of the view], the nearest of those that cover it; -1 where there is none. */
export function rodAt(frame, view, x, y) {
  let best = -1, least = Infinity;
  const side = frame.box_side_mm;
  for (let i = 0; i < frame.n_rods; ++i) {
    const [length, middle, end] = frame.outlines[frame.species[i]], theta = frame.heading[i] / 32768 * Math.PI;
    const off = (at, from, to) => {
      const d = to - (at / 65536 + 0.5 - from) * side;
      return frame.walls ? d : d - side * Math.round(d / side);
    };
    const dx = off(frame.x[i], view.x, x), dy = off(frame.y[i], view.y, y);
    const along = dx * Math.cos(theta) + dy * Math.sin(theta), across = -dx * Math.sin(theta) + dy * Math.cos(theta);
    const flat = length * Math.sqrt(Math.max(0, 1 - (frame.n_z[i] / 32768) ** 2));
    const beyond = Math.hypot(Math.max(0, Math.abs(along) - flat), across);
    if (beyond <= Math.max(middle, end) && beyond < least) [best, least] = [i, beyond];
  }
  return best;
}

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
  if (colouring == 0) colour = texture(layers, vec2(clamp(turned * 6.0 + 0.5, 0.0, 1.0), 0.5)).rgb;
  else if (colouring == 1) colour = texture(wheel, vec2(theta / pi, 0.5)).rgb;
  else if (colouring == 2) colour = texture(tilt, vec2(min(abs(nz) * 2.0, 1.0), 0.5)).rgb;
  if (colouring == 3 || (colouring == 0 && species > 0.5)) colour = speciesColour[min(int(species), 2)];
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

export class RodCanvas {
  constructor(canvas, marks, palettes) {
    this.canvas = canvas;
    this.marks = marks;
    this.palettes = palettes;
    this.frame = null;
    this.defects = [];
    this.showsDefects = true;
    this.colouring = "auto";
    this.automatic = "";
    this.view = {x: 0.5, y: 0.5, zoom: 1};
    this.framesDrawn = 0;
    const gl = canvas.getContext("webgl2", {antialias: false, preserveDrawingBuffer: true});
    if (!gl) throw new Error("this browser has no WebGL2, by which rods are drawn");
    this.gl = gl;
    this.makeProgram();
    this.makeBuffers();
    this.makeTextures();
    this.handlePointer();
    this.handleKeys();
    onTheme(() => this.draw());
    new ResizeObserver(() => this.draw()).observe(canvas);
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
    gl.uniform3fv(this.uniforms.speciesColour, this.palettes.species.flatMap(rgb).map((c) => c / 255));
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

  clear() {
    this.frame = null;
    this.automatic = "";
    this.defects = [];
    this.draw();
  }

  set(frame) {
    this.frame = frame;
    // spheres have no axes, and so no S; layers where there is order, the wheel where there is none, and no flicker between
    if (frame.order === null) this.automatic = "species";
    else if (frame.order > (this.automatic ? 0.6 : 0.5)) this.automatic = "layers";
    else if (frame.order < 0.4 || !this.automatic) this.automatic = "wheel";
    this.draw();
  }

  /** By what the rods are coloured now. */
  chosenColouring() { return this.colouring === "auto" ? this.automatic || "layers" : this.colouring; }

  fitSize() {
    const size = Math.max(1, Math.round(this.canvas.clientWidth * (window.devicePixelRatio || 1)));
    for (const canvas of [this.canvas, this.marks]) {
      if (canvas.width !== size) { canvas.width = size; canvas.height = size; }
    }
    return size;
  }

  /** What has changed is drawn with the browser's next picture: however many changes there were, once. */
  draw() {
    if (this.isDue) return;
    this.isDue = true;
    requestAnimationFrame(() => { this.isDue = false; this.drawNow(); });
  }

  drawNow() {
    const {gl, frame, view, uniforms} = this, size = this.fitSize();
    gl.viewport(0, 0, size, size);
    const [r, g, b] = rgb(parseInt(cssColour("panel").slice(1), 16));
    gl.clearColor(r / 255, g / 255, b / 255, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    if (frame) {
      gl.enable(gl.BLEND);
      gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
      gl.uniform1f(uniforms.scale, 2 * view.zoom / frame.box_side_mm);
      gl.uniform3fv(uniforms.outline, frame.outlines.slice(0, 8).flat());
      gl.uniform1f(uniforms.director, frame.director_rad);
      gl.uniform1i(uniforms.colouring, kColourings.indexOf(this.chosenColouring()));
      const {count, rods, species} = instancesOf(frame, view);
      for (const [buffer, values] of [[this.rods, rods], [this.species, species]]) {
        gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
        gl.bufferData(gl.ARRAY_BUFFER, values, gl.DYNAMIC_DRAW);
      }
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
    }
    this.drawMarks(size);
    ++this.framesDrawn;
  }

  /** Walls, defects and a scale bar, over the rods. */
  drawMarks(size) {
    const {frame, view} = this, context = this.marks.getContext("2d");
    context.clearRect(0, 0, size, size);
    if (!frame) return;
    const side = frame.box_side_mm, perMm = size * view.zoom / side;
    const toPixel = (x, y) => {
      let dx = x - view.x * side, dy = y - view.y * side;
      if (!frame.walls) { dx -= side * Math.round(dx / side); dy -= side * Math.round(dy / side); }
      return [size / 2 + dx * perMm, size / 2 - dy * perMm];
    };
    if (frame.walls) {
      const {arena, size_mm, inner_mm} = frame.walls, [x, y] = toPixel(side / 2, side / 2);
      context.strokeStyle = cssColour("edge");
      context.lineWidth = 2;
      if (arena === "square") context.strokeRect(x - size_mm * perMm / 2, y - size_mm * perMm / 2, size_mm * perMm, size_mm * perMm);
      for (const diameter of arena === "square" ? [] : [size_mm, ...(inner_mm > 0 ? [inner_mm] : [])]) {
        context.beginPath();
        context.arc(x, y, diameter * perMm / 2, 0, 2 * Math.PI);
        context.stroke();
      }
    }
    if (this.showsDefects) for (const one of this.defects) this.drawDefect(context, one, toPixel, size);
    const bar = [1, 2, 5, 10, 20, 50, 100, 200].filter((mm) => mm * perMm < size / 3).at(-1) ?? 1;
    context.fillStyle = cssColour("ink");
    context.strokeStyle = cssColour("panel");
    context.lineWidth = 4;
    context.font = `${Math.max(11, size / 45)}px sans-serif`;
    context.fillRect(size * 0.03, size * 0.965, bar * perMm, Math.max(2, size / 250));
    context.strokeText(`${bar} mm`, size * 0.03, size * 0.955);
    context.fillText(`${bar} mm`, size * 0.03, size * 0.955);
  }

  /** +1/2: a comet with its tail; -1/2: three arms. */
  drawDefect(context, [x, y, charge, direction], toPixel, size) {
    const [px, py] = toPixel(x, y), reach = Math.max(8, size / 45);
    const arms = charge > 0 ? [direction + Math.PI] : [0, 1, 2].map((k) => direction + 2 * Math.PI * k / 3);
    for (const [colour, width] of [["#000", 5], [charge > 0 ? "#ffd166" : "#8be9fd", 2.5]]) {
      context.strokeStyle = context.fillStyle = colour;
      context.lineWidth = width;
      context.beginPath();
      for (const angle of arms) {
        context.moveTo(px, py);
        context.lineTo(px + reach * Math.cos(angle), py - reach * Math.sin(angle));
      }
      context.stroke();
      context.beginPath();
      context.arc(px, py, reach / 3.2 + (width > 3 ? 1.5 : 0), 0, 2 * Math.PI);
      context.fill();
    }
  }

  /** What there is to say of the rod under the pointer, if there is one. */
  describe(event) {
    const {frame, view, marks} = this;
    if (!frame || !this.onRod) return;
    const width = frame.box_side_mm / view.zoom, place = (at) => ((at / 65536 + 0.5) * frame.box_side_mm).toFixed(2);
    const i = rodAt(frame, view, (event.offsetX / marks.clientWidth - 0.5) * width, (0.5 - event.offsetY / marks.clientHeight) * width);
    this.onRod(i < 0 ? "" : `Rod ${i}: x = ${place(frame.x[i])} mm, y = ${place(frame.y[i])} mm, ` +
      (frame.order === null ? "" : `${angleToDirector(frame, i).toFixed(1)}° to the director, `) +
      `n_z = ${(frame.n_z[i] / 32768).toFixed(3)}`);
  }

  reset() {
    this.view = {x: 0.5, y: 0.5, zoom: 1};
    this.draw();
  }

  /** Keeps the point under (`across`, `up`), parts of the canvas from its middle, where it is. */
  zoomTo(wanted, across = 0, up = 0) {
    const {view} = this, zoom = Math.min(40, Math.max(1, wanted));
    view.x += across / view.zoom - across / zoom;
    view.y += up / view.zoom - up / zoom;
    view.zoom = zoom;
    this.draw();
  }

  move(across, up) {
    this.view.x += across / this.view.zoom;
    this.view.y += up / this.view.zoom;
    this.draw();
  }

  handleKeys() {
    const step = 0.1, moves = {ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, step], ArrowDown: [0, -step]};
    this.marks.addEventListener("keydown", (event) => {
      if (event.key === "+" || event.key === "=") this.zoomTo(this.view.zoom * 1.25);
      else if (event.key === "-") this.zoomTo(this.view.zoom / 1.25);
      else if (event.key === "0") this.reset();
      else if (event.key in moves) this.move(...moves[event.key]);
      else return;
      event.preventDefault();
    });
  }

  handlePointer() {
    let last = null;
    this.marks.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoomTo(this.view.zoom * Math.exp(-event.deltaY / 500), event.offsetX / this.marks.clientWidth - 0.5,
                  0.5 - event.offsetY / this.marks.clientHeight);
    }, {passive: false});
    this.marks.addEventListener("pointerdown", (event) => {
      last = [event.clientX, event.clientY];
      this.marks.setPointerCapture(event.pointerId);
    });
    this.marks.addEventListener("pointerleave", () => this.onRod?.(""));
    this.marks.addEventListener("pointermove", (event) => {
      if (!last) return this.describe(event);
      this.move((last[0] - event.clientX) / this.marks.clientWidth, (event.clientY - last[1]) / this.marks.clientHeight);
      last = [event.clientX, event.clientY];
    });
    for (const end of ["pointerup", "pointercancel"]) this.marks.addEventListener(end, () => { last = null; });
  }
}
