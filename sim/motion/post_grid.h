#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/core/box.h"
#include "base/core/types.h"
#include "sim/posts.h"

namespace shaken {

/// Posts by the cells of a grid over the box, about one to a cell, so that those near a point are found without looking
/// at the others.
class PostGrid {
 public:
  /// `period`: after what the plane repeats itself along x and along y; 0 where it does not [mm].
  PostGrid(const StandingPosts& posts, const Box& box, const Vec2& period);

  int n_posts() const { return static_cast<int>(centres_.size()); }
  double radius() const { return radius_; }  ///< of each post [mm]
  /// The length of the cells' shorter side [mm].
  double spacing() const { return width_.minCoeff(); }

  /// Calls visit(post, centre) for each post, in each of its images, whose axis is at most `reach` away from a point of
  /// the plane; `centre`: that image's. The point may lie outside of the box.
  template <class Visit>
  void for_each_within(const Vec2& point, double reach, const Visit& visit) const {
    const Range columns = cells_within(0, point.x(), reach), rows = cells_within(1, point.y(), reach);
    for (long row = rows.first; row <= rows.last; ++row) {
      const long row_image = image_of(1, row);
      for (long column = columns.first; column <= columns.last; ++column) {
        const long column_image = image_of(0, column);
        const Vec2 shift(static_cast<double>(column_image) * period_.x(), static_cast<double>(row_image) * period_.y());
        const long cell = (row - row_image * n_[1]) * n_[0] + column - column_image * n_[0];
        for (int k = begin_[static_cast<std::size_t>(cell)]; k < begin_[static_cast<std::size_t>(cell) + 1]; ++k) {
          const Vec2 centre = centres_[static_cast<std::size_t>(k)] + shift;
          if ((point - centre).squaredNorm() <= reach * reach) visit(k, centre);
        }
      }
    }
  }

 private:
  struct Range {
    long first, last;
  };
  /// Cells along one axis; those beyond the box are images.
  Range cells_within(int axis, double at, double reach) const {
    constexpr double kRounding = 1e-6;  // of a cell, by which a quotient may be wrong
    Range range{static_cast<long>(std::floor((at - reach) / width_[axis] - kRounding)),
                static_cast<long>(std::floor((at + reach) / width_[axis] + kRounding))};
    if (period_[axis] > 0) return range;
    return {std::max(0L, range.first), std::min(n_[static_cast<std::size_t>(axis)] - 1, range.last)};
  }
  long image_of(int axis, long cell) const {
    const long n = n_[static_cast<std::size_t>(axis)];
    return cell >= 0 ? cell / n : -((n - 1 - cell) / n);
  }

  double radius_;
  Vec2 period_;
  std::array<long, 2> n_{1, 1};  ///< cells along x and y
  Vec2 width_;                   ///< of a cell [mm]
  std::vector<Vec2> centres_;    ///< (n_posts) cell by cell
  std::vector<int> begin_;       ///< (n_cells + 1) where those of each cell begin
};

}  // namespace shaken
