#pragma once

#include "base/keys/document.h"
#include "base/keys/problem.h"
#include "base/keys/units.h"

namespace shaken::scene {

/// Scenes are made of keys, and name what belongs to them as base/keys does.
using namespace keys;  // NOLINT(google-build-using-namespace)

}  // namespace shaken::scene
