#include <algorithm>
#include <limits>

#include "analysis/oscillation.h"
#include "analysis/pair_map.h"
#include "run/measure/estimates.h"
#include "run/measure/measured.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

/// g and G2 in the frame of the director, and the wavelength of layers as G2 across it tells.
std::unique_ptr<Measurement> measure_pairs(const MeasureContext& context) {
  const scene::MeasurePairs& settings = *context.plan.pairs;
  const Box box = context.plan.system.box();
  const double width = 2 * context.species.max_radius;
  const double rod_length = context.plan.system.rod.length, range = settings.range_for(rod_length, box.shorter());
  const analysis::PairMap::Shape shape{settings.bins, std::min(range, box.shorter() / 2),
                                       std::min(width, box.shorter() / 2), box};
  const auto sample = [](const Sample& now, auto& pairs) { pairs.accumulate(now->time, now->position, now->director); };
  const auto reduce = [rod_length](Reduction& result, const auto& pairs) {
    const analysis::PairCurves curves = pairs.after(result.t_steady).reduce();
    result.arrays["/pairs/along_mm"] = curves.along;
    result.arrays["/pairs/across_mm"] = curves.across;
    result.arrays["/pairs/g"] = curves.g;
    result.arrays["/pairs/g2"] = curves.g2;
    result.arrays["/pairs/cut/r_mm"] = curves.r;
    result.arrays["/pairs/cut/g_along"] = curves.g_along;
    result.arrays["/pairs/cut/g_across"] = curves.g_across;
    result.arrays["/pairs/cut/g2_along"] = curves.g2_along;
    result.arrays["/pairs/cut/g2_across"] = curves.g2_across;
    const auto errors = block_errors(pairs, result.t_steady, [](const analysis::PairMap& part) {
      const analysis::PairCurves cut = part.reduce();
      return std::vector{cut.g_along, cut.g_across, cut.g2_along, cut.g2_across};
    });
    const char* const cuts[] = {"g_along", "g_across", "g2_along", "g2_across"};
    for (std::size_t k = 0; k < std::size(cuts); ++k) {
      result.arrays[std::string("/pairs/cut/") + cuts[k] + "_sem"] = errors[k];
    }
    // Rods side by side make ripples of their distances, and of multiples of these where they are crystalline. A layer
    // is half a period: it is taken for one only where it is as wide as its rods are long.
    const auto wavelength = block_estimates(pairs, result.t_steady, [&](const analysis::PairMap& part) {
      constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
      const analysis::PairCurves cut = part.reduce();
      return std::vector<double>{analysis::first_period(cut.r, cut.g2_across, rod_length).value_or(kNone)};
    });
    result.scalars["wavelength_g2_mm"] = wavelength[0];
  };
  return measured(sample, reduce, analysis::Blocked(analysis::PairMap(shape)));
}

}  // namespace

MeasurementKind pairs_kind() {
  return {
      .name = "pairs",
      .sources = "pair_map, oscillation",
      .make = measure_pairs,
      .arrays =
          {
              {"along_mm", "(bins) bin centres along the director"},
              {"across_mm", "(bins) bin centres across it"},
              called("pair correlation", "g",
                     {"g", "(bins · bins) g(x, y), row by row: `g.reshape(bins, bins)[across, along]`"}),
              called("orientational correlation", "G_2", {"g2", "(bins · bins) G₂(x, y), in the same order"}),
              called("distance across the director", "r_⊥",
                     {"cut/r_mm",
                      "bin centres of cuts through the maps, up to half the longer side of the box; NaN stands where "
                      "images "
                      "end"}),
              {"cut/g_along", "g along the director", kWithError},
              {"cut/g_across", "g across it", kWithError},
              {"cut/g2_along", "G₂ along the director", kWithError},
              called("orientational correlation", "G_2(r_⊥)", {"cut/g2_across", "G₂ across it", kWithError}),
          },
      .axes = {{"g", "across_mm along_mm"}, {"g2", "across_mm along_mm"}},
      .numbers =
          {
              {"wavelength_g2_mm",
               "wavelength of layers: first period of G₂ across the director of at least two rod lengths"},
          },
  };
}

}  // namespace shaken::run
