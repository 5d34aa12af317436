#include "sim/motion/post_grid.h"

#include <numeric>

namespace shaken {

PostGrid::PostGrid(const StandingPosts& posts, const Box& box, const Vec2& period)
    : radius_(0.5 * posts.diameter), period_(period) {
  constexpr double kMostCells = 1000;  // along a side
  const double n_posts = std::max<double>(1, static_cast<double>(posts.centres.size()));
  const double width = std::max(posts.diameter, std::sqrt(box.area() / n_posts));
  for (const int axis : {0, 1}) {
    const double n = std::clamp(std::floor(box[axis] / width), 1.0, kMostCells);
    n_[static_cast<std::size_t>(axis)] = static_cast<long>(n);
    width_[axis] = box[axis] / n;
  }

  const auto along = [&](int axis, double at) {
    const long n = n_[static_cast<std::size_t>(axis)];
    return std::clamp(static_cast<long>(std::floor(at / width_[axis])), 0L, n - 1);
  };
  std::vector<Vec2> places = posts.centres;
  std::vector<std::size_t> cell_of;
  begin_.assign(static_cast<std::size_t>(n_[0] * n_[1]) + 1, 0);
  for (Vec2& place : places) {
    for (const int axis : {0, 1}) {
      if (period_[axis] > 0) place[axis] -= std::floor(place[axis] / period_[axis]) * period_[axis];
    }
    cell_of.push_back(static_cast<std::size_t>(along(1, place.y()) * n_[0] + along(0, place.x())));
    ++begin_[cell_of.back() + 1];
  }
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  std::vector<int> next(begin_.begin(), begin_.end() - 1);
  centres_.resize(places.size());
  for (std::size_t k = 0; k < places.size(); ++k) centres_[static_cast<std::size_t>(next[cell_of[k]]++)] = places[k];
}

}  // namespace shaken
