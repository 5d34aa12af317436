#pragma once

#include <cstdint>
#include <vector>

#include "analysis/errors/spread.h"
#include "analysis/errors/summed.h"

namespace shaken::analysis {

/// P[S] and what follows from the moments of S. NaN without samples.
struct OrderDistribution {
  std::vector<double> order;    ///< (bins) bin centres in [0, 1]
  std::vector<double> density;  ///< (bins) probability per unit S; integral 1
  double variance = 0;          ///< of S; times the number of rods it is the susceptibility
  /// U2 = 2 - <S^4> / <S^2>^2, Binder's cumulant for an order with two components: 0 where they are independent
  /// Gaussians (disorder; there it is of order 1 / N), 1 where S does not fluctuate. Curves of different box sizes
  /// against the control parameter cross at a continuous transition (Binder, Z. Phys. B 43, 119 (1981)).
  double binder = 0;
};

/// Histogram and moments of the nematic order S over the samples of a run.
class OrderStatistics : public Summed<OrderStatistics> {
 public:
  /// `bins` equal bins over [0, 1].
  explicit OrderStatistics(int bins);

  /// S of one instant; what is not finite is left out.
  void accumulate(double order);
  OrderDistribution reduce() const;

  static constexpr const char* kName = "OrderStatistics";
  static auto fields(auto& self) { return listed(self.counts_, self.spread_, self.square_, self.fourth_); }

 private:
  std::vector<std::int64_t> counts_;
  Spread spread_;      // of S
  double square_ = 0;  // sum of S^2
  double fourth_ = 0;  // sum of S^4
};

}  // namespace shaken::analysis
