// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/hard/outcome.h"

namespace shaken::bench {

/// A hard case made by hand: a few rods placed exactly so that something degenerates, or a run that must not go on.
struct MadeCase {
  std::string name;
  std::function<HardCase()> run;
};
const std::vector<MadeCase>& made_cases();

}  // namespace shaken::bench
