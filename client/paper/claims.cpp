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

/// What runs say to a yes-or-no question, if they can tell.
enum class Answer { kYes, kNo, kUnknown };

Answer answer(bool yes) { return yes ? Answer::kYes : Answer::kNo; }

/// All yes: agrees. All no: disagrees. Some of both: in part. Otherwise it is open.
Verdict verdict_of(const std::vector<Answer>& answers) {
  const auto n = [&](Answer wanted) { return std::count(answers.begin(), answers.end(), wanted); };
  if (answers.empty()) return Verdict::kNoData;
  if (n(Answer::kYes) > 0 && n(Answer::kNo) > 0) return Verdict::kPartly;
  if (n(Answer::kUnknown) > 0) return Verdict::kUnresolved;
  return n(Answer::kYes) > 0 ? Verdict::kAgrees : Verdict::kDisagrees;
}

/// Of what is said to hold everywhere: one no is enough.
Verdict verdict_everywhere(const std::vector<Answer>& answers) {
  const bool refuted = std::find(answers.begin(), answers.end(), Answer::kNo) != answers.end();
  return refuted ? Verdict::kDisagrees : verdict_of(answers);
}

bool has_error(const Quantity& q) { return q.is_known() && std::isfinite(q.sem); }

/// a > b, by their errors. A number without an error tells nothing.
Answer larger(const Quantity& a, const Quantity& b) {
  if (!has_error(a) || !has_error(b)) return Answer::kUnknown;
  const double margin = kSigmas * std::hypot(a.sem, b.sem);
  if (a.value - b.value > margin) return Answer::kYes;
  return b.value - a.value > margin ? Answer::kNo : Answer::kUnknown;
}
Answer above(const Quantity& q, double level) { return larger(q, {level, 0}); }
Answer below(const Quantity& q, double level) { return larger({level, 0}, q); }

/// Within `tolerance` of `target`, with its error to spare.
Answer close_to(const Quantity& q, double target, double tolerance) {
  if (!has_error(q)) return Answer::kUnknown;
  const double away = std::abs(q.value - target);
  if (away + kSigmas * q.sem <= tolerance) return Answer::kYes;
  return away - kSigmas * q.sem > tolerance ? Answer::kNo : Answer::kUnknown;
}

/// With at least `digits` decimals, and as many as the error needs to show.
std::string text(const Quantity& q, int digits = 2) {
  if (!q.is_known()) return "-";
  if (!std::isfinite(q.sem)) return fmt::format("{:.{}f} ± ?", q.value, digits);
  if (q.sem > 0) digits = std::clamp(static_cast<int>(std::ceil(-std::log10(q.sem))), digits, 6);
  return fmt::format("{:.{}f} ± {:.{}f}", q.value, digits, q.sem, digits);
}

RunSet of(const Library& runs, const char* set, double length, double fraction) {
  return where(where(runs[set], "rods.length", length), "rods.area_fraction", fraction);
}

/// Runs of the layered sweep with the default ends.
RunSet layers(const Library& runs, double length, double fraction, double end_diameter = 0.4) {
  return where(of(runs, "layers", length, fraction), "rods.end_diameter", end_diameter);
}

/// A scalar at each value of a key, in words.
std::string values_text(const RunSet& runs, const std::string& key, const std::string& scalar, int digits) {
  std::string words;
  for (const double value : values_of(runs, key)) {
    words += fmt::format("{}{} at {}", words.empty() ? "" : "; ",
                         text(mean_scalar(where(runs, key, value), scalar), digits), value_label(key, value));
  }
  return words;
}

/// A scalar at the values of a key, and whether it rises (or falls) from the first to the last at which it is known.
Finding trend(const RunSet& runs, const std::string& key, const std::string& scalar, bool rising, int digits,
              const std::string& unit) {
  const std::vector<double> values = values_of(runs, key);
  if (values.size() < 2) return {};
  std::vector<Quantity> known;
  for (const double value : values) {
    const Quantity quantity = mean_scalar(where(runs, key, value), scalar);
    if (has_error(quantity)) known.push_back(quantity);
  }
  const Answer answer = known.size() < 2 ? Answer::kUnknown
                        : rising         ? larger(known.back(), known.front())
                                         : larger(known.front(), known.back());
  return {verdict_of({answer}), values_text(runs, key, scalar, digits) + unit};
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
  if (here.empty()) return {};
  const Quantity s = mean_scalar(here, "order.mean");
  return {verdict_of({close_to(s, 0.9, 0.05)}), "S = " + text(s, 3)};
}

/// Of rods that do not know of each other.
double random_order(const FinishedRun& run) { return std::sqrt(std::numbers::pi / (4 * run.scalar("n_rods").value)); }

Finding disordered_when_dilute(const Library& runs) {
  const RunSet here = of(runs, "phases", 4.5, 0.45);
  if (here.empty()) return {};
  const Quantity s = mean_scalar(here, "order.mean");
  const double floor = random_order(here.front());
  return {verdict_of({below(s, 3 * floor)}), fmt::format("S = {} (independent rods: {:.3f})", text(s, 3), floor)};
}

Finding short_rods_do_not_order(const Library& runs) {
  Finding finding;
  std::vector<Answer> answers;
  double largest = -1;
  for (const double length : {2.5, 3.0}) {
    for (const double fraction : values_of(runs["phases"], "rods.area_fraction")) {
      const RunSet here = of(runs, "phases", length, fraction);
      if (here.empty()) continue;
      const Quantity s = mean_scalar(here, "order.mean");
      answers.push_back(below(s, 0.5));
      if (!s.is_known() || s.value <= largest) continue;
      largest = s.value;
      finding.found = fmt::format("largest S = {} at {}, {}", text(s), value_label("rods.length", length),
                                  value_label("rods.area_fraction", fraction));
    }
  }
  finding.verdict = verdict_everywhere(answers);
  return finding;
}

Finding transition_falls_with_length(const Library& runs) {
  if (runs["phases"].empty()) return {};
  Finding finding;
  std::vector<Quantity> found;
  for (const double length : {3.5, 4.0, 4.5}) {
    const Quantity phi = transition(runs, length);
    finding.found += fmt::format("{}{}: {}", finding.found.empty() ? "" : "; ", value_label("rods.length", length),
                                 phi.is_known() ? text(phi, 3) : "not passed");
    if (phi.is_known()) found.push_back(phi);
  }
  finding.verdict = found.size() < 2 ? Verdict::kUnresolved : verdict_of({larger(found.front(), found.back())});
  return finding;
}

Finding broadest_at_the_transition(const Library& runs) {
  const RunSet longest = where(runs["phases"], "rods.length", 4.5);
  const Quantity phi = transition(runs, 4.5);
  double widest = 0, place = NAN;
  for (const double fraction : values_of(longest, "rods.area_fraction")) {
    const double spread = order_spread(where(longest, "rods.area_fraction", fraction));
    if (!(spread > widest)) continue;
    widest = spread;
    place = fraction;
  }
  if (std::isnan(place)) return {};
  const std::string found = fmt::format("S scatters most, by {:.3f}, at {}; the transition is at {}", widest,
                                        value_label("rods.area_fraction", place), text(phi, 3));
  // as near as the steps of the sweep allow
  return {verdict_of({close_to(phi, place, 0.055)}), found};
}

/// Means over five neighbouring places.
std::vector<double> smoothed(const std::vector<double>& values) {
  std::vector<double> means(values.size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    const std::size_t from = k < 2 ? 0 : k - 2, to = std::min(k + 3, values.size());
    for (std::size_t j = from; j < to; ++j) means[k] += values[j] / static_cast<double>(to - from);
  }
  return means;
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

/// Independent samples of S below which the shape of P[S] is left to chance.
constexpr double kSamplesForAShape = 50;

Finding one_peak(const Library& runs) {
  Finding finding;
  std::vector<Answer> answers;
  for (const FinishedRun& run : where(runs["phases"], "rods.length", 4.5)) {
    const auto& density = run.array("/order/pdf/density");
    if (density.empty()) continue;
    const int peaks = n_peaks(smoothed(density));
    const double n = run.scalar("order.n_effective").value;
    answers.push_back(peaks == 1 ? Answer::kYes : n > kSamplesForAShape ? Answer::kNo : Answer::kUnknown);
    if (peaks == 1) continue;
    finding.found += fmt::format("{}{} peaks at {} ({:.0f} independent samples)", finding.found.empty() ? "" : "; ",
                                 peaks, value_label("rods.area_fraction", run.number("rods.area_fraction")), n);
  }
  finding.verdict = verdict_everywhere(answers);
  if (finding.verdict == Verdict::kAgrees) finding.found = "one peak at every packing";
  return finding;
}

Finding g2_decays_or_levels(const Library& runs) {
  const double shortest = tail(of(runs, "phases", 2.5, 0.80), "/g2/g2");
  const double longest = tail(of(runs, "phases", 4.5, 0.80), "/g2/g2");
  if (std::isnan(shortest) || std::isnan(longest)) return {};
  return {verdict_of({answer(shortest < 0.25), answer(longest > 0.5)}),
          fmt::format("at half a box and φ = 0.80: {:.2f} for ℓ = 2.5 mm, {:.2f} for ℓ = 4.5 mm", shortest, longest)};
}

/// Mean and error of along - across in the farther half; the error from the scatter of the places, of which about one
/// in four is taken as independent.
Quantity excess(const FinishedRun& run) {
  const auto &along = run.array("/pairs/cut/g2_along"), &across = run.array("/pairs/cut/g2_across");
  double sum = 0, squares = 0, n = 0;
  for (std::size_t k = along.size() / 2; k < std::min(along.size(), across.size()); ++k) {
    const double difference = along[k] - across[k];
    if (!std::isfinite(difference)) continue;
    sum += difference;
    squares += difference * difference;
    n += 1;
  }
  if (n < 8) return {};
  const double mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / (n / 4))};
}

Finding g2_anisotropic(const Library& runs) {
  const RunSet here = layers(runs, 4.5, 0.75);
  if (here.empty()) return {};
  const Quantity difference = excess(here.front());
  return {verdict_of({above(difference, 0)}),
          fmt::format("far out, φ = 0.75: {:.3f} along, {:.3f} across, difference {}",
                      tail(here, "/pairs/cut/g2_along"), tail(here, "/pairs/cut/g2_across"), text(difference, 4))};
}

std::string layers_text(const Quantity& theta) {
  return theta.is_known() ? "θ_m = ±" + text(theta, 1) + "°" : "one peak";
}

Finding layers_when_dense(const Library& runs) {
  Finding finding;
  std::vector<Answer> answers;
  for (const double fraction : {0.75, 0.80, 0.85}) {
    const RunSet here = layers(runs, 4.5, fraction);
    if (here.empty()) continue;
    const Quantity theta = mean_scalar(here, "theta_m_deg");
    finding.found += fmt::format("{}{}: {}", finding.found.empty() ? "" : "; ",
                                 value_label("rods.area_fraction", fraction), layers_text(theta));
    if (fraction < 0.78) {
      answers.push_back(answer(!theta.is_known()));
    } else {
      answers.push_back(theta.is_known() ? close_to(theta, 10, 4) : Answer::kNo);
    }
  }
  finding.verdict = verdict_of(answers);
  return finding;
}

Finding no_layers_at_other_gaps(const Library& runs) {
  const RunSet reference = layers(runs, 4.5, 0.80);
  const RunSet narrow = where(runs["gaps"], "box.gap", 0.9), wide = where(runs["gaps"], "box.gap", 1.4);
  if (reference.empty() || narrow.empty() || wide.empty()) return {};
  Finding finding;
  for (const auto& [gap, set] : {std::pair{0.9, &narrow}, {1.2, &reference}, {1.4, &wide}}) {
    finding.found += fmt::format("{}w = {} mm: {}, layer order {}, Bragg peak {}", finding.found.empty() ? "" : "; ",
                                 gap, layers_text(mean_scalar(*set, "theta_m_deg")),
                                 text(mean_scalar(*set, "layer_order")), text(mean_scalar(*set, "bragg_peak"), 3));
  }
  finding.verdict = verdict_of({answer(!mean_scalar(narrow, "theta_m_deg").is_known()),
                                answer(!mean_scalar(wide, "theta_m_deg").is_known()),
                                larger(mean_scalar(narrow, "bragg_peak"), mean_scalar(reference, "bragg_peak"))});
  return finding;
}

RunSet layered_by_packing(const Library& runs) { return joined(layers(runs, 4.5, 0.80), layers(runs, 4.5, 0.85)); }
RunSet layered_by_length(const Library& runs) {
  RunSet found;
  for (const double length : {3.5, 4.0, 4.5}) found = joined(found, layers(runs, length, 0.85));
  return found;
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
/// A trend of the wavelength, over runs that have layers.
Finding wavelength_trend(const RunSet& runs, const std::string& key, bool rising) {
  const RunSet with_layers = layered(runs);
  if (values_of(runs, key).size() < 2) return {};
  if (values_of(with_layers, key).size() < 2) {
    return {Verdict::kUnresolved, "layers at " + std::to_string(values_of(with_layers, key).size()) + " of " +
                                      std::to_string(values_of(runs, key).size()) + " points"};
  }
  return trend(with_layers, key, "wavelength_mm", rising, 1, " (mm)");
}

Finding wavelength_falls_with_packing(const Library& runs) {
  return wavelength_trend(layered_by_packing(runs), "rods.area_fraction", false);
}
Finding wavelength_grows_with_length(const Library& runs) {
  return wavelength_trend(layered_by_length(runs), "rods.length", true);
}
Finding wavelength_grows_with_end(const Library& runs) {
  return wavelength_trend(layered_by_end(runs), "rods.end_diameter", true);
}

Finding larger_box(const Library& runs) {
  const RunSet& large = runs["large"];
  const RunSet small = large.empty() ? large : at_point_of(runs["layers"], large.front());
  if (small.empty()) return {};
  const Quantity lambda[] = {mean_scalar(layered(small), "wavelength_mm"),
                             mean_scalar(layered(large), "wavelength_mm")};
  const Quantity theta[] = {mean_scalar(small, "theta_m_deg"), mean_scalar(large, "theta_m_deg")};
  return {verdict_of({larger(lambda[1], lambda[0]), larger(theta[0], theta[1])}),
          fmt::format("{}, {}: λ = {} mm and {} mm, θ_m = {}° and {}°, boxes of {:.1f} and {:.1f} mm",
                      value_label("rods.length", large.front().number("rods.length")),
                      value_label("rods.area_fraction", large.front().number("rods.area_fraction")), text(lambda[0], 1),
                      text(lambda[1], 1), text(theta[0], 1), text(theta[1], 1), small.front().number("box.side"),
                      large.front().number("box.side"))};
}

Finding diffusion_law(const Library& runs) {
  const RunSet shortest = where(runs["phases"], "rods.length", 2.5);
  Finding finding;
  std::vector<Answer> answers;
  for (const double fraction : values_of(shortest, "rods.area_fraction")) {
    if (fraction < 0.64) continue;
    const Quantity d = mean_scalar(where(shortest, "rods.area_fraction", fraction), "diffusion_mm2_s");
    const double law = papers_diffusion(fraction);
    finding.found += fmt::format("{}{}: {} ({:.1f})", finding.found.empty() ? "D in mm²/s (the paper's fit): " : "; ",
                                 value_label("rods.area_fraction", fraction), text(d, 1), law);
    answers.push_back(close_to(d, law, 0.2 * law));
  }
  finding.verdict = verdict_of(answers);
  return finding;
}

Finding diffusion_rises(const Library& runs) {
  RunSet dense;
  for (const FinishedRun& run : where(runs["phases"], "rods.length", 2.5)) {
    if (run.number("rods.area_fraction") > 0.62) dense.push_back(run);
  }
  return trend(dense, "rods.area_fraction", "diffusion_mm2_s", true, 1, " (mm²/s)");
}

Finding diffusion_along_the_director(const Library& runs) {
  const RunSet longest = where(runs["phases"], "rods.length", 4.5);
  if (longest.empty()) return {};
  const auto at = [&](const char* scalar, double phi) {
    return mean_scalar(where(longest, "rods.area_fraction", phi), scalar);
  };
  const Quantity a70 = at("diffusion_along_mm2_s", 0.70), a80 = at("diffusion_along_mm2_s", 0.80),
                 a85 = at("diffusion_along_mm2_s", 0.85);
  const Quantity c70 = at("diffusion_across_mm2_s", 0.70), c80 = at("diffusion_across_mm2_s", 0.80);
  return {verdict_of({larger(a80, a70), larger(a80, a85), larger(c70, c80), larger(a80, c80)}),
          fmt::format("along: {} at 0.70, {} at 0.80, {} at 0.85; across: {} at 0.70, {} at 0.80 (mm²/s)", text(a70),
                      text(a80), text(a85), text(c70), text(c80))};
}

Finding tilt_and_velocity(const Library& runs) {
  const RunSet here = where(runs["mechanism"], "rods.area_fraction", 0.60);
  if (here.empty()) return {};
  const Quantity fastest = mean_scalar(here, "tilt_fastest_n_z"), speed = mean_scalar(here, "tilt_fastest_mm_s");
  const Quantity zero = mean_scalar(here, "tilt_reversal_n_z"), beyond = mean_scalar(here, "tilt_reversal_sigmas");
  const bool reverses = zero.is_known() && std::abs(zero.value - 0.3) < 0.05 && beyond.value > 3;
  return {verdict_of({below(speed, 0), answer(std::abs(fastest.value - 0.2) < 0.04), answer(reverses)}),
          fmt::format("fastest at n_z = ±{:.2f}, {} mm/s along the tilt; {}", fastest.value, text(speed),
                      zero.is_known() ? fmt::format("reversed beyond {:.2f} by {:.0f} errors", zero.value, beyond.value)
                                      : "no reversal seen")};
}

Finding slower_when_denser(const Library& runs) {
  const RunSet shortest = where(runs["phases"], "rods.length", 2.5);
  const Finding c2 = trend(shortest, "rods.area_fraction", "c2_decay_s", true, 2, " s");
  const Finding cv = trend(shortest, "rods.area_fraction", "velocity_correlation_s", true, 2, " s");
  if (c2.verdict == Verdict::kNoData || cv.verdict == Verdict::kNoData) return {};
  return {c2.verdict == cv.verdict ? c2.verdict : Verdict::kPartly, "C₂: " + c2.found + ". C_v: " + cv.found};
}

Finding rotation_slows(const Library& runs) {
  return trend(where(runs["phases"], "rods.length", 2.5), "rods.area_fraction", "rotational_diffusion_rad2_s", false, 3,
               " (rad²/s)");
}

Finding rotation_subdiffusive(const Library& runs) {
  const RunSet shortest = where(runs["phases"], "rods.length", 2.5);
  const std::vector<double> fractions = values_of(shortest, "rods.area_fraction");
  if (fractions.size() < 2) return {};
  const auto at = [&](double phi) {
    return mean_scalar(where(shortest, "rods.area_fraction", phi), "alpha_rotation_short");
  };
  return {verdict_of({below(at(fractions.back()), 1), larger(at(fractions.front()), at(fractions.back()))}),
          "exponent " + values_text(shortest, "rods.area_fraction", "alpha_rotation_short", 2)};
}

Finding defects_move(const Library& runs) {
  const RunSet here = with_most_defects(runs["defects"]);
  if (here.empty()) return {};
  const Quantity plus = mean_scalar(here, "lasting_defect_speed_plus_mm_s"),
                 minus = mean_scalar(here, "lasting_defect_speed_minus_mm_s"),
                 along = mean_scalar(here, "lasting_defect_speed_plus_along_mm_s");
  const bool motile = has_error(along) && std::abs(along.value) > kSigmas * along.sem;
  return {motile ? Verdict::kAgrees : Verdict::kUnresolved,
          fmt::format("{}, {}: +1/2 move at {} mm/s, −1/2 at {} mm/s; +1/2 towards their own tail: {} mm/s",
                      value_label("rods.length", here.front().number("rods.length")),
                      value_label("rods.area_fraction", here.front().number("rods.area_fraction")), text(plus),
                      text(minus), text(along, 3))};
}

Finding long_range(const Library& runs) {
  const RunSet set = joined(where(runs["size"], "rods.area_fraction", 0.70), of(runs, "phases", 4.5, 0.70));
  const std::vector<double> sides = values_of(set, "box.side");
  if (sides.size() < 2) return {};
  const Quantity small = mean_scalar(where(set, "box.side", sides.front()), "order.mean"),
                 large = mean_scalar(where(set, "box.side", sides.back()), "order.mean");
  Finding finding{Verdict::kUnresolved, "S = " + values_text(set, "box.side", "order.mean", 3)};
  if (!has_error(small) || !has_error(large)) return finding;
  const double octaves = std::log(sides.back() / sides.front());
  const Quantity exponent{std::log(large.value / small.value) / octaves,
                          std::hypot(small.sem / small.value, large.sem / large.value) / octaves};
  // Quasi-long-range order is a small power too, at most L^-1/8 in an equilibrium nematic (Kosterlitz & Thouless):
  // boxes like these can rule long-range order out, not prove it.
  finding.found +=
      fmt::format("; S ~ L^x with x = {}; quasi-long-range order would be a small power as well", text(exponent, 3));
  if (below(exponent, -0.125) == Answer::kYes || below(large, 0.5) == Answer::kYes)
    finding.verdict = Verdict::kDisagrees;
  return finding;
}

Finding oblique_axis(const Library& runs) {
  const RunSet here = layers(runs, 3.5, 0.85);
  if (here.empty()) return {};
  const Quantity s = mean_scalar(here, "order.mean");
  const auto &time = here.front().array("/order/time_s"), &angle = here.front().array("/order/director_rad");
  const double steady = here.front().scalar("t_steady_s").value;
  // the director's own mean, as an axis
  double c = 0, d = 0;
  for (std::size_t k = 0; k < std::min(time.size(), angle.size()); ++k) {
    if (time[k] < steady) continue;
    c += std::cos(2 * angle[k]);
    d += std::sin(2 * angle[k]);
  }
  const double degrees = std::atan2(d, c) / 2 * 180 / std::numbers::pi;
  const double to_side = std::min(std::abs(degrees), 90 - std::abs(degrees));
  const Answer ordered = above(s, 0.5);
  return {ordered == Answer::kYes && to_side > 10 ? Verdict::kAgrees
          : ordered == Answer::kNo                ? Verdict::kDisagrees
                                                  : Verdict::kUnresolved,
          fmt::format("S = {}, director {:.0f}° from the nearest side of the box", text(s), to_side)};
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
      {"defects", "defects",
       "Defects of a system that is ordered here and there move by themselves (the paper: ℓ = 3.0 mm at 0.85)",
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
