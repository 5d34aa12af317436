// SPDX-License-Identifier: MIT
#include "run/measure/order.h"

#include "run/measure/registry.h"

namespace shaken::run {

void MeasuredOrder::sample(const Moment& moment) { series_.accumulate(moment->time, moment->director); }

void MeasuredOrder::reduce(Reduction& result) const {
  result.arrays["/order/time_s"] = series_.times();
  result.arrays["/order/order"] = series_.orders();
  result.arrays["/order/director_rad"] = series_.directors();
}

std::unique_ptr<Measurement> make_order(const MeasureContext&) { return std::make_unique<MeasuredOrder>(); }

}  // namespace shaken::run
