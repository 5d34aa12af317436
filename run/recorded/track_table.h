#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/keys/problem.h"
#include "run/files/recorded_frames.h"
#include "run/measure/measurement_kinds.h"
#include "scene/keys/run_plan.h"

namespace shaken::run {

/// What a table of tracked rods does not say of itself.
struct TrackConventions {
  double scale = 1;                            ///< mm in one unit of its lengths: a pixel, say
  std::optional<double> interval;              ///< from one number of a frame to the next [s]; none: a column of times
  bool flips_y = false;                        ///< y is counted downwards
  bool wraps = false;                          ///< positions outside of a periodic box are put into it
  int filled = 0;                              ///< frames, at most, that a rod was missed for and is interpolated in
  bool only_complete = false;                  ///< rods that are not in every frame are left out
  std::optional<bool> radians;                 ///< of angles; none: by the name of their column, degrees otherwise
  std::map<std::string, std::string> columns;  ///< "x": "POSITION_X"; names that trackers use need not be named
  std::map<std::string, std::string> species;  ///< "long": "rods_2", where a table has other names for them
};

/// Rods as an experiment has tracked them.
struct TrackedRods {
  std::unique_ptr<RecordedFrames> frames;  ///< species by species; of a single one some may be missed
  scene::RunPlan plan;                     ///< the scene with the number of rods, the frames' times and their length
  Lacking lacking;
  std::vector<std::string> remarks;
};

/// Reads a table in CSV with a row for each rod and frame: a number of the frame or a time, x and y, angle (or nx, ny),
/// and, if it has them, an id, z, tilt (or nz), species; rows in any order. `plan` has the box and the rods' shapes.
/// Rows without a position, an angle or a time are rods that were missed. What is wrong is added to `problems`; then
/// there is no result.
std::optional<TrackedRods> read_tracks(std::string_view text, const std::string& file, const scene::RunPlan& plan,
                                       const TrackConventions& conventions, std::vector<keys::Problem>& problems);

}  // namespace shaken::run
