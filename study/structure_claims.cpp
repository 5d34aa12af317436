// SPDX-License-Identifier: MIT
// Correlations in space, isotropic and along and across the director, and what they say of elasticity.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/claim_checks.h"
#include "study/panels.h"

namespace shaken::study {
namespace {

/// G2 that counts as none at half a box.
constexpr double kNoCorrelation = 0.05;
/// G2 levels off at S^2: that of S = 0.5.
constexpr double kPlateau = kOrdered * kOrdered;

/// along - across in the farther half of the cuts through the map of G2.
Estimate far_anisotropy(const RunSet& runs) {
  return mean_over(runs, [](const FinishedRun& run) {
    const auto &along = run.array("/pairs/cut/g2_along"), &across = run.array("/pairs/cut/g2_across");
    const auto &along_sem = run.array("/pairs/cut/g2_along_sem"), &across_sem = run.array("/pairs/cut/g2_across_sem");
    MeanOverPlaces mean;
    for (std::size_t k = along.size() / 2; k < std::min(along.size(), across.size()); ++k) {
      mean.add(along[k] - across[k],
               std::hypot(error_at(along_sem, k, along.size()), error_at(across_sem, k, across.size())));
    }
    return mean.of(run);
  });
}

/// Mean of (g - 1)^2 from one rod's length on, less what its errors put there.
Estimate unevenness(const RunSet& runs, const std::string& cut) {
  return mean_over(runs, [&](const FinishedRun& run) {
    const auto &r = run.array("/pairs/cut/r_mm"), &g = run.array("/pairs/cut/" + cut);
    const auto& errors = run.array("/pairs/cut/" + cut + "_sem");
    MeanOverPlaces mean;
    for (std::size_t k = 0; k < std::min(r.size(), g.size()); ++k) {
      if (r[k] < run.number(kLength)) continue;
      const double sem = error_at(errors, k, g.size());
      mean.add((g[k] - 1) * (g[k] - 1) - (std::isnan(sem) ? 0 : sem * sem), 2 * std::abs(g[k] - 1) * sem);
    }
    return mean.of(run);
  });
}

}  // namespace

Estimate far_g2(const RunSet& runs) {
  return mean_over(runs, [](const FinishedRun& run) {
    const auto &g2 = run.array("/g2/g2"), &errors = run.array("/g2/g2_sem");
    MeanOverPlaces mean;
    for (std::size_t k = 3 * g2.size() / 4; k < g2.size(); ++k) mean.add(g2[k], error_at(errors, k, g2.size()));
    return mean.of(run);
  });
}

Finding g2_decays_or_levels(const Library& runs) {
  Evidence evidence;
  for (const double length : {2.5, 4.5}) {
    std::vector<Point> points;
    for (const double fraction : values_of(where(runs["phases"], kLength, length), kPacking)) {
      if (length > 4 && fraction < 0.74) continue;
      const RunSet here = with_extreme(
          joined(of(runs, "phases", length, fraction), of(runs, "diffusion", length, fraction)), "box.side", true);
      const Estimate far = far_g2(here);
      points.push_back({fraction, far});
      Answer answer = length > 4 ? above(far, kPlateau) : close_to(far, 0, kNoCorrelation);
      if (length < 4 && answer == no() && !is_papers_box(here)) {
        answer = unknown("half the box is less far than the paper's");
      }
      evidence.answer(std::move(answer));
    }
    if (!points.empty()) evidence.say(value_label(kLength, length) + ": " + text(points, kPacking));
  }
  return conclude(evidence, evidence.found.empty() ? "" : "G₂ at half a box, ");
}

Finding g2_anisotropic(const Library& runs) {
  const RunSet here = layers(runs, 4.5, 0.75);
  if (here.empty()) return {};
  const Estimate difference = far_anisotropy(here);
  return conclude({above(difference, 0)}, "along − across, far out at φ = 0.75: " + text(difference, 3));
}

Finding g2_isotropic_when_dilute(const Library& runs) {
  const RunSet here = with_extreme(of(runs, "size", 4.5, 0.45), "box.side", true);
  if (here.empty()) return {};
  const Estimate difference = far_anisotropy(here);
  return conclude({close_to(difference, 0, kNoCorrelation)},
                  "along − across, far out at φ = 0.45: " + text(difference, 3));
}

Finding g_flattens(const Library& runs) {
  const RunSet here = layers(runs, 4.5, 0.75);
  if (here.empty()) return {};
  const Estimate along = unevenness(here, "g_along"), across = unevenness(here, "g_across");
  return conclude({larger(across, along)},
                  fmt::format("mean (g − 1)² from one rod length on, φ = 0.75: {} along, {} across", text(along, 4),
                              text(across, 4)));
}

Finding splay_stiffer_than_bend(const Library& runs) {
  const RunSet here = layers(runs, 4.5, 0.75);
  if (here.empty()) return {};
  const Estimate ratio = mean_scalar(here, "frank_ratio");
  const double chi2 = mean_scalar(here, "frank_chi2").value;
  const bool fits = chi2 < 2;
  return conclude({fits ? below(ratio, 1) : unknown("the law of Frank's constants does not hold")},
                  fmt::format("K₃/K₁ (bend to splay) = {} at φ = 0.75, χ² per point {:.1f}", text(ratio, 1), chi2));
}

}  // namespace shaken::study
