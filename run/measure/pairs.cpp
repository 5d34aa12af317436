#include <algorithm>
#include <optional>

#include "analysis/oscillation.h"
#include "analysis/pair_map.h"
#include "run/measure/measured.h"
#include "run/measure/rows.h"

namespace shaken::run {
namespace {

using analysis::PairCurves;

constexpr std::array kPairCurves{
    from<&PairCurves::along>({"along_mm", "(bins) bin centres along the director"}),
    from<&PairCurves::across>({"across_mm", "(bins) bin centres across it"}),
    from<&PairCurves::g>(called("pair correlation", "g",
                                {"g", "(bins · bins) g(x, y), row by row: `g.reshape(bins, bins)[across, along]`"})),
    from<&PairCurves::g2>(
        called("orientational correlation", "G_2", {"g2", "(bins · bins) G₂(x, y), in the same order"})),
    from<&PairCurves::r>(
        called("distance across the director", "r_⊥",
               {"cut/r_mm",
                "bin centres of cuts through the maps, up to half the longer side of the box; NaN stands where "
                "images end"})),
    from<&PairCurves::g_along>({"cut/g_along", "g along the director", kWithError}),
    from<&PairCurves::g_across>({"cut/g_across", "g across it", kWithError}),
    from<&PairCurves::g2_along>({"cut/g2_along", "G₂ along the director", kWithError}),
    from<&PairCurves::g2_across>(
        called("orientational correlation", "G_2(r_⊥)", {"cut/g2_across", "G₂ across it", kWithError})),
};
constexpr std::array kPairNumbers{
    from<[](const std::optional<double>& period) { return period.value_or(analysis::kNaN); }>(
        {"wavelength_g2_mm",
         "wavelength of layers: first period of G₂ across the director of at least two rod lengths"}),
};

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
    put(result, "/pairs/", kPairCurves, pairs);
    // Rods side by side make ripples of their distances, and of multiples of these where they are crystalline. A layer
    // is half a period: it is taken for one only where it is as wide as its rods are long.
    put(result, "", kPairNumbers, pairs, [&](const analysis::PairMap& part) {
      const PairCurves cut = part.reduce();
      return analysis::first_period(cut.r, cut.g2_across, rod_length);
    });
  };
  return measured(sample, reduce, analysis::Blocked(analysis::PairMap(shape)));
}

}  // namespace

MeasurementKind pairs_kind() {
  return {
      .name = "pairs",
      .sources = "pair_map, oscillation",
      .make = measure_pairs,
      .arrays = outputs_of(kPairCurves),
      .axes = {{"g", "across_mm along_mm"}, {"g2", "across_mm along_mm"}},
      .numbers = outputs_of(kPairNumbers),
  };
}

}  // namespace shaken::run
