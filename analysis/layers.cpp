#include "analysis/layers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "analysis/bins.h"
#include "analysis/geometry/periodic.h"
#include "analysis/geometry/wave_sums.h"
#include "analysis/order.h"
#include "base/core/check.h"

namespace shaken::analysis {
namespace {

/// Bounds the cost: a sample takes 4 n_rods (waves + 1)^2 multiplications.
constexpr int kMostLayerWaves = 40;
/// Half the opening of a cone of wave vectors about an axis.
constexpr double kCone = kPi / 6;

}  // namespace

LayerOrder::LayerOrder(const Box& box, double shortest)
    : vectors_(box, std::max(1, static_cast<int>(std::min(kMostLayerWaves * std::sqrt(box.longer() / box.shorter()),
                                                          box.longer() / shortest)))),
      amplitudes_(vectors_.size()),
      within_(vectors_.size()) {
  SHAKEN_CHECK(shortest > 0, "waves have a length");
  for (auto* sums : {&across_, &along_}) sums->resize(static_cast<std::size_t>(vectors_.waves));
  for (auto* terms : {&n_across_, &n_along_}) terms->resize(static_cast<std::size_t>(vectors_.waves));
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
  const std::vector<double> powers = wave_powers(places, turns, vectors_);
  const auto n_rods = static_cast<double>(places.size());
  const double nearest = std::cos(kCone);
  vectors_.for_each([&](int m, int n, const Vec2& q) {
    const double length = std::hypot(q.x(), q.y());
    if (length > vectors_.waves) return;
    const std::size_t vector = vectors_.index(m, n);
    const double per_rod = powers[vector] / n_rods;
    const auto shell = static_cast<std::size_t>(std::lround(length)) - 1;
    if (std::abs(q.y() * cosine - q.x() * sine) >= nearest * length) {
      amplitudes_[vector] += 4 * per_rod / n_rods;
      ++within_[vector];
      across_[shell] += per_rod;
      ++n_across_[shell];
    } else if (std::abs(q.x() * cosine + q.y() * sine) >= nearest * length) {
      along_[shell] += per_rod;
      ++n_along_[shell];
    }
  });
  floor_ += 4 * squares / (n_rods * n_rods);
  ++samples_;
}

LayerSpectrum LayerOrder::reduce() const {
  LayerSpectrum spectrum;
  for (std::size_t shell = 0; shell < across_.size(); ++shell) {
    spectrum.q.push_back(vectors_.wave_number(static_cast<double>(shell + 1)));
    spectrum.across.push_back(mean_of(across_[shell], n_across_[shell]));
    spectrum.along.push_back(mean_of(along_[shell], n_along_[shell]));
  }
  return spectrum;
}

std::optional<std::size_t> LayerOrder::find(int m, int n) const {
  if (m < 0 || (m == 0 && n < 0)) return find(-m, -n);
  if (m > vectors_.most_m || std::abs(n) > vectors_.most_n) return std::nullopt;
  return vectors_.index(m, n);
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
  int best_m = vectors_.most_n > 0 ? 0 : 1, best_n = vectors_.most_n > 0 ? 1 : 0;
  vectors_.for_each([&](int m, int n, const Vec2&) {
    if (power(m, n) > power(best_m, best_n)) {
      best_m = m;
      best_n = n;
    }
  });
  return peak_at(best_m, best_n);
}

LayerPeak LayerOrder::peak_at(int m, int n) const {
  SHAKEN_CHECK(m >= 0 && find(m, n) && (m != 0 || n != 0), "a wave vector that is kept");
  const std::int64_t often = std::max<std::int64_t>(1, (within_[vectors_.index(m, n)] + 1) / 2);
  double weight = power_within(m, n, often).value_or(0.0);
  Vec2 mean = weight * vectors_.at(m, n);
  constexpr std::array<std::pair<int, int>, 4> kNeighbours{{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};
  for (const auto& [dm, dn] : kNeighbours) {
    // The mean over the box, (0, 0), is no wave; without it its opposite is left out as well.
    if ((m == dm && n == dn) || (m == -dm && n == -dn)) continue;
    const std::optional<double> after = power_within(m + dm, n + dn, often);
    const std::optional<double> before = power_within(m - dm, n - dn, often);
    if (!after || !before) continue;
    weight += *after + *before;
    mean += *after * vectors_.at(m + dm, n + dn) + *before * vectors_.at(m - dm, n - dn);
  }
  const Vec2 q = vectors_.at(m, n);
  const double waves = weight > 0 ? mean.norm() / weight : std::hypot(q.x(), q.y());
  const double side = std::abs(q.x()) > std::abs(q.y()) ? vectors_.box.x() : vectors_.box.y();
  const double floor = samples_ > 0 ? floor_ / static_cast<double>(samples_) : 0.0;
  return {m, n, side, vectors_.box.longer() / waves, std::sqrt(power(m, n)), std::sqrt(floor)};
}

}  // namespace shaken::analysis
