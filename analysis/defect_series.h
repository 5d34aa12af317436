// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "analysis/defects.h"
#include "analysis/state_io.h"

namespace shaken::analysis {

/// Every defect found, one entry each; all of the same length.
struct DefectList {
  std::vector<double> time;       ///< [s]
  std::vector<double> x, y;       ///< [mm]
  std::vector<double> charge;     ///< +1/2 or -1/2
  std::vector<double> direction;  ///< [rad], see Defect
};

/// Numbers of defects against time and the list of all of them. Grows by three numbers a sample and five a defect.
class DefectSeries {
 public:
  void accumulate(double time, std::span<const Defect> defects);
  /// Mean numbers over the samples from `t_steady` on.
  struct MeanCounts {
    double n_plus = 0, n_minus = 0;
  };
  MeanCounts reduce(double t_steady) const;
  void reset();

  const std::vector<double>& times() const { return times_; }      ///< (n) [s]
  const std::vector<double>& n_plus() const { return n_plus_; }    ///< (n) defects of positive charge
  const std::vector<double>& n_minus() const { return n_minus_; }  ///< (n)
  const DefectList& list() const { return list_; }

  void save(StateWriter& writer) const;
  void restore(StateReader& reader);

 private:
  std::vector<double> times_, n_plus_, n_minus_;
  DefectList list_;
};

}  // namespace shaken::analysis
