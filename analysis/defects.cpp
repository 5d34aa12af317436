#include "analysis/defects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "base/core/check.h"

namespace shaken::analysis {
namespace {

constexpr int kRingPoints = 32;

/// Half turns to take off the step from angle `a` to angle `b` so that it lies in (-pi/2, pi/2].
int half_turns(double a, double b) { return static_cast<int>(std::ceil((b - a) / kPi - 0.5)); }

/// Twice the charge inside every plaquette (rows * columns, the plaquette with its lower left corner at node (i, j), i
/// fastest). The four differences of angles round a plaquette cancel, so the charge is minus half the half turns taken
/// off. Each edge is looked at once and serves its two plaquettes with opposite signs: the sum over all is zero in
/// integers.
std::vector<int> twice_charges(const DirectorField& field) {
  const auto [m, n] = field.grid();
  std::vector<double> theta;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < m; ++i) theta.push_back(field.theta(i, j));
  }
  std::vector<int> charge(theta.size(), 0);
  const auto at = [m = m, n = n](int i, int j) { return static_cast<std::size_t>((j + n) % n * m + (i + m) % m); };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < m; ++i) {
      const int rightwards = half_turns(theta[at(i, j)], theta[at(i + 1, j)]);
      charge[at(i, j)] -= rightwards;      // the lower edge of this plaquette, counter-clockwise
      charge[at(i, j - 1)] += rightwards;  // the upper edge of the one below, clockwise
      const int upwards = half_turns(theta[at(i, j)], theta[at(i, j + 1)]);
      charge[at(i, j)] += upwards;      // the left edge of this plaquette, clockwise
      charge[at(i - 1, j)] -= upwards;  // the right edge of the one to the left, counter-clockwise
    }
  }
  return charge;
}

/// Coefficients of c0 + c1 u + c2 v + c3 u v, with the given values at the corners of the unit square.
std::array<double, 4> bilinear(double q00, double q10, double q01, double q11) {
  return {q00, q10 - q00, q01 - q00, q11 - q10 - q01 + q00};
}

/// Where in the unit square two bilinear functions are both zero. The winding of (Q_xx, Q_xy) round a plaquette that
/// holds a defect makes sure that there is such a point, but for rounding.
std::optional<Vec2> common_zero(const std::array<double, 4>& a, const std::array<double, 4>& b) {
  // Without u: p v^2 + q v + r = 0.
  const double p = b[2] * a[3] - b[3] * a[2];
  const double q = b[0] * a[3] + b[2] * a[1] - b[1] * a[2] - b[3] * a[0];
  const double r = b[0] * a[1] - b[1] * a[0];
  const double discriminant = q * q - 4 * p * r;
  if (discriminant < 0) return std::nullopt;
  const double stable = -0.5 * (q + std::copysign(std::sqrt(discriminant), q));
  for (const double v : {stable / p, r / stable}) {
    if (!(v >= 0 && v <= 1)) continue;  // also when not a number
    const double slope_a = a[1] + a[3] * v;
    const double slope_b = b[1] + b[3] * v;
    const double u =
        std::abs(slope_a) >= std::abs(slope_b) ? -(a[0] + a[2] * v) / slope_a : -(b[0] + b[2] * v) / slope_b;
    if (u >= 0 && u <= 1) return Vec2(u, v);
  }
  return std::nullopt;
}

Vec2 core_position(const DirectorField& field, int i, int j) {
  const auto xx = bilinear(field.q_xx(i, j), field.q_xx(i + 1, j), field.q_xx(i, j + 1), field.q_xx(i + 1, j + 1));
  const auto xy = bilinear(field.q_xy(i, j), field.q_xy(i + 1, j), field.q_xy(i, j + 1), field.q_xy(i + 1, j + 1));
  const Vec2 inside = common_zero(xx, xy).value_or(Vec2(0.5, 0.5));
  Vec2 position = (Vec2(i, j) + inside).cwiseProduct(field.mesh());
  for (int axis = 0; axis < 2; ++axis) {
    if (position[axis] >= field.region().box()[axis]) position[axis] -= field.region().box()[axis];
  }
  return position;
}

double distance_to_next(const std::vector<Defect>& defects, std::size_t self, const Region& region) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < defects.size(); ++k) {
    if (k != self) {
      nearest = std::min(nearest, region.shortest(defects[k].position - defects[self].position).norm());
    }
  }
  return nearest;
}

/// At all corners of a plaquette.
bool is_defined(const DirectorField& field, int i, int j) {
  return field.is_defined(i, j) && field.is_defined(i + 1, j) && field.is_defined(i, j + 1) &&
         field.is_defined(i + 1, j + 1);
}

/// Vromans & Giomi 2016, eq. 5.
double core_direction(const DirectorField& field, const Defect& defect, double radius) {
  const double sign = defect.charge > 0 ? 1.0 : -1.0;
  const Vec2 h = field.mesh();
  double sine = 0, cosine = 0;
  for (int k = 0; k < kRingPoints; ++k) {
    const double phi = 2 * kPi * k / kRingPoints;
    const Vec2 p = defect.position + radius * Vec2(std::cos(phi), std::sin(phi));
    const Vec2 dx = field.q_at(p + Vec2(h.x(), 0)) - field.q_at(p - Vec2(h.x(), 0));
    const Vec2 dy = (field.q_at(p + Vec2(0, h.y())) - field.q_at(p - Vec2(0, h.y()))) * (h.x() / h.y());
    sine += sign * dx.y() - dy.x();
    cosine += dx.x() + sign * dy.y();
  }
  const double direction = defect.charge / (1 - defect.charge) * std::atan2(sine, cosine);
  const double period = kPi / (1 - defect.charge);  // 2 pi for +1/2, 2 pi / 3 for -1/2
  return direction >= 0.5 * period ? direction - period : direction;
}

}  // namespace

std::vector<Defect> find_defects(const DirectorField& field) {
  const auto [columns, rows] = field.grid();
  const std::vector<int> charges = twice_charges(field);
  // Where walls end the region no plaquette reaches round the box.
  const Vec2 period = field.region().period();
  const int last_column = period.x() > 0 ? columns : columns - 1, last_row = period.y() > 0 ? rows : rows - 1;
  std::vector<Defect> defects;
  for (int j = 0; j < last_row; ++j) {
    for (int i = 0; i < last_column; ++i) {
      const int charge = charges[static_cast<std::size_t>(j * columns + i)];
      if (charge != 0 && is_defined(field, i, j)) defects.push_back({core_position(field, i, j), 0.5 * charge, 0.0});
    }
  }
  for (std::size_t k = 0; k < defects.size(); ++k) {
    if (std::abs(defects[k].charge) != 0.5) continue;
    const double half_way = 0.5 * distance_to_next(defects, k, field.region());
    const double radius = std::max(field.mesh().maxCoeff(), std::min(field.smoothing(), half_way));
    defects[k].direction = core_direction(field, defects[k], radius);
  }
  return defects;
}

}  // namespace shaken::analysis
