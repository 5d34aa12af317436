// SPDX-License-Identifier: MIT
#include "study/claims.h"

#include <fmt/format.h>

#include <algorithm>

#include "study/claim_checks.h"

namespace shaken::study {

std::span<const Claim> paper_claims() {
  static const std::vector<Claim> kClaims{
      {"steady-state", "2", "Rods start aligned, S(0) = 1, and are steady after 400 to 600 s (ℓ = 4.5 mm)",
       starts_aligned_and_settles},
      {"ordered", "3", "Long rods (ℓ = 4.5 mm) at area fraction 0.75 are ordered, S about 0.9", ordered_when_dense},
      {"disordered", "3", "At 0.45 they are not: ⟨S⟩ < 0.5, and nothing of it far away or in larger boxes",
       disordered_when_dilute},
      {"short", "3", "Rods shorter than 3.5 mm do not order at any packing", short_rods_do_not_order},
      {"transition", "3", "The area fraction at which order sets in falls with the length",
       transition_falls_with_length},
      {"saturates", "3", "⟨S⟩ of rods longer than 3.5 mm rises with packing to about 1", saturates, Reach::kEitherWay,
       "whether it rises continuously takes runs from disorder too, which these are not"},
      {"transition-size", "size", "The area fraction at which order sets in rises with the box",
       transition_rises_with_size},
      {"long-range", "size", "The order is long-range", long_range, Reach::kCannotAgree,
       "quasi-long-range order is a small power of L as well"},
      {"unimodal", "4", "P[S] has one peak at every packing (ℓ = 4.5 mm)", one_peak},
      {"broadest", "4", "S fluctuates most near the transition", broadest_at_the_transition},
      {"oblique", "steady", "ℓ = 3.5 mm at 0.85 orders along an oblique axis", oblique_axis, Reach::kEitherWay,
       "while they are ordered, runs that start along a side of the box cannot refute it"},
      {"activity", "shaking", "Γ is a measure of the activity, and at Γ = 0 there is none", activity},

      {"g2", "5", "G₂(r) decays to 0 for ℓ = 2.5 mm at every packing, and levels off for ℓ = 4.5 mm when dense",
       g2_decays_or_levels},
      {"isotropic", "6", "G₂ is isotropic at 0.45 (ℓ = 4.5 mm)", g2_isotropic_when_dilute},
      {"anisotropy", "6", "G₂ falls faster across the director than along it", g2_anisotropic},
      {"g-flattens", "7", "g(r) flattens sooner along the director than across it", g_flattens, Reach::kEitherWay,
       "the paper's sentence is not consistent in itself; this is its main clause"},
      {"splay-bend", "elasticity", "Splay costs more than bend, K₁ > K₃", splay_stiffer_than_bend, Reach::kEitherWay,
       "the paper concludes it from G₂ falling faster across the director; in linear theory, ⟨δθ²⟩ ~ 1/(K₁q_across² "
       "+ K₃q_along²), that means the reverse, K₁ < K₃"},

      {"layers", "8", "Layers at ±θ_m, about 10°, for ℓ = 4.5 mm from 0.80 on, and none at 0.75", layers_when_dense},
      {"g2-oscillates", "8", "Where there are layers, G₂ oscillates across the director", g2_oscillates},
      {"gap", "gap", "No layers at gaps of 1.4 and 1.6 mm", no_layers_at_wide_gaps},
      {"crystal", "gap", "At a gap of 0.9 mm a crystal, without layers", crystal_at_a_narrow_gap, Reach::kCannotAgree,
       "all runs start as a crystal"},
      {"angle-packing", "layer-trends", "θ_m grows with packing", angle_grows_with_packing},
      {"angle-length", "layer-trends", "θ_m falls with rod length", angle_falls_with_length},
      {"angle-end", "layer-trends", "θ_m falls with the end radius", angle_falls_with_end},
      {"peaks-end", "layer-trends", "P(θ) has two peaks at every end radius", two_peaks_at_every_end},
      {"wavelength-packing", "layer-trends", "The wavelength grows from 0.85 to 0.80", wavelength_falls_with_packing},
      {"wavelength-length", "layer-trends", "The wavelength grows with rod length", wavelength_grows_with_length},
      {"wavelength-end", "layer-trends", "The wavelength grows with the end radius", wavelength_grows_with_end},
      {"larger-box", "larger-box", "In a larger box the wavelength is larger and θ_m smaller", larger_box},

      {"tilt", "10", "Rods swim against their tilt, fastest near n_z = ±0.2, the other way beyond 0.3",
       tilt_and_velocity},
      {"sideways", "10", "Across the rod ⟨v⟩ = 0 at every tilt", no_motion_sideways},
      {"switching", "10", "The tilt of a rod switches from one sign to the other", tilt_switches},
      {"persistence", "11", "Ways of single rods persist longer at 0.85 than at 0.65", persists_when_dense},
      {"diffusion-rises", "9", "Short rods diffuse faster when denser", diffusion_rises},
      {"diffusion-law", "9", "D = 1.7 + 480 (φ − 0.64)² mm²/s for ℓ = 2.5 mm", diffusion_law, Reach::kEitherWay,
       "the paper prints MSD = 2Dt; read here as 4Dt in the plane, which fits at 0.65"},
      {"diffusion-normal", "9", "Short rods diffuse normally at short and at long times", diffusion_is_normal},
      {"diffusion-along", "9",
       "Along the director D rises up to 0.80, then falls; across it D falls, and is smaller (ℓ = 4.5 mm)",
       diffusion_along_the_director},
      {"diffusion-across", "9", "Across the director nothing is super-diffusive, and the exponent at short times falls",
       no_superdiffusion_across},
      {"memory", "12", "C₂ and C_v decay more slowly when denser (ℓ = 2.5 mm)", slower_when_denser},
      {"c2-plateau", "12", "C₂ of long rods levels off, near 1 when dense", c2_levels_off},
      {"velocity-along", "12", "C_v along the director grows with packing up to 0.80 (ℓ = 4.5 mm)",
       velocity_along_grows},
      {"rotation", "13", "The rotational diffusion constant falls with packing (ℓ = 2.5 mm)", rotation_slows},
      {"rotation-short", "13", "At short times rotation is sub-diffusive, the more so the denser",
       rotation_subdiffusive},
      {"rotation-saturates", "13",
       "The angle turned levels off in the nematic and grows linearly in disorder (ℓ = 4.5 mm)", turning_saturates},
      {"defects", "14", "Defects of a system that is ordered here and there move by themselves (ℓ = 3.0 mm at 0.85)",
       defects_move, Reach::kEitherWay, "the paper's text has ℓ = 0.3 mm, its caption 3.0 mm"},
  };
  return kClaims;
}

std::vector<Claim> claims_of(std::span<const std::string_view> figures) {
  std::vector<Claim> chosen;
  for (const Claim& claim : paper_claims()) {
    if (figures.empty() || std::find(figures.begin(), figures.end(), claim.figure) != figures.end()) {
      chosen.push_back(claim);
    }
  }
  return chosen;
}

std::string_view word(Verdict verdict) {
  switch (verdict) {
    case Verdict::kAgrees:
      return "agrees";
    case Verdict::kPartly:
      return "in part";
    case Verdict::kDisagrees:
      return "disagrees";
    case Verdict::kUnresolved:
      return "not resolved";
    case Verdict::kNoData:
      break;
  }
  return "no data";
}

std::string claims_table(const Library& runs, std::span<const Claim> claims) {
  std::string table = "| figure | the paper says | found here | verdict |\n|---|---|---|---|\n";
  for (const Claim& claim : claims) {
    const Finding finding = claim.check(runs);
    std::string says(claim.says), verdict(word(finding.verdict));
    if (claim.reach == Reach::kCannotAgree) says += ". *Runs like these can refute it only:* ";
    if (claim.reach == Reach::kCannotDisagree) says += ". *Runs like these can confirm it only:* ";
    if (claim.reach == Reach::kEitherWay && !claim.note.empty()) says += ". *Note:* ";
    says += claim.note;
    if (finding.verdict == Verdict::kDisagrees) verdict.insert(0, "**").append("**");
    if (!finding.why.empty()) verdict += ": " + finding.why;
    table += fmt::format("| {} | {} | {} | {} |\n", claim.figure, says, finding.found, verdict);
  }
  return table;
}

Json claims_json(const Library& runs, std::span<const Claim> claims) {
  Json list = Json::array();
  for (const Claim& claim : claims) {
    const Finding finding = claim.check(runs);
    list.push_back({{"claim", claim.id},
                    {"figure", claim.figure},
                    {"says", claim.says},
                    {"verdict", word(finding.verdict)},
                    {"found", finding.found},
                    {"why", finding.why},
                    {"note", claim.note}});
  }
  return list;
}

}  // namespace shaken::study
