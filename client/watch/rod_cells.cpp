// SPDX-License-Identifier: MIT
#include "client/watch/rod_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

namespace shaken::client {
namespace {

constexpr double kHalfTurn = std::numbers::pi;
constexpr Ink kMarkInk = 0xFFFFFF;
constexpr Ink kMarkBack = 0x000000;

/// `x` less whole periods, in [-period/2, period/2).
double folded(double x, double period) { return x - period * std::floor(x / period + 0.5); }

/// Samples of what lies in the picture: 2 x 4 in each cell, and which of them lie in the box at all.
class SampleGrid {
 public:
  SampleGrid(const RodFrame& frame, const RodView& view, const Area& area)
      : frame_(frame),
        x_(view.x * frame.box_side),
        y_(view.y * frame.box_side),
        per_mm_(dots_per_mm(frame, view, area)),
        width_(2 * area.columns),
        height_(4 * area.lines),
        tones_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), kFloorTone) {
    // A periodic box is seen from half a side left of the middle of the view to half a side right of it.
    const double half = frame.box_side / 2;
    const double left = frame.walls ? -x_ : -half, bottom = frame.walls ? -y_ : -half;
    column_begin_ = std::max(0, first_column(left));
    column_end_ = std::min(width_, first_column(left + frame.box_side));
    row_begin_ = std::max(0, first_row(bottom + frame.box_side));
    row_end_ = std::min(height_, first_row(bottom));
  }

  bool is_in_box(int column, int row) const {
    return column >= column_begin_ && column < column_end_ && row >= row_begin_ && row < row_end_;
  }
  Tone tone(int column, int row) const {
    return tones_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(column)];
  }

  /// The sample at a point of the box, of its image nearest to the middle of the view.
  std::pair<int, int> place(double x, double y) const {
    const auto [dx, dy] = from_middle(x, y);
    return {static_cast<int>(std::floor(width_ / 2.0 + dx * per_mm_)),
            static_cast<int>(std::floor(height_ / 2.0 - dy * per_mm_))};
  }

  void draw(const proto::RodPose& rod, const RodOutline& outline, Tone tone) {
    const auto [dx, dy] = from_middle(rod.x, rod.y);
    const std::array axis = rod.axis();
    const double flat = std::hypot(axis[0], axis[1]);
    const double half = outline.half_length * flat;
    const double ux = flat > 0 ? axis[0] / flat : 1, uy = flat > 0 ? axis[1] / flat : 0;
    const double period = frame_.walls ? 0 : frame_.box_side;
    const int n_images = frame_.walls ? 0 : 1;
    for (int i = -n_images; i <= n_images; ++i) {
      for (int j = -n_images; j <= n_images; ++j) {
        draw_image(dx + i * period, dy + j * period, ux, uy, half, outline, tone);
      }
    }
  }

  void draw_walls(const SideWalls& walls) {
    const double reach = 0.75 / per_mm_;
    for (int row = row_begin_; row < row_end_; ++row) {
      for (int column = column_begin_; column < column_end_; ++column) {
        const double x = x_ + x_of(column) - frame_.box_side / 2, y = y_ + y_of(row) - frame_.box_side / 2;
        const double distance = walls.arena == Arena::kSquare ? std::max(std::abs(x), std::abs(y)) : std::hypot(x, y);
        const bool is_outer = std::abs(distance - walls.size / 2) < reach;
        const bool is_inner = walls.arena == Arena::kAnnulus && std::abs(distance - walls.inner / 2) < reach;
        if (is_outer || is_inner) set(column, row, kWallTone);
      }
    }
  }

 private:
  /// [mm] from the middle of the view.
  std::pair<double, double> from_middle(double x, double y) const {
    if (frame_.walls) return {x - x_, y - y_};
    return {folded(x - x_, frame_.box_side), folded(y - y_, frame_.box_side)};
  }
  double x_of(int column) const { return (column + 0.5 - width_ / 2.0) / per_mm_; }
  double y_of(int row) const { return (height_ / 2.0 - row - 0.5) / per_mm_; }
  /// The first column or row of samples whose middle is not left of, or above, a distance from the middle of the view.
  int first_column(double x) const { return bounded(std::ceil(width_ / 2.0 + x * per_mm_ - 0.5), width_); }
  int first_row(double y) const { return bounded(std::ceil(height_ / 2.0 - y * per_mm_ - 0.5), height_); }
  static int bounded(double place, int most) { return static_cast<int>(std::clamp(place, 0.0, 1.0 * most)); }
  void set(int column, int row, Tone tone) {
    tones_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(column)] = tone;
  }

  void draw_image(double dx, double dy, double ux, double uy, double half, const RodOutline& outline, Tone tone) {
    const double thinnest = 0.5001 / per_mm_;  // never between two samples
    const double widest = std::max({outline.middle, outline.end, thinnest});
    const double reach_x = half * std::abs(ux) + widest, reach_y = half * std::abs(uy) + widest;
    const int begin_column = std::max(column_begin_, first_column(dx - reach_x));
    const int end_column = std::min(column_end_, first_column(dx + reach_x));
    const int begin_row = std::max(row_begin_, first_row(dy + reach_y));
    const int end_row = std::min(row_end_, first_row(dy - reach_y));
    for (int row = begin_row; row < end_row; ++row) {
      for (int column = begin_column; column < end_column; ++column) {
        const double x = x_of(column) - dx, y = y_of(row) - dy;
        const double along = std::abs(x * ux + y * uy), across = std::abs(y * ux - x * uy);
        const double part = half > 0 ? std::min(along / half, 1.0) : 1.0;
        const double radius = std::max(outline.middle + part * (outline.end - outline.middle), thinnest);
        if (std::hypot(std::max(along - half, 0.0), across) <= radius) set(column, row, tone);
      }
    }
  }

  const RodFrame& frame_;
  double x_;
  double y_;
  double per_mm_;
  int width_;
  int height_;
  int column_begin_ = 0;
  int column_end_ = 0;
  int row_begin_ = 0;
  int row_end_ = 0;
  std::vector<Tone> tones_;
};

Tone tone_of(const RodFrame& frame, std::size_t rod, Colouring colouring) {
  const std::size_t species = frame.species_of_rod.empty() ? 0 : frame.species_of_rod[rod];
  const proto::RodPose& pose = frame.rods[rod];
  if (colouring == Colouring::kTilt) return tilt_tone(pose.n_z);
  if (species > 0 || colouring == Colouring::kSpecies) return species_tone(species);
  if (colouring == Colouring::kWheel) return wheel_tone(pose.theta);
  return layer_tone(folded(pose.theta - frame.director, kHalfTurn));
}

/// What several samples have in common.
struct Blend {
  Tone tone = kFloorTone;  ///< that of most of those that are something
  int n_filled = 0;
  int n_in_box = 0;
};

Blend blended(const SampleGrid& samples, int column, int row, int columns, int rows) {
  Blend blend;
  std::array<Tone, 8> seen{};
  std::size_t n_seen = 0;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      if (!samples.is_in_box(column + i, row + j)) continue;
      ++blend.n_in_box;
      if (const Tone tone = samples.tone(column + i, row + j); tone != kFloorTone) seen[n_seen++] = tone;
    }
  }
  const std::span filled(seen.data(), n_seen);
  std::ptrdiff_t most = 0;
  for (const Tone tone : filled) {
    if (const auto n = std::count(filled.begin(), filled.end(), tone); n > most) {
      most = n;
      blend.tone = tone;
    }
  }
  blend.n_filled = static_cast<int>(n_seen);
  return blend;
}

/// The colour of half a cell; the terminal's own outside the box.
Ink half_ink(const Blend& blend, bool mixes) {
  if (blend.n_in_box == 0) return kOwnInk;
  if (!mixes) return 2 * blend.n_filled >= blend.n_in_box ? ink_of(blend.tone) : ink_of(kFloorTone);
  return ink_of(blend.tone, static_cast<double>(blend.n_filled) / blend.n_in_box);
}

Cell block_cell(const SampleGrid& samples, int column, int row, bool mixes) {
  const Ink upper = half_ink(blended(samples, column, row, 2, 2), mixes);
  const Ink lower = half_ink(blended(samples, column, row + 2, 2, 2), mixes);
  if (upper == lower) return {.back = upper};
  if (upper == kOwnInk) return {.glyph = U'▄', .fore = lower};
  return {.glyph = U'▀', .fore = upper, .back = lower};
}

Cell braille_cell(const SampleGrid& samples, int column, int row, bool in_colour) {
  // Unicode numbers the dots 1-3 and 7 down the left column, 4-6 and 8 down the right.
  static constexpr std::uint8_t kBits[4][2] = {{0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};
  const Blend blend = blended(samples, column, row, 2, 4);
  Cell cell;
  if (in_colour && blend.n_in_box > 0) cell.back = ink_of(kFloorTone);
  std::uint8_t bits = 0;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 2; ++i) {
      const bool is_set = samples.is_in_box(column + i, row + j) && samples.tone(column + i, row + j) != kFloorTone;
      if (is_set) bits |= kBits[j][i];
    }
  }
  if (bits == 0) return cell;
  cell.glyph = 0x2800 + bits;
  if (in_colour) cell.fore = ink_of(blend.tone);
  return cell;
}

}  // namespace

double dots_per_mm(const RodFrame& frame, const RodView& view, const Area& area) {
  return view.zoom * std::min(2 * area.columns, 4 * area.lines) / frame.box_side;
}

void draw_rods(const RodFrame& frame, const std::vector<DefectMark>& defects, const RodView& view,
               const RodStyle& style, const Area& area, CellGrid& grid) {
  SampleGrid samples(frame, view, area);
  if (frame.walls) samples.draw_walls(*frame.walls);
  for (std::size_t i = 0; i < frame.rods.size(); ++i) {
    const std::size_t species = frame.species_of_rod.empty() ? 0 : frame.species_of_rod[i];
    samples.draw(frame.rods[i], frame.outlines[species], tone_of(frame, i, style.colouring));
  }
  const bool has_blocks = style.in_colour && style.grain == Grain::kBlocks;
  for (int line = 0; line < area.lines; ++line) {
    for (int column = 0; column < area.columns; ++column) {
      grid.at(area.column + column, area.line + line) =
          has_blocks ? block_cell(samples, 2 * column, 4 * line, style.mixes)
                     : braille_cell(samples, 2 * column, 4 * line, style.in_colour);
    }
  }
  if (!style.shows_defects) return;
  for (const DefectMark& defect : defects) {
    const auto [column, row] = samples.place(defect.x, defect.y);
    if (!samples.is_in_box(column, row)) continue;
    Cell& cell = grid.at(area.column + column / 2, area.line + row / 4);
    cell = {.glyph = defect.is_positive ? U'+' : U'−', .bold = true};
    if (style.in_colour) {
      cell.fore = defect.is_positive ? kMarkBack : kMarkInk;
      cell.back = defect.is_positive ? kMarkInk : kMarkBack;
    }
  }
}

}  // namespace shaken::client
