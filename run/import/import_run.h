#pragma once

namespace shaken::run {

/// `shaken-worker import FILE --scene SCENE`: makes a run directory of the rods in a file, with one frame at t = 0, in
/// the daemon's folder of runs, so that runs can start from it. Exit codes: 0 done, 1 failed, 2 bad input.
int import_command(int argc, char** argv);

}  // namespace shaken::run
