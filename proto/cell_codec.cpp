#include "proto/cell_codec.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <span>
#include <string_view>

namespace shaken::proto {

namespace {

/// What an arena has beside its size, which goes by the name that it had when an annulus alone had any [mm].
double second_length(const SideWalls& walls) {
  if (walls.has_length()) return walls.length;
  return walls.arena == Arena::kAnnulus ? walls.inner : 0;
}

/// The name of an arena; of a wedge with its third length, for which messages have no field. What is read gives these
/// numbers back.
std::string arena_text(const SideWalls& walls) {
  const std::string name = name_of(walls.arena);
  return walls.arena == Arena::kWedge ? fmt::format("{} {}", name, walls.narrow) : name;
}

std::optional<SideWalls> decode_walls(const frame_static_t& message) {
  const std::string_view text = message.arena, name = text.substr(0, text.find(' '));
  const std::optional<Arena> arena = arena_of(name);
  if (!arena) return std::nullopt;
  SideWalls walls{.arena = *arena, .size = message.arena_size_mm, .inner = 0};
  (walls.has_length() ? walls.length : walls.inner) = message.arena_inner_mm;
  if (name == text) return walls;
  const std::string_view number = text.substr(name.size() + 1);
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), walls.narrow);
  const bool is_all = error == std::errc() && end == number.data() + number.size();
  return is_all && *arena == Arena::kWedge ? std::optional(walls) : std::nullopt;
}

}  // namespace

frame_static_t encode_cell(const Cell& cell, std::size_t n_rods, const std::string& label) {
  frame_static_t message{};
  message.n_rods = static_cast<std::int32_t>(n_rods);
  message.box_x_mm = cell.box.x();
  message.box_y_mm = cell.box.y();
  message.gap_mm = cell.gap;
  for (const auto& [offset, radius] : cell.shapes) {
    message.species_beads.push_back(static_cast<std::int32_t>(offset.size()));
    message.bead_offset_mm.insert(message.bead_offset_mm.end(), offset.begin(), offset.end());
    message.bead_radius_mm.insert(message.bead_radius_mm.end(), radius.begin(), radius.end());
  }
  message.n_species = static_cast<std::int32_t>(message.species_beads.size());
  message.n_beads = static_cast<std::int32_t>(message.bead_offset_mm.size());
  message.rod_species = cell.shape_of_rod;
  message.n_rod_species = static_cast<std::int32_t>(message.rod_species.size());
  if (cell.walls) {
    message.arena = arena_text(*cell.walls);
    message.arena_size_mm = cell.walls->size;
    message.arena_inner_mm = second_length(*cell.walls);
  }
  message.label = label;
  return message;
}

std::optional<Cell> decode_cell(const frame_static_t& message) {
  Cell cell;
  cell.box = {message.box_x_mm, message.box_y_mm};
  cell.gap = message.gap_mm;
  cell.shape_of_rod = message.rod_species;
  std::span<const double> offsets(message.bead_offset_mm), radii(message.bead_radius_mm);
  for (const std::int32_t n_beads : message.species_beads) {
    if (n_beads < 1 || static_cast<std::size_t>(n_beads) > std::min(offsets.size(), radii.size())) return std::nullopt;
    const auto n = static_cast<std::size_t>(n_beads);
    cell.shapes.push_back({{offsets.begin(), offsets.begin() + n_beads}, {radii.begin(), radii.begin() + n_beads}});
    offsets = offsets.subspan(n);
    radii = radii.subspan(n);
  }
  if (!offsets.empty() || !radii.empty()) return std::nullopt;
  cell.walls = decode_walls(message);
  return cell;
}

posts_t encode_posts(const StandingPosts& posts) {
  posts_t message{};
  message.diameter_mm = posts.diameter;
  message.n_posts = static_cast<std::int32_t>(posts.centres.size());
  for (const Vec2& centre : posts.centres) {
    message.x_mm.push_back(centre.x());
    message.y_mm.push_back(centre.y());
  }
  return message;
}

sizes_t encode_sizes(const std::vector<std::uint8_t>& species_of_shape) {
  sizes_t message{};
  message.species = species_of_shape;
  message.n_sizes = static_cast<std::int32_t>(message.species.size());
  return message;
}

StandingPosts decode_posts(const posts_t& message) {
  StandingPosts posts{message.diameter_mm, {}};
  for (std::size_t k = 0; k < message.x_mm.size(); ++k) posts.centres.emplace_back(message.x_mm[k], message.y_mm[k]);
  return posts;
}

}  // namespace shaken::proto
