#pragma once

#include <optional>
#include <string>
#include <vector>

#include "client/live/live.h"
#include "client/watch/cells.h"
#include "client/watch/rod_cells.h"
#include "client/watch/screen_writer.h"
#include "client/watch/steering.h"

namespace shaken::client {

/// Where things stand on the screen of one run. The first line is the title, the last one the status.
struct WatchLayout {
  Area picture;
  Area legend;   ///< one line under the picture
  Area numbers;  ///< beside the picture, or under it
  friend bool operator==(const WatchLayout&, const WatchLayout&) = default;
};

/// The arrangement, numbers beside or under the rods, in which the picture (a cell is about twice as high as wide)
/// becomes larger. Nothing if the terminal is too small for either.
std::optional<WatchLayout> watch_layout(int columns, int lines);

/// "the rods need a terminal of 60x16 or 40x28; this one has 40x10".
std::string size_note(int columns, int lines);

/// All that a screen is made of.
struct WatchContent {
  const LiveJobs& jobs;
  const Steering& steering;
  const RodFrame* rods = nullptr;  ///< of the job that is steered to; null if none have come
  const std::vector<DefectMark>& defects;
  std::string title;
  std::string note;  ///< where the numbers come from
  ColourDepth depth = ColourDepth::kTrue;
};

/// The screen of one run, with its rods, numbers and S(t); that of all runs, if asked for; or what it would need, with
/// as many numbers as fit, if the terminal is too small.
CellGrid watch_cells(const WatchContent& content, int columns, int lines);

/// The runs that keys switch between: those that run, or all if none does.
std::vector<std::string> choices(const LiveJobs& jobs);
/// The run to show: `job` as long as it runs or no other does; otherwise the first that runs, rather than draws its
/// film.
std::string job_to_show(const std::string& job, const LiveJobs& jobs);

}  // namespace shaken::client
