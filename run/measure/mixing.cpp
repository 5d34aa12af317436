#include "analysis/mixing.h"

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/errors/blocked.h"
#include "analysis/geometry/region.h"
#include "run/measure/estimates.h"
#include "run/measure/measured.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

using analysis::PairMixing;

/// (n_species) of the species that a scene has: 1 of `rods`, 2 of `rods_2`, 3 of `rods_3`.
std::vector<int> numbers_of(const System& system) {
  std::vector<int> numbers;
  for (std::size_t k = 0; k < kMostSpecies; ++k) {
    if (system.has_species(k)) numbers.push_back(static_cast<int>(k) + 1);
  }
  return numbers;
}

std::unique_ptr<Measurement> measure_mixing(const MeasureContext& context) {
  const System& system = context.run.system;
  const scene::MeasureMixing& settings = *context.plan.mixing;
  const std::vector<int> species = numbers_of(system);
  const analysis::Region region(system.box(), system.walls);
  const double near = settings.distance_for(system.rod.length, system.box().shorter());
  const auto sample = [region, species_of_rod = context.cell.species_of_rods()](const Sample& now, auto& mixing) {
    mixing.accumulate(now->time, now.all().position, species_of_rod, region);
  };
  const auto reduce = [species](Reduction& result, const auto& mixing) {
    const analysis::MixingCurves curves = mixing.after(result.t_steady).reduce();
    const auto errors = block_errors(mixing, result.t_steady, [](const PairMixing& part) { return part.reduce().g; });
    const auto numbers =
        block_estimates(mixing, result.t_steady, [](const PairMixing& part) { return part.reduce().segregation; });
    result.arrays["/mixing/r_mm"] = curves.r;
    for (std::size_t a = 0; a < species.size(); ++a) {
      for (std::size_t b = a; b < species.size(); ++b) {
        const std::size_t kind = PairMixing::pair_kind(species.size(), a, b);
        const std::string pair = std::to_string(species[a]) + std::to_string(species[b]);
        put(result, "/mixing/g_" + pair, analysis::EstimateCurve{curves.g[kind], errors[kind]});
        if (a != b) result.scalars["segregation_" + pair] = numbers[kind];
      }
    }
  };
  return measured(sample, reduce,
                  analysis::Blocked(PairMixing(species.size(), settings.bins, system.box().shorter() / 2, near)));
}

}  // namespace

MeasurementKind mixing_kind() {
  return {
      .name = "mixing",
      .sources = "mixing, geometry/pair_bins, geometry/region",
      .make = measure_mixing,
      .arrays =
          {
              called("distance", "r", {"r_mm", "bin centres"}),
              {"g_11", "g(r) of `rods` with each other", kWithError},
              called("pair distribution between species", "g_{12}(r)",
                     {"g_12", "of `rods` and `rods_2`; likewise the others, of species that there are", kWithError}),
              {"g_13", "of `rods` and `rods_3`", kWithError},
              {"g_22", "of `rods_2` with each other", kWithError},
              {"g_23", "of `rods_2` and `rods_3`", kWithError},
              {"g_33", "of `rods_3` with each other", kWithError},
          },
      .numbers =
          {
              called("segregation of the first two species", "",
                     {"segregation_12",
                      "how far `rods` and `rods_2` keep apart: 0 if they are mixed at random, 1 if no rod has "
                      "a neighbour of the other species",
                      false, "no neighbours"}),
              {"segregation_13", "the same of `rods` and `rods_3`", false, "no neighbours"},
              {"segregation_23", "the same of `rods_2` and `rods_3`", false, "no neighbours"},
          },
      .needs = {Needs::kIdentities, Needs::kEveryRod},
  };
}

}  // namespace shaken::run
