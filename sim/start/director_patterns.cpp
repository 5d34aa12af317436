#include "sim/start/director_patterns.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

#include "base/core/rng.h"
#include "base/core/sincos.h"

namespace shaken {
namespace {

constexpr int kCandidates = 10;
constexpr int kImages = 6;  ///< exp(-2 pi kImages) is below the last bit

double distance2(const Vec2& a, const Vec2& b, const Box& box) {
  Vec2 apart = b - a;
  for (const int axis : {0, 1}) apart[axis] -= box[axis] * std::nearbyint(apart[axis] / box[axis]);
  return apart.squaredNorm();
}

/// exp(-x) for x >= 0: Taylor's series of exp(-x / 2^k), and k squares. Relative error 1e-13 or so.
double decay(double x) {
  if (x > 700) return 0;
  constexpr int kSquares = 10;
  const double y = x * 0x1p-10;
  double sum = 1;
  for (int n = 14; n >= 1; --n) sum = 1.0 - y / n * sum;
  for (int k = 0; k < kSquares; ++k) sum *= sum;
  return sum;
}

/// tanh(x); near 0 it is right to 1e-13 or so, not relatively.
double hyperbolic_tangent(double x) {
  const double e = decay(2.0 * std::abs(x));
  return std::copysign((1.0 - e) / (1.0 + e), x);
}

/// sin(a + i b), but for its length.
std::complex<double> complex_sine(double a, double b) {
  const SinCos turn = sincos(a);
  return {turn.sin, turn.cos * hyperbolic_tangent(b)};
}

/// exp(i phi / 2) of exp(i phi) times any positive number, with phi in (-pi, pi].
std::complex<double> half_phase(const std::complex<double>& z) {
  const double length = std::sqrt(z.real() * z.real() + z.imag() * z.imag());
  if (!(length > 0)) return 1;
  const double c = z.real() / length;
  return {std::sqrt(std::max(0.0, 0.5 * (1.0 + c))),
          std::copysign(std::sqrt(std::max(0.0, 0.5 * (1.0 - c))), z.imag())};
}

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

std::vector<Domain> draw_domains(const Box& box, int n, std::uint64_t seed) {
  Rng rng(seed, RngStream::kDomains, 0, 0);
  const double first = kPi * rng.uniform();
  std::vector<int> dealt(static_cast<std::size_t>(n));
  for (std::size_t k = 0; k < dealt.size(); ++k) {  // a random permutation (Fisher & Yates)
    const std::size_t at = rng.below(k + 1);
    dealt[k] = dealt[at];
    dealt[at] = static_cast<int>(k);
  }
  std::vector<Domain> domains;
  for (const int step : dealt) {
    const SinCos along = sincos(first + kPi * step / n);
    Domain domain{Vec2::Zero(), Vec2(along.cos, along.sin)};
    double furthest = -1;
    for (int candidate = 0; candidate < kCandidates; ++candidate) {
      const double x = box.x() * rng.uniform(), y = box.y() * rng.uniform();
      double nearest = INFINITY;
      for (const Domain& other : domains) nearest = std::min(nearest, distance2({x, y}, other.centre, box));
      if (nearest > furthest) {
        furthest = nearest;
        domain.centre = {x, y};
      }
    }
    domains.push_back(domain);
  }
  return domains;
}

DirectorAt director_of_domains(const Box& box, std::vector<Domain> domains) {
  return [box, domains = std::move(domains)](const Vec2& place) {
    const auto further = [&](const Domain& one, const Domain& other) {
      return distance2(place, one.centre, box) < distance2(place, other.centre, box);
    };
    return std::min_element(domains.begin(), domains.end(), further)->director;
  };
}

DefectPair defect_pair(const Box& box, double separation) {
  const Vec2 middle = 0.5 * box.sides();
  const Vec2 half = 0.5 * separation * (box.y() > box.x() ? Vec2::UnitY() : Vec2::UnitX());
  return {middle - half, middle + half};
}

DirectorAt director_of_defect_pair(const Box& box, double separation, double angle) {
  const DefectPair pair = defect_pair(box, separation);
  const bool upright = box.y() > box.x();
  const double longer = box.longer(), per_length = kPi / box.shorter();
  const SinCos beyond = sincos(angle);
  return [=](const Vec2& place) {
    const auto along = [&](const Vec2& from) { return upright ? place.y() - from.y() : place.x() - from.x(); };
    const double across = upright ? place.x() - pair.plus.x() : pair.plus.y() - place.y();
    std::complex<double> phase = 1;
    for (int image = -kImages; image <= kImages; ++image) {
      const auto factor = [&](const Vec2& defect) {
        return complex_sine(per_length * across, per_length * (along(defect) - image * longer));
      };
      phase *= factor(pair.plus) * std::conj(factor(pair.minus));
    }
    const std::complex<double> director = half_phase(phase) * std::complex<double>(beyond.cos, beyond.sin);
    return Vec2(director.real(), director.imag());
  };
}

DirectorAt start_pattern(const System& system) {
  const Box box = system.box();
  if (system.start == Start::kPolydomain) {
    return director_of_domains(box, draw_domains(box, system.start_domains, system.seed));
  }
  if (system.start == Start::kDefectPair) {
    return director_of_defect_pair(box, system.start_separation, system.start_angle * (kPi / 180.0));
  }
  return {};
}

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
