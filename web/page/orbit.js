// Rods by WebGL2 as bodies between their plates, in perspective from anywhere above: as `shaken picture --view orbit` has it.
import {colour as cssColour} from "./dom.js";
import {attribute, fill, kColourOf, newProgram, rgb, useForRods} from "./gl.js";
import {halfTurns, kUpright, partOf, periodOf} from "./plane.js";

const kSegments = 10;    // around a rod
const kTangent = 0.27;   // of half the angle of view
const kMargin = 1.03;

const kVertex = `
layout(location = 0) in vec4 ring;  // parts of the half length, and of the end's radius, along the rod; radius / end's; angle
layout(location = 1) in vec4 rod;   // its centre [mm]; heading / pi
layout(location = 2) in vec2 kind;  // n_z, which outline
uniform mat4 look;
uniform vec3 toEye;
uniform vec4 outline[27];           // half length, radius in the middle, radius at the ends [mm]; species
centroid out vec3 colour;
${kColourOf}
void main() {
  vec4 shape = outline[int(kind.y)];
  float theta = rod.w * pi, nz = kind.x, flatPart = sqrt(max(0.0, 1.0 - nz * nz));
  vec3 axis = vec3(flatPart * cos(theta), flatPart * sin(theta), nz);
  vec3 across = vec3(-sin(theta), cos(theta), 0.0), third = cross(axis, across);
  vec3 radial = cos(ring.w) * across + sin(ring.w) * third;
  float radius = ring.x == 0.0 ? shape.y : shape.z * ring.z;
  vec3 place = rod.xyz + (ring.x * shape.x + ring.y * shape.z) * axis + radius * radial;
  gl_Position = look * vec4(place, 1.0);
  vec3 normal = normalize(ring.y * axis + ring.z * radial);
  vec3 light = normalize(toEye + vec3(0.0, 0.0, 0.6));
  colour = colourOf(theta, nz, shape.w) * (0.35 + 0.65 * max(0.0, dot(normal, light)));
}`;
const kFragment = `
centroid in vec3 colour;
out vec4 ink;
void main() { ink = vec4(colour, 1.0); }`;

const kPlateVertex = `
layout(location = 0) in vec3 place;
uniform mat4 look;
void main() { gl_Position = look * vec4(place, 1.0); }`;
const kPlateFragment = `
uniform vec4 shade;
out vec4 ink;
void main() { ink = vec4(shade.rgb * shade.a, shade.a); }`;

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/**
 * The eye for a view {x, y, zoom, orbit: [azimuth, elevation]} of a box, by the formulas of render/camera.cpp: azimuth 0 is
 * from below the picture from above, 90 from its right, elevation 90 from above [degrees]. At zoom 1 the box just fits.
 * Returns {eye, right, up, forward, half: tangent, distance, radius}; lengths in mm.
 */
export function cameraOf({box_mm: [width, height], gap_mm: gap}, {x, y, zoom, orbit}) {
  const [azimuth, elevation] = orbit.map((degrees) => degrees * Math.PI / 180);
  const right = [Math.cos(azimuth), Math.sin(azimuth), 0], flat = Math.cos(elevation);
  const forward = [-right[1] * flat, right[0] * flat, -Math.sin(elevation)], up = cross(right, forward);
  let distance = 0, radius = 0;
  for (let corner = 0; corner < 8; ++corner) {
    const at = [((corner & 1) - 0.5) * width, ((corner >> 1 & 1) - 0.5) * height, ((corner >> 2) - 0.5) * gap];
    const aside = Math.max(Math.abs(dot(right, at)), Math.abs(dot(up, at)));
    distance = Math.max(distance, kMargin * aside / kTangent - dot(forward, at));
    radius = Math.max(radius, Math.hypot(...at));
  }
  const eye = [x * width, y * height, gap / 2].map((one, k) => one - distance * forward[k]);
  return {eye, right, up, forward, half: kTangent / Math.max(zoom, 1), distance, radius};
}

/** What the eye sees as a matrix for WebGL, column by column. */
export function matrixOf({eye, right, up, forward, half, distance, radius}) {
  const near = 0.1 * distance, far = distance + 3 * radius;
  const rows = [right.map((one) => one / half), up.map((one) => one / half), forward.map((one) => one * (far + near) / (far - near)), forward];
  const last = rows.map((row) => -dot(row, eye));
  last[2] -= 2 * far * near / (far - near);
  return [0, 1, 2].flatMap((k) => rows.map((row) => row[k])).concat(last);
}

/** A body of revolution: corners on rings from one tip to the other, as kVertex has them, and triangles between them. */
function bodyOfRings() {
  const cap = [[1, 0], [0.71, 0.71], [0, 1]], ends = (sign, /** @type {number[]} */ [along, radius]) => [sign, sign * along, radius];
  const rings = [...cap.map((ring) => ends(-1, ring)), [0, 0, 1], ...[...cap].reverse().map((ring) => ends(1, ring))];
  const corners = rings.flatMap((ring) => Array.from({length: kSegments}, (_, i) => [...ring, 2 * Math.PI * i / kSegments]));
  const triangles = [];
  for (let k = 0; k + 1 < rings.length; ++k) {
    for (let i = 0; i < kSegments; ++i) {
      const [a, b] = [i, (i + 1) % kSegments].map((j) => k * kSegments + j), [c, d] = [a + kSegments, b + kSegments];
      triangles.push(a, b, c, c, b, d);
    }
  }
  return {corners: new Float32Array(corners.flat()), triangles: new Uint16Array(triangles)};
}

/** The edges of what rods may be in: of the box, or of its arena, and of the posts in it. Corners of closed lines. */
export function edgesOf(frame) {
  const circle = ([x, y], radius) => Array.from({length: 36}, (_, k) =>
    [x + radius * Math.cos(k * Math.PI / 18), y + radius * Math.sin(k * Math.PI / 18)]);
  const {diameter_mm = 0, centres_mm = []} = frame.posts ?? {};
  return [...outerEdgesOf(frame), ...centres_mm.map((centre) => circle(centre, diameter_mm / 2))];
}

function outerEdgesOf({box_mm: [width, height], walls}) {
  const rectangle = (a, b) => [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([x, y]) => [(width + x * a) / 2, (height + y * b) / 2]);
  if (!walls) return [rectangle(width, height)];
  if (walls.arena === "square") return [rectangle(walls.size_mm, walls.size_mm)];
  if (walls.arena === "channel") return [rectangle(width, walls.size_mm)];
  const {size_mm, inner_mm, length_mm = 0, narrow_mm = 0, arena} = walls, turned = (k) => (k + 0.5) * Math.PI / 36;
  if (arena === "wedge") {
    return [[[-1, -size_mm], [1, -narrow_mm], [1, narrow_mm], [-1, size_mm]].map(([x, y]) => [(width + x * length_mm) / 2, (height + y) / 2])];
  }
  if (arena === "ellipse") {
    return [Array.from({length: 72}, (_, k) =>
      [(width + length_mm * Math.cos(turned(k))) / 2, (height + size_mm * Math.sin(turned(k))) / 2])];
  }
  const round = (size, length) => Array.from({length: 72}, (_, k) =>
    [(width + size * Math.cos(turned(k)) + length * Math.sign(Math.cos(turned(k)))) / 2, (height + size * Math.sin(turned(k))) / 2]);
  return [round(size_mm, length_mm), ...(arena === "annulus" ? [round(inner_mm, 0)] : [])];
}

/** Where the rods are: 4 numbers for each, its centre [mm] and its heading / pi; half way up where heights are not known. */
export function placesOf({n_rods, box_mm: [width, height], gap_mm, x, y, z, heading}) {
  const places = new Float32Array(4 * n_rods);
  for (let i = 0; i < n_rods; ++i) {
    const above = z ? (z[i] / kUpright + 0.5) * gap_mm : gap_mm / 2;
    places.set([partOf(x[i]) * width, partOf(y[i]) * height, above, halfTurns(heading[i])], 4 * i);
  }
  return places;
}

export class OrbitPainter {
  constructor(gl, palettes) {
    this.gl = gl;
    this.palettes = palettes;
    this.bodies = newProgram(gl, kVertex, kFragment);
    this.plates = newProgram(gl, kPlateVertex, kPlateFragment);
    const {corners, triangles} = bodyOfRings();
    this.nIndices = triangles.length;
    this.vertices = gl.createVertexArray();
    gl.bindVertexArray(this.vertices);
    fill(gl, attribute(gl, 0, 4, gl.FLOAT), corners);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, triangles, gl.STATIC_DRAW);
    this.rods = attribute(gl, 1, 4, gl.FLOAT, true);
    this.kinds = attribute(gl, 2, 2, gl.FLOAT, true);
    this.plateVertices = gl.createVertexArray();
    gl.bindVertexArray(this.plateVertices);
    this.places = attribute(gl, 0, 3, gl.FLOAT);
    this.smooth = gl.createFramebuffer();
    this.layers = [gl.createRenderbuffer(), gl.createRenderbuffer()];
  }

  /** Begins a picture with depths, and with `wanted` samples for each pixel: four cost three times as much without a GPU. */
  begin(size, wanted) {
    const {gl} = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.smooth);
    const samples = Math.min(wanted, gl.getParameter(gl.MAX_SAMPLES));
    if (size !== this.size || samples !== this.samples) {
      this.size = size;
      this.samples = samples;
      for (const [layer, format, place] of [[this.layers[0], gl.RGBA8, gl.COLOR_ATTACHMENT0],
                                            [this.layers[1], gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT]]) {
        gl.bindRenderbuffer(gl.RENDERBUFFER, layer);
        gl.renderbufferStorageMultisample(gl.RENDERBUFFER, samples, format, size, size);
        gl.framebufferRenderbuffer(gl.FRAMEBUFFER, place, gl.RENDERBUFFER, layer);
      }
    }
    gl.enable(gl.DEPTH_TEST);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  }

  end() {
    const {gl, size} = this;
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, this.smooth);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
    gl.blitFramebuffer(0, 0, size, size, 0, 0, size, size, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.disable(gl.DEPTH_TEST);
  }

  /** `isMoving` spares samples. */
  paint(frame, view, size, colouring, isMoving) {
    const {gl} = this, period = periodOf(frame);
    const [x, y] = [view.x, view.y].map((part, axis) => (period[axis] > 0 ? part - Math.floor(part) : part));
    const camera = cameraOf(frame, {...view, x, y}), look = matrixOf(camera);
    this.begin(size, isMoving ? 0 : 4);
    this.paintPlates(frame, look, [[gl.TRIANGLE_FAN, 0, 0.12]]);
    this.paintRods(frame, look, camera.forward.map((one) => -one), colouring);
    this.paintPlates(frame, look, [[gl.LINE_LOOP, 0, 0.8], [gl.LINES, 0, 0.4], [gl.LINE_LOOP, frame.gap_mm, 0.6], [gl.TRIANGLE_FAN, frame.gap_mm, 0.06]]);
    this.end();
  }

  paintRods(frame, look, toEye, colouring) {
    const {gl, bodies} = this, n = frame.n_rods, kinds = new Float32Array(2 * n);
    for (let i = 0; i < n; ++i) kinds.set([frame.n_z[i] / kUpright, frame.shape[i]], 2 * i);
    useForRods(gl, bodies, this.palettes, frame, colouring);
    gl.uniformMatrix4fv(bodies.at.look, false, look);
    gl.uniform3fv(bodies.at.toEye, toEye);
    gl.bindVertexArray(this.vertices);
    fill(gl, this.rods, placesOf(frame));
    fill(gl, this.kinds, kinds);
    gl.enable(gl.CULL_FACE);  // what looks away is hidden anyway
    gl.drawElementsInstanced(gl.TRIANGLES, this.nIndices, gl.UNSIGNED_SHORT, 0, n);
    gl.disable(gl.CULL_FACE);
  }

  /** Parts of the plates: [what of it, at which height, how dark]. They hide nothing. */
  paintPlates(frame, look, parts) {
    const {gl, plates} = this, [r, g, b] = rgb(parseInt(cssColour("edge").slice(1), 16));
    gl.useProgram(plates.program);
    gl.bindVertexArray(this.plateVertices);
    gl.uniformMatrix4fv(plates.at.look, false, look);
    gl.depthMask(false);
    for (const [what, height, darkness] of parts) {
      gl.uniform4f(plates.at.shade, r / 255, g / 255, b / 255, darkness);
      const lines = edgesOf(frame), isUpright = what === gl.LINES;
      for (const line of what === gl.TRIANGLE_FAN ? lines.slice(0, 1) : lines) {
        const feet = line.filter((_, k) => k % Math.ceil(line.length / 8) === 0);
        const places = isUpright ? feet.flatMap(([x, y]) => [x, y, 0, x, y, frame.gap_mm]) : line.flatMap(([x, y]) => [x, y, height]);
        fill(gl, this.places, new Float32Array(places));
        gl.drawArrays(what, 0, places.length / 3);
      }
    }
    gl.depthMask(true);
  }
}
