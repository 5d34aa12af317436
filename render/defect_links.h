#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "analysis/defect_tracks.h"
#include "analysis/geometry/region.h"
#include "render/picture.h"

namespace shaken::render {

/// One defect from its first frame to its last.
struct DefectLife {
  double charge = 0;
  std::vector<double> time;    ///< increasing [s]
  std::vector<Vec2> position;  ///< (time.size()) goes on across the border of a periodic box [mm]

  /// Where it is at `time`, or where it was born or died if that is nearer [mm].
  Vec2 at(double time) const;
};

/// The defects of successive frames, linked as a run links them (analysis/defect_tracks.h).
class DefectLinks {
 public:
  /// `rod_length`: no defect goes farther from one frame to the next [mm].
  DefectLinks(const analysis::Region& region, double rod_length);

  /// Takes the next frame.
  void add(double time, const std::vector<analysis::Defect>& defects);
  /// Faster than this no defect goes: a longer step is that of another one, or of noise in the field [mm/s].
  static constexpr double kFastest = 60;
  /// What has been seen for less time leaves no trail [s].
  static constexpr double kShortest = 0.2;
  /// Where defects were from `time - span` to `time`, each with its whole way in that time, in pieces without such
  /// steps.
  std::vector<DefectTrail> trails(double time, double span) const;
  /// The defect with that charge that has lived longest, or after `rank` others; the older of equal ones.
  std::optional<DefectLife> longest(double charge, std::size_t rank) const;
  /// Defects with that charge.
  std::size_t count(double charge) const;

 private:
  analysis::Region region_;
  analysis::DefectTracks tracks_;
  std::vector<DefectLife> lives_;  // in the order of their tracks' numbers
};

}  // namespace shaken::render
