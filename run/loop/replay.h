#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "base/core/result.h"
#include "run/loop/trouble_file.h"
#include "sim/close_up.h"

namespace shaken::run {

/// A run's numerical trouble, met once more.
struct Replay {
  TroubleReport recorded;  ///< what trouble.json says (without the rods)
  Tick started_at = 0;     ///< the checkpoint's tick, or 0
  CloseUp before;          ///< the rods concerned, one tick before
  std::optional<NumericalTrouble> met;
  bool same() const {
    return met && met->tick == recorded.trouble.tick && met->rods == recorded.trouble.rods &&
           met->what == recorded.trouble.what;
  }
};

/// Goes from the last sound checkpoint of the run in `directory`, or from its beginning, to the tick before its
/// trouble, looks at the rods concerned, and does that tick. Writes nothing. Fails if the directory has no
/// trouble.json, or no scene that can be read.
Result<Replay> replay(const std::filesystem::path& directory);

/// The same for people.
std::string as_text(const Replay& replay, double dt);

/// `shaken-worker replay DIR [--json]`. Exit codes: 0 the same trouble came back, 1 it did not, 2 bad input.
int replay_command(int argc, char** argv);

}  // namespace shaken::run
