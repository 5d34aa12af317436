#pragma once

namespace shaken::run {

/// `shaken-worker measure FILE`: measures recorded frames anew and leaves a run directory of what it found, "measured,
/// not simulated". Exit codes: 0 done, 1 failed, 2 bad input.
int measure_command(int argc, char** argv);

}  // namespace shaken::run
