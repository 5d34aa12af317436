#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/errors/summed.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// P(theta): bin centres and the probability density at them.
struct AnglePdf {
  std::vector<double> theta;    ///< (bins) bin centres in [-pi/2, pi/2) [rad]
  std::vector<double> density;  ///< (bins) [1/rad]; integral 1, or 0 everywhere without samples
};

/// Histogram of the in-plane angles of the rods, measured from the director of the same instant and folded into
/// [-pi/2, pi/2). Two peaks at +-theta_m are the mark of the layered phase. Rods exactly upright are left out.
class AngleDistribution : public Summed<AngleDistribution> {
 public:
  explicit AngleDistribution(int bins);

  void accumulate(std::span<const Vec3> directors);
  AnglePdf reduce() const;

  static constexpr const char* kName = "AngleDistribution";
  static auto fields(auto& self) { return listed(self.counts_); }

 private:
  std::vector<std::int64_t> counts_;
};

}  // namespace shaken::analysis
