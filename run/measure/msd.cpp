// SPDX-License-Identifier: MIT
#include "analysis/msd.h"

#include <optional>

#include "analysis/steady.h"
#include "run/measure/estimates.h"
#include "run/measure/registry.h"

namespace shaken::run {
namespace {

class MeasuredDisplacement : public Measurement {
 public:
  MeasuredDisplacement(double interval, std::optional<double> steady) : steady_(steady), msd_(interval) {}

  void sample(const Moment& moment) override {
    if (!analysis::is_steady(moment->time, steady_.value_or(0.0))) return;
    msd_.accumulate(moment->time, moment.unwrapped(), moment.order().director);
  }
  void reduce(Reduction& result) const override {
    const double from = steady_.value_or(result.t_steady);
    const analysis::MsdCurve curve = msd_.reduce(from);
    result.arrays["/msd/lag_s"] = curve.lag;
    put(result, "/msd/total", "_mm2", curve.total);
    put(result, "/msd/along", "_mm2", curve.along);
    put(result, "/msd/across", "_mm2", curve.across);
    put(result, "/msd/relative_total", "_mm2", curve.relative_total);
    put(result, "/msd/relative_along", "_mm2", curve.relative_along);
    put(result, "/msd/relative_across", "_mm2", curve.relative_across);
    put(result, "/msd/exponent", "", curve.exponent);
    const analysis::Diffusion diffusion = msd_.diffusion(from);
    result.scalars["diffusion_mm2_s"] = scalar(diffusion.d_long);
    result.scalars["diffusion_short_mm2_s"] = scalar(diffusion.d_short);
    result.scalars["diffusion_along_mm2_s"] = scalar(diffusion.d_along);
    result.scalars["diffusion_across_mm2_s"] = scalar(diffusion.d_across);
    result.scalars["diffusion_relative_mm2_s"] = scalar(diffusion.d_relative);
    result.scalars["alpha_short"] = scalar(diffusion.total.at_short.exponent);
    result.scalars["alpha_long"] = scalar(diffusion.total.at_long.exponent);
    result.scalars["alpha_along_short"] = scalar(diffusion.along.at_short.exponent);
    result.scalars["alpha_along_long"] = scalar(diffusion.along.at_long.exponent);
    result.scalars["alpha_across_short"] = scalar(diffusion.across.at_short.exponent);
    result.scalars["alpha_across_long"] = scalar(diffusion.across.at_long.exponent);
    result.scalars["diffusion_lag_from_s"] = {diffusion.total.at_long.lag_from};
    result.scalars["diffusion_lag_to_s"] = {diffusion.total.at_long.lag_to};
    result.scalars["diffusion_short_lag_from_s"] = {diffusion.total.at_short.lag_from};
    result.scalars["diffusion_short_lag_to_s"] = {diffusion.total.at_short.lag_to};
  }
  void save(analysis::StateWriter& writer) const override { msd_.save(writer); }
  void restore(analysis::StateReader& reader) override { msd_.restore(reader); }

 private:
  std::optional<double> steady_;  ///< [s]; given, it leaves out what is before, or else the reduction does
  analysis::MeanSquareDisplacement msd_;
};

}  // namespace

std::unique_ptr<Measurement> make_msd(const MeasureContext& context) {
  return std::make_unique<MeasuredDisplacement>(context.interval, context.plan.steady);
}

}  // namespace shaken::run
