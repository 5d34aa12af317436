// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "scene/derived.h"
#include "scene/resolve/steps.h"
#include "sim/rod/sizes.h"
#include "sim/rod/species.h"

namespace shaken::scene {

namespace {

constexpr double kRoomRoundArena = 0.2;  // [mm]

/// Lengths that only one kind of arena has.
void check_kind(Resolution& scene) {
  const Arena arena = scene.plan.system.walls->arena;
  const Field& field = field_at("walls.arena");
  const std::string is = fmt::format("walls.arena is {}", show(field, field.fetch(scene.plan)));
  if (scene.given("walls.inner") && arena != Arena::kAnnulus) {
    scene.report({"walls.inner"}, fmt::format("only an annulus has an inner wall, and {}; remove walls.inner, or set "
                                              "walls.arena to \"annulus\"",
                                              is));
  }
  if (scene.given("walls.length") && arena != Arena::kStadium) {
    scene.report({"walls.length"}, fmt::format("only a stadium has straight walls of a given length, and {}; remove "
                                               "walls.length, or set walls.arena to \"stadium\"",
                                               is));
  }
}

/// The area that so many rods of such an area fraction need, if both are given; none among posts, whose number depends
/// on the arena [mm^2].
std::optional<double> area_wanted(const Resolution& scene) {
  if (!scene.given("rods.count") || !scene.given("rods.area_fraction") || scene.plan.system.posts) return std::nullopt;
  const System& system = scene.plan.system;
  return system.n_rods * mean_area_of(system.rod) / scene.number("rods.area_fraction");
}

/// The size at which the arena has so much area; of a stadium without a given length, one that is as long as wide.
double size_for(const SideWalls& walls, double area, bool has_length) {
  switch (walls.arena) {
    case Arena::kSquare:
      return std::sqrt(area);
    case Arena::kAnnulus:
      return std::sqrt(4.0 * area / kPi + walls.inner * walls.inner);
    case Arena::kStadium:
      if (!has_length) return std::sqrt(area / (1.0 + 0.25 * kPi));
      return 2.0 * area / (walls.length + std::sqrt(walls.length * walls.length + kPi * area));
    case Arena::kDisc:
    case Arena::kChannel:
      break;
  }
  return std::sqrt(4.0 * area / kPi);
}

/// Size and length of the walls, and the side of the square box round them, which is `room` larger.
void resolve_lengths(Resolution& scene, double room) {
  System& system = scene.plan.system;
  SideWalls& walls = *system.walls;
  const bool is_stadium = walls.arena == Arena::kStadium, has_length = scene.given("walls.length");
  const std::optional<double> area = area_wanted(scene);
  if (!scene.given("walls.size")) {
    if (area && !scene.given("box.side")) {
      walls.size = size_for(walls, *area, has_length);
      scene.check_derived("walls.size", {"rods.count", "rods.area_fraction"});
    } else {
      const double most = system.box_side - room;
      walls.size = !is_stadium ? most : has_length ? most - walls.length : most / 2;
      scene.check_derived("walls.size", {"box.side"});
    }
  }
  if (is_stadium && !has_length) walls.length = walls.size;
  if (!scene.given("box.side")) {
    system.box_side = walls.size + (is_stadium ? walls.length : 0.0) + room;
    scene.check_derived("box.side", {"walls.size"});
  }
}

/// Width of a channel, and the sides of the box round it: that along y is `room` larger.
void resolve_channel(Resolution& scene, double room) {
  System& system = scene.plan.system;
  double& width = system.walls->size;
  const bool has_size = scene.given("walls.size"), has_side = scene.given("box.side");
  const bool has_aspect = scene.given("box.aspect");
  const double aspect = system.box_aspect;
  const std::optional<double> area = area_wanted(scene);
  if (area && has_size && !has_side) {
    system.box_side = *area / width;
    scene.check_derived("box.side", {"rods.count", "rods.area_fraction", "walls.size"});
  } else if (area && !has_size && !has_side) {
    width = 2.0 * aspect * *area / (room + std::sqrt(room * room + 4.0 * aspect * *area));
    scene.check_derived("walls.size", {"rods.count", "rods.area_fraction"});
    system.box_side = (width + room) / aspect;
    scene.check_derived("box.side", {"walls.size", "box.aspect"});
  } else if (area && !has_size && !has_aspect) {
    width = *area / system.box_side;
    scene.check_derived("walls.size", {"rods.count", "rods.area_fraction", "box.side"});
  } else if (!has_size) {
    width = system.box().y() - room;
    scene.check_derived("walls.size", {"box.side", "box.aspect"});
  } else if (has_aspect && !has_side) {
    system.box_side = (width + room) / aspect;
    scene.check_derived("box.side", {"walls.size", "box.aspect"});
  }
  // a box that is square but for rounding is a square: what was resolved resolves to itself
  const double fitting = (width + room) / system.box_side;
  if (has_aspect || std::abs(fitting - 1.0) < 1e-9) return;
  system.box_aspect = fitting;
  scene.check_derived("box.aspect", {"walls.size", "box.side"});
}

/// That the box has room for the arena, and the arena for its inner wall.
void check_fits(Resolution& scene, double room, double longest) {
  const System& system = scene.plan.system;
  const SideWalls& walls = *system.walls;
  const double along = walls.arena == Arena::kStadium ? walls.length : 0.0, high = system.box().y();
  if (high < walls.size + along + room - 1e-12 * high) {
    const bool is_channel = walls.arena == Arena::kChannel;
    const std::string arena =
        along > 0 ? fmt::format("a stadium of {} and {}", length_text(walls.size), length_text(walls.length))
                  : fmt::format("{} of {}", is_channel ? "a channel" : "an arena", length_text(walls.size));
    scene.report(
        {"walls.size", "walls.length", "box.side", "box.aspect"},
        fmt::format("{} does not fit into a box of {}: at most {}{}; or leave {} out", arena, length_text(high),
                    length_text(high - room), along > 0 ? " in all" : "", is_channel ? "box.aspect" : "box.side"));
  } else if (walls.arena == Arena::kAnnulus && walls.inner >= walls.size) {
    scene.report(
        {"walls.inner", "walls.size"},
        fmt::format("an inner wall of {} does not fit into an outer one of {}, {}", length_text(walls.inner),
                    length_text(walls.size), scene.given("walls.size") ? "walls.size" : "as large as box.side allows"));
  } else if (walls.arena == Arena::kAnnulus && walls.size - walls.inner < 2.0 * longest) {
    scene.report({"walls.inner", "walls.size"},
                 fmt::format("an annulus from {} to {} leaves no room for rods of {} to turn: its walls must be a rod "
                             "length apart",
                             length_text(walls.inner), length_text(walls.size), length_text(longest)));
  }
}

}  // namespace

bool resolve_arena(Resolution& scene) {
  System& system = scene.plan.system;
  if (!scene.ok({"walls.size", "walls.inner", "walls.length", "walls.arena", "box.side", "box.aspect"})) return false;
  if (!system.walls) return true;
  const bool is_channel = system.walls->arena == Arena::kChannel;
  if (system.box_aspect != 1 && !is_channel) {
    return scene.refuse({"box.aspect", "walls"},
                        "an arena lies in the middle of a square box, unless it is a channel: remove box.aspect or "
                        "walls");
  }
  double thickest = 0;
  double longest = 0;
  for (const RodGroup& group : rod_groups(system)) {
    for (const Species& size : sizes_of_species(group.rod)) thickest = std::max(thickest, 2.0 * size.max_radius);
    for (const RodShape& size : sizes_of(group.rod)) longest = std::max(longest, size.length);
  }
  const double room = thickest + kRoomRoundArena;  // so that rods do not meet through the periodic border
  const std::size_t n_before = scene.problems.size();
  check_kind(scene);
  if (area_wanted(scene) && !scene.ok({"rods.count", "rods.area_fraction"})) return false;
  is_channel ? resolve_channel(scene, room) : resolve_lengths(scene, room);
  check_fits(scene, room, longest);
  return scene.problems.size() == n_before;
}

}  // namespace shaken::scene
