#include "sim/posts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "scene/keys/derived.h"
#include "scene/resolve/resolution.h"
#include "sim/rod/species.h"

namespace shaken::scene {

namespace {

constexpr double kTouching = 1e-6;  // of a diameter, by which numbers that were rounded may be off

const Paths kPostKeys{"posts.diameter", "posts.columns", "posts.rows", "posts.places"};

std::string place_text(const Vec2& place) { return fmt::format("[{:.10g}, {:.10g}] mm", place.x(), place.y()); }

/// Two posts that overlap at their given places; an image of one of them may be meant.
struct Overlapping {
  Vec2 one, other;
  double apart;  ///< [mm]
};
std::optional<Overlapping> overlapping_places(const StandingPosts& posts, const Vec2& period) {
  const double least = posts.diameter * (1 - kTouching);
  for (std::size_t a = 0; a < posts.centres.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      Vec2 way = posts.centres[a] - posts.centres[b];
      for (const int axis : {0, 1}) {
        if (period[axis] > 0) way[axis] = std::remainder(way[axis], period[axis]);
      }
      if (way.squaredNorm() < least * least) return Overlapping{posts.centres[b], posts.centres[a], way.norm()};
    }
  }
  return std::nullopt;
}

void check_places(Resolution& scene, const StandingPosts& posts, const Vec2& period) {
  const System& system = scene.plan.system;
  const Paths paths{"posts.places", "posts.diameter", "box.side", "walls.size"};
  for (const Vec2& place : posts.centres) {
    if (place.x() > system.box().x() || place.y() > system.box().y()) {
      return scene.report(paths, fmt::format("the post at {} stands outside of the box, {} by {}", place_text(place),
                                             length_text(system.box().x()), length_text(system.box().y())));
    }
    if (!stands_within(place, posts.diameter * (1 - kTouching), system.box(), system.walls)) {
      return scene.report(paths, fmt::format("the post at {} does not stand within the walls: its axis must be {} from "
                                             "them",
                                             place_text(place), length_text(0.5 * posts.diameter)));
    }
  }
  if (const auto pair = overlapping_places(posts, period)) {
    scene.report(paths,
                 fmt::format("the posts at {} and {} overlap: they are {} apart, and {} thick", place_text(pair->one),
                             place_text(pair->other), length_text(pair->apart), length_text(posts.diameter)));
  }
}

void check_lattice(Resolution& scene, const StandingPosts& posts, const Vec2& period) {
  const System& system = scene.plan.system;
  if (posts.centres.empty()) {
    return scene.report({"posts.diameter", "posts.columns", "posts.rows", "walls.size"},
                        fmt::format("no post of {} stands within the walls: make it thinner, or change posts.columns "
                                    "and posts.rows",
                                    length_text(posts.diameter)));
  }
  const Vec2 around = rectangle_round(system.box(), system.walls);
  const std::array sites{system.posts->columns, system.posts->rows};
  for (const int axis : {0, 1}) {
    const int n = sites[static_cast<std::size_t>(axis)];
    const double apart = around[axis] / n;
    const bool has_next = n > 1 || period[axis] > 0;
    if (!has_next || apart >= posts.diameter * (1 - kTouching)) continue;
    return scene.report({axis == 0 ? "posts.columns" : "posts.rows", "posts.diameter", "box.side", "walls.size"},
                        fmt::format("posts of {} overlap: {} {} in {} stand {} apart", length_text(posts.diameter), n,
                                    axis == 0 ? "columns" : "rows", length_text(around[axis]), length_text(apart)));
  }
}

/// No bead may touch a post and an image of it at a time.
void check_images(Resolution& scene, double diameter, const Vec2& period) {
  double thickest = 0;
  for (const RodGroup& group : rod_groups(scene.plan.system)) {
    for (const Species& size : sizes_of_species(group.rod)) thickest = std::max(thickest, 2.0 * size.max_radius);
  }
  for (const int axis : {0, 1}) {
    if (period[axis] == 0 || period[axis] - diameter > thickest) continue;
    return scene.report(
        {"posts.diameter", "box.side", "box.aspect"},
        fmt::format("a post of {} is {} from its own image, so that beads of {} would touch both: make "
                    "it thinner, or the box larger",
                    length_text(diameter), length_text(period[axis] - diameter), length_text(thickest)));
  }
}

}  // namespace

bool resolve_posts(Resolution& scene) {
  const System& system = scene.plan.system;
  if (!system.posts) return true;
  if (!scene.ok(kPostKeys)) return false;
  if (!system.posts->places.empty() && (scene.given("posts.columns") || scene.given("posts.rows"))) {
    return scene.refuse(
        kPostKeys,
        "posts stand at posts.places or at the sites of a lattice: remove posts.places, or posts.columns "
        "and posts.rows");
  }
  const bool box_follows = !scene.given("box.side") && scene.given("rods.count") && scene.given("rods.area_fraction");
  if (system.area() > 0 || box_follows) return true;
  return scene.refuse({"posts.diameter", "posts.columns", "posts.rows", "posts.places", "box.side", "walls.size"},
                      fmt::format("{} posts of {} leave no room for rods", standing_posts(system).centres.size(),
                                  length_text(system.posts->diameter)));
}

void check_posts(Resolution& scene) {
  const System& system = scene.plan.system;
  if (!system.posts) return;
  const StandingPosts posts = standing_posts(system);
  const Vec2 period = period_of(system.box(), system.walls);
  if (system.posts->places.empty()) {
    check_lattice(scene, posts, period);
  } else {
    check_places(scene, posts, period);
  }
  check_images(scene, posts.diameter, period);
}

}  // namespace shaken::scene
