#pragma once

/// GLSL of the rods pass. Lengths are in mm; places are relative to the eye, along the axes of the box.
namespace shaken::render::shaders {

/// What vertex shaders know of the camera: rows of `axes` are to the right, up and forward.
inline constexpr const char* kCamera = R"(#version 330 core
uniform mat3 axes;
uniform vec2 half_view;  // mm if rays are parallel, else tangents
uniform bool is_parallel;

// Where a point lies on the screen; the weight makes what is interpolated right in perspective.
vec4 on_screen(vec3 point) {
  vec3 seen = axes * point;
  return vec4(seen.xy / half_view, 0.0, is_parallel ? 1.0 : seen.z);
}
vec3 start_of(vec2 slope) { return is_parallel ? transpose(axes) * vec3(slope, 0.0) : vec3(0.0); }
vec3 ray_of(vec2 slope) { return transpose(axes) * (is_parallel ? vec3(0.0, 0.0, 1.0) : vec3(slope, 1.0)); }
vec2 corner() { return vec2(gl_VertexID & 1, gl_VertexID >> 1); }
)";

/// What fragment shaders know of the floor: where it ends (ENDS), and how all fades with depth (FADES).
inline constexpr const char* kFloor = R"(#version 330 core
uniform bool is_round;   // the arena's ends; or it is a trapezoid
uniform vec2 middle;     // of the arena
uniform vec2 size;       // diameters of the ends along x and y, or sides of the trapezoid's rectangle
uniform float narrow;    // side of the trapezoid at larger x, along y
uniform float inner;     // diameter of the inner wall; 0: there is none
uniform float between;   // distance of the ends' centres, along x
uniform vec2 fade;       // depths where fading into the page begins and ends
uniform vec3 page;
uniform vec3 floor_colour;

// How far a point of the floor lies beyond the arena's edge: of an ellipse exact only at the edge.
float beyond(vec2 at) {
#ifndef ENDS
  return -1.0;
#endif
  vec2 from_middle = at - middle;
  if (!is_round) {
    float slope = 0.5 * (size.y - narrow) / size.x;
    float past_slant = abs(from_middle.y) - 0.25 * (size.y + narrow) + slope * from_middle.x;
    return max(abs(from_middle.x) - 0.5 * size.x, past_slant * inversesqrt(1.0 + slope * slope));
  }
  vec2 from_end = vec2(max(abs(from_middle.x) - 0.5 * between, 0.0), from_middle.y);
  float r = length(from_end);
  vec2 squeezed = 2.0 * from_end / size;
  float part = length(squeezed);  // of the way to the edge
  float past_end = size.x == size.y ? r - 0.5 * size.x : (part - 1.0) * part / max(length(2.0 * squeezed / size), 1e-9);
  return max(past_end, 0.5 * inner - r);
}
vec3 faded(vec3 colour, float depth) {
#ifndef FADES
  return colour;
#endif
  return mix(page, colour, smoothstep(0.0, 0.9, clamp((fade.y - depth) / (fade.y - fade.x), 0.0, 1.0)));
}
)";

/// One quad around each rod as it is seen. (After kCamera.)
inline constexpr const char* kQuad = R"(
layout(location = 0) in vec3 centre;
layout(location = 1) in vec3 axis;
layout(location = 2) in vec3 colour;
uniform vec2 beads[255];  // offset along the axis, radius
uniform int n_beads;
flat out vec3 rod_centre;
flat out vec3 rod_axis;
flat out vec3 rod_colour;
out vec3 start;  // of the ray, from the rod's centre
out vec3 ray;

// Where a bead is seen, and a radius in which all of it lies: |u.xy - s u.z| <= sqrt(1 + s^2) for a unit vector u.
vec3 seen_bead(vec3 c, vec3 a, int i) {
  vec3 p = c + beads[i].x * a;
  if (is_parallel) return vec3(p.xy, beads[i].y);
  vec2 s = p.xy / p.z;
  return vec3(s, beads[i].y * sqrt(1.0 + dot(s, s)) / max(p.z - beads[i].y, 1e-3));
}

void main() {
  vec3 c = axes * centre, a = axes * axis;
  vec2 line = seen_bead(c, a, n_beads - 1).xy - seen_bead(c, a, 0).xy;
  float extent = length(line);
  vec2 along = extent > 1e-6 ? line / extent : vec2(1.0, 0.0);
  mat2 turn = mat2(along.x, -along.y, along.y, along.x);  // into the quad's own axes
  vec2 low = vec2(1e9), high = vec2(-1e9);
  for (int i = 0; i < n_beads; ++i) {
    vec3 bead = seen_bead(c, a, i);
    low = min(low, turn * bead.xy - bead.z);
    high = max(high, turn * bead.xy + bead.z);
  }
  vec2 slope = transpose(turn) * mix(low, high, corner());
  rod_centre = centre;
  rod_axis = axis;
  rod_colour = colour;
  start = start_of(slope) - centre;
  ray = ray_of(slope);
  gl_Position = vec4(slope / half_view, 0.0, 1.0);
}
)";

/// The body: the nearest bead along the pixel's ray. (After kFloor.)
inline constexpr const char* kBody = R"(
uniform vec2 beads[255];
uniform int n_beads;
uniform vec2 ends;       // offsets of the first and the last bead
uniform float pitch;     // distance of neighbouring beads; 0 if it is not the same everywhere
uniform float thick;     // greatest radius
uniform vec3 forward;
uniform vec2 depths;     // that the depth buffer spans
uniform vec2 heights;    // that shades span
uniform vec3 light;      // towards it
flat in vec3 rod_centre;
flat in vec3 rod_axis;
flat in vec3 rod_colour;
in vec3 start;
in vec3 ray;
out vec4 pixel;

void main() {
  vec3 direction = normalize(ray);
  // From the point of the ray that is nearest to the rod's centre: all lengths are small, and o is normal to the ray.
  vec3 o = start - dot(start, direction) * direction;
  float cosine = dot(direction, rod_axis), sine = 1.0 - cosine * cosine;  // the latter squared
  float square = dot(o, o), along = dot(o, rod_axis);
  // Only beads near the point of the axis that the ray comes closest to can be hit.
  int first = 0, last = n_beads - 1;
  if (pitch > 0.0 && sine > 1e-4) {
    float middle = along / sine - ends.x;
    float reach = thick * inversesqrt(sine);
    first = max(first, int(floor((middle - reach) / pitch)));
    last = min(last, int(ceil((middle + reach) / pitch)));
  }
  float nearest = 1e9;
  vec2 bead;
  for (int i = first; i <= last; ++i) {
    float x = beads[i].x, r = beads[i].y;
    float inside = r * r - (square + x * (x * sine - 2.0 * along));  // of the half chord, squared
    float t = x * cosine - sqrt(max(inside, 0.0));
    if (inside > 0.0 && t < nearest) {
      nearest = t;
      bead = beads[i];
    }
  }
  if (nearest > 1e8) discard;
  vec3 hit = o + nearest * direction;  // from the rod's centre
  vec3 normal = (hit - bead.x * rod_axis) / bead.y;

#ifdef SMOOTH
  // The beads' own normals, eased towards those of a smooth spindle: round bodies rather than strings of pearls.
  vec3 spindle = hit - clamp(dot(hit, rod_axis), ends.x, ends.y) * rod_axis;
  normal = normalize(mix(normal, normalize(spindle), 0.8));
#endif

  vec3 place = rod_centre + hit, eye = -direction;
  float depth = dot(place, forward);
  float height = clamp((place.z - heights.x) / (heights.y - heights.x), 0.0, 1.0);
  float diffuse = 0.5 + 0.5 * dot(normal, light);                // wrapped: soft
  float shade = (0.35 + 0.72 * diffuse) * mix(0.80, 1.04, height);
#ifdef OCCLUSION
  shade *= mix(0.34, 1.0, smoothstep(-0.05, 0.75, dot(normal, eye)));  // the sides see their neighbours, not the sky
#endif
#ifdef GLOSS
  float gloss = pow(max(dot(normal, normalize(light + eye)), 0.0), 40.0) * 0.16;
#else
  float gloss = 0.0;
#endif
  // Light adds up in linear units; a square root is near enough to sRGB's curve, and exact on the way back.
  vec3 lit = rod_colour * rod_colour * shade + gloss;
  pixel = vec4(faded(sqrt(min(lit, 1.0)), depth), 1.0);
  // Never quite at the end of the depth buffer, where nothing is drawn.
  gl_FragDepth = clamp((depth - depths.x) / (depths.y - depths.x), 0.0, 0.999);
}
)";

/// The quad of a rod's shadow on the floor, `margin` wider than the rod on every side. (After kCamera.)
inline constexpr const char* kShadowQuad = R"(
layout(location = 0) in vec3 centre;
layout(location = 1) in vec3 axis;
layout(location = 2) in vec3 colour;
uniform vec2 beads[255];
uniform int n_beads;
uniform float base;    // height of the floor
uniform float margin;
uniform vec2 shift;    // away from the light
flat out vec3 rod_axis;
out vec2 place;        // from the middle of the shadow
out vec3 at;

void main() {
  float flat_part = length(axis.xy);
  vec2 along = flat_part > 1e-6 ? axis.xy / flat_part : vec2(1.0, 0.0);
  vec2 reach = vec2(0.0);
  for (int i = 0; i < n_beads; ++i) {
    reach = max(reach, vec2(abs(beads[i].x) * flat_part + beads[i].y, beads[i].y));
  }
  reach = (reach + margin) * (corner() * 2.0 - 1.0);
  place = along * reach.x + vec2(-along.y, along.x) * reach.y;
  rod_axis = axis;
  at = vec3(centre.xy + shift + place, base);
  gl_Position = on_screen(at);
}
)";

/// A soft shadow: dark under the rod, fading out over `margin`. (After kFloor.)
inline constexpr const char* kShadow = R"(
uniform vec2 beads[255];
uniform int n_beads;
uniform vec2 ends;
uniform float margin;
uniform vec3 forward;
uniform float nearest;
flat in vec3 rod_axis;
in vec2 place;
in vec3 at;
out vec4 pixel;

void main() {
  float depth = dot(at, forward);
#if defined(ENDS) || defined(FADES)
  if (depth < nearest || beyond(at.xy) > 0.0) discard;  // walls stand upright: no shadow falls there
#endif
  float flat_part = max(dot(rod_axis.xy, rod_axis.xy), 1e-9);
  float o = clamp(dot(place, rod_axis.xy) / flat_part, ends.x, ends.y);
  // Between two beads the radius changes linearly. They stand at equal distances.
  float between = ends.y > ends.x ? (o - ends.x) / (ends.y - ends.x) * float(n_beads - 1) : 0.0;
  int lower = min(int(between), n_beads - 1);
  float radius = mix(beads[lower].y, beads[min(lower + 1, n_beads - 1)].y, between - float(lower));
  float dark = 1.0 - clamp((length(place - o * rod_axis.xy) - radius) / margin, 0.0, 1.0);
  pixel = vec4(faded(floor_colour * (1.0 - 0.50 * dark * dark), depth), 1.0);
}
)";

/// One quad around each post as it is seen; the whole picture if a part of it lies behind the eye. (After kCamera.)
inline constexpr const char* kPostQuad = R"(
layout(location = 0) in vec3 centre;  // of which the height does not matter
layout(location = 1) in vec3 axis;
layout(location = 2) in vec3 colour;
uniform float radius;
uniform vec2 plates;
flat out vec2 post;
flat out vec3 post_colour;
out vec3 start;
out vec3 ray;

void main() {
  vec2 low = vec2(1e9), high = vec2(-1e9);
  for (int i = 0; i < 8; ++i) {
    vec2 edge = centre.xy + radius * (vec2(i & 1, (i >> 1) & 1) * 2.0 - 1.0);
    vec3 seen = axes * vec3(edge, (i >> 2) == 0 ? plates.x : plates.y);
    bool is_behind = !is_parallel && seen.z < 1e-3;
    vec2 slope = is_parallel ? seen.xy : seen.xy / seen.z;
    low = is_behind ? -half_view : min(low, slope);
    high = is_behind ? half_view : max(high, slope);
  }
  vec2 slope = mix(max(low, -half_view), min(high, half_view), corner());
  post = centre.xy;
  post_colour = colour;
  start = start_of(slope);
  ray = ray_of(slope);
  gl_Position = vec4(slope / half_view, 0.0, 1.0);
}
)";

/// A post: what lies between the plates of a vertical cylinder, with its rim in ink. (After kFloor.)
inline constexpr const char* kPost = R"(
uniform float radius;
uniform vec2 plates;
uniform float cut;
uniform float nearest;
uniform float line;
uniform vec3 forward;
uniform vec2 depths;
uniform vec3 light;
uniform vec3 ink;
flat in vec2 post;
flat in vec3 post_colour;
in vec3 start;
in vec3 ray;
out vec4 pixel;

void main() {
  // The part of the ray between the plates, and of that the part within the cylinder.
  vec2 ends = ray.z == 0.0 ? vec2(-1e9, 1e9) : (plates - start.z) / ray.z;
  float enter = min(ends.x, ends.y), leave = max(ends.x, ends.y);
  vec2 o = start.xy - post;
  float a = dot(ray.xy, ray.xy), b = dot(o, ray.xy), inside = radius * radius - dot(o, o);
  bool is_side = false;
  if (a > 1e-9) {
    float root2 = b * b + a * inside;
    if (root2 < 0.0) discard;
    float first = (-b - sqrt(root2)) / a;
    is_side = first > enter;
    enter = max(enter, first);
    leave = min(leave, (-b + sqrt(root2)) / a);
  } else if (inside < 0.0) {
    discard;
  }
  float opened = cut > 0.0 ? cut / dot(ray, forward) : nearest < 0.0 ? -1e9 : 0.0;
  bool is_cut = enter < opened;
  enter = max(enter, opened);
  if (enter > leave) discard;

  vec3 at = start + enter * ray;
  vec2 from_axis = at.xy - post;
  vec3 colour = post_colour;
  if (is_cut) {
    // as the cut edges of the plates
  } else if (is_side) {
    colour *= 0.72 + 0.28 * dot(vec3(from_axis / radius, 0.0), light);
  } else if (radius - length(from_axis) < line) {
    colour = ink;
  }
  float depth = dot(at, forward);
  pixel = vec4(faded(colour, depth), 1.0);
  gl_FragDepth = clamp((depth - depths.x) / (depths.y - depths.x), 0.0, 0.999);
}
)";

/// The whole picture as one quad. (After kCamera.)
inline constexpr const char* kStage = R"(
out vec3 start;
out vec3 ray;

void main() {
  vec2 at = corner() * 2.0 - 1.0;
  start = start_of(at * half_view);
  ray = ray_of(at * half_view);
  gl_Position = vec4(at, 0.0, 1.0);
}
)";

/// The plates: the floor with its edge, the lid above one's head, and their cut edges. (After kFloor.)
inline constexpr const char* kPlates = R"(
uniform vec2 plates;       // heights of base and lid
uniform bool has_lid;
uniform float cut;         // depth where they are cut open; 0: they are not
uniform float grid;        // distance of the lines on them; 0: none
uniform float line;        // thickness of the arena's edge
uniform vec2 plate;        // sides of the plates
uniform vec3 forward;
uniform vec3 cut_colour;
uniform vec3 outside;
uniform vec3 ink;
in vec3 start;
in vec3 ray;
out vec4 pixel;

float line_at(float x, float width) {
  float from = abs(fract(x / grid + 0.5) - 0.5) * grid;
  return 1.0 - smoothstep(0.5 * width, 1.5 * width, from);
}

void main() {
  gl_FragDepth = 1.0;
  float gap = plates.y - plates.x;
  float z = ray.z * cut / dot(ray, forward);
  if (cut > 0.0 && (z < plates.x || (has_lid && z > plates.y))) {
    float into = z < plates.x ? plates.x - z : z - plates.y;
    pixel = vec4(into > 0.8 * gap ? page : into < 0.012 * gap ? ink : cut_colour, 1.0);
    gl_FragDepth = 0.0;  // the cut edges stand in front of everything
    return;
  }
  bool is_base = ray.z < 0.0;
  float t = ray.z == 0.0 ? -1.0 : ((is_base ? plates.x : plates.y) - start.z) / ray.z;
  vec3 at = start + t * ray;
  float depth = dot(at, forward);
  vec2 past_sides = abs(at.xy - middle) - 0.5 * plate;
  if (t < 0.0 || max(past_sides.x, past_sides.y) > line || depth > fade.y || (!is_base && !has_lid)) {
    pixel = vec4(page, 1.0);
    return;
  }
  vec3 colour = floor_colour * (is_base ? 1.0 : 0.93);
  if (grid > 0.0) {
    float width = 0.0016 * depth;
    colour = mix(colour, ink, 0.12 * max(line_at(at.x - middle.x, width), line_at(at.y - middle.y, width)));
  }
  float out_by = beyond(at.xy);
  if (out_by > 0.0) colour = out_by < line ? ink : outside;
  pixel = vec4(faded(colour, depth), 1.0);
}
)";

}  // namespace shaken::render::shaders
