#include "client/live/live_rods.h"

#include <algorithm>
#include <cmath>

#include "proto/cell_codec.h"
#include "scene/keys/cell_limits.h"

namespace shaken::client {
namespace {

RodOutline outline_of(const BeadRow& beads) {
  RodOutline outline;
  for (std::size_t i = 0; i < beads.offset.size(); ++i) {
    if (std::abs(beads.offset[i]) > outline.half_length || i == 0) {
      outline.half_length = std::abs(beads.offset[i]);
      outline.end = beads.radius[i];
    }
    outline.middle = std::max(outline.middle, beads.radius[i]);
  }
  return outline;
}

}  // namespace

Result<RodFrame> constants_of(const Cell& cell, std::size_t n_rods) {
  constexpr double kMostLayers = 20;
  SHAKEN_TRY(scene::check_cell(cell, n_rods));
  RodFrame frame{.cell = cell};
  double largest = 0;
  for (const BeadRow& beads : cell.shapes) {
    const RodOutline& outline = frame.outlines.emplace_back(outline_of(beads));
    largest = std::max(largest, 4 * (outline.half_length + outline.end) * outline.middle);
  }
  // Rods that lie flat and fill the box several times are no rods of a scene, and would take long to draw.
  if (static_cast<double>(n_rods) * largest <= kMostLayers * cell.box.area()) return frame;
  return Error{"more rods than a box can hold"};
}

void LiveRods::select(const std::string& job) {
  if (job == job_) return;
  *this = LiveRods();
  job_ = job;
  assembler_ = proto::FrameAssembler(job);
}

void LiveRods::note(const frame_static_t& message) {
  if (job_.empty() || message.job_id != job_) return;
  std::optional<Cell> cell = proto::decode_cell(message);
  if (!cell || message.n_rods < 0) return;
  cell->posts = posts_;
  if (species_of_shape_.size() == cell->shapes.size()) cell->species_of_shape = species_of_shape_;
  change(*cell, static_cast<std::size_t>(message.n_rods));
}

void LiveRods::note(const posts_t& message) {
  if (!constants_ || message.job_id != job_) return;
  Cell cell = constants_->cell;
  cell.posts = proto::decode_posts(message);
  if (change(cell, n_rods_)) posts_ = cell.posts;
}

void LiveRods::note(const sizes_t& message) {
  if (!constants_ || message.job_id != job_) return;
  Cell cell = constants_->cell;
  cell.species_of_shape = message.species;
  if (change(cell, n_rods_)) species_of_shape_ = cell.species_of_shape;
}

bool LiveRods::change(const Cell& cell, std::size_t n_rods) {
  Result<RodFrame> constants = constants_of(cell, n_rods);
  if (!constants) return false;
  constants_ = std::move(*constants);
  n_rods_ = n_rods;
  return true;
}

namespace {

/// S is a number, and may be NaN where there are no axes.
bool has_fitting_order(double order, const RodFrame& constants) {
  return std::isfinite(order) || (std::isnan(order) && !constants.cell.has_axes());
}

}  // namespace

void LiveRods::note(const frame_t& message) {
  if (!constants_ || message.job_id != job_) return;
  const bool fits = message.n_rods >= 0 && static_cast<std::size_t>(message.n_rods) == n_rods_ &&
                    Box(message.box_x_mm, message.box_y_mm) == constants_->cell.box &&
                    has_fitting_order(message.order, *constants_) && std::abs(message.director_rad) <= 4 &&
                    std::isfinite(message.sim_time_s);
  if (!fits) return;
  std::optional<proto::Frame> frame = assembler_.add(message);
  if (!frame) return;
  ++received_;
  RodFrame next = *constants_;
  next.time = frame->sim_time_s;
  next.order = next.cell.has_axes() ? frame->order : std::nan("");
  next.director = frame->director_rad;
  next.rods = std::move(frame->rods);
  newest_ = std::make_shared<const RodFrame>(std::move(next));
}

}  // namespace shaken::client
