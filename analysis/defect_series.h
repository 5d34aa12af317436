#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/defects.h"
#include "analysis/errors/bounded_series.h"
#include "analysis/errors/saved.h"

namespace shaken::analysis {

/// Every defect found, one entry each; all of the same length.
struct DefectList {
  std::vector<double> time;       ///< [s]
  std::vector<double> x, y;       ///< [mm]
  std::vector<double> charge;     ///< +1/2 or -1/2
  std::vector<double> direction;  ///< [rad], see Defect
  std::vector<double> track;      ///< see DefectTracks
  static auto fields(auto& self) {
    return listed(Growing{self.time, self.x, self.y, self.charge, self.direction, self.track});
  }
};

/// Numbers of defects against time, in bounded memory; and the list of all of them if it is asked for, which grows by
/// six numbers a defect.
class DefectSeries : public Saved<DefectSeries> {
 public:
  explicit DefectSeries(bool keeps_list = false) : keeps_list_(keeps_list) {}

  /// The defects at `time` [s], later than all before, and the track of each (n_defects).
  void accumulate(double time, std::span<const Defect> defects, std::span<const std::int64_t> tracks);
  /// Mean numbers over the points from `t_steady` on.
  struct MeanCounts {
    double n_plus = 0, n_minus = 0;
  };
  MeanCounts reduce(double t_steady) const;

  const std::vector<double>& times() const { return counts_.times(); }      ///< (n) [s]
  const std::vector<double>& n_plus() const { return counts_.column(0); }   ///< (n) defects of positive charge
  const std::vector<double>& n_minus() const { return counts_.column(1); }  ///< (n)
  bool keeps_list() const { return keeps_list_; }
  const DefectList& list() const { return list_; }

  static constexpr const char* kName = "DefectSeries";
  static auto fields(auto& self) {
    return listed(self.counts_, Setting{"choice of a list", self.keeps_list_},
                  Unless{!self.keeps_list_, listed(self.list_)});
  }

 private:
  bool keeps_list_;
  BoundedSeries<2> counts_;
  DefectList list_;
};

}  // namespace shaken::analysis
