#include "run/measure/measure_order.h"

#include "run/measure/rows.h"

namespace shaken::run {
namespace {

using analysis::OrderDistribution;
using analysis::OrderSeries;

constexpr std::array kOrderSeries{
    from<&OrderSeries::times>(
        called("time", "t", {"time_s", "times of S(t); of more than 65,536 samples, each point is a mean of several"})),
    from<&OrderSeries::orders>(called("nematic order", "S", {"order", "S(t)"})),
    from<&OrderSeries::directors>({"director_rad", "angle of the director to the x axis"}),
};
constexpr std::array kOrderPdf{
    from<&OrderDistribution::order>(called("nematic order", "S", {"pdf/order", "bin centres"})),
    from<&OrderDistribution::density>(called("probability density", "P(S)", {"pdf/density", "P[S], of integral 1"})),
};
constexpr std::array kOrderNumbers{
    from<&OrderDistribution::binder>(
        called("Binder cumulant", "U_2", {"binder", "Binder cumulant U₂ = 2 − ⟨S⁴⟩/⟨S²⟩²: 0 in disorder, 1 in order"})),
    from<&OrderDistribution::variance>({"susceptibility", "N · var S"}),
};

}  // namespace

void MeasuredOrder::sample(const Sample& sample) {
  series_.accumulate(sample->time, sample.order());
  statistics_.accumulate(sample->time, sample.order().order);
}

void MeasuredOrder::reduce(Reduction& result) const {
  put(result, "/order/", kOrderSeries, series_);
  put(result, "/order/", kOrderPdf, statistics_.after(result.t_steady).reduce());
  put(result, "", kOrderNumbers, statistics_, [&](const analysis::OrderStatistics& statistics) {
    OrderDistribution found = statistics.reduce();
    found.variance *= n_rods_;
    return found;
  });
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
      .sources = "order, time_series",
      .make = [](const MeasureContext& context) -> std::unique_ptr<Measurement> {
        return std::make_unique<MeasuredOrder>(context.plan.system.n_rods);
      },
      .arrays = outputs_of(kOrderSeries, kOrderPdf),
      .numbers = outputs_of(kOrderNumbers),
  };
}

}  // namespace shaken::run
