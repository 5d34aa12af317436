#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "scene/keys/derived.h"
#include "scene/resolve/resolution.h"
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
  if (scene.given("walls.length") && !scene.plan.system.walls->has_length()) {
    scene.report({"walls.length"}, fmt::format("only a stadium, an ellipse and a wedge have a length, and {}; remove "
                                               "walls.length, or set walls.arena to one of them",
                                               is));
  }
  if (scene.given("walls.narrow") && arena != Arena::kWedge) {
    scene.report({"walls.narrow"}, fmt::format("only a wedge has a narrow end, and {}; remove walls.narrow, or set "
                                               "walls.arena to \"wedge\"",
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

/// The size at which the arena has so much area; without a given length, the arena is twice as long as wide.
double size_for(const SideWalls& walls, double area, bool has_length) {
  switch (walls.arena) {
    case Arena::kSquare:
      return std::sqrt(area);
    case Arena::kAnnulus:
      return std::sqrt(4.0 * area / kPi + walls.inner * walls.inner);
    case Arena::kStadium:
      if (!has_length) return std::sqrt(area / (1.0 + 0.25 * kPi));
      return 2.0 * area / (walls.length + std::sqrt(walls.length * walls.length + kPi * area));
    case Arena::kEllipse:
      return has_length ? 4.0 * area / (kPi * walls.length) : std::sqrt(2.0 * area / kPi);
    case Arena::kWedge:
      if (!has_length) return 2.0 * area / (walls.narrow + std::sqrt(walls.narrow * walls.narrow + 4.0 * area));
      return 2.0 * area / walls.length - walls.narrow;
    case Arena::kDisc:
    case Arena::kChannel:
      break;
  }
  return std::sqrt(4.0 * area / kPi);
}

/// The size of the largest arena that a square of side `most` has room for.
double size_within(const SideWalls& walls, double most, bool has_length) {
  if (!walls.has_length()) return most;
  if (!has_length) return most / 2;
  if (walls.arena == Arena::kStadium) return most - walls.length;
  return walls.arena == Arena::kEllipse ? std::min(most, walls.length) : most;
}

/// Size and length of the walls, and the side of the square box round them, which is `room` larger.
void resolve_lengths(Resolution& scene, double room) {
  System& system = scene.plan.system;
  SideWalls& walls = *system.walls;
  const bool has_length = scene.given("walls.length");
  const std::optional<double> area = area_wanted(scene);
  if (!scene.given("walls.size")) {
    if (area && !scene.given("box.side")) {
      walls.size = size_for(walls, *area, has_length);
      scene.check_derived("walls.size", {"rods.count", "rods.area_fraction"});
    } else {
      walls.size = size_within(walls, system.box_side - room, has_length);
      scene.check_derived("walls.size", {"box.side"});
    }
  }
  if (walls.has_length() && !has_length) walls.length = (walls.arena == Arena::kStadium ? 1.0 : 2.0) * walls.size;
  if (!scene.given("box.side")) {
    system.box_side = walls.extent().maxCoeff() + room;
    scene.check_derived("box.side", {"walls.size", "walls.length"});
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

/// "a stadium of 20 mm and 10 mm", "an ellipse of 40 mm by 20 mm".
std::string text_of(const SideWalls& walls) {
  const std::string size = length_text(walls.size), length = length_text(walls.length);
  switch (walls.arena) {
    case Arena::kStadium:
      if (walls.length > 0) return fmt::format("a stadium of {} and {}", size, length);
      break;
    case Arena::kEllipse:
      return fmt::format("an ellipse of {} by {}", length, size);
    case Arena::kWedge:
      return fmt::format("a wedge of {} by {}", length, size);
    case Arena::kChannel:
      return "a channel of " + size;
    case Arena::kDisc:
    case Arena::kSquare:
    case Arena::kAnnulus:
      break;
  }
  return "an arena of " + size;
}

/// That an ellipse is not wider than long, and its tips are no sharper than the thickest bead is round.
void check_ellipse(Resolution& scene, const SideWalls& walls, double thickest) {
  const double tip = 0.5 * walls.size * walls.size / walls.length;  // radius of curvature
  if (walls.length < walls.size * (1 - 1e-12)) {
    scene.report(
        {"walls.length", "walls.size"},
        fmt::format("{} is wider than long: its long axis lies along x, so give the greater of the two lengths "
                    "to walls.length",
                    text_of(walls)));
  } else if (tip < 0.5 * thickest) {
    scene.report(
        {"walls.size", "walls.length"},
        fmt::format("the ends of {} have a radius of curvature of {}, and rods {} thick do not fit into them: "
                    "make walls.size at least {}, or walls.length at most {}",
                    text_of(walls), length_text(tip), length_text(thickest),
                    length_text(std::sqrt(thickest * walls.length)), length_text(walls.size * walls.size / thickest)));
  }
}

void check_wedge(Resolution& scene, const SideWalls& walls) {
  const double least = field_at("walls.size").low;
  if (walls.length < least) {
    scene.report({"walls.length"},
                 fmt::format("a wedge of {} is too short: at least {}", length_text(walls.length), length_text(least)));
  } else if (walls.narrow > walls.size) {
    scene.report({"walls.narrow", "walls.size"},
                 fmt::format("a narrow end of {} is wider than the wide end of {}, walls.size",
                             length_text(walls.narrow), length_text(walls.size)));
  }
}

/// That the box has room for the arena, and the arena for its inner wall.
void check_fits(Resolution& scene, double room, double longest) {
  const System& system = scene.plan.system;
  const SideWalls& walls = *system.walls;
  const double high = system.box().y();
  if (high < walls.extent().maxCoeff() + room - 1e-12 * high) {
    scene.report({"walls.size", "walls.length", "box.side", "box.aspect"},
                 fmt::format("{} does not fit into a box of {}: at most {}{}; or leave {} out", text_of(walls),
                             length_text(high), length_text(high - room),
                             walls.arena == Arena::kStadium && walls.length > 0 ? " in all" : "",
                             walls.arena == Arena::kChannel ? "box.aspect" : "box.side"));
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
  if (!scene.ok({"walls.size", "walls.inner", "walls.length", "walls.narrow", "walls.arena", "box.side", "box.aspect"}))
    return false;
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
  if (system.walls->arena == Arena::kEllipse) check_ellipse(scene, *system.walls, thickest);
  if (system.walls->arena == Arena::kWedge) check_wedge(scene, *system.walls);
  return scene.problems.size() == n_before;
}

}  // namespace shaken::scene
