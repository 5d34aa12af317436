#include "analysis/rotation.h"

#include <cmath>
#include <limits>
#include <utility>

#include "analysis/geometry/periodic.h"
#include "analysis/lags/lag_fits.h"
#include "base/core/check.h"

namespace shaken::analysis {
namespace {

// Weights of the kernel's quantities.
constexpr double kMsad[] = {1, 0};
constexpr double kC2[] = {0, 1};

/// A step from sample to sample beyond which folding begins to be in doubt [rad].
constexpr double kLargeTurn = kPi / 3;

}  // namespace

LagPair<TurnKernel::kQuantities> TurnKernel::between(const LagFrame<kColumns>& origin,
                                                     const LagFrame<kColumns>& later) {
  const std::vector<double>& from = origin.column[0];
  const std::vector<double>& to = later.column[0];
  LagPair<kQuantities> pair;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const double turn = to[i] - from[i];
    if (std::isnan(turn)) continue;
    pair.rods += 1;
    pair.sums[0] += turn * turn;
    pair.sums[1] += std::cos(2 * turn);
  }
  return pair;
}

void Rotation::accumulate(double time, std::span<const Vec3> directors) {
  if (angles_.empty()) {
    angles_ = average_.samples() > 0 ? average_.last().column[0]
                                     : std::vector(directors.size(), std::numeric_limits<double>::quiet_NaN());
  }
  SHAKEN_CHECK(angles_.size() == directors.size(), "as many rods as before");
  LagFrame<TurnKernel::kColumns> frame;
  for (std::size_t i = 0; i < directors.size(); ++i) {
    const double x = directors[i].x(), y = directors[i].y();
    const bool is_seen = std::isfinite(x) && std::isfinite(y), lies = is_seen && (x != 0.0 || y != 0.0);
    double& angle = angles_[i];
    if (lies) {
      const double now = std::atan2(y, x);
      const double turn = std::isnan(angle) ? 0.0 : fold_half_turn(now - angle);
      if (std::abs(turn) > kLargeTurn) ++large_turns_;
      angle = std::isnan(angle) ? now : angle + turn;
    }
    frame.column[0].push_back(is_seen ? angle : std::numeric_limits<double>::quiet_NaN());
  }
  average_.accumulate(time, std::move(frame));
}

RotationCurve Rotation::reduce(double t_steady) const {
  const LagCurve curve = average_.after(t_steady);
  return {curve.lags(), curve.combination(kMsad), curve.combination(kC2)};
}

RotationSummary Rotation::summarize(double t_steady) const {
  const LagCurve curve = average_.after(t_steady);
  RotationSummary summary;
  summary.growth = growth(curve, kMsad);
  summary.d_r = summary.growth.at_long.slope / 2;
  summary.c2_decay_time = decay_time(curve.lags(), curve.combination(kC2));
  summary.large_turns = static_cast<double>(large_turns_);
  if (const LagCurve::Window window = curve.last_octave(); window.size() > 0) {
    std::vector<LagTerm> terms;
    double sum = 0;
    const double share = 1.0 / static_cast<double>(window.size());
    for (std::size_t lag = window.first; lag < window.end; ++lag) {
      terms.push_back({1, lag, share});
      sum += share * curve.mean(1, lag);
    }
    summary.c2_plateau = curve.estimate(sum, terms);
  }
  return summary;
}

}  // namespace shaken::analysis
