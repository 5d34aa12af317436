#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "scene/keys/derived.h"
#include "scene/resolve/resolution.h"
#include "sim/rod/sizes.h"
#include "sim/rod/species.h"

namespace shaken::scene {

namespace {

/// Neighbouring beads leave holes between them.
bool has_holes(const RodShape& rod) {
  const Species species = species_of(rod);
  for (int b = 0; b + 1 < species.n_beads(); ++b) {
    if (species.bead_radius[b] + species.bead_radius[b + 1] < species.pitch()) return true;
  }
  return false;
}

/// The first size that has holes.
std::optional<RodShape> size_with_holes(const RodShape& rod) {
  for (const RodShape& size : sizes_of(rod)) {
    if (has_holes(size)) return size;
  }
  return std::nullopt;
}

/// Diameter of the thinnest bead [mm].
double thinnest_bead(const RodShape& rod) {
  if (!rod.has_axis()) return rod.mid_diameter;
  return rod.bead_diameters.empty() ? std::min(rod.mid_diameter, rod.end_diameter)
                                    : std::ranges::min(rod.bead_diameters);
}

/// Every size is longer than thick.
bool check_lengths(Resolution& scene, const RodGroup& group) {
  for (const RodShape& size : sizes_of(group.rod)) {
    if (size.length > thickest_bead(size)) continue;
    return scene.refuse({group.path("length"), group.path("length_spread"), group.path("mid_diameter"),
                         group.path("end_diameter"), group.path("bead_diameters")},
                        fmt::format("a rod of length {} is not longer than its thickest bead ({})",
                                    length_text(size.length), length_text(thickest_bead(size))));
  }
  return true;
}

/// Ends differ where their diameter is given, as that of a profile; and every size is one that a scene could give.
bool check_spread(Resolution& scene, const RodGroup& group) {
  const std::string path = group.path("end_diameter_spread"), of_length = group.path("length_spread");
  if (!scene.ok({path, of_length})) return false;
  const RodShape& rod = group.rod;
  if (rod.spread.end_diameter > 0 && (!rod.has_axis() || !rod.bead_diameters.empty())) {
    return scene.refuse({path}, fmt::format("{} is of rods whose ends have a diameter of their own, not {}; remove it",
                                            path, rod.has_axis() ? "of beads one by one" : "of spheres"));
  }
  if (!rod.spread.is_any()) return true;
  const auto is_within = [](const Field& field, double value) { return value >= field.low && value <= field.high; };
  const Field& length = field_at("rods.length");
  const Field& diameter = field_at("rods.mid_diameter");
  for (const RodShape& size : sizes_of(rod)) {
    if (is_within(length, size.length) && is_within(diameter, thinnest_bead(size)) &&
        is_within(diameter, thickest_bead(size)))
      continue;
    return scene.refuse(
        {of_length, path},
        fmt::format("rods of {}, {} to {} thick, are among those that {} and {} make: lengths are {}, diameters {}",
                    length_text(size.length), length_text(thinnest_bead(size)), length_text(thickest_bead(size)),
                    of_length, path, format_range(length.low, length.high, length.dimension),
                    format_range(diameter.low, diameter.high, diameter.dimension)));
  }
  return true;
}

/// No bead of a list sticks out beyond the tips, in any size.
bool check_tips(Resolution& scene, const RodGroup& group) {
  for (const RodShape& size : sizes_of(group.rod)) {
    const std::vector<double>& diameters = size.bead_diameters;
    const auto n = static_cast<int>(diameters.size());
    const double pitch = n > 1 ? (size.length - 0.5 * (diameters.front() + diameters.back())) / (n - 1) : 0.0;
    for (int b = 0; b < n; ++b) {
      const double center = 0.5 * diameters.front() + b * pitch;
      const double radius = 0.5 * diameters[static_cast<std::size_t>(b)];
      if (center - radius >= -1e-9 && center + radius <= size.length + 1e-9) continue;
      return scene.refuse({group.path("bead_diameters"), group.path("length"), group.path("length_spread")},
                          fmt::format("bead {} of {} would stick out beyond the tips of a rod of {}", b + 1,
                                      length_text(diameters[static_cast<std::size_t>(b)]), length_text(size.length)));
    }
  }
  return true;
}

/// Beads one by one: what the other keys say of them follows.
bool resolve_listed_beads(Resolution& scene, const RodGroup& group) {
  RodShape& rod = group.rod;
  const std::vector<double>& diameters = rod.bead_diameters;
  const std::string list = group.path("bead_diameters");
  const auto n = static_cast<int>(diameters.size());
  const double thickest = *std::max_element(diameters.begin(), diameters.end());
  bool fine = true;
  const auto follows = [&](const char* key, double value) {
    if (scene.given(group.path(key)) && scene.number(group.path(key)) != value) {
      scene.report({group.path(key)},
                   fmt::format("{} follows from {}, which makes it {:.10g}; remove it", group.path(key), list, value));
      fine = false;
    }
    return value;
  };
  if (n > kMostBeads) {
    return scene.refuse({list}, fmt::format("{} beads are more than {}", n, kMostBeads));
  }
  rod.n_beads = static_cast<int>(follows("beads", n));
  rod.mid_diameter = follows("mid_diameter", thickest);
  rod.end_diameter = follows("end_diameter", diameters.back());
  for (const char* key : {"profile", "bead_pitch"}) {
    if (!scene.given(group.path(key))) continue;
    scene.report({group.path(key)}, fmt::format("{} and {} are both given; remove one", list, group.path(key)));
    fine = false;
  }
  if (n == 1) rod.length = follows("length", thickest);
  if (!fine) return false;
  if (n > 1 && !check_lengths(scene, group)) return false;
  if (!check_tips(scene, group)) return false;
  if (const auto size = size_with_holes(rod)) {
    return scene.refuse({list},
                        fmt::format("{} beads of these diameters leave holes between them on a rod of {}; give more", n,
                                    length_text(size->length)));
  }
  return true;
}

bool resolve_shape(Resolution& scene, const RodGroup& group) {
  RodShape& rod = group.rod;
  const std::string length_path = group.path("length"), mid = group.path("mid_diameter"),
                    end = group.path("end_diameter"), beads = group.path("beads"),
                    pitch_path = group.path("bead_pitch"), list = group.path("bead_diameters");
  if (!scene.ok({length_path, mid, end, beads, pitch_path, list})) return false;
  if (!rod.bead_diameters.empty()) return resolve_listed_beads(scene, group);
  if (scene.given(beads) && scene.given(pitch_path)) {
    return scene.refuse({beads}, fmt::format("{} and {} are both given; remove one", beads, pitch_path));
  }
  if (scene.given(beads) && rod.n_beads % 2 == 0) {
    return scene.refuse({beads}, fmt::format("{} is even; a rod has a centre bead, so an odd number; did you mean {}?",
                                             rod.n_beads, rod.n_beads + 1));
  }
  if (scene.given(beads) && rod.n_beads == 1) {
    if (!scene.given(length_path)) rod.length = rod.mid_diameter;
    if (rod.length == rod.mid_diameter) return true;
    return scene.refuse({length_path, beads}, fmt::format("one bead is a sphere: {} ({}) must be {} ({})", length_path,
                                                          length_text(rod.length), mid, length_text(rod.mid_diameter)));
  }
  if (!check_lengths(scene, group)) return false;
  if (!scene.given(beads)) {
    const double pitch = scene.number(pitch_path);
    int n_beads = 1;
    for (const RodShape& size : sizes_of(rod)) {
      if ((size.length - size.end_diameter) / pitch > kMostBeads - 1) {
        return scene.refuse({pitch_path, length_path},
                            fmt::format("beads every {} make more than {} on a rod of {}", length_text(pitch),
                                        kMostBeads, length_text(size.length)));
      }
      n_beads = std::max(n_beads, beads_for_pitch(size.length, size.end_diameter, pitch));
    }
    rod.n_beads = n_beads;
  }
  if (rod.n_beads == 1) return true;
  if (const auto size = size_with_holes(rod)) {
    RodShape enough = rod;
    while (size_with_holes(enough) && enough.n_beads < kMostBeads) enough.n_beads += 2;
    const std::string cure = size_with_holes(enough) ? fmt::format("even {} would; make the rods thicker", kMostBeads)
                                                     : fmt::format("take at least {}", enough.n_beads);
    return scene.refuse(
        {beads, pitch_path, length_path, group.path("length_spread"), group.path("end_diameter_spread")},
        fmt::format("{} beads leave holes between them on a rod of {}; {}", rod.n_beads, length_text(size->length),
                    cure));
  }
  return true;
}

}  // namespace

bool resolve_rod_shapes(Resolution& scene) {
  bool all_ok = true;
  for (const RodGroup& group : rod_groups(scene.plan.system))
    all_ok = resolve_shape(scene, group) && check_spread(scene, group) && all_ok;
  return all_ok;
}

}  // namespace shaken::scene
