// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "run/files/provenance.h"
#include "run/files/recorded_frame.h"
#include "sim/rod/bead_row.h"
#include "sim/system.h"

namespace shaken::run {

/// What does not change along a trajectory, and what drawing it needs.
struct TrajectoryHeader {
  int n_rods = 0;
  double box_side = 0;                         ///< [mm]
  double gap = 0;                              ///< [mm]
  double dt = 0;                               ///< [s]
  std::vector<double> bead_offset;             ///< (n_beads) of the first species, along it from its centre [mm]
  std::vector<double> bead_radius;             ///< (n_beads) [mm]
  std::string scene_json;                      ///< the resolved scene
  std::vector<BeadRow> added_beads{};          ///< of the other species
  std::vector<std::uint8_t> species_of_rod{};  ///< (n_rods) species of each rod, from 0; empty if there is one
  std::optional<SideWalls> walls{};            ///< of the arena, if there are any
  Provenance provenance{};
};

/// Nothing if every rod is of a species that has beads, and all lengths are such; else what is wrong.
Result<void> check(const TrajectoryHeader& header);

/// Frames in a file of either kind.
class RecordedFrames {
 public:
  virtual ~RecordedFrames() = default;
  virtual const TrajectoryHeader& header() const = 0;
  virtual std::size_t n_frames() const = 0;
  /// Fails if the frame is damaged. `index` < n_frames().
  virtual Result<RecordedFrame> frame(std::size_t index) const = 0;
};

}  // namespace shaken::run
