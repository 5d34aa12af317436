// SPDX-License-Identifier: MIT
#include "bench/accuracy/variant.h"

namespace shaken::bench {

const std::vector<Variant>& variants() {
  static const std::vector<Variant> all{
      {"newton", [](Scene& scene) { scene.law = ImpulseLaw::kNewton; }},
      {"instant", [](Scene& scene) { scene.impacts = ImpactTime::kAtInstant; }},
      {"poisson", [](Scene& scene) { scene.law = ImpulseLaw::kPoisson; }},
      {"energetic", [](Scene& scene) { scene.law = ImpulseLaw::kEnergetic; }},
  };
  return all;
}

}  // namespace shaken::bench
