#include "sim/start/aligning_field.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace shaken {
namespace {

constexpr double kMeshes = 4;  ///< in one standard deviation

/// (cos, sin) of twice the angle of a unit vector.
Vec2 doubled(const Vec2& n) { return {n.x() * n.x() - n.y() * n.y(), 2.0 * n.x() * n.y()}; }

int nodes_along(double side, double mesh) { return std::max(2, static_cast<int>(std::ceil(side / mesh))); }

/// The node before x, the one after it, and how far x is on the way.
struct Between {
  int before, after;
  double part;
};
Between between_nodes(double x, double side, int nodes) {
  const double at = x / side * nodes;
  const double floor = std::floor(at);
  const int before = (static_cast<int>(floor) % nodes + nodes) % nodes;
  return {before, (before + 1) % nodes, at - floor};
}

}  // namespace

AligningField::AligningField(const Box& box, const DirectorAt& directors, double smoothing)
    : box_(box), columns_(nodes_along(box.x(), smoothing / kMeshes)), rows_(nodes_along(box.y(), smoothing / kMeshes)) {
  for (int j = 0; j < rows_; ++j) {
    for (int i = 0; i < columns_; ++i) {
      q_.push_back(doubled(directors(Vec2(box.x() * i / columns_, box.y() * j / rows_))));
    }
  }
  for (int step = 0; step < 4 * kMeshes * kMeshes; ++step) diffuse();
}

/// Each node becomes the mean of its four neighbours and four times itself: a variance of a quarter of a mesh squared
/// each way.
void AligningField::diffuse() {
  std::vector<Vec2> next(q_.size());
  for (int j = 0; j < rows_; ++j) {
    const int up = (j + 1) % rows_, down = (j + rows_ - 1) % rows_;
    for (int i = 0; i < columns_; ++i) {
      const int right = (i + 1) % columns_, left = (i + columns_ - 1) % columns_;
      next[static_cast<std::size_t>(j) * columns_ + i] =
          0.5 * at(i, j) + 0.125 * (at(right, j) + at(left, j) + at(i, up) + at(i, down));
    }
  }
  q_ = std::move(next);
}

double AligningField::torque(const Vec2& place, const Vec2& along) const {
  const Between x = between_nodes(place.x(), box_.x(), columns_), y = between_nodes(place.y(), box_.y(), rows_);
  const Vec2 below = (1.0 - x.part) * at(x.before, y.before) + x.part * at(x.after, y.before);
  const Vec2 above = (1.0 - x.part) * at(x.before, y.after) + x.part * at(x.after, y.after);
  const Vec2 field = (1.0 - y.part) * below + y.part * above;
  const Vec2 rod = doubled(along);
  return rod.x() * field.y() - rod.y() * field.x();
}

}  // namespace shaken
