// SPDX-License-Identifier: MIT
#include "client/live/live_rods.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "scene/fields.h"

namespace shaken::client {
namespace {

/// Whether a scene may have `value` at `path`; false for NaN.
bool is_allowed(double value, const char* path) {
  constexpr double kRounding = 1e-9;
  const scene::Field& field = scene::field_at(path);
  return value >= field.low * (1 - kRounding) && value <= field.high * (1 + kRounding);
}

std::optional<RodOutline> outline_of(std::span<const double> offsets, std::span<const double> radii) {
  RodOutline outline;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    if (!std::isfinite(offsets[i]) || !is_allowed(2 * radii[i], "rods.bead_diameters")) return std::nullopt;
    if (std::abs(offsets[i]) > outline.half_length || i == 0) {
      outline.half_length = std::abs(offsets[i]);
      outline.end = radii[i];
    }
    outline.middle = std::max(outline.middle, radii[i]);
  }
  if (2 * outline.half_length > scene::field_at("rods.length").high) return std::nullopt;
  return outline;
}

/// Rods that lie flat and fill the box several times are no rods of a scene, and would take long to draw.
bool fit_in(double box_side, std::size_t n_rods, const std::vector<RodOutline>& outlines) {
  constexpr double kMostLayers = 20;
  double largest = 0;
  for (const RodOutline& outline : outlines) {
    largest = std::max(largest, 4 * (outline.half_length + outline.end) * outline.middle);
  }
  return static_cast<double>(n_rods) * largest <= kMostLayers * box_side * box_side;
}

}  // namespace

std::optional<RodFrame> constants_of(const frame_static_t& message) {
  RodFrame frame;
  frame.box_side = message.box_side_mm;
  if (!is_allowed(frame.box_side, "box.side") || !is_allowed(message.n_rods, "rods.count")) return std::nullopt;
  const auto n_rods = static_cast<std::size_t>(message.n_rods);
  std::span<const double> offsets(message.bead_offset_mm), radii(message.bead_radius_mm);
  for (const std::int32_t n_beads : message.species_beads) {
    if (n_beads < 1 || static_cast<std::size_t>(n_beads) > std::min(offsets.size(), radii.size())) return std::nullopt;
    const auto n = static_cast<std::size_t>(n_beads);
    const std::optional<RodOutline> outline = outline_of(offsets.first(n), radii.first(n));
    if (!outline) return std::nullopt;
    frame.outlines.push_back(*outline);
    offsets = offsets.subspan(n);
    radii = radii.subspan(n);
  }
  if (frame.outlines.empty() || !fit_in(frame.box_side, n_rods, frame.outlines)) return std::nullopt;
  frame.species_of_rod.assign(message.rod_species.begin(), message.rod_species.end());
  if (frame.species_of_rod.size() != (frame.outlines.size() > 1 ? n_rods : 0)) return std::nullopt;
  const bool are_known = std::all_of(frame.species_of_rod.begin(), frame.species_of_rod.end(),
                                     [&](std::uint8_t species) { return species < frame.outlines.size(); });
  if (!are_known) return std::nullopt;
  if (const std::optional<Arena> arena = arena_of(message.arena)) {
    frame.walls.emplace();
    frame.walls->arena = *arena;
    frame.walls->size = message.arena_size_mm;
    frame.walls->inner = message.arena_inner_mm;
    if (!std::isfinite(message.arena_size_mm) || !std::isfinite(message.arena_inner_mm)) return std::nullopt;
  }
  return frame;
}

void LiveRods::select(const std::string& job) {
  if (job == job_) return;
  *this = LiveRods();
  job_ = job;
  assembler_ = proto::FrameAssembler(job);
}

void LiveRods::note(const frame_static_t& message) {
  if (job_.empty() || message.job_id != job_) return;
  if (std::optional<RodFrame> constants = constants_of(message)) {
    constants_ = std::move(constants);
    n_rods_ = static_cast<std::size_t>(message.n_rods);
  }
}

namespace {

/// S is a number, and may be NaN where there are no axes.
bool has_fitting_order(double order, const RodFrame& constants) {
  return std::isfinite(order) || (std::isnan(order) && !constants.has_axes());
}

}  // namespace

void LiveRods::note(const frame_t& message) {
  if (!constants_ || message.job_id != job_) return;
  const bool fits = message.n_rods >= 0 && static_cast<std::size_t>(message.n_rods) == n_rods_ &&
                    message.box_side_mm == constants_->box_side && has_fitting_order(message.order, *constants_) &&
                    std::abs(message.director_rad) <= 4 && std::isfinite(message.sim_time_s);
  if (!fits) return;
  std::optional<proto::Frame> frame = assembler_.add(message);
  if (!frame) return;
  ++received_;
  RodFrame next = *constants_;
  next.time = frame->sim_time_s;
  next.order = next.has_axes() ? frame->order : std::nan("");
  next.director = frame->director_rad;
  next.rods = std::move(frame->rods);
  newest_ = std::make_shared<const RodFrame>(std::move(next));
}

}  // namespace shaken::client
