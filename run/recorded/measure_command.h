#pragma once

#include <string>
#include <vector>

#include "run/recorded/track_table.h"

namespace CLI {
class App;
}

namespace shaken::run {

struct MeasureOptions {
  std::string file;
  std::string scene;
  std::vector<std::string> settings;
  std::string out;
  TrackConventions conventions;
  std::string interval;                       ///< of the conventions, as given
  std::vector<std::string> columns, species;  ///< the same
  bool radians = false, degrees = false;
  bool json = false;
};
/// Declares what `shaken measure`, too, takes besides the file; `asked` must outlive the parsing.
void declare(CLI::App& app, MeasureOptions& asked);

/// `shaken-worker measure FILE`: measures recorded frames anew and leaves a run directory of what it found, "measured,
/// not simulated". Exit codes: 0 done, 1 failed, 2 bad input.
int measure_command(int argc, char** argv);

}  // namespace shaken::run
