#pragma once

#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

#include "base/failure.h"
#include "base/keys/problem.h"

namespace shaken::run {

struct ImportOptions {
  std::string file;
  std::string scene;
  std::vector<std::string> settings;
  std::optional<int> frame;
  std::string root;
  bool random_velocities = false;
  bool json = false;
};
/// Declares what `shaken import`, too, takes besides the file and the root; `asked` must outlive the parsing.
void declare(CLI::App& app, ImportOptions& asked);

/// `shaken-worker import FILE --scene SCENE`: makes a run directory of the rods in a file, with one frame at t = 0, in
/// the daemon's folder of runs, so that runs can start from it. Exit codes: 0 done, 1 failed, 2 bad input.
int import_command(int argc, char** argv);

/// Says on stdout, as JSON, all that is wrong with a file and its scene; without `json` it throws a Failure that does,
/// "FILE is refused:" and a line for each.
ExitCode refuse(const std::string& file, const std::vector<keys::Problem>& problems, bool json);

}  // namespace shaken::run
