// SPDX-License-Identifier: MIT
#include "analysis/layers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "analysis/order.h"
#include "analysis/periodic.h"
#include "analysis/wave_sums.h"
#include "base/core/check.h"

namespace shaken::analysis {
namespace {

/// Bounds the cost: a sample takes 4 n_rods (waves + 1)^2 multiplications.
constexpr int kMostLayerWaves = 40;
/// Half the opening of a cone of wave vectors about an axis.
constexpr double kCone = kPi / 6;

/// The wave vectors of a half plane, |(m, n)| <= waves, one of each pair: visit(m, n, |(m, n)|).
template <class Visitor>
void for_half_plane(int waves, const Visitor& visit) {
  for (int m = 0; m <= waves; ++m) {
    for (int n = m == 0 ? 1 : -waves; n <= waves; ++n) {
      const double length = std::hypot(m, n);
      if (length <= waves) visit(m, n, length);
    }
  }
}

}  // namespace

LayerOrder::LayerOrder(double box_side, double shortest) : box_side_(box_side), waves_(kMostLayerWaves) {
  SHAKEN_CHECK(box_side > 0 && shortest > 0, "a box and waves in it");
  if (box_side / shortest < kMostLayerWaves) waves_ = std::max(1, static_cast<int>(box_side / shortest));
  const auto waves = static_cast<std::size_t>(waves_);
  amplitudes_.resize((waves + 1) * (2 * waves + 1));
  within_.resize(amplitudes_.size());
  across_.resize(waves);
  along_.resize(waves);
  n_across_.resize(waves);
  n_along_.resize(waves);
}

std::size_t LayerOrder::index(int m, int n) const {
  return static_cast<std::size_t>(m) * static_cast<std::size_t>(2 * waves_ + 1) + static_cast<std::size_t>(n + waves_);
}

void LayerOrder::accumulate(std::span<const Vec3> positions, std::span<const Vec3> directors) {
  SHAKEN_CHECK(positions.size() == directors.size(), "one position for each director");
  const double director = nematic_order(directors).director;
  const double cosine = std::cos(director), sine = std::sin(director);
  const double c2 = std::cos(2 * director), s2 = std::sin(2 * director);
  std::vector<Vec2> places;
  std::vector<double> turns;  // sin 2 (theta - theta_N)
  double squares = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec2 angle = double_angle(directors[i]);
    if (angle == Vec2::Zero()) continue;
    places.push_back(positions[i].head<2>());
    turns.push_back(angle.y() * c2 - angle.x() * s2);
    squares += turns.back() * turns.back();
  }
  if (places.empty()) return;
  const WavePowers powers = wave_powers(places, turns, box_side_, waves_);
  const auto n_rods = static_cast<double>(places.size());
  const double nearest = std::cos(kCone);
  for_half_plane(waves_, [&](int m, int n, double length) {
    const double per_rod = powers.at(m, n) / n_rods;
    const auto shell = static_cast<std::size_t>(std::lround(length)) - 1;
    if (std::abs(n * cosine - m * sine) >= nearest * length) {
      amplitudes_[index(m, n)] += 4 * per_rod / n_rods;
      ++within_[index(m, n)];
      across_[shell] += per_rod;
      ++n_across_[shell];
    } else if (std::abs(m * cosine + n * sine) >= nearest * length) {
      along_[shell] += per_rod;
      ++n_along_[shell];
    }
  });
  floor_ += 4 * squares / (n_rods * n_rods);
  ++samples_;
}

LayerSpectrum LayerOrder::reduce() const {
  LayerSpectrum spectrum;
  const auto mean = [](double sum, std::int64_t n) {
    return n > 0 ? sum / static_cast<double>(n) : std::numeric_limits<double>::quiet_NaN();
  };
  for (std::size_t shell = 0; shell < across_.size(); ++shell) {
    spectrum.q.push_back(2 * kPi * static_cast<double>(shell + 1) / box_side_);
    spectrum.across.push_back(mean(across_[shell], n_across_[shell]));
    spectrum.along.push_back(mean(along_[shell], n_along_[shell]));
  }
  return spectrum;
}

std::optional<std::size_t> LayerOrder::find(int m, int n) const {
  if (m < 0 || (m == 0 && n < 0)) return find(-m, -n);
  if (m > waves_ || std::abs(n) > waves_) return std::nullopt;
  return index(m, n);
}

double LayerOrder::power(int m, int n) const {
  const std::optional<std::size_t> wave = find(m, n);
  return wave && samples_ > 0 ? amplitudes_[*wave] / static_cast<double>(samples_) : 0.0;
}

std::optional<double> LayerOrder::power_within(int m, int n, std::int64_t at_least) const {
  const std::optional<std::size_t> wave = find(m, n);
  if (!wave || within_[*wave] < at_least) return std::nullopt;
  return amplitudes_[*wave] / static_cast<double>(within_[*wave]);
}

std::optional<LayerPeak> LayerOrder::peak() const {
  if (samples_ == 0) return std::nullopt;
  int best_m = 0, best_n = 1;
  for_half_plane(waves_, [&](int m, int n, double) {
    if (power(m, n) > power(best_m, best_n)) {
      best_m = m;
      best_n = n;
    }
  });
  return peak_at(best_m, best_n);
}

LayerPeak LayerOrder::peak_at(int m, int n) const {
  SHAKEN_CHECK(m >= 0 && m <= waves_ && std::abs(n) <= waves_ && (m != 0 || n != 0), "a wave vector that is kept");
  const std::int64_t often = std::max<std::int64_t>(1, (within_[index(m, n)] + 1) / 2);
  double weight = power_within(m, n, often).value_or(0.0);
  Vec2 mean = weight * Vec2(m, n);
  constexpr std::array<std::pair<int, int>, 4> kNeighbours{{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};
  for (const auto& [dm, dn] : kNeighbours) {
    // The mean over the box, (0, 0), is no wave; without it its opposite is left out as well.
    if ((m == dm && n == dn) || (m == -dm && n == -dn)) continue;
    const std::optional<double> after = power_within(m + dm, n + dn, often);
    const std::optional<double> before = power_within(m - dm, n - dn, often);
    if (!after || !before) continue;
    weight += *after + *before;
    mean += *after * Vec2(m + dm, n + dn) + *before * Vec2(m - dm, n - dn);
  }
  const double waves = weight > 0 ? mean.norm() / weight : std::hypot(m, n);
  const double floor = samples_ > 0 ? floor_ / static_cast<double>(samples_) : 0.0;
  return {m, n, box_side_ / waves, std::sqrt(power(m, n)), std::sqrt(floor)};
}

}  // namespace shaken::analysis
