// SPDX-License-Identifier: MIT
#include "analysis/angles.h"

#include "analysis/blocked.h"
#include "run/measure/registry.h"

namespace shaken::run {
namespace {

class MeasuredAngles : public Measurement {
 public:
  explicit MeasuredAngles(int bins) : angles_(analysis::AngleDistribution(bins)) {}

  void sample(const Moment& moment) override { angles_.accumulate(moment->time, moment->director); }
  void reduce(Reduction& result) const override {
    const analysis::AnglePdf pdf = angles_.after(result.t_steady).reduce();
    result.arrays["/angles/theta_rad"] = pdf.theta;
    result.arrays["/angles/density_per_rad"] = pdf.density;
  }
  void save(analysis::StateWriter& writer) const override { angles_.save(writer); }
  void restore(analysis::StateReader& reader) override { angles_.restore(reader); }

 private:
  analysis::Blocked<analysis::AngleDistribution> angles_;
};

}  // namespace

std::unique_ptr<Measurement> make_angles(const MeasureContext& context) {
  return std::make_unique<MeasuredAngles>(context.plan.angles->bins);
}

}  // namespace shaken::run
