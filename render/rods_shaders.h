// SPDX-License-Identifier: MIT
#pragma once

/// GLSL of the rods pass. Lengths are in mm; `place` is relative to the view's lower left corner.
namespace shaken::render::shaders {

/// One quad around the projection of each rod, `margin` wider on every side.
inline constexpr const char* kQuad = R"(#version 330 core
layout(location = 0) in vec3 centre;
layout(location = 1) in vec3 axis;
layout(location = 2) in vec3 colour;
uniform vec2 beads[255];  // offset along the axis, radius
uniform int n_beads;
uniform float view_side;
uniform float margin;
uniform vec2 shift;
flat out vec3 rod_axis;
flat out vec3 rod_colour;
flat out float rod_height;
out vec2 place;  // relative to the rod's centre

void main() {
  float flat_part = length(axis.xy);
  vec2 along = flat_part > 1e-6 ? axis.xy / flat_part : vec2(1.0, 0.0);
  vec2 reach = vec2(0.0);
  for (int i = 0; i < n_beads; ++i) {
    reach = max(reach, vec2(abs(beads[i].x) * flat_part + beads[i].y, beads[i].y));
  }
  reach += margin;
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  place = along * (corner.x * reach.x) + vec2(-along.y, along.x) * (corner.y * reach.y);
  rod_axis = axis;
  rod_colour = colour;
  rod_height = centre.z;
  gl_Position = vec4((centre.xy + shift + place) / view_side * 2.0 - 1.0, 0.0, 1.0);
}
)";

/// The body: the highest bead along the pixel's ray.
inline constexpr const char* kBody = R"(#version 330 core
uniform vec2 beads[255];
uniform int n_beads;
uniform vec2 ends;       // offsets of the first and the last bead
uniform float pitch;     // distance of neighbouring beads; 0 if it is not the same everywhere
uniform float thick;     // greatest radius
uniform float low;       // heights that the depth buffer spans
uniform float high;
flat in vec3 rod_axis;
flat in vec3 rod_colour;
flat in float rod_height;
in vec2 place;
out vec4 pixel;

const vec3 kLight = vec3(-0.42, 0.50, 0.757);
const vec3 kHalfway = vec3(-0.224, 0.267, 0.937);  // between the light and the eye

void main() {
  // Squared distance to bead i: |place|^2 - 2 o (place . axis) + o^2 |axis.xy|^2.
  float square = dot(place, place);
  float along = 2.0 * dot(place, rod_axis.xy);
  float flat_part = dot(rod_axis.xy, rod_axis.xy);
  float top = -1e9;
  vec3 normal = vec3(0.0);
  // Only beads whose centre is no farther along the rod than the thickest one reaches can be hit.
  int first = 0, last = n_beads - 1;
  if (pitch > 0.0 && flat_part > 1e-4) {
    float middle = 0.5 * along / flat_part - ends.x;
    float reach = thick / sqrt(flat_part);
    first = max(first, int(floor((middle - reach) / pitch)));
    last = min(last, int(ceil((middle + reach) / pitch)));
  }
  for (int i = first; i <= last; ++i) {
    float o = beads[i].x;
    float r = beads[i].y;
    float inside = r * r - (square + o * (o * flat_part - along));
    float z = o * rod_axis.z + sqrt(max(inside, 0.0));
    if (inside > 0.0 && z > top) {
      top = z;
      normal = (vec3(place, z) - o * rod_axis) / r;
    }
  }
  if (top < -1e8) discard;

#ifdef SMOOTH
  // The beads' own normals, eased towards those of a smooth spindle: round bodies rather than strings of pearls.
  vec3 hit = vec3(place, top);
  vec3 spindle = hit - clamp(dot(hit, rod_axis), ends.x, ends.y) * rod_axis;
  normal = normalize(mix(normal, normalize(spindle), 0.8));
#endif

  // Never quite at the floor of the depth buffer, where nothing is drawn.
  float height = clamp((rod_height + top - low) / (high - low), 0.001, 1.0);
  float diffuse = 0.5 + 0.5 * dot(normal, kLight);               // wrapped: soft
#ifdef OCCLUSION
  float rim = smoothstep(-0.05, 0.75, normal.z);                 // the sides see their neighbours, not the sky
  float shade = (0.35 + 0.72 * diffuse) * mix(0.34, 1.0, rim) * mix(0.80, 1.04, height);
#else
  float shade = (0.35 + 0.72 * diffuse) * mix(0.80, 1.04, height);
#endif
#ifdef GLOSS
  float gloss = pow(max(dot(normal, kHalfway), 0.0), 40.0) * 0.16;
#else
  float gloss = 0.0;
#endif
  // Light adds up in linear units; a square root is near enough to sRGB's curve, and exact on the way back.
  vec3 light = rod_colour * rod_colour * shade + gloss;
  pixel = vec4(sqrt(min(light, 1.0)), 1.0);
  gl_FragDepth = 1.0 - height;
}
)";

/// The soft shadow on the floor: dark under the rod, fading out over `margin`.
inline constexpr const char* kShadow = R"(#version 330 core
uniform vec2 beads[255];
uniform int n_beads;
uniform vec2 ends;
uniform float margin;
uniform vec3 floor_colour;
flat in vec3 rod_axis;
flat in vec3 rod_colour;
flat in float rod_height;
in vec2 place;
out vec4 pixel;

void main() {
  float flat_part = max(dot(rod_axis.xy, rod_axis.xy), 1e-9);
  float o = clamp(dot(place, rod_axis.xy) / flat_part, ends.x, ends.y);
  // Between two beads the radius changes linearly. They stand at equal distances.
  float between = ends.y > ends.x ? (o - ends.x) / (ends.y - ends.x) * float(n_beads - 1) : 0.0;
  int lower = min(int(between), n_beads - 1);
  float radius = mix(beads[lower].y, beads[min(lower + 1, n_beads - 1)].y, between - float(lower));
  float outside = (length(place - o * rod_axis.xy) - radius) / margin;
  float dark = 1.0 - clamp(outside, 0.0, 1.0);
  pixel = vec4(floor_colour * (1.0 - 0.50 * dark * dark), 1.0);
}
)";

/// The whole view as one quad.
inline constexpr const char* kView = R"(#version 330 core
uniform float view_side;
out vec2 place;

void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  place = corner * view_side;
  gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}
)";

/// What lies beyond the side walls, with a line along its edge. Walls stand upright: no shadow falls there.
inline constexpr const char* kWalls = R"(#version 330 core
uniform int arena;        // 0 disc, 1 square, 2 annulus
uniform float size;       // diameter, or side of the square
uniform float inner;      // diameter of the annulus' inner wall
uniform float box_side;
uniform vec2 view_corner;
uniform float line;       // its thickness
uniform vec3 wall_colour;
uniform vec3 line_colour;
in vec2 place;
out vec4 pixel;

void main() {
  vec2 from_middle = view_corner + place - 0.5 * box_side;
  float r = length(from_middle);
  float outside = r - 0.5 * size;
  if (arena == 1) outside = max(abs(from_middle.x), abs(from_middle.y)) - 0.5 * size;
  if (arena == 2) outside = max(outside, 0.5 * inner - r);
  if (outside <= 0.0) discard;
  pixel = vec4(outside < line ? line_colour : wall_colour, 1.0);
}
)";

}  // namespace shaken::render::shaders
