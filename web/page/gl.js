// What the two painters of rods share: programs of WebGL2, and the colours of rods in them.

const kTextures = ["layers", "wheel", "tilt"], kColourings = [...kTextures, "species"];
export const rgb = (ink) => [ink >> 16 & 255, ink >> 8 & 255, ink & 255];

/** Of a rod with in-plane angle `theta` and vertical part `nz`. */
export const kColourOf = `
uniform float director, fullTilt;
uniform int colouring;
uniform sampler2D layers, wheel, tilt;
uniform vec3 speciesColour[3];
const float pi = 3.14159265358979;
vec3 colourOf(float theta, float nz, float species) {
  if (colouring == 3 || (colouring < 2 && species > 0.5)) return speciesColour[min(int(species), 2)];
  float turned = (theta - director) / pi;
  turned -= floor(turned + 0.5);
  if (colouring == 0) return texture(layers, vec2(turned + 0.5, 0.5)).rgb;
  if (colouring == 1) return texture(wheel, vec2(theta / pi, 0.5)).rgb;
  return texture(tilt, vec2(clamp(nz / (2.0 * fullTilt) + 0.5, 0.0, 1.0), 0.5)).rgb;
}`;

/** A program with the places of its uniforms: {program, at: {name: location}}. Throws what the compiler says. */
export function newProgram(gl, vertex, fragment) {
  const program = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, `#version 300 es\nprecision highp float;\n${source}`);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  const at = {};
  for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); ++i) {
    const name = gl.getActiveUniform(program, i).name.replace("[0]", "");
    at[name] = gl.getUniformLocation(program, name);
  }
  return {program, at};
}

/** A buffer of one attribute of the vertex array that is bound: of each instance if it `isOfInstance`. */
export function attribute(gl, index, size, type, isOfInstance) {
  const buffer = gl.createBuffer();
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  gl.enableVertexAttribArray(index);
  gl.vertexAttribPointer(index, size, type, false, 0, 0);
  gl.vertexAttribDivisor(index, isOfInstance ? 1 : 0);
  return buffer;
}

export function fill(gl, buffer, values) {
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  gl.bufferData(gl.ARRAY_BUFFER, values, gl.DYNAMIC_DRAW);
}

/** The palettes, a texture for each unit. */
export function makeTextures(gl, palettes) {
  kTextures.forEach((name, unit) => {
    const colours = palettes[name];
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

/** Uses a program that has kColourOf, for the rods of a frame. */
export function useForRods(gl, {program, at}, palettes, frame, colouring) {
  gl.useProgram(program);
  kTextures.forEach((name, unit) => gl.uniform1i(at[name], unit));
  const ofSpecies = palettes[colouring === "species" ? "species" : "others"];
  gl.uniform3fv(at.speciesColour, ofSpecies.flatMap(rgb).map((c) => c / 255));
  const speciesOf = frame.species_of_outline;
  gl.uniform4fv(at.outline, frame.outlines.slice(0, 27).flatMap((one, k) => [...one, speciesOf.length ? speciesOf[k] : k]));
  gl.uniform1f(at.director, frame.director_rad);
  gl.uniform1f(at.fullTilt, palettes.full_tilt);
  gl.uniform1i(at.colouring, kColourings.indexOf(colouring));
}
