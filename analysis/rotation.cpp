#include "analysis/rotation.h"

#include <cmath>
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
  LagFrame<TurnKernel::kColumns> frame;
  std::vector<double>& angles = frame.column[0];
  angles.resize(directors.size());
  const std::vector<double>* before = average_.samples() > 0 ? &average_.last().column[0] : nullptr;
  SHAKEN_CHECK(before == nullptr || before->size() == directors.size(), "as many rods as before");
  for (std::size_t i = 0; i < directors.size(); ++i) {
    const double x = directors[i].x(), y = directors[i].y();
    const bool lies = (x != 0.0 || y != 0.0) && std::isfinite(x) && std::isfinite(y);
    const double angle = lies ? std::atan2(y, x) : std::numeric_limits<double>::quiet_NaN();
    angles[i] = angle;
    if (before == nullptr || std::isnan((*before)[i])) continue;
    const double turn = lies ? fold_half_turn(angle - (*before)[i]) : 0.0;
    if (std::abs(turn) > kLargeTurn) ++large_turns_;
    angles[i] = (*before)[i] + turn;
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
