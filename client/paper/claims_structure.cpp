// SPDX-License-Identifier: MIT
// Correlations in space, isotropic and along and across the director, and what they say of elasticity.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "client/paper/claims.h"
#include "client/paper/panels.h"

namespace shaken::client {
namespace {

/// G2 that counts as none at half a box.
constexpr double kNoCorrelation = 0.05;
/// G2 levels off at S^2: that of S = 0.5.
constexpr double kPlateau = 0.25;

Finding g2_decays_or_levels(const Library& runs) {
  std::vector<Answer> answers;
  std::string found;
  for (const double length : {2.5, 4.5}) {
    std::vector<Point> points;
    const RunSet column = where(runs["phases"], "rods.length", length);
    for (const double fraction : values_of(column, "rods.area_fraction")) {
      if (length > 4 && fraction < 0.74) continue;
      const RunSet here = with_extreme(
          joined(of(runs, "phases", length, fraction), of(runs, "diffusion", length, fraction)), "box.side", true);
      const Quantity far = far_g2(here);
      points.push_back({fraction, far});
      if (length > 4) {
        answers.push_back(above(far, kPlateau));
        continue;
      }
      Answer answer = close_to(far, 0, kNoCorrelation);
      if (answer == no() && !is_papers_box(here)) answer = unknown("half the box is less far than the paper's");
      answers.push_back(std::move(answer));
    }
    if (points.empty()) continue;
    found = listed(std::move(found), value_label("rods.length", length) + ": " + text(points, "rods.area_fraction"));
  }
  return conclude(answers, found.empty() ? found : "G₂ at half a box, " + found);
}

/// along - across in the farther half of the cuts through the map of G2. Its error is the mean of theirs, as if
/// neighbouring places went up and down together.
Quantity far_anisotropy(const RunSet& runs) {
  std::vector<Quantity> differences;
  for (const FinishedRun& run : runs) {
    const auto &along = run.array("/pairs/cut/g2_along"), &across = run.array("/pairs/cut/g2_across");
    const auto &along_sem = run.array("/pairs/cut/g2_along_sem"), &across_sem = run.array("/pairs/cut/g2_across_sem");
    const bool with_errors = along_sem.size() == along.size() && across_sem.size() == across.size();
    double sum = 0, error = 0, n = 0;
    for (std::size_t k = along.size() / 2; k < std::min(along.size(), across.size()); ++k) {
      if (!std::isfinite(along[k] - across[k])) continue;
      sum += along[k] - across[k];
      error += with_errors ? std::hypot(along_sem[k], across_sem[k]) : NAN;
      n += 1;
    }
    differences.push_back(n > 0 ? Quantity{sum / n, error / n, run.steadiness()} : Quantity{});
  }
  return mean_of(differences);
}

Finding g2_anisotropic(const Library& runs) {
  const RunSet here = layers(runs, 4.5, 0.75);
  if (here.empty()) return {};
  const Quantity difference = far_anisotropy(here);
  return conclude({above(difference, 0)}, "along − across, far out at φ = 0.75: " + text(difference, 3));
}

Finding g2_isotropic_when_dilute(const Library& runs) {
  const RunSet here = with_extreme(of(runs, "size", 4.5, 0.45), "box.side", true);
  if (here.empty()) return {};
  const Quantity difference = far_anisotropy(here);
  return conclude({close_to(difference, 0, kNoCorrelation)},
                  "along − across, far out at φ = 0.45: " + text(difference, 3));
}

/// Mean of (g - 1)^2 from one rod's length on, less what its errors put there; its error as if neighbouring places went
/// up and down together.
Quantity unevenness(const RunSet& runs, const std::string& cut) {
  std::vector<Quantity> found;
  for (const FinishedRun& run : runs) {
    const auto &r = run.array("/pairs/cut/r_mm"), &g = run.array("/pairs/cut/" + cut);
    const auto& errors = run.array("/pairs/cut/" + cut + "_sem");
    double sum = 0, error = 0, n = 0;
    for (std::size_t k = 0; k < std::min(r.size(), g.size()); ++k) {
      if (r[k] < run.number("rods.length") || !std::isfinite(g[k])) continue;
      const double sem = errors.size() == g.size() ? errors[k] : NAN;
      sum += (g[k] - 1) * (g[k] - 1) - (std::isnan(sem) ? 0 : sem * sem);
      error += 2 * std::abs(g[k] - 1) * sem;
      n += 1;
    }
    found.push_back(n > 0 ? Quantity{sum / n, error / n, run.steadiness()} : Quantity{});
  }
  return mean_of(found);
}

Finding g_flattens(const Library& runs) {
  const RunSet here = layers(runs, 4.5, 0.75);
  if (here.empty()) return {};
  const Quantity along = unevenness(here, "g_along"), across = unevenness(here, "g_across");
  return conclude({larger(across, along)},
                  fmt::format("mean (g − 1)² from one rod length on, φ = 0.75: {} along, {} across", text(along, 4),
                              text(across, 4)));
}

Finding splay_stiffer_than_bend(const Library& runs) {
  const RunSet here = layers(runs, 4.5, 0.75);
  if (here.empty()) return {};
  const Quantity ratio = mean_scalar(here, "frank_ratio");
  const double chi2 = mean_scalar(here, "frank_chi2").value;
  const bool fits = chi2 < 2;
  return conclude({fits ? below(ratio, 1) : unknown("the law of Frank's constants does not hold")},
                  fmt::format("K₃/K₁ (bend to splay) = {} at φ = 0.75, χ² per point {:.1f}", text(ratio, 1), chi2));
}

}  // namespace

std::vector<Claim> structure_claims() {
  return {
      {"g2", "4", "G₂(r) decays to 0 for ℓ = 2.5 mm at every packing, and levels off for ℓ = 4.5 mm when dense",
       g2_decays_or_levels},
      {"isotropic", "5", "G₂ is isotropic at 0.45 (ℓ = 4.5 mm)", g2_isotropic_when_dilute},
      {"anisotropy", "5", "G₂ falls faster across the director than along it", g2_anisotropic},
      {"g-flattens", "5", "g(r) flattens sooner along the director than across it", g_flattens, Reach::kEitherWay,
       "the paper's sentence is not consistent in itself; this is its main clause"},
      {"splay-bend", "elasticity", "Splay costs more than bend, K₁ > K₃", splay_stiffer_than_bend, Reach::kEitherWay,
       "the paper concludes it from G₂ falling faster across the director; in linear theory, ⟨|δθ|²⟩ ~ 1/(K₁q_across² "
       "+ "
       "K₃q_along²), that means the reverse, K₁ < K₃"},
  };
}

}  // namespace shaken::client
