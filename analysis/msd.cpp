#include "analysis/msd.h"

#include <array>
#include <cmath>
#include <utility>

namespace shaken::analysis {
namespace {

// Weights of the kernel's quantities.
constexpr double kTotal[] = {1, 1, 0, 0};
constexpr double kAlong[] = {1, 0, 0, 0};
constexpr double kAcross[] = {0, 1, 0, 0};

/// Motion relative to that of all rods, as if the mean of all took nothing away: with the factor N / (N - 1).
class Relative {
 public:
  explicit Relative(std::size_t n_rods) : f_(static_cast<double>(n_rods) / (static_cast<double>(n_rods) - 1)) {}
  std::array<double, 4> total() const { return {f_, f_, -f_, -f_}; }
  std::array<double, 4> along() const { return {f_, 0, -f_, 0}; }
  std::array<double, 4> across() const { return {0, f_, 0, -f_}; }

 private:
  double f_;
};

/// A mean square displacement over 2 d t.
EstimateCurve diffusivity(const std::vector<double>& lags, const EstimateCurve& msd, double dimensions) {
  EstimateCurve curve;
  for (std::size_t i = 0; i < lags.size(); ++i) {
    curve.push_back(Estimate{msd.value[i], msd.sem[i]} / (2 * dimensions * lags[i]));
  }
  return curve;
}

}  // namespace

LagPair<DisplacementKernel::kQuantities> DisplacementKernel::between(const LagFrame<kColumns>& origin,
                                                                     const LagFrame<kColumns>& later) {
  const auto& [x0, y0] = origin.column;
  const auto& [x1, y1] = later.column;
  double rods = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  for (std::size_t i = 0; i < x0.size(); ++i) {
    const double dx = x1[i] - x0[i];
    const double dy = y1[i] - y0[i];
    if (std::isnan(dx + dy)) continue;
    rods += 1;
    x += dx;
    y += dy;
    xx += dx * dx;
    xy += dx * dy;
    yy += dy * dy;
  }
  if (rods == 0) return {};
  const double c = std::cos(origin.director);
  const double s = std::sin(origin.director);
  const double along = c * x + s * y;
  const double across = c * y - s * x;
  return {rods,
          {c * c * xx + 2 * c * s * xy + s * s * yy, s * s * xx - 2 * c * s * xy + c * c * yy, along * along / rods,
           across * across / rods}};
}

void MeanSquareDisplacement::accumulate(double time, std::span<const Vec3> unwrapped, double director) {
  LagFrame<DisplacementKernel::kColumns> frame;
  frame.director = director;
  for (std::vector<double>& column : frame.column) column.resize(unwrapped.size());
  for (std::size_t i = 0; i < unwrapped.size(); ++i) {
    frame.column[0][i] = unwrapped[i].x();
    frame.column[1][i] = unwrapped[i].y();
  }
  average_.accumulate(time, std::move(frame));
}

MsdCurve MeanSquareDisplacement::reduce(double t_steady) const {
  const LagCurve curve = average_.after(t_steady);
  const Relative relative(n_rods_);
  MsdCurve result{curve.lags(),
                  curve.combination(kTotal),
                  curve.combination(kAlong),
                  curve.combination(kAcross),
                  curve.combination(relative.total()),
                  curve.combination(relative.along()),
                  curve.combination(relative.across()),
                  local_exponent(curve, kTotal),
                  {},
                  {},
                  {}};
  result.d_total = diffusivity(result.lag, result.total, 2);
  result.d_along = diffusivity(result.lag, result.along, 1);
  result.d_across = diffusivity(result.lag, result.across, 1);
  return result;
}

Diffusion MeanSquareDisplacement::diffusion(double t_steady) const {
  const LagCurve curve = average_.after(t_steady);
  Diffusion result;
  result.total = growth(curve, kTotal);
  result.along = growth(curve, kAlong);
  result.across = growth(curve, kAcross);
  result.relative = growth(curve, Relative(n_rods_).total());
  result.d_short = result.total.at_short.slope / 4;
  result.d_long = result.total.at_long.slope / 4;
  result.d_along = result.along.at_long.slope / 2;
  result.d_across = result.across.at_long.slope / 2;
  result.d_relative = result.relative.at_long.slope / 4;
  return result;
}

}  // namespace shaken::analysis
