#include "scene/keys/cell_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "scene/keys/fields.h"

namespace shaken::scene {

namespace {

constexpr std::size_t kMostPosts = 3600;  ///< sites of the largest lattice, 60 by 60

}  // namespace

Result<void> check_cell(const Cell& cell, std::size_t n_rods) {
  std::string wrong;
  const auto hold = [&](const char* what, double value, const char* path, double share = 1) {
    constexpr double kRounding = 1e-9;
    const Field& field = field_at(path);
    const double low = share * field.low, high = share * field.high;
    if (value >= low * (1 - kRounding) && value <= high * (1 + kRounding)) return;  // false for NaN
    wrong = fmt::format("a {} of {} mm; a scene has {} to {} mm", what, value, low, high);
  };
  for (const double side : {cell.box.x(), cell.box.y()}) hold("box side", side, "box.side");
  hold("gap", cell.gap, "box.gap");
  for (const BeadRow& beads : cell.shapes) {
    for (const double radius : beads.radius) hold("bead radius", radius, "rods.bead_diameters", 0.5);
    // Beads may lie anywhere along a rod, so the shortest rod does not matter; nor where its centre of mass is.
    for (const double offset : beads.offset) {
      if (!(std::abs(offset) <= field_at("rods.length").low)) hold("bead offset", std::abs(offset), "rods.length");
    }
    if (beads.offset.size() != beads.radius.size()) return Error{"not as many radii of beads as places"};
  }
  if (cell.walls) {
    hold("arena", cell.walls->size, "walls.size");
    if (cell.walls->arena == Arena::kAnnulus) hold("inner wall", cell.walls->inner, "walls.inner");
    if (cell.walls->has_length()) hold("length of an arena", cell.walls->length, "walls.length");
    if (cell.walls->arena == Arena::kWedge) hold("narrow end", cell.walls->narrow, "walls.narrow");
    const bool is_thin = cell.walls->arena == Arena::kWedge && !(cell.walls->length > 0);
    const bool is_upright =
        cell.walls->arena == Arena::kEllipse && !(cell.walls->length >= cell.walls->size * (1 - 1e-12));
    if (is_thin || is_upright) wrong = "an arena that is too short";
  }
  if (!cell.posts.centres.empty()) hold("post", cell.posts.diameter, "posts.diameter");
  if (cell.posts.centres.size() > kMostPosts) return Error{"more posts than a scene can have"};
  for (const Vec2& centre : cell.posts.centres) {
    const bool is_inside = (centre.array() >= 0).all() && (centre.array() <= cell.box.sides().array()).all();
    if (!is_inside) return Error{"a post outside of the box"};
  }
  if (!wrong.empty()) return Error{wrong};
  if (cell.shapes.empty()) return Error{"no beads"};
  if (cell.shape_of_rod.size() != (cell.shapes.size() > 1 ? n_rods : 0)) {
    return Error{"a number of rods that contradicts that of their shapes"};
  }
  if (const auto& species = cell.species_of_shape; !species.empty()) {
    const bool has_gap =
        std::ranges::adjacent_find(species, [](int a, int b) { return b < a || b > a + 1; }) != species.end();
    if (species.size() != cell.shapes.size() || species.front() != 0 || has_gap)
      return Error{"sizes that contradict the species that they are of"};
  }
  const auto is_known = [&](std::uint8_t shape) { return shape < cell.shapes.size(); };
  if (std::all_of(cell.shape_of_rod.begin(), cell.shape_of_rod.end(), is_known)) return {};
  return Error{"a rod of a shape whose beads are not there"};
}

}  // namespace shaken::scene
