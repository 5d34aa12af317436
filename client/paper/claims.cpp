// SPDX-License-Identifier: MIT
#include "client/paper/claims.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "client/failure.h"
#include "client/paper/panels.h"

namespace shaken::client {
namespace {

/// Errors by which two numbers must differ before they count as different.
constexpr double kSigmas = 2;

std::string text(const Quantity& q, int digits = 2) {
  if (!q.is_known()) return "-";
  if (!std::isfinite(q.sem)) return fmt::format("{:.{}f}", q.value, digits);
  return fmt::format("{:.{}f} ± {:.{}f}", q.value, digits, q.sem, digits);
}

RunSet of(const Library& runs, const char* set, double length, double fraction) {
  return where(where(runs[set], "rods.length", length), "rods.area_fraction", fraction);
}

/// Runs of the layered sweep with the default ends.
RunSet layers(const Library& runs, double length, double fraction, double end_diameter = 0.4) {
  return where(of(runs, "layers", length, fraction), "rods.end_diameter", end_diameter);
}

double sem_or_zero(const Quantity& q) { return std::isfinite(q.sem) ? q.sem : 0.0; }
double difference_in_sigmas(const Quantity& a, const Quantity& b) {
  const double error = std::hypot(sem_or_zero(a), sem_or_zero(b));
  return error > 0 ? (a.value - b.value) / error
                   : (a.value == b.value ? 0 : std::copysign(INFINITY, a.value - b.value));
}

Verdict rises(const Quantity& from, const Quantity& to) {
  const double sigmas = difference_in_sigmas(to, from);
  if (sigmas > kSigmas) return Verdict::kAgrees;
  return sigmas < -kSigmas ? Verdict::kDisagrees : Verdict::kUnresolved;
}

/// A scalar at the values of a key, and whether it rises (or falls) from the first to the last of them.
Finding trend(const RunSet& runs, const std::string& key, const std::string& scalar, bool rising, int digits,
              const std::string& unit) {
  const Curve curve = scalar_curve(runs, key, scalar, "", 0);
  if (curve.x.size() < 2) return {};
  Finding finding;
  for (std::size_t k = 0; k < curve.x.size(); ++k) {
    finding.found += fmt::format("{}{} at {}", k > 0 ? "; " : "", text({curve.y[k], curve.y_error[k]}, digits),
                                 value_label(key, curve.x[k]));
  }
  finding.found += unit;
  const Quantity first{curve.y.front(), curve.y_error.front()}, last{curve.y.back(), curve.y_error.back()};
  finding.verdict = rising ? rises(first, last) : rises(last, first);
  return finding;
}

/// Area fraction at which <S> passes 0.5 for rods of this length.
Quantity transition(const Library& runs, double length) {
  return crossing(scalar_curve(where(runs["phases"], "rods.length", length), "rods.area_fraction", "order.mean", "", 0),
                  0.5);
}

/// Mean of an array over the last quarter of its places.
double tail(const RunSet& runs, const char* array) {
  double sum = 0, n = 0;
  for (const FinishedRun& run : runs) {
    const auto& values = run.array(array);
    for (std::size_t k = 3 * values.size() / 4; k < values.size(); ++k) {
      if (!std::isfinite(values[k])) continue;
      sum += values[k];
      n += 1;
    }
  }
  return n > 0 ? sum / n : NAN;
}

Finding ordered_when_dense(const Library& runs) {
  const RunSet here = of(runs, "phases", 4.5, 0.75);
  const Quantity s = mean_scalar(here, "order.mean");
  if (!s.is_known()) return {};
  return {std::abs(s.value - 0.9) < std::max(0.05, kSigmas * sem_or_zero(s)) ? Verdict::kAgrees : Verdict::kDisagrees,
          "S = " + text(s, 3)};
}

Finding disordered_when_dilute(const Library& runs) {
  const RunSet here = of(runs, "phases", 4.5, 0.45);
  const Quantity s = mean_scalar(here, "order.mean");
  if (!s.is_known()) return {};
  const double floor = std::sqrt(std::numbers::pi / (4 * here.front().scalar("n_rods").value));
  return {s.value < 0.5 ? Verdict::kAgrees : Verdict::kDisagrees,
          fmt::format("S = {} (independent rods: {:.3f})", text(s, 3), floor)};
}

Finding short_rods_do_not_order(const Library& runs) {
  Finding finding;
  double largest = -1;
  for (const double length : {2.5, 3.0}) {
    for (const double fraction : values_of(runs["phases"], "rods.area_fraction")) {
      const Quantity s = mean_scalar(of(runs, "phases", length, fraction), "order.mean");
      if (!s.is_known() || s.value <= largest) continue;
      largest = s.value;
      finding.found = fmt::format("largest S = {} at {}, {}", text(s), value_label("rods.length", length),
                                  value_label("rods.area_fraction", fraction));
    }
  }
  if (largest < 0) return {};
  finding.verdict = largest < 0.5 ? Verdict::kAgrees : Verdict::kDisagrees;
  return finding;
}

Finding transition_falls_with_length(const Library& runs) {
  Finding finding;
  std::vector<Quantity> found;
  for (const double length : {3.5, 4.0, 4.5}) {
    const Quantity phi = transition(runs, length);
    finding.found += fmt::format("{}{}: {}", finding.found.empty() ? "" : "; ", value_label("rods.length", length),
                                 phi.is_known() ? text(phi, 3) : "not passed");
    if (phi.is_known()) found.push_back(phi);
  }
  if (runs["phases"].empty()) return {};
  finding.verdict = found.size() < 2 ? Verdict::kUnresolved : rises(found.back(), found.front());
  return finding;
}

Finding broadest_at_the_transition(const Library& runs) {
  const Curve spread =
      scalar_curve(where(runs["phases"], "rods.length", 4.5), "rods.area_fraction", "order.std", "", 0);
  const Quantity phi = transition(runs, 4.5);
  if (spread.y.empty() || !phi.is_known()) return {};
  const auto widest = static_cast<std::size_t>(std::max_element(spread.y.begin(), spread.y.end()) - spread.y.begin());
  return {std::abs(spread.x[widest] - phi.value) < 0.075 ? Verdict::kAgrees : Verdict::kDisagrees,
          fmt::format("S(t) scatters most, by {:.3f}, at {}; the transition is at {}", spread.y[widest],
                      value_label("rods.area_fraction", spread.x[widest]), text(phi, 3))};
}

/// Maxima of a density that stand at least a third of the largest one above the valleys beside them.
int n_peaks(const std::vector<double>& density) {
  const double largest = density.empty() ? 0 : *std::max_element(density.begin(), density.end());
  const double step = largest / 3;
  int peaks = 0;
  double low = 0, high = 0;
  bool climbing = true;
  for (std::size_t k = 0; k <= density.size(); ++k) {
    const double value = k < density.size() ? density[k] : 0;
    if (climbing) {
      high = std::max(high, value);
      if (value < high - step) {
        if (high - low >= step) ++peaks;
        climbing = false;
        low = value;
      }
    } else {
      low = std::min(low, value);
      if (value > low + step) {
        climbing = true;
        high = value;
      }
    }
  }
  return peaks;
}

Finding one_peak(const Library& runs) {
  Finding finding{Verdict::kAgrees, ""};
  for (const FinishedRun& run : where(runs["phases"], "rods.length", 4.5)) {
    const auto& density = run.array("/order/pdf/density");
    if (density.empty()) continue;
    const int peaks = n_peaks(density);
    if (peaks != 1) {
      finding.verdict = Verdict::kUnresolved;
      finding.found += fmt::format("{}{} peaks at {}", finding.found.empty() ? "" : "; ", peaks,
                                   value_label("rods.area_fraction", run.number("rods.area_fraction")));
    }
  }
  if (where(runs["phases"], "rods.length", 4.5).empty()) return {};
  if (finding.found.empty())
    finding.found = "one peak at every packing";
  else
    finding.found += " (S passes through its range only a few times in a run)";
  return finding;
}

Finding g2_decays_or_levels(const Library& runs) {
  const double shortest = tail(of(runs, "phases", 2.5, 0.80), "/g2/g2");
  const double longest = tail(of(runs, "phases", 4.5, 0.80), "/g2/g2");
  if (std::isnan(shortest) || std::isnan(longest)) return {};
  return {shortest < 0.25 && longest > 0.5 ? Verdict::kAgrees : Verdict::kPartly,
          fmt::format("at half a box and φ = 0.80: {:.2f} for ℓ = 2.5 mm, {:.2f} for ℓ = 4.5 mm", shortest, longest)};
}

Finding g2_anisotropic(const Library& runs) {
  const RunSet here = layers(runs, 4.5, 0.75);
  const double along = tail(here, "/pairs/cut/g2_along"), across = tail(here, "/pairs/cut/g2_across");
  if (std::isnan(along) || std::isnan(across)) return {};
  return {across < along ? Verdict::kAgrees : Verdict::kDisagrees,
          fmt::format("far out, φ = 0.75: {:.3f} along, {:.3f} across", along, across)};
}

Finding layers_when_dense(const Library& runs) {
  Finding finding;
  int n_layered = 0, n = 0;
  for (const double fraction : {0.75, 0.80, 0.85}) {
    const RunSet here = layers(runs, 4.5, fraction);
    if (here.empty()) continue;
    const Quantity theta = mean_scalar(here, "theta_m_deg");
    finding.found +=
        fmt::format("{}{}: {}", finding.found.empty() ? "" : "; ", value_label("rods.area_fraction", fraction),
                    theta.is_known() ? "θ_m = ±" + text(theta, 1) + "°" : "one peak");
    if (fraction < 0.78) continue;
    ++n;
    n_layered += theta.is_known() && theta.value > 7 && theta.value < 14;
  }
  if (n == 0) return {};
  finding.verdict = n_layered == n ? Verdict::kAgrees : (n_layered > 0 ? Verdict::kPartly : Verdict::kDisagrees);
  return finding;
}

Finding no_layers_at_other_gaps(const Library& runs) {
  Finding finding;
  const RunSet reference = layers(runs, 4.5, 0.80);
  const RunSet narrow = where(runs["gaps"], "box.gap", 0.9), wide = where(runs["gaps"], "box.gap", 1.4);
  if (reference.empty() || narrow.empty() || wide.empty()) return {};
  bool layered_elsewhere = false;
  for (const auto& [gap, set] : {std::pair{0.9, &narrow}, {1.2, &reference}, {1.4, &wide}}) {
    const Quantity theta = mean_scalar(*set, "theta_m_deg");
    finding.found += fmt::format("{}w = {} mm: {}, layer order {}, Bragg peak {}", finding.found.empty() ? "" : "; ",
                                 gap, theta.is_known() ? "θ_m = ±" + text(theta, 1) + "°" : "one peak",
                                 text(mean_scalar(*set, "layer_order")), text(mean_scalar(*set, "bragg_peak"), 3));
    if (set != &reference && theta.is_known()) layered_elsewhere = true;
  }
  const bool crystal =
      difference_in_sigmas(mean_scalar(narrow, "bragg_peak"), mean_scalar(reference, "bragg_peak")) > kSigmas;
  finding.verdict = !layered_elsewhere && crystal     ? Verdict::kAgrees
                    : (!layered_elsewhere || crystal) ? Verdict::kPartly
                                                      : Verdict::kDisagrees;
  return finding;
}

RunSet layered_by_packing(const Library& runs) {
  RunSet set = layers(runs, 4.5, 0.80);
  for (const FinishedRun& run : layers(runs, 4.5, 0.85)) set.push_back(run);
  return set;
}
RunSet layered_by_length(const Library& runs) {
  RunSet set = layers(runs, 4.0, 0.80);
  for (const FinishedRun& run : layers(runs, 4.5, 0.80)) set.push_back(run);
  return set;
}
RunSet layered_by_end(const Library& runs) { return of(runs, "layers", 4.5, 0.80); }

Finding angle_grows_with_packing(const Library& runs) {
  return trend(layered_by_packing(runs), "rods.area_fraction", "theta_m_deg", true, 1, " (degrees)");
}
Finding angle_falls_with_length(const Library& runs) {
  return trend(layered_by_length(runs), "rods.length", "theta_m_deg", false, 1, " (degrees)");
}
Finding angle_falls_with_end(const Library& runs) {
  return trend(layered_by_end(runs), "rods.end_diameter", "theta_m_deg", false, 1, " (degrees)");
}
Finding wavelength_falls_with_packing(const Library& runs) {
  return trend(layered_by_packing(runs), "rods.area_fraction", "wavelength_mm", false, 1, " (mm)");
}
Finding wavelength_grows_with_length(const Library& runs) {
  return trend(layered_by_length(runs), "rods.length", "wavelength_mm", true, 1, " (mm)");
}
Finding wavelength_grows_with_end(const Library& runs) {
  return trend(layered_by_end(runs), "rods.end_diameter", "wavelength_mm", true, 1, " (mm)");
}

Finding larger_box(const Library& runs) {
  const RunSet small = layers(runs, 4.5, 0.80);
  const RunSet& large = runs["large"];
  if (small.empty() || large.empty()) return {};
  const Quantity lambda[] = {mean_scalar(small, "wavelength_mm"), mean_scalar(large, "wavelength_mm")};
  const Quantity theta[] = {mean_scalar(small, "theta_m_deg"), mean_scalar(large, "theta_m_deg")};
  const Verdict longer = rises(lambda[0], lambda[1]);
  const Verdict flatter = theta[0].is_known() && theta[1].is_known() ? rises(theta[1], theta[0]) : Verdict::kUnresolved;
  return {longer == flatter ? longer : Verdict::kPartly,
          fmt::format("λ = {} mm and {} mm, θ_m = {}° and {}°, boxes of {:.1f} and {:.1f} mm", text(lambda[0], 1),
                      text(lambda[1], 1), text(theta[0], 1), text(theta[1], 1), small.front().number("box.side"),
                      large.front().number("box.side"))};
}

Finding diffusion_law(const Library& runs) {
  const RunSet shortest = where(runs["phases"], "rods.length", 2.5);
  Finding finding;
  int n = 0, n_good = 0;
  for (const double fraction : values_of(shortest, "rods.area_fraction")) {
    if (fraction < 0.64) continue;
    const Quantity d = mean_scalar(where(shortest, "rods.area_fraction", fraction), "diffusion_mm2_s");
    if (!d.is_known()) continue;
    const double law = 1.7 + 480 * (fraction - 0.64) * (fraction - 0.64);
    finding.found += fmt::format("{}{}: {} ({:.1f})", finding.found.empty() ? "D in mm²/s (the paper's fit): " : "; ",
                                 value_label("rods.area_fraction", fraction), text(d, 1), law);
    ++n;
    n_good += std::abs(d.value - law) < std::max(0.2 * law, kSigmas * sem_or_zero(d));
  }
  if (n == 0) return {};
  finding.verdict = n_good == n ? Verdict::kAgrees : (n_good > 0 ? Verdict::kPartly : Verdict::kDisagrees);
  return finding;
}

Finding diffusion_rises(const Library& runs) {
  RunSet dense;
  for (const FinishedRun& run : where(runs["phases"], "rods.length", 2.5)) {
    if (run.number("rods.area_fraction") > 0.59) dense.push_back(run);
  }
  return trend(dense, "rods.area_fraction", "diffusion_mm2_s", true, 1, " (mm²/s)");
}

Finding diffusion_along_the_director(const Library& runs) {
  const RunSet longest = where(runs["phases"], "rods.length", 4.5);
  const Curve along = scalar_curve(longest, "rods.area_fraction", "diffusion_along_mm2_s", "", 0);
  if (along.x.size() < 3) return {};
  const auto at = [&](const char* scalar, double phi) {
    return mean_scalar(where(longest, "rods.area_fraction", phi), scalar);
  };
  const Quantity a70 = at("diffusion_along_mm2_s", 0.70), a80 = at("diffusion_along_mm2_s", 0.80),
                 a85 = at("diffusion_along_mm2_s", 0.85);
  const Quantity c70 = at("diffusion_across_mm2_s", 0.70), c80 = at("diffusion_across_mm2_s", 0.80);
  if (!a70.is_known() || !a80.is_known() || !a85.is_known()) return {};
  const bool up = rises(a70, a80) == Verdict::kAgrees, down = rises(a85, a80) == Verdict::kAgrees;
  const bool across_falls = rises(c80, c70) == Verdict::kAgrees;
  const bool larger = difference_in_sigmas(a80, c80) > kSigmas;
  const int n = up + down + across_falls + larger;
  return {n == 4 ? Verdict::kAgrees : (n > 0 ? Verdict::kPartly : Verdict::kDisagrees),
          fmt::format("along: {} at 0.70, {} at 0.80, {} at 0.85; across: {} at 0.70, {} at 0.80 (mm²/s)", text(a70),
                      text(a80), text(a85), text(c70), text(c80))};
}

Finding tilt_and_velocity(const Library& runs) {
  const RunSet here = where(runs["mechanism"], "rods.area_fraction", 0.60);
  const Quantity fastest = mean_scalar(here, "tilt_fastest_n_z"), speed = mean_scalar(here, "tilt_fastest_mm_s");
  const Quantity zero = mean_scalar(here, "tilt_reversal_n_z"), beyond = mean_scalar(here, "tilt_reversal_sigmas");
  if (!speed.is_known()) return {};
  const bool opposite = speed.value < 0 && std::abs(speed.value) > kSigmas * sem_or_zero(speed);
  const bool place = std::abs(fastest.value - 0.2) < 0.04;
  const bool reverses = zero.is_known() && beyond.value > kSigmas;
  return {opposite && place && reverses ? Verdict::kAgrees : (opposite ? Verdict::kPartly : Verdict::kDisagrees),
          fmt::format("largest at n_z = ±{:.2f}, {} mm/s against the tilt; {}", fastest.value, text(speed),
                      zero.is_known() ? fmt::format("reversed beyond {:.2f} by {:.1f} errors", zero.value, beyond.value)
                                      : "no reversal seen")};
}

Finding slower_when_denser(const Library& runs) {
  const RunSet shortest = where(runs["phases"], "rods.length", 2.5);
  Finding c2 = trend(shortest, "rods.area_fraction", "c2_decay_s", true, 2, " (s)");
  const Finding cv = trend(shortest, "rods.area_fraction", "velocity_correlation_s", true, 2, " (s)");
  if (c2.verdict == Verdict::kNoData || cv.verdict == Verdict::kNoData) return {};
  return {c2.verdict == cv.verdict ? c2.verdict : Verdict::kPartly, "C_2: " + c2.found + ". C_v: " + cv.found};
}

Finding rotation_slows(const Library& runs) {
  return trend(where(runs["phases"], "rods.length", 2.5), "rods.area_fraction", "rotational_diffusion_rad2_s", false, 3,
               " (rad²/s)");
}

Finding rotation_subdiffusive(const Library& runs) {
  return trend(where(runs["phases"], "rods.length", 2.5), "rods.area_fraction", "alpha_rotation_short", false, 2, "");
}

Finding defects_move(const Library& runs) {
  const RunSet& here = runs["defects"];
  const Quantity plus = mean_scalar(here, "lasting_defect_speed_plus_mm_s"),
                 minus = mean_scalar(here, "lasting_defect_speed_minus_mm_s");
  const Quantity along = mean_scalar(here, "lasting_defect_speed_plus_along_mm_s");
  if (!plus.is_known() || !along.is_known()) return {};
  const bool motile = std::abs(along.value) > kSigmas * sem_or_zero(along);
  return {motile ? Verdict::kAgrees : Verdict::kUnresolved,
          fmt::format("+1/2 move at {} mm/s, −1/2 at {} mm/s; +1/2 towards their own tail: {} mm/s", text(plus),
                      text(minus), text(along, 3))};
}

Finding long_range(const Library& runs) {
  RunSet set = where(runs["size"], "rods.area_fraction", 0.70);
  for (const FinishedRun& run : of(runs, "phases", 4.5, 0.70)) set.push_back(run);
  Finding finding = trend(set, "box.side", "order.mean", false, 3, "");
  if (finding.verdict == Verdict::kNoData) return finding;
  const Curve curve = scalar_curve(set, "box.side", "order.mean", "", 0);
  const double exponent = std::log(curve.y.back() / curve.y.front()) / std::log(curve.x.back() / curve.x.front());
  finding.found = "S = " + finding.found + fmt::format("; S ~ L^{:.3f}", exponent);
  // Quasi-long-range order with exponent 1/4 in G2 would be S ~ L^-1/8 at the transition of an equilibrium nematic.
  finding.verdict = exponent > -0.03 ? Verdict::kAgrees : Verdict::kUnresolved;
  return finding;
}

Finding oblique_axis(const Library& runs) {
  const RunSet here = layers(runs, 3.5, 0.85);
  if (here.empty()) return {};
  const auto& angle = here.front().array("/order/director_rad");
  const Quantity s = mean_scalar(here, "order.mean");
  if (angle.empty()) return {};
  const double degrees = angle.back() * 180 / std::numbers::pi;
  return {std::abs(degrees) > 10 && s.value > 0.5 ? Verdict::kAgrees : Verdict::kUnresolved,
          fmt::format("S = {}, director at {:.0f}° to the side of the box at the end", text(s), degrees)};
}

}  // namespace

std::span<const Claim> paper_claims() {
  static constexpr Claim kClaims[] = {
      {"ordered", "2", "Long rods (ℓ = 4.5 mm) at area fraction 0.75 are ordered, S about 0.9", ordered_when_dense},
      {"disordered", "2", "At 0.45 they are not, S about 0", disordered_when_dilute},
      {"short", "2", "Rods shorter than 3.5 mm do not order at any packing", short_rods_do_not_order},
      {"transition", "2", "The area fraction at which order sets in falls with the length",
       transition_falls_with_length},
      {"unimodal", "3", "P[S] has one peak at every packing (ℓ = 4.5 mm)", one_peak},
      {"broadest", "3", "S fluctuates most near the transition", broadest_at_the_transition},
      {"g2", "4", "G₂(r) decays to 0 for ℓ = 2.5 mm and levels off for ℓ = 4.5 mm when dense", g2_decays_or_levels},
      {"anisotropy", "5", "G₂ falls faster across the director than along it", g2_anisotropic},
      {"long-range", "size", "The order is long-range", long_range},
      {"layers", "6", "Layers at ±θ_m, about 10°, for ℓ = 4.5 mm from 0.80 on", layers_when_dense},
      {"gap", "gap", "No layers at gaps 0.9 mm (a crystal) and 1.4 mm", no_layers_at_other_gaps},
      {"angle-packing", "7", "θ_m grows with packing", angle_grows_with_packing},
      {"angle-length", "7", "θ_m falls with rod length", angle_falls_with_length},
      {"angle-end", "7", "θ_m falls with the end radius", angle_falls_with_end},
      {"wavelength-packing", "7", "The wavelength grows from 0.85 to 0.80", wavelength_falls_with_packing},
      {"wavelength-length", "7", "The wavelength grows with rod length", wavelength_grows_with_length},
      {"wavelength-end", "7", "The wavelength grows with the end radius", wavelength_grows_with_end},
      {"larger-box", "larger-box", "In a larger box the wavelength is larger and θ_m smaller", larger_box},
      {"oblique", "steady", "ℓ = 3.5 mm at 0.85 orders along an oblique axis", oblique_axis},
      {"tilt", "8", "Rods swim against their tilt, fastest near n_z = ±0.2, the other way beyond 0.3",
       tilt_and_velocity},
      {"diffusion-rises", "9", "Short rods diffuse faster when denser", diffusion_rises},
      {"diffusion-law", "9", "D = 1.7 + 480 (φ − 0.64)² mm²/s for ℓ = 2.5 mm", diffusion_law},
      {"diffusion-along", "9",
       "Along the director D rises up to 0.80, then falls; across it D falls, and is smaller (ℓ = 4.5 mm)",
       diffusion_along_the_director},
      {"memory", "10", "C₂ and C_v decay more slowly when denser (ℓ = 2.5 mm)", slower_when_denser},
      {"rotation", "10", "The rotational diffusion constant falls with packing (ℓ = 2.5 mm)", rotation_slows},
      {"rotation-short", "10", "At short times rotation is sub-diffusive, the more so the denser",
       rotation_subdiffusive},
      {"defects", "defects", "Defects of the locally ordered system (ℓ = 3.0 mm, 0.85) move by themselves",
       defects_move},
  };
  return kClaims;
}

namespace {

std::string_view word(Verdict verdict) {
  switch (verdict) {
    case Verdict::kAgrees:
      return "agrees";
    case Verdict::kPartly:
      return "in part";
    case Verdict::kDisagrees:
      return "**disagrees**";
    case Verdict::kUnresolved:
      return "not resolved";
    case Verdict::kNoData:
      break;
  }
  return "no data";
}

}  // namespace

std::string claims_table(const Library& runs) {
  std::string table = "| figure | the paper says | found here | verdict |\n|---|---|---|---|\n";
  for (const Claim& claim : paper_claims()) {
    const Finding finding = claim.check(runs);
    table += fmt::format("| {} | {} | {} | {} |\n", claim.figure, claim.says, finding.found, word(finding.verdict));
  }
  return table;
}

Json claims_json(const Library& runs) {
  Json list = Json::array();
  for (const Claim& claim : paper_claims()) {
    const Finding finding = claim.check(runs);
    std::string verdict(word(finding.verdict));
    std::erase(verdict, '*');
    list.push_back({{"claim", claim.id},
                    {"figure", claim.figure},
                    {"says", claim.says},
                    {"verdict", verdict},
                    {"found", finding.found}});
  }
  return list;
}

std::string with_section(const std::string& document, const std::string& name, const std::string& table) {
  const std::string begin_mark = fmt::format("<!-- {}: begin -->\n", name);
  const std::string end_mark = fmt::format("<!-- {}: end -->", name);
  const std::size_t begin = document.find(begin_mark);
  const std::size_t end = document.find(end_mark);
  if (begin == std::string::npos || end == std::string::npos || end < begin) {
    throw Failure(ExitCode::kBadInput, fmt::format("the report lacks the lines {}{}", begin_mark, end_mark));
  }
  return document.substr(0, begin + begin_mark.size()) + table + document.substr(end);
}

}  // namespace shaken::client
