#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "client/live/rod_frame.h"

namespace shaken::client {

/// Samples of what lies in a picture, as many as it shall be fine, and which of them lie in the box at all. A sample is
/// a rod's if it lies within the rod's outline, seen from above; rods that are thinner than a sample are as wide as
/// one. In a periodic box the view may be anywhere: one box around its middle is seen, with rods across the border on
/// both sides. Where walls end the box nothing is repeated. Rows go down, y goes up.
class RodSamples {
 public:
  /// Samples of the walls and of all rods. Numbers must be finite and the sides of the box positive; `colouring` is not
  /// kAuto. `frame` must outlive this.
  RodSamples(const RodFrame& frame, const RodView& view, Colouring colouring, int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }
  bool is_in_box(int column, int row) const {
    return column >= column_begin_ && column < column_end_ && row >= row_begin_ && row < row_end_;
  }
  Tone tone(int column, int row) const { return tones_[index(column, row)]; }
  /// The point under (column, row) of the picture, which may lie between samples [mm]; a periodic box goes on there.
  std::pair<double, double> point(double column, double row) const {
    return {x_ + (column - width_ / 2.0) / per_mm_, y_ + (height_ / 2.0 - row) / per_mm_};
  }
  /// The sample at a point of the box [mm], of its image nearest to the middle of the view.
  std::pair<int, int> place(double x, double y) const;

 private:
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(column);
  }
  std::pair<double, double> from_middle(double x, double y) const;
  double x_of(int column) const { return (column + 0.5 - width_ / 2.0) / per_mm_; }
  double y_of(int row) const { return (height_ / 2.0 - row - 0.5) / per_mm_; }
  int first_column(double x) const;
  int first_row(double y) const;
  void draw(const proto::RodPose& rod, const RodOutline& outline, Tone tone);
  void draw_walls(const SideWalls& walls);
  void draw_posts(const StandingPosts& posts);
  template <class IsInside>
  void paint(double x, double y, const Vec2& reach, Tone tone, const IsInside& is_inside);

  const RodFrame& frame_;
  double x_;  ///< the middle of the view [mm]
  double y_;
  Vec2 period_;  ///< 0 where walls end the box
  double per_mm_;
  int width_;
  int height_;
  int column_begin_ = 0;
  int column_end_ = 0;
  int row_begin_ = 0;
  int row_end_ = 0;
  std::vector<Tone> tones_;
};

/// Samples per millimetre of the box, which fits into the picture at zoom 1.
double samples_per_mm(const RodFrame& frame, const RodView& view, int width, int height);

}  // namespace shaken::client
