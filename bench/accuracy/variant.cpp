// SPDX-License-Identifier: MIT
#include "bench/accuracy/variant.h"

namespace shaken::bench {

const std::vector<Variant>& variants() {
  static const std::vector<Variant> all{
      {"newton", [](Scene& scene) { scene.law = ImpulseLaw::kNewton; }},
  };
  return all;
}

}  // namespace shaken::bench
