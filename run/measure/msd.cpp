// SPDX-License-Identifier: MIT
#include "analysis/msd.h"

#include "analysis/steady.h"
#include "run/measure/registry.h"

namespace shaken::run {
namespace {

/// Counts from the given steady time on; where that is found only afterwards, from the start of the run.
class MeasuredDisplacement : public Measurement {
 public:
  MeasuredDisplacement(double interval, double steady) : steady_(steady), msd_(interval) {}

  void sample(const Moment& moment) override {
    if (!analysis::is_steady(moment->time, steady_)) return;
    msd_.accumulate(moment.unwrapped(), moment->director);
  }
  void reduce(Reduction& result) const override {
    const analysis::MsdCurve curve = msd_.reduce();
    result.arrays["/msd/lag_s"] = curve.lag;
    result.arrays["/msd/total_mm2"] = curve.total;
    result.arrays["/msd/along_mm2"] = curve.along;
    result.arrays["/msd/across_mm2"] = curve.across;
  }
  void save(analysis::StateWriter& writer) const override { msd_.save(writer); }
  void restore(analysis::StateReader& reader) override { msd_.restore(reader); }

 private:
  double steady_;  ///< [s]
  analysis::MeanSquareDisplacement msd_;
};

}  // namespace

std::unique_ptr<Measurement> make_msd(const MeasureContext& context) {
  return std::make_unique<MeasuredDisplacement>(context.interval, context.plan.steady.value_or(0.0));
}

}  // namespace shaken::run
