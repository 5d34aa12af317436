#include "render/interpolation.h"

#include <cmath>

namespace shaken::render {
namespace {

constexpr double kLeastCosine = 0.5;  // of a turn

Vec3 unwrapped(const Snapshot& frame, std::size_t rod, const Box& box) {
  const auto& image = frame.image[rod];
  return frame.position[rod] + Vec3(image[0] * box.x(), image[1] * box.y(), 0);
}

}  // namespace

Snapshot between(const Snapshot& before, const Snapshot& after, double time, const Cell& cell) {
  const double share = (time - before.time) / (after.time - before.time);
  Snapshot now = share < 0.5 ? before : after;
  now.time = time;
  for (std::size_t i = 0; i < now.n_rods(); ++i) {
    const BeadRow& beads = cell.beads_of(i);
    const Vec3 from = unwrapped(before, i, cell.box), way = unwrapped(after, i, cell.box) - from;
    const Vec3& n = before.director[i];
    Vec3 turned = after.director[i];
    if (!beads.is_polar() && turned.dot(n) < 0) turned = -turned;
    if (way.norm() > beads.length() || turned.dot(n) < kLeastCosine) continue;
    Vec3 at = from + share * way;
    for (int axis = 0; axis < 2; ++axis) {
      if (!(cell.period()[axis] > 0)) continue;
      const double image = std::floor(at[axis] / cell.box[axis]);
      now.image[i][static_cast<std::size_t>(axis)] = static_cast<std::int32_t>(image);
      at[axis] -= image * cell.box[axis];
    }
    now.position[i] = at;
    now.director[i] = ((1 - share) * n + share * turned).normalized();
    now.velocity[i] = (1 - share) * before.velocity[i] + share * after.velocity[i];
  }
  return now;
}

}  // namespace shaken::render
