#pragma once

#include "analysis/errors/blocked.h"
#include "analysis/order.h"
#include "run/measure/measurement.h"

namespace shaken::run {

/// S(t), P[S] and what follows from its moments; the other measurements take from it when the steady state begins.
class MeasuredOrder : public Measurement {
 public:
  explicit MeasuredOrder(int n_rods) : n_rods_(n_rods) {}

  void sample(const Sample& sample) override;
  void reduce(Reduction& result) const override;
  void save(StateWriter& writer) const override;
  void restore(StateReader& reader) override;

  const analysis::OrderSeries& series() const { return series_; }

 private:
  int n_rods_;
  analysis::OrderSeries series_;
  analysis::Blocked<analysis::OrderStatistics> statistics_{analysis::OrderStatistics(100)};
};

}  // namespace shaken::run
