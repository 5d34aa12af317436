#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "scene/keys/derived.h"
#include "scene/resolve/resolution.h"
#include "sim/posts.h"
#include "sim/rod/sizes.h"
#include "sim/rod/species.h"

namespace shaken::scene {

namespace {

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
  const double area = mean_area_of(group.rod);
  if (!is_first && !scene.given(count_path) && !scene.given(fraction_path)) {
    return scene.refuse({group.name, fraction_path},
                        fmt::format("how many rods? Give {} or {}", count_path, fraction_path));
  }
  const double wanted = scene.given(fraction_path) || is_first ? scene.number(fraction_path) : 0.0;
  const auto count_for = [&] { return std::round(wanted * system.area() / area); };
  if (!scene.given(count_path)) {
    const Field& field = field_at(count_path);
    if (count_for() < field.low || count_for() > field.high) {
      return scene.refuse({fraction_path, "walls.size", "box.side", "box.aspect"},
                          fmt::format("{} {:.10g} and {} make {} rods, outside [{:.10g}, {:.10g}]", fraction_path,
                                      wanted, room_for_rods(scene), count_for(), field.low, field.high));
    }
    group.count = static_cast<int>(count_for());
  } else if (is_first && scene.given(fraction_path) && !scene.given("box.side") && !system.walls) {
    system.box_side = std::sqrt((group.count * area / wanted + standing_posts(system).area()) / system.box_aspect);
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
    scene.report(
        causes,
        fmt::format(
            "{} rods in {} of {}{} are an area fraction of {:.4g}; {} at most {} can be placed{}", system.n_all_rods(),
            system.walls ? "an arena" : "a box", system.walls ? length_text(system.walls->size) : sides_text(system),
            system.posts ? " with posts" : "", fraction,
            in_rows  ? "in rows"
            : random ? "at random"
                     : "by compression",
            most, in_rows || groups.size() > 1 || system.rod.spread.is_any() ? "" : "; start \"aligned\" packs more"));
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
    const double least = least_box_side(sizes_of_species(group.rod));
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
  const double gap = system.least_gap();
  for (const RodGroup& group : rod_groups(system)) {
    const Paths diameters{group.path("mid_diameter"), group.path("end_diameter"), group.path("bead_diameters"),
                          group.path("length_spread"), group.path("end_diameter_spread")};
    double thickest = 0;
    for (const RodShape& size : sizes_of(group.rod)) thickest = std::max(thickest, thickest_bead(size));
    if (!scene.ok({"box.gap"}) || !scene.ok(diameters) || gap > thickest) continue;
    const std::string moving =
        system.has_lid_motion()
            ? fmt::format(", of which the plates leave {} where they are nearest,", length_text(gap))
            : std::string();
    scene.report({"box.gap", diameters[0], diameters[1], diameters[2], diameters[3], diameters[4]},
                 fmt::format("a gap of {}{} is too small for rods {} thick", length_text(system.gap), moving,
                             length_text(thickest)));
  }
}

}  // namespace shaken::scene
