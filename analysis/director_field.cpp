// SPDX-License-Identifier: MIT
#include "analysis/director_field.h"

#include <algorithm>
#include <cmath>

#include "analysis/fold.h"
#include "sim/core/check.h"

namespace shaken::analysis {
namespace {

/// The Gaussian is cut here, in standard deviations.
constexpr double kCut = 4.0;

/// i modulo n, in [0, n).
int wrapped(int i, int n) {
  const int remainder = i % n;
  return remainder < 0 ? remainder + n : remainder;
}

/// The grid lines that one rod reaches in one direction, and their weights.
struct Reach {
  std::vector<int> node;
  std::vector<double> weight;
};

void fill_reach(Reach& reach, double coordinate, double mesh, int n, double smoothing) {
  reach.node.clear();
  reach.weight.clear();
  const double place = coordinate / mesh;
  // At most n lines, the nearest ones: in a small box each line is then met by the nearest image only.
  const double half_width = std::min(kCut * smoothing / mesh, 0.5 * n);
  const auto first = static_cast<int>(std::ceil(place - half_width));
  const int last = std::min(static_cast<int>(std::floor(place + half_width)), first + n - 1);
  for (int i = first; i <= last; ++i) {
    const double distance = (i - place) * mesh / smoothing;
    reach.node.push_back(wrapped(i, n));
    reach.weight.push_back(std::exp(-0.5 * distance * distance));
  }
}

double theta_of(const Vec2& q) { return fold_half_turn(0.5 * std::atan2(q.y(), q.x())); }

double order_of(const Vec2& q) { return std::min(1.0, 2.0 * q.norm()); }

}  // namespace

int grid_nodes(double box_side, double mesh) {
  SHAKEN_CHECK(box_side > 0.0 && mesh > 0.0, "box and mesh must be positive");
  // A mesh that divides the box must not gain a node by rounding.
  return std::max(4, static_cast<int>(std::ceil(box_side / mesh - 1e-9)));
}

DirectorField::DirectorField(std::span<const Vec3> positions, std::span<const Vec3> directors, double box_side, int n,
                             double smoothing)
    : n_(n), box_side_(box_side), smoothing_(smoothing) {
  SHAKEN_CHECK(positions.size() == directors.size(), "one position for each director");
  SHAKEN_CHECK(n >= 2 && box_side > 0.0 && smoothing > 0.0, "grid, box and smoothing must be positive");
  const auto n_nodes = static_cast<std::size_t>(n) * static_cast<std::size_t>(n);
  q_xx_.assign(n_nodes, 0.0);
  q_xy_.assign(n_nodes, 0.0);
  std::vector<double> weight(n_nodes, 0.0);
  Reach x, y;
  for (std::size_t i_rod = 0; i_rod < positions.size(); ++i_rod) {
    const Vec2 angle = double_angle(directors[i_rod]);
    if (angle == Vec2::Zero()) continue;
    // A Gaussian is a product, so a rod costs exponentials for its lines only, not for its nodes.
    const Vec2 place =
        positions[i_rod].head<2>() - box_side * (positions[i_rod].head<2>() / box_side).array().floor().matrix();
    fill_reach(x, place.x(), mesh(), n, smoothing);
    fill_reach(y, place.y(), mesh(), n, smoothing);
    for (std::size_t b = 0; b < y.node.size(); ++b) {
      const std::size_t row = index(0, y.node[b]);
      for (std::size_t a = 0; a < x.node.size(); ++a) {
        const double k = x.weight[a] * y.weight[b];
        const std::size_t node = row + static_cast<std::size_t>(x.node[a]);
        weight[node] += k;
        q_xx_[node] += k * 0.5 * angle.x();
        q_xy_[node] += k * 0.5 * angle.y();
      }
    }
  }
  for (std::size_t node = 0; node < n_nodes; ++node) {
    if (weight[node] == 0.0) continue;
    q_xx_[node] /= weight[node];
    q_xy_[node] /= weight[node];
  }
}

double DirectorField::theta(int i, int j) const { return theta_of({q_xx(i, j), q_xy(i, j)}); }

double DirectorField::order(int i, int j) const { return order_of({q_xx(i, j), q_xy(i, j)}); }

Vec2 DirectorField::q_at(const Vec2& position) const {
  const Vec2 place = position / mesh();
  const Vec2 corner(std::floor(place.x()), std::floor(place.y()));
  const Vec2 part = place - corner;
  const int i = static_cast<int>(corner.x());
  const int j = static_cast<int>(corner.y());
  const auto q = [this](int a, int b) { return Vec2(q_xx(a, b), q_xy(a, b)); };
  return (1 - part.y()) * ((1 - part.x()) * q(i, j) + part.x() * q(i + 1, j)) +
         part.y() * ((1 - part.x()) * q(i, j + 1) + part.x() * q(i + 1, j + 1));
}

double DirectorField::theta_at(const Vec2& position) const { return theta_of(q_at(position)); }

double DirectorField::order_at(const Vec2& position) const { return order_of(q_at(position)); }

std::size_t DirectorField::index(int i, int j) const {
  return static_cast<std::size_t>(wrapped(j, n_)) * static_cast<std::size_t>(n_) +
         static_cast<std::size_t>(wrapped(i, n_));
}

}  // namespace shaken::analysis
