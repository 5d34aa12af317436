// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "scene/derived.h"
#include "scene/resolve/steps.h"
#include "sim/rod/species.h"

namespace shaken::scene {

namespace {

constexpr double kRoomRoundArena = 0.2;  // [mm]

/// What sets the area that the rods share, as it was written: "box.side 40 mm".
std::string room_for_rods(const Resolution& scene) {
  const System& system = scene.plan.system;
  std::string box = "box.side " + length_text(system.box_side);
  if (system.box_aspect != 1) box += fmt::format(", box.aspect {:.10g}", system.box_aspect);
  if (!system.walls) return box;
  if (scene.given("walls.size")) return "walls.size " + length_text(system.walls->size);
  return fmt::format("{} (an arena of {})", box, length_text(system.walls->size));
}

/// "40 mm", or of a rectangle "21 mm by 126 mm".
std::string sides_text(const System& system) {
  if (system.box_aspect == 1) return length_text(system.box_side);
  return length_text(system.box().x()) + " by " + length_text(system.box().y());
}

/// Number and area fraction of one species; false if a problem is reported.
bool resolve_number_of(Resolution& scene, const RodGroup& group) {
  System& system = scene.plan.system;
  const std::string fraction_path = group.path("area_fraction"), count_path = group.path("count");
  const bool is_first = group.name == "rods";
  const double area = species_of(group.rod).area;
  if (!is_first && !scene.given(count_path) && !scene.given(fraction_path)) {
    return scene.refuse({group.name, fraction_path},
                        fmt::format("how many rods? Give {} or {}", count_path, fraction_path));
  }
  const double wanted = scene.given(fraction_path) || is_first ? scene.number(fraction_path) : 0.0;
  const auto count_for = [&] { return std::round(wanted * area_for_rods(system) / area); };
  if (!scene.given(count_path)) {
    const Field& field = field_at(count_path);
    if (count_for() < field.low || count_for() > field.high) {
      return scene.refuse({fraction_path, "walls.size", "box.side", "box.aspect"},
                          fmt::format("{} {:.10g} and {} make {} rods, outside [{:.10g}, {:.10g}]", fraction_path,
                                      wanted, room_for_rods(scene), count_for(), field.low, field.high));
    }
    group.count = static_cast<int>(count_for());
  } else if (is_first && scene.given(fraction_path) && !scene.given("box.side") && !system.walls) {
    system.box_side = std::sqrt(group.count * area / (wanted * system.box_aspect));
    scene.check_derived("box.side", {"rods.count", "rods.area_fraction", "box.aspect"});
  } else if (scene.given(fraction_path) && count_for() != group.count &&
             !agree(area_fraction_of(system, group.rod, group.count), wanted)) {
    return scene.refuse(
        {fraction_path},
        fmt::format("{} {:.10g} contradicts {} {} in {}, which make {:.10g}; remove one", fraction_path, wanted,
                    count_path, group.count, room_for_rods(scene), area_fraction_of(system, group.rod, group.count)));
  }
  return true;
}

}  // namespace

bool resolve_arena(Resolution& scene) {
  System& system = scene.plan.system;
  if (!scene.ok({"walls.size", "walls.inner", "walls.arena", "box.side", "box.aspect"})) return false;
  if (!system.walls) return true;
  if (system.box_aspect != 1) {
    return scene.refuse({"box.aspect", "walls"},
                        "an arena lies in the middle of a square box: remove box.aspect or walls");
  }
  double thickest = 0;
  double longest = 0;
  for (const RodGroup& group : rod_groups(system)) {
    thickest = std::max(thickest, 2.0 * species_of(group.rod).max_radius);
    longest = std::max(longest, group.rod.length);
  }
  const double room = thickest + kRoomRoundArena;  // so that rods do not meet through the periodic border
  SideWalls& walls = *system.walls;
  const std::size_t n_before = scene.problems.size();
  if (scene.given("walls.inner") && walls.arena != Arena::kAnnulus) {
    const Field& arena = field_at("walls.arena");
    scene.report({"walls.inner"}, fmt::format("only an annulus has an inner wall, and walls.arena is {}; remove "
                                              "walls.inner, or set walls.arena to \"annulus\"",
                                              show(arena, arena.fetch(scene.plan))));
  }
  if (!scene.given("walls.size") && !scene.given("box.side") && scene.given("rods.count") &&
      scene.given("rods.area_fraction")) {
    if (!scene.ok({"rods.count", "rods.area_fraction"})) return false;
    walls.size =
        arena_size_for(walls, system.n_rods * species_of(system.rod).area / scene.number("rods.area_fraction"));
    scene.check_derived("walls.size", {"rods.count", "rods.area_fraction"});
  } else if (!scene.given("walls.size")) {
    walls.size = system.box_side - room;
    scene.check_derived("walls.size", {"box.side"});
  }
  if (!scene.given("box.side")) {
    system.box_side = walls.size + room;
    scene.check_derived("box.side", {"walls.size"});
  }
  if (system.box_side < walls.size + room * (1 - 1e-12)) {
    scene.report(
        {"walls.size", "box.side"},
        fmt::format("an arena of {} does not fit into a box of {}: at most {}; or leave box.side out",
                    length_text(walls.size), length_text(system.box_side), length_text(system.box_side - room)));
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
  return scene.problems.size() == n_before;
}

void resolve_numbers(Resolution& scene) {
  System& system = scene.plan.system;
  const std::vector<RodGroup> groups = rod_groups(system);
  for (const RodGroup& group : groups) {
    if (!scene.ok({group.path("area_fraction"), group.path("count")}) || !resolve_number_of(scene, group)) return;
  }
  double fraction = 0;
  Paths causes;
  for (const RodGroup& group : groups) {
    fraction += area_fraction_of(system, group.rod, group.count);
    causes.push_back(group.path("area_fraction"));
    causes.push_back(group.path("count"));
  }
  causes.insert(causes.end(), {"walls.size", "box.side", "box.aspect", "rods.start"});
  const bool in_rows = system.start == Start::kAligned, random = system.start == Start::kRandom;
  const double most = in_rows ? kMaxAreaFractionAligned : random ? kMaxAreaFractionRandom : kMaxAreaFractionCompressed;
  if (scene.draft.is_ok("rods.start") && fraction > most) {
    scene.report(causes,
                 fmt::format("{} rods in {} of {} are an area fraction of {:.4g}; {} at most {} can be placed{}",
                             system.n_all_rods(), system.walls ? "an arena" : "a box",
                             system.walls ? length_text(system.walls->size) : sides_text(system), fraction,
                             in_rows  ? "in rows"
                             : random ? "at random"
                                      : "by compression",
                             most, in_rows || groups.size() > 1 ? "" : "; start \"aligned\" packs more"));
  } else {
    for (const RodGroup& group : groups) {
      scene.check_derived(group.path("area_fraction"),
                          {group.path("count"), scene.given("walls.size") ? "walls.size" : "box.side"});
    }
  }
}

void check_box(Resolution& scene) {
  System& system = scene.plan.system;
  const Field& side = field_at("box.side");
  const double high = system.box().y();
  if (scene.ok({"box.side", "box.aspect"}) && (high < side.low || high > side.high)) {
    scene.report({"box.aspect", "box.side"}, fmt::format("a box of {}: sides are {} to {} long", sides_text(system),
                                                         length_text(side.low), length_text(side.high)));
  }
  for (const RodGroup& group : rod_groups(system)) {
    const Species species = species_of(group.rod);
    const double least = least_box_side(std::span(&species, 1));
    if (scene.ok({"box.side", "box.aspect", group.path("count"), group.path("area_fraction")}) &&
        system.box().shorter() < least * (1.0 - 1e-9)) {
      scene.report({"box.side", "box.aspect", "walls.size", group.path("count"), group.path("length")},
                   fmt::format("a periodic box of {} is too small for rods of {}: at least {}", sides_text(system),
                               length_text(group.rod.length), length_text(least)));
    }
  }
}

void check_gap(Resolution& scene) {
  System& system = scene.plan.system;
  for (const RodGroup& group : rod_groups(system)) {
    const Paths diameters{group.path("mid_diameter"), group.path("end_diameter"), group.path("bead_diameters")};
    const double thickest = group.rod.bead_diameters.empty()
                                ? std::max(group.rod.mid_diameter, group.rod.end_diameter)
                                : *std::max_element(group.rod.bead_diameters.begin(), group.rod.bead_diameters.end());
    if (!scene.ok({"box.gap"}) || !scene.ok(diameters) || system.gap > thickest) continue;
    scene.report(
        {"box.gap", diameters[0], diameters[1], diameters[2]},
        fmt::format("a gap of {} is too small for rods {} thick", length_text(system.gap), length_text(thickest)));
  }
}

}  // namespace shaken::scene
