#include "run/measure/measure_order.h"

#include "run/measure/estimates.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {

void MeasuredOrder::sample(const Sample& sample) {
  series_.accumulate(sample->time, sample.order());
  statistics_.accumulate(sample->time, sample.order().order);
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

void MeasuredOrder::save(StateWriter& writer) const {
  series_.save(writer);
  statistics_.save(writer);
}

void MeasuredOrder::restore(StateReader& reader) {
  series_.restore(reader);
  statistics_.restore(reader);
}

MeasurementKind order_kind() {
  return {
      .name = "order",
      .sources = "order, order_statistics, time_series",
      .make = [](const MeasureContext& context) -> std::unique_ptr<Measurement> {
        return std::make_unique<MeasuredOrder>(context.plan.system.n_rods);
      },
      .arrays =
          {
              called("time", "t",
                     {"time_s", "times of S(t); of more than 65,536 samples, each point is a mean of several"}),
              called("nematic order", "S", {"order", "S(t)"}),
              {"director_rad", "angle of the director to the x axis"},
              called("nematic order", "S", {"pdf/order", "bin centres"}),
              called("probability density", "P(S)", {"pdf/density", "P[S], of integral 1"}),
          },
      .numbers =
          {
              called("Binder cumulant", "U_2",
                     {"binder", "Binder cumulant U₂ = 2 − ⟨S⁴⟩/⟨S²⟩²: 0 in disorder, 1 in order"}),
              {"susceptibility", "N · var S"},
          },
  };
}

}  // namespace shaken::run
