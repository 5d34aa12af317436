#include "analysis/lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <vector>

#include "analysis/geometry/periodic.h"
#include "analysis/geometry/wave_sums.h"
#include "analysis/order.h"
#include "base/core/check.h"
#include "base/core/rng.h"

namespace shaken::analysis {
namespace {

/// Bounds of the cost: rods looked at in one sample, waves to the side of a square box, or vectors as many as there.
constexpr std::size_t kMaxReferencesOfPeak = 1024;
constexpr int kMostPeakWaves = 128;
constexpr std::size_t kNeighbours = 6;
/// Distances that differ by less than this share of themselves are the same.
constexpr double kSame = 1e-6;

/// The rods that one sample takes, in rising order (see LatticeOrder).
std::vector<std::size_t> references(std::size_t n, std::int64_t sample) {
  const std::size_t stride = (n + kMaxReferencesOfPeak - 1) / kMaxReferencesOfPeak;
  std::vector<std::size_t> rods;
  for (std::size_t first = 0; first < n; first += stride) {
    Rng draw(static_cast<std::uint64_t>(sample), RngStream::kReferences, 0, first);
    rods.push_back(first + draw.below(std::min(stride, n - first)));
  }
  return rods;
}

/// Bonds from one rod to all: squared length (n), and their ends in the frame of the director.
struct Bonds {
  std::vector<double> x, y, square;
  explicit Bonds(std::size_t n) : x(n), y(n), square(n) {}
};

/// psi_6 of one rod, whose own entry has an infinite length.
std::complex<double> psi_6(const Bonds& bonds) {
  std::array<double, kNeighbours> nearest;
  nearest.fill(std::numeric_limits<double>::infinity());
  for (const double square : bonds.square) {
    if (square >= nearest.back()) continue;
    std::size_t place = kNeighbours - 1;
    for (; place > 0 && nearest[place - 1] > square; --place) nearest[place] = nearest[place - 1];
    nearest[place] = square;
  }
  const double sure = nearest.back() * (1 - 2 * kSame), last = nearest.back() * (1 + 2 * kSame);
  std::complex<double> near_sum = 0, last_sum = 0;
  double n_near = 0, n_last = 0;
  for (std::size_t j = 0; j < bonds.square.size(); ++j) {
    if (!(bonds.square[j] <= last)) continue;
    const std::complex<double> bond(bonds.x[j], bonds.y[j]);
    const double length = std::abs(bond);
    if (length == 0) continue;  // in one place: no direction
    const std::complex<double> unit = bond / length, cube = unit * unit * unit;
    (bonds.square[j] < sure ? near_sum : last_sum) += cube * cube;
    (bonds.square[j] < sure ? n_near : n_last) += 1;
  }
  if (n_last == 0) return 0;
  const double share = (static_cast<double>(kNeighbours) - n_near) / n_last;
  return (near_sum + share * last_sum) / static_cast<double>(kNeighbours);
}

}  // namespace

LatticeOrder::LatticeOrder(const Shape& shape) : shape_(shape) {
  SHAKEN_CHECK(shape.box.shorter() > 0 && shape.ratio > 0, "a box and rods with a shape");
  SHAKEN_CHECK(shape.shortest > 0 && shape.longest > shape.shortest, "wavelengths to look at");
}

void LatticeOrder::accumulate(std::span<const Vec3> positions, std::span<const Vec3> directors) {
  SHAKEN_CHECK(positions.size() == directors.size(), "one position for each director");
  const std::size_t n = positions.size();
  if (n == 0) return;
  const Box& box = shape_.box;
  const double director = nematic_order(directors).director;
  const double cosine = std::cos(director), sine = std::sin(director);
  std::vector<double> xs(n), ys(n);
  for (std::size_t i = 0; i < n; ++i) {
    xs[i] = wrapped(positions[i].x(), box.x());
    ys[i] = wrapped(positions[i].y(), box.y());
  }
  const std::vector<std::size_t> rods = references(n, calls_++);
  std::vector<Vec2> places;
  places.reserve(rods.size());
  for (const std::size_t i : rods) places.emplace_back(xs[i], ys[i]);
  const auto n_places = static_cast<double>(places.size());

  if (n > kNeighbours) {
    std::complex<double> sum = 0, raw_sum = 0;
    double local = 0;
    Bonds raw(n), compressed(n);
    for (const std::size_t i : rods) {
      for (std::size_t j = 0; j < n; ++j) {
        const double dx = wrapped_difference(xs[j] - xs[i], box.x()), dy = wrapped_difference(ys[j] - ys[i], box.y());
        raw.x[j] = dx * cosine + dy * sine;
        raw.y[j] = dy * cosine - dx * sine;
        raw.square[j] = dx * dx + dy * dy;
        compressed.x[j] = raw.x[j] / shape_.ratio;
        compressed.y[j] = raw.y[j];
        compressed.square[j] = compressed.x[j] * compressed.x[j] + compressed.y[j] * compressed.y[j];
      }
      raw.square[i] = compressed.square[i] = std::numeric_limits<double>::infinity();
      const std::complex<double> psi = psi_6(compressed);
      sum += psi;
      local += std::abs(psi);
      raw_sum += psi_6(raw);
    }
    sums_.psi_6 += std::abs(sum) / n_places;
    sums_.psi_6_local += local / n_places;
    sums_.psi_6_raw += std::abs(raw_sum) / n_places;
  } else {
    sums_.psi_6 = sums_.psi_6_local = sums_.psi_6_raw = std::numeric_limits<double>::quiet_NaN();
  }

  const double most = box.longer() / shape_.shortest, fewest = box.longer() / shape_.longest;
  const double most_waves = std::min(most, kMostPeakWaves * std::sqrt(box.longer() / box.shorter()));
  const WaveVectors vectors(box, std::max(1, static_cast<int>(most_waves)));
  const std::vector<double> powers = wave_powers(places, std::vector<double>(places.size(), 1.0), vectors);
  double largest = 0;
  vectors.for_each([&](int m, int k, const Vec2& q) {
    const double length = std::hypot(q.x(), q.y());
    if (length >= fewest && length <= most) largest = std::max(largest, powers[vectors.index(m, k)]);
  });
  sums_.bragg_peak += largest / (n_places * n_places);
  ++samples_;
}

LatticeMeans LatticeOrder::reduce() const {
  const auto n = static_cast<double>(samples_);
  return {sums_.psi_6 / n, sums_.psi_6_local / n, sums_.psi_6_raw / n, sums_.bragg_peak / n};
}

}  // namespace shaken::analysis
