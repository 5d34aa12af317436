// SPDX-License-Identifier: MIT
#include "run/measure/order.h"

#include "run/measure/estimates.h"
#include "run/measure/registry.h"

namespace shaken::run {

void MeasuredOrder::sample(const Moment& moment) {
  series_.accumulate(moment->time, moment.order());
  statistics_.accumulate(moment->time, moment.order().order);
}

void MeasuredOrder::reduce(Reduction& result) const {
  result.arrays["/order/time_s"] = series_.times();
  result.arrays["/order/order"] = series_.orders();
  result.arrays["/order/director_rad"] = series_.directors();
  const analysis::OrderDistribution pdf = statistics_.after(result.t_steady).reduce();
  result.arrays["/order/pdf/order"] = pdf.order;
  result.arrays["/order/pdf/density"] = pdf.density;
  const auto moments = block_estimates(statistics_, result.t_steady, [&](const analysis::OrderStatistics& statistics) {
    const analysis::OrderDistribution found = statistics.reduce();
    return std::vector<double>{found.binder, n_rods_ * found.variance};
  });
  result.scalars["binder"] = moments[0];
  result.scalars["susceptibility"] = moments[1];
}

void MeasuredOrder::save(analysis::StateWriter& writer) const {
  series_.save(writer);
  statistics_.save(writer);
}

void MeasuredOrder::restore(analysis::StateReader& reader) {
  series_.restore(reader);
  statistics_.restore(reader);
}

std::unique_ptr<Measurement> make_order(const MeasureContext& context) {
  return std::make_unique<MeasuredOrder>(context.plan.system.n_rods);
}

}  // namespace shaken::run
