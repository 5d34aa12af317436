// SPDX-License-Identifier: MIT
#include "analysis/mixing.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "analysis/blocked.h"
#include "analysis/region.h"
#include "run/measure/estimates.h"
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

class MeasuredMixing : public Measurement {
 public:
  MeasuredMixing(const System& system, const Cell& cell, int bins, double near)
      : numbers_(numbers_of(system)),
        region_(system.box(), system.walls),
        species_of_rod_(cell.species_of_rods()),
        mixing_(PairMixing(numbers_.size(), bins, system.box().shorter() / 2, near)) {}

  void sample(const Sample& sample) override {
    mixing_.accumulate(sample->time, sample.all().position, species_of_rod_, region_);
  }
  void reduce(Reduction& result) const override {
    const analysis::MixingCurves curves = mixing_.after(result.t_steady).reduce();
    const auto errors = block_errors(mixing_, result.t_steady, [](const PairMixing& part) { return part.reduce().g; });
    const auto numbers =
        block_estimates(mixing_, result.t_steady, [](const PairMixing& part) { return part.reduce().segregation; });
    result.arrays["/mixing/r_mm"] = curves.r;
    for (std::size_t a = 0; a < numbers_.size(); ++a) {
      for (std::size_t b = a; b < numbers_.size(); ++b) {
        const std::size_t kind = PairMixing::pair_kind(numbers_.size(), a, b);
        const std::string pair = std::to_string(numbers_[a]) + std::to_string(numbers_[b]);
        put(result, "/mixing/g_" + pair, "", analysis::EstimateCurve{curves.g[kind], errors[kind]});
        if (a != b) result.scalars["segregation_" + pair] = numbers[kind];
      }
    }
  }
  void save(StateWriter& writer) const override { mixing_.save(writer); }
  void restore(StateReader& reader) override { mixing_.restore(reader); }

 private:
  std::vector<int> numbers_;
  analysis::Region region_;
  std::vector<std::uint8_t> species_of_rod_;
  analysis::Blocked<PairMixing> mixing_;
};

}  // namespace

MeasurementKind mixing_kind() {
  return {
      .name = "mixing",
      .sources = "mixing, pair_bins, region",
      .make = [](const MeasureContext& context) -> std::unique_ptr<Measurement> {
        const System& system = context.run.system;
        const scene::MeasureMixing& settings = *context.plan.mixing;
        return std::make_unique<MeasuredMixing>(system, context.cell, settings.bins,
                                                settings.distance_for(system.rod.length, system.box().shorter()));
      },
      .arrays =
          {
              {"r_mm", "bin centres"},
              {"g_11", "g(r) of `rods` with each other", kWithError},
              {"g_12", "of `rods` and `rods_2`; likewise the others, of species that there are", kWithError},
              {"g_13", "of `rods` and `rods_3`", kWithError},
              {"g_22", "of `rods_2` with each other", kWithError},
              {"g_23", "of `rods_2` and `rods_3`", kWithError},
              {"g_33", "of `rods_3` with each other", kWithError},
          },
      .numbers =
          {
              {"segregation_12",
               "how far `rods` and `rods_2` keep apart: 0 if they are mixed at random, 1 if no rod has "
               "a neighbour of the other species",
               false, "no neighbours"},
              {"segregation_13", "the same of `rods` and `rods_3`", false, "no neighbours"},
              {"segregation_23", "the same of `rods_2` and `rods_3`", false, "no neighbours"},
          },
  };
}

}  // namespace shaken::run
