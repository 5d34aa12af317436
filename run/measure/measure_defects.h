#pragma once

#include <optional>
#include <vector>

#include "analysis/defect_series.h"
#include "analysis/defect_tracks.h"
#include "analysis/geometry/region.h"
#include "run/measure/measurement.h"

namespace shaken::run {

/// Defects of one sample.
struct DefectSample {
  Tick tick = 0;
  double time = 0;       ///< [s]
  double smoothing = 0;  ///< of the director field [mm]
  std::vector<analysis::Defect> defects;
};

/// The defects of the measured rods: `smoothing` of the director field and mesh width of its grid, at most, in mm.
std::vector<analysis::Defect> defects_of(const Sample& sample, const analysis::Region& region, double smoothing,
                                         double mesh);

/// Topological defects of the smoothed director field, and their tracks.
class MeasuredDefects : public Measurement {
 public:
  explicit MeasuredDefects(const MeasureContext& context);
  void sample(const Sample& sample) override;
  void reduce(Reduction& result) const override;
  void save(StateWriter& writer) const override;
  void restore(StateReader& reader) override;

  /// The last sample, for viewers; none before the first and after a restart.
  const std::optional<DefectSample>& last() const { return last_; }

 private:
  analysis::Region region_;
  double smoothing_;  ///< [mm]
  double mesh_;       ///< of the field's grid, at most [mm]
  analysis::DefectSeries series_;
  analysis::DefectTracks tracks_;
  std::optional<DefectSample> last_;
};

}  // namespace shaken::run
