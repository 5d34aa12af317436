// SPDX-License-Identifier: MIT
#include "analysis/g2.h"

#include "analysis/blocked.h"
#include "run/measure/registry.h"

namespace shaken::run {
namespace {

class MeasuredG2 : public Measurement {
 public:
  MeasuredG2(int bins, double r_max) : g2_(analysis::OrientationCorrelation(bins, r_max)) {}

  void sample(const Moment& moment) override {
    g2_.accumulate(moment->time, moment->position, moment->director, moment->box_side);
  }
  void reduce(Reduction& result) const override {
    const analysis::OrientationCurve curve = g2_.after(result.t_steady).reduce();
    result.arrays["/g2/r_mm"] = curve.r;
    result.arrays["/g2/g2"] = curve.g2;
    result.arrays["/g2/g"] = curve.g;
  }
  void save(analysis::StateWriter& writer) const override { g2_.save(writer); }
  void restore(analysis::StateReader& reader) override { g2_.restore(reader); }

 private:
  analysis::Blocked<analysis::OrientationCorrelation> g2_;
};

}  // namespace

std::unique_ptr<Measurement> make_g2(const MeasureContext& context) {
  return std::make_unique<MeasuredG2>(context.plan.g2->bins, context.plan.system.box_side / 2);
}

}  // namespace shaken::run
