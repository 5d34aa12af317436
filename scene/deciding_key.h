#pragma once

#include <string>
#include <string_view>

#include "scene/keys/run_plan.h"

namespace shaken::scene {

/// The key that decides, with its value ("plates.noise = 0.1 rad/mm"): of `keys`, patterns in which * stands for any
/// letters, the first that is not neutral, else the first that has a value, else the block that is not there.
std::string deciding_key(const RunPlan& plan, std::string_view keys);

}  // namespace shaken::scene
