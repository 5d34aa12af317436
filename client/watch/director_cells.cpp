#include "client/watch/director_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

#include "analysis/geometry/director_field.h"
#include "client/watch/rod_samples.h"
#include "scene/keys/measure_plan.h"

namespace shaken::client {
namespace {

/// Shades of a colour: few, so that a cell often keeps its own from one picture to the next.
constexpr int kShades = 5;

/// Smoothing lengths along a box: with more, the field would take long.
constexpr double kMostSmoothingLengths = 512;

/// What there is at a point of the box.
struct Director {
  bool is_defined = false;
  double order = 0;
  double theta = 0;  ///< [rad]
};

class SmoothedDirector {
 public:
  /// `cell` is the width of a cell [mm]: nothing finer is seen.
  SmoothedDirector(const RodFrame& frame, double cell) : field_(field_of(frame, cell)) {}

  Director at(double x, double y) const {
    const Vec2 q = field_.q_at({x, y});
    const auto node = [](double place, double mesh) { return static_cast<int>(std::lround(place / mesh)); };
    const Vec2 mesh = field_.mesh();
    return {field_.is_defined(node(x, mesh.x()), node(y, mesh.y())), 2 * q.norm(), std::atan2(q.y(), q.x()) / 2};
  }

  bool allows(const DefectMark& defect) const {
    constexpr int kPlaces = 12;
    const Box& box = field_.region().box();
    if (std::abs(defect.x) > box.x() || std::abs(defect.y) > box.y()) return false;  // anybody can send messages
    double order = 0;
    for (int k = 0; k < kPlaces; ++k) {
      const double angle = 2 * std::numbers::pi * k / kPlaces, ring = 2 * field_.smoothing();
      order += at(defect.x + ring * std::cos(angle), defect.y + ring * std::sin(angle)).order / kPlaces;
    }
    return order >= kLeastLocalOrder;
  }

 private:
  static analysis::DirectorField field_of(const RodFrame& frame, double cell) {
    std::vector<Vec3> positions, directors;
    for (std::size_t i = 0; i < frame.rods.size(); ++i) {
      if (frame.cell.species_of(i) > 0) continue;
      const std::array axis = frame.rods[i].axis();
      positions.emplace_back(frame.rods[i].x, frame.rods[i].y, 0);
      directors.emplace_back(axis[0], axis[1], axis[2]);
    }
    const RodOutline& outline = frame.outlines.front();
    const double length = 2 * (outline.half_length + outline.end);
    const Box& box = frame.cell.box;
    const double smoothing =
        std::max({scene::MeasureDefects{}.smoothing_for(length), cell / 2, box.longer() / kMostSmoothingLengths});
    return {positions, directors, analysis::Region(box, frame.cell.walls), analysis::Grid(box, smoothing / 2),
            smoothing};
  }

  analysis::DirectorField field_;
};

Tone director_tone(const Director& director, const RodFrame& frame, Colouring colouring) {
  if (colouring == Colouring::kWheel) return wheel_tone(director.theta);
  return layer_tone(std::remainder(director.theta - frame.director, std::numbers::pi));
}

Ink ink_at(const Director& director, const RodFrame& frame, const RodStyle& style) {
  if (!director.is_defined) return ink_of(kFloorTone);
  const Tone tone = director_tone(director, frame, style.colouring);
  if (!style.mixes) return ink_of(director.order >= kLeastLocalOrder ? tone : kFloorTone);
  return ink_of(tone, std::round(std::min(director.order, 1.0) * kShades) / kShades);
}

char32_t stroke_of(const Director& director) {
  static constexpr std::array kStrokes{U'─', U'╱', U'│', U'╲'};
  if (!director.is_defined) return U' ';
  if (director.order < kLeastLocalOrder) return U'·';
  return kStrokes[static_cast<std::size_t>(std::lround(director.theta / (std::numbers::pi / 4)) + 4) % 4];
}

}  // namespace

bool draws_director(const RodFrame& frame, const RodView& view, Colouring colouring, const Area& area) {
  if (std::isnan(frame.order) || (colouring != Colouring::kLayers && colouring != Colouring::kWheel)) return false;
  return 2 * frame.outlines.front().middle * samples_per_mm(frame, view, 2 * area.columns, 4 * area.lines) < 2;
}

void draw_director(const RodFrame& frame, const std::vector<DefectMark>& defects, const RodView& view,
                   const RodStyle& style, const Area& area, CellGrid& grid) {
  const double cell = 2 / samples_per_mm(frame, view, 2 * area.columns, 4 * area.lines);
  const SmoothedDirector smoothed(frame, cell);
  const RodFrame ground{.order = frame.order, .cell = frame.cell, .outlines = frame.outlines};
  const RodSamples samples(ground, view, style.colouring, 2 * area.columns, 4 * area.lines);
  const bool has_blocks = style.in_colour && style.grain == Grain::kBlocks;
  const auto at = [&](double column, double row) {
    const auto [x, y] = samples.point(column, row);
    return smoothed.at(x, y);
  };
  const auto half_ink = [&](int column, int row) {
    if (!samples.is_in_box(column, row)) return kOwnInk;
    const bool has_wall = samples.tone(column, row) == kWallTone || samples.tone(column + 1, row + 1) == kWallTone;
    return has_wall ? ink_of(kWallTone) : ink_at(at(column + 1, row + 1), frame, style);
  };
  for (int line = 0; line < area.lines; ++line) {
    for (int i = 0; i < area.columns; ++i) {
      ScreenCell& shown = grid.at(area.column + i, area.line + line);
      const int column = 2 * i, row = 4 * line;
      if (has_blocks) {
        shown = {.glyph = U'▀', .fore = half_ink(column, row), .back = half_ink(column, row + 2)};
        if (shown.fore == shown.back) shown = {.back = shown.back};
      } else if (samples.is_in_box(column, row + 2)) {
        const Director director = at(column + 1, row + 2);
        shown.glyph = stroke_of(director);
        if (style.in_colour) shown.fore = ink_at(director, frame, style), shown.back = ink_of(kFloorTone);
      }
    }
  }
  if (!style.shows_defects) return;
  std::vector<DefectMark> allowed;
  std::copy_if(defects.begin(), defects.end(), std::back_inserter(allowed),
               [&](const DefectMark& defect) { return smoothed.allows(defect); });
  mark_defects(samples, allowed, style, area, grid);
}

}  // namespace shaken::client
