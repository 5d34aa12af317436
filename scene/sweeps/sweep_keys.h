#pragma once

#include "base/keys/table.h"
#include "scene/sweeps/sweep.h"

namespace shaken::scene {

/// The keys of a sweep file. What stands in "scene" and "sweep" is read elsewhere.
const keys::Table<Sweep>& sweep_keys();

}  // namespace shaken::scene
