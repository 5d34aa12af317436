// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sim/scene.h"

namespace shaken::bench {

/// One way to treat impacts whose accuracy is measured.
struct Variant {
  const char* name;
  void (*apply)(Scene& scene);  ///< sets what the variant is about, and nothing else
};

/// All of them; the first is the default of a scene.
const std::vector<Variant>& variants();

}  // namespace shaken::bench
