#pragma once

#include <string>
#include <vector>

#include "scene/keys/run_plan.h"

namespace shaken::scene {

/// What is allowed, but hardly meant: a sentence for each.
std::vector<std::string> remarks(const RunPlan& plan);

}  // namespace shaken::scene
