// SPDX-License-Identifier: MIT
#pragma once

#include "analysis/order.h"
#include "run/measure/measurement.h"

namespace shaken::run {

/// S(t); the other measurements take from it when the steady state begins.
class MeasuredOrder : public Measurement {
 public:
  void sample(const Moment& moment) override;
  void reduce(Reduction& result) const override;
  void save(analysis::StateWriter& writer) const override { series_.save(writer); }
  void restore(analysis::StateReader& reader) override { series_.restore(reader); }

  const analysis::OrderSeries& series() const { return series_; }

 private:
  analysis::OrderSeries series_;
};

}  // namespace shaken::run
