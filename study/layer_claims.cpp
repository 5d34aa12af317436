// SPDX-License-Identifier: MIT
// Layers at +-theta_m: whether there are any, and how angle and wavelength depend on rods, packing, gap and box.
#include <fmt/format.h>

#include <cmath>

#include "study/claim_checks.h"
#include "study/panels.h"

namespace shaken::study {
namespace {

/// P(0) / max P(theta): below it there are two peaks, above it there is one.
constexpr double kTwoPeaks = 0.95;

/// Whether P(theta) has two peaks. That none was found is no answer: the dip must be known to be shallow.
Answer two_peaks(const RunSet& runs) { return below(mean_scalar(runs, "dip"), kTwoPeaks); }

/// theta_m; "one peak" where the dip says so.
std::string layers_text(const RunSet& runs) {
  const Estimate theta = mean_scalar(runs, "theta_m_deg");
  if (is_known(theta)) return "θ_m = ±" + text(theta, 1) + "°";
  return "no second peak seen, dip to " + text(mean_scalar(runs, "dip"));
}

Answer negated(const Answer& answer) { return answer == yes() ? no() : answer == no() ? yes() : answer; }

/// The value of a curve at the place nearest to x.
Estimate value_at(const FinishedRun& run, const std::string& x_array, const std::string& y_array, double x) {
  const auto &xs = run.array(x_array), &ys = run.array(y_array), &errors = run.array(y_array + "_sem");
  std::size_t nearest = xs.size();
  for (std::size_t k = 0; k < std::min(xs.size(), ys.size()); ++k) {
    if (nearest == xs.size() || std::abs(xs[k] - x) < std::abs(xs[nearest] - x)) nearest = k;
  }
  if (nearest == xs.size()) return {};
  return run.estimate(ys[nearest], error_at(errors, nearest, ys.size()));
}

std::string gap_text(const RunSet& runs) {
  return fmt::format("w = {} mm: {}, layer order {}, Bragg peak {}", runs.front().number("box.gap"), layers_text(runs),
                     text(mean_scalar(runs, "layer_order")), text(mean_scalar(runs, "bragg_peak"), 3));
}

/// Runs that differ in one thing alone, of rods of one length.
struct Series {
  RunSet runs;
  std::string key;
};

std::vector<Series> by_packing(const Library& runs) {
  std::vector<Series> all;
  for (const double length : {4.0, 4.5}) {
    RunSet set;
    for (const double fraction : {0.80, 0.85}) set = joined(set, layers(runs, length, fraction));
    all.push_back({set, kPacking});
  }
  return all;
}
std::vector<Series> by_length(const Library& runs) {
  RunSet set;
  for (const double length : {3.5, 4.0, 4.5}) set = joined(set, layers(runs, length, 0.85));
  return {{set, kLength}};
}
std::vector<Series> by_end(const Library& runs) {
  return {{of(runs, "layers", 4.0, 0.85), "rods.end_diameter"}, {of(runs, "layers", 4.5, 0.80), "rods.end_diameter"}};
}

/// A trend of the layers, in series of which those decide that can tell.
Finding layer_trend(const std::vector<Series>& all, const std::string& scalar, bool rising, const std::string& unit) {
  Evidence evidence;
  for (const auto& [runs, key] : all) {
    if (values_of(runs, key).size() < 2) continue;
    const std::vector<Point> points = scalar_points(layered(runs), key, scalar);
    evidence.answer(points.size() < 2 ? unknown("layers at fewer than two points") : trend(points, rising));
    evidence.say((key == kLength ? "" : label_of(runs, kLength) + ": ") +
                 (points.empty() ? "no layers" : text(points, key, 1)));
  }
  return conclude(telling(evidence.answers), evidence.found + unit);
}

}  // namespace

Finding layers_when_dense(const Library& runs) {
  Evidence evidence;
  for (const double fraction : {0.75, 0.80, 0.85}) {
    const RunSet here = layers(runs, 4.5, fraction);
    if (here.empty()) continue;
    const bool layered_there = fraction > 0.78;
    const Answer two = two_peaks(here);
    evidence.answer(!layered_there ? negated(two)
                    : two == yes() ? close_to(mean_scalar(here, "theta_m_deg"), 10, 4)
                                   : two);
    evidence.say(value_label(kPacking, fraction) + ": " + layers_text(here));
  }
  return conclude(evidence);
}

Finding g2_oscillates(const Library& runs) {
  Evidence evidence;
  for (const double fraction : {0.80, 0.85}) {
    const RunSet here = layered(layers(runs, 4.5, fraction));
    if (here.empty()) continue;
    const Estimate rise = mean_over(here, [](const FinishedRun& run) {
      const double wavelength = run.scalar("wavelength_mm").value;
      const auto g2 = [&](double r) { return value_at(run, "/pairs/cut/r_mm", "/pairs/cut/g2_across", r); };
      const Estimate crest = g2(wavelength), trough = g2(wavelength / 2);
      return run.estimate(crest.value - trough.value, std::hypot(crest.sem, trough.sem));
    });
    evidence.answer(above(rise, 0));
    evidence.say(value_label(kPacking, fraction) + ": " + text(rise, 3));
  }
  return conclude(evidence, "G₂ across the director, a wavelength away less half a wavelength away: ");
}

Finding no_layers_at_wide_gaps(const Library& runs) {
  const RunSet reference = layers(runs, 4.5, 0.80);
  if (reference.empty()) return {};
  Evidence evidence;
  evidence.say(gap_text(reference));
  for (const double gap : {1.4, 1.6}) {
    const RunSet wide = where(runs["gaps"], "box.gap", gap);
    if (wide.empty()) continue;
    evidence.answer(negated(two_peaks(wide)));
    evidence.answer(larger(mean_scalar(reference, "layer_order"), mean_scalar(wide, "layer_order")));
    evidence.say(gap_text(wide));
  }
  return conclude(evidence);
}

Finding crystal_at_a_narrow_gap(const Library& runs) {
  const RunSet reference = layers(runs, 4.5, 0.80), narrow = where(runs["gaps"], "box.gap", 0.9);
  if (reference.empty() || narrow.empty()) return {};
  // A crystal that is there is that of the start; one that is gone would tell.
  const Answer more = larger(mean_scalar(narrow, "bragg_peak"), mean_scalar(reference, "bragg_peak"));
  return conclude({more == yes() ? unknown("the crystal is that of the start") : more,
                   two_peaks(narrow) == yes() ? no() : unknown("the crystal is that of the start")},
                  gap_text(reference) + "; " + gap_text(narrow));
}

Finding angle_grows_with_packing(const Library& runs) {
  return layer_trend(by_packing(runs), "theta_m_deg", true, " (degrees)");
}
Finding angle_falls_with_length(const Library& runs) {
  return layer_trend(by_length(runs), "theta_m_deg", false, " (degrees)");
}
Finding angle_falls_with_end(const Library& runs) {
  return layer_trend(by_end(runs), "theta_m_deg", false, " (degrees)");
}
Finding wavelength_falls_with_packing(const Library& runs) {
  return layer_trend(by_packing(runs), "wavelength_mm", false, " (mm)");
}
Finding wavelength_grows_with_length(const Library& runs) {
  return layer_trend(by_length(runs), "wavelength_mm", true, " (mm)");
}
Finding wavelength_grows_with_end(const Library& runs) {
  return layer_trend(by_end(runs), "wavelength_mm", true, " (mm)");
}

Finding two_peaks_at_every_end(const Library& runs) {
  Evidence evidence;
  for (const auto& [set, key] : by_end(runs)) {
    if (values_of(set, key).size() < 2) continue;
    for (const double end : values_of(set, key)) {
      const RunSet here = where(set, key, end);
      evidence.answer(two_peaks(here));
      evidence.say(label_of(here, kLength) + ", " + value_label(key, end) + ": " + layers_text(here));
    }
  }
  return conclude(evidence);
}

Finding larger_box(const Library& runs) {
  const RunSet& large = runs["large"];
  const RunSet small = large.empty() ? large : at_point_of(runs["layers"], large.front());
  if (small.empty()) return {};
  const Estimate lambda[] = {mean_scalar(layered(small), "wavelength_mm"),
                             mean_scalar(layered(large), "wavelength_mm")};
  const Estimate theta[] = {mean_scalar(small, "theta_m_deg"), mean_scalar(large, "theta_m_deg")};
  return conclude({larger(lambda[1], lambda[0]), larger(theta[0], theta[1])},
                  fmt::format("{}, {}: λ = {} mm and {} mm, θ_m = {}° and {}°, boxes of {:.1f} and {:.1f} mm",
                              label_of(large, kLength), label_of(large, kPacking), text(lambda[0], 1),
                              text(lambda[1], 1), text(theta[0], 1), text(theta[1], 1),
                              small.front().number("box.side"), large.front().number("box.side")));
}

}  // namespace shaken::study
