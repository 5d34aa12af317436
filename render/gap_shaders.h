// SPDX-License-Identifier: MIT
#pragma once

/// GLSL of the gap pass. Lengths are in mm, relative to the eye; y is the direction of view.
namespace shaken::render::shaders {

/// One quad on the screen around each rod.
inline constexpr const char* kGapRod = R"(#version 330 core
layout(location = 0) in vec3 centre;
layout(location = 1) in vec3 axis;
layout(location = 2) in vec3 colour;
uniform vec2 beads[255];  // offset along the axis, radius
uniform int n_beads;
uniform vec2 tangent;
flat out vec3 rod_centre;
flat out vec3 rod_axis;
flat out vec3 rod_colour;
out vec2 slope;  // of the ray: x / y, z / y

void main() {
  vec2 low = vec2(1e9), high = vec2(-1e9);
  for (int i = 0; i < n_beads; ++i) {
    vec3 c = centre + beads[i].x * axis;
    float r = beads[i].y;
    // A sphere lies within the box around it, and that within its nearer and its farther face.
    float near = max(c.y - r, 1e-3), far = c.y + r;
    low = min(low, min((c.xz - r) / near, (c.xz - r) / far));
    high = max(high, max((c.xz + r) / near, (c.xz + r) / far));
  }
  slope = mix(low, high, vec2(gl_VertexID & 1, gl_VertexID >> 1));
  rod_centre = centre;
  rod_axis = axis;
  rod_colour = colour;
  gl_Position = vec4(slope / tangent, 0.0, 1.0);
}
)";

/// The nearest bead along the ray.
inline constexpr const char* kGapBody = R"(#version 330 core
uniform vec2 beads[255];
uniform int n_beads;
uniform vec2 ends;
uniform float pitch;   // distance of neighbouring beads; 0 if it is not the same everywhere
uniform float thick;   // greatest radius
uniform vec2 depths;   // where the depth buffer begins and ends
uniform vec2 plates;   // heights of base and lid
uniform float front;
uniform vec3 haze;     // what everything fades into
flat in vec3 rod_centre;
flat in vec3 rod_axis;
flat in vec3 rod_colour;
in vec2 slope;
out vec4 pixel;

const vec3 kLight = vec3(-0.42, -0.50, 0.757);

void main() {
  vec3 ray = vec3(slope.x, 1.0, slope.y);
  float square = dot(ray, ray);
  float nearest = 1e9;
  vec3 normal = vec3(0.0);
  // Only beads near the point of the axis that the ray comes closest to can be hit.
  int first = 0, last = n_beads - 1;
  vec3 direction = ray / sqrt(square);
  float cosine = dot(direction, rod_axis);
  float sine = 1.0 - cosine * cosine;  // squared
  if (pitch > 0.0 && sine > 1e-3) {
    float middle = (cosine * dot(direction, rod_centre) - dot(rod_axis, rod_centre)) / sine;
    float reach = thick / sqrt(sine);
    first = max(first, int(floor((middle - reach - ends.x) / pitch)));
    last = min(last, int(ceil((middle + reach - ends.x) / pitch)));
    vec3 from_axis = cross(direction, rod_axis);
    float apart = dot(rod_centre, from_axis);
    if (apart * apart > thick * thick * sine * 1.001) last = -1;
  }
  for (int i = first; i <= last; ++i) {
    vec3 c = rod_centre + beads[i].x * rod_axis;
    float r = beads[i].y;
    float half_b = dot(ray, c);
    float inside = half_b * half_b - square * (dot(c, c) - r * r);
    float t = (half_b - sqrt(max(inside, 0.0))) / square;
    if (inside > 0.0 && t < nearest) {
      nearest = t;
      normal = (t * ray - c) / r;
    }
  }
  if (nearest > 1e8) discard;
  vec3 hit = nearest * ray;
#ifdef SMOOTH
  // The beads' own normals, eased towards those of a smooth spindle.
  vec3 from_centre = hit - rod_centre;
  vec3 spindle = from_centre - clamp(dot(from_centre, rod_axis), ends.x, ends.y) * rod_axis;
  normal = normalize(mix(normal, normalize(spindle), 0.8));
#endif

  vec3 eye = -normalize(ray);
  float diffuse = 0.5 + 0.5 * dot(normal, kLight);
  float shade = 0.35 + 0.72 * diffuse;
#ifdef OCCLUSION
  float rim = smoothstep(-0.05, 0.75, dot(normal, eye));
  // Close to a plate less light comes in.
  float room = clamp((hit.z - plates.x) / (0.4 * (plates.y - plates.x)), 0.0, 1.0);
  shade = shade * mix(0.45, 1.0, rim) * mix(0.70, 1.04, room);
#endif
#ifdef GLOSS
  float gloss = pow(max(dot(normal, normalize(kLight + eye)), 0.0), 40.0) * 0.16;
#else
  float gloss = 0.0;
#endif
  vec3 light = rod_colour * rod_colour * shade + gloss;
  float clear = clamp((depths.y - hit.y) / (depths.y - front), 0.0, 1.0);
  pixel = vec4(mix(haze, sqrt(min(light, 1.0)), smoothstep(0.0, 0.9, clear)), 1.0);
  gl_FragDepth = clamp((hit.y - depths.x) / (depths.y - depths.x), 0.0, 0.9999);
}
)";

/// The shadow's quad on the base, and its darkness.
inline constexpr const char* kGapShadowQuad = R"(#version 330 core
layout(location = 0) in vec3 centre;
layout(location = 1) in vec3 axis;
layout(location = 2) in vec3 colour;
uniform vec2 beads[255];
uniform int n_beads;
uniform vec2 tangent;
uniform vec2 plates;
uniform float margin;
flat out vec3 rod_axis;
flat out float rod_radius;
out vec2 place;  // from the rod's centre
out float depth;

void main() {
  float flat_part = length(axis.xy);
  vec2 along = flat_part > 1e-6 ? axis.xy / flat_part : vec2(1.0, 0.0);
  vec2 reach = vec2(0.0);
  for (int i = 0; i < n_beads; ++i) {
    reach = max(reach, vec2(abs(beads[i].x) * flat_part + beads[i].y, beads[i].y));
  }
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  place = along * (corner.x * (reach.x + margin)) + vec2(-along.y, along.x) * (corner.y * (reach.y + margin));
  rod_axis = axis;
  rod_radius = reach.y;
  vec2 at = centre.xy + place;
  depth = at.y;
  // The weight makes `place` right in perspective.
  float y = max(at.y, 1e-3);
  gl_Position = vec4(at.x / tangent.x, plates.x / tangent.y, 0.0, y);
}
)";
inline constexpr const char* kGapShadow = R"(#version 330 core
uniform vec2 ends;
uniform vec2 depths;
uniform float margin;
uniform float front;
flat in vec3 rod_axis;
flat in float rod_radius;
in vec2 place;
in float depth;
out vec4 pixel;

void main() {
  if (depth < front) discard;
  float flat_part = max(dot(rod_axis.xy, rod_axis.xy), 1e-9);
  float o = clamp(dot(place, rod_axis.xy) / flat_part, ends.x, ends.y);
  // A spindle, which is near enough for a shadow.
  float radius = rod_radius * (1.0 - 0.5 * abs(o) / max(ends.y, 1e-3));
  float dark = 1.0 - clamp((length(place - o * rod_axis.xy) - 0.6 * radius) / (margin + 0.4 * radius), 0.0, 1.0);
  float clear = clamp((depths.y - depth) / (depths.y - front), 0.0, 1.0);
  pixel = vec4(0.0, 0.0, 0.0, 0.42 * dark * dark * clear);
}
)";

/// The whole stage as one quad.
inline constexpr const char* kStage = R"(#version 330 core
uniform vec2 tangent;
out vec2 slope;

void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  slope = corner * tangent;
  gl_Position = vec4(corner, 0.0, 1.0);
}
)";

/// The plates: cut open at the front, with lines every 5 mm on their faces.
inline constexpr const char* kPlates = R"(#version 330 core
uniform vec2 plates;
uniform bool has_lid;
uniform float front;
uniform vec2 depths;
uniform vec2 origin;    // of the lines, relative to the eye
uniform float thickness;
uniform vec3 page;
uniform vec3 face;
uniform vec3 cut;
uniform vec3 ink;
uniform vec3 haze;
in vec2 slope;
out vec4 pixel;

float line_at(float x, float width) {
  float from = abs(fract(x / 5.0 + 0.5) - 0.5) * 5.0;
  return 1.0 - smoothstep(0.5 * width, 1.5 * width, from);
}

void main() {
  gl_FragDepth = 0.99995;
  float z = slope.y * front;
  float edge = 0.012 * (plates.y - plates.x);
  // The cut edges stand in front of everything.
  if (z < plates.x || (has_lid && z > plates.y)) {
    float into = z < plates.x ? plates.x - z : z - plates.y;
    vec3 colour = into < edge ? ink : cut;
    if (into > thickness) colour = page;
    pixel = vec4(colour, 1.0);
    gl_FragDepth = 0.0;
    return;
  }
  float height = slope.y < 0.0 ? plates.x : plates.y;
  float t = slope.y == 0.0 ? 1e9 : height / slope.y;
  if (t > depths.y || t < 0.0 || (slope.y > 0.0 && !has_lid)) {
    pixel = vec4(haze, 1.0);
    return;
  }
  vec2 at = vec2(slope.x * t, t) - origin;
  float width = 0.0016 * t;
  float lines = max(line_at(at.x, width), line_at(at.y, width));
  float clear = smoothstep(0.0, 0.9, clamp((depths.y - t) / (depths.y - front), 0.0, 1.0));
  vec3 colour = mix(face * (slope.y < 0.0 ? 1.0 : 0.93), ink, 0.12 * lines);
  pixel = vec4(mix(haze, colour, clear), 1.0);
}
)";

}  // namespace shaken::render::shaders
