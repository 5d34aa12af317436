// SPDX-License-Identifier: MIT
// Where rods order, how sharply, from which start and in which box.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "study/claim_checks.h"
#include "study/panels.h"

namespace shaken::study {
namespace {

constexpr double kLongest = 4.5;  // [mm]

/// Runs of a state point in the largest box in which it was run.
RunSet in_largest_box(const Library& runs, double length, double fraction) {
  RunSet all;
  for (const char* set : {"phases", "size", "defects", "diffusion"}) all = joined(all, of(runs, set, length, fraction));
  return with_extreme(all, "box.side", true);
}

/// Runs of the longest rods in every box.
RunSet longest_in_all_boxes(const Library& runs) {
  return where(joined(runs["phases"], runs["size"]), kLength, kLongest);
}

/// x of S ~ L^x between the smallest and the largest box.
Estimate power_of_size(const RunSet& runs) {
  const std::vector<Point> points = scalar_points(runs, "box.side", "order.mean");
  if (points.size() < 2) return {};
  const auto& [l0, small] = points.front();
  const auto& [l1, large] = points.back();
  const double scale = std::log(l1 / l0);
  return derived(std::log(large.value / small.value) / scale,
                 std::vector<Term>{{-1 / (small.value * scale), small}, {1 / (large.value * scale), large}});
}

/// The longest rods of the phase diagram.
RunSet longest(const Library& runs) { return where(runs["phases"], kLength, kLongest); }

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

/// Independent samples of S below which the shape of P[S] is left to chance: one peak may hide another not yet met, two
/// may be one.
constexpr double kSamplesForAShape = 50;

/// Angle between the director and the nearest side of the box [degrees], from both halves of the steady state: their
/// mean, and half their difference as its error.
Estimate angle_to_side(const FinishedRun& run) {
  const auto &time = run.array("/order/time_s"), &angle = run.array("/order/director_rad");
  const std::size_t n = std::min(time.size(), angle.size());
  const auto first = static_cast<std::size_t>(
      std::lower_bound(time.begin(), time.begin() + static_cast<std::ptrdiff_t>(n), run.scalar("t_steady_s").value) -
      time.begin());
  const auto mean = [&](std::size_t from, std::size_t to) {
    double c = 0, d = 0;  // of the axis
    for (std::size_t k = from; k < to; ++k) {
      c += std::cos(2 * angle[k]);
      d += std::sin(2 * angle[k]);
    }
    const double degrees = std::abs(std::atan2(d, c) / 2 * 180 / std::numbers::pi);
    return std::min(degrees, 90 - degrees);
  };
  if (n < first + 4) return {};
  const double early = mean(first, (first + n) / 2), late = mean((first + n) / 2, n);
  return run.estimate((early + late) / 2, std::abs(early - late) / 2);
}

}  // namespace

Finding starts_aligned_and_settles(const Library& runs) {
  constexpr double kPapersWait = 600;  // [s]
  std::vector<Answer> answers;
  int n_settled = 0;
  double longest_wait = 0;
  const RunSet set = longest(runs);
  for (const FinishedRun& run : set) {
    const auto& order = run.array("/order/order");
    if (!order.empty()) answers.push_back(order.front() > 0.95 ? yes() : no());
    if (!run.steady()) {
      answers.push_back(unknown("not known whether a run is steady"));
    } else if (*run.steady()) {
      const double t = run.scalar("t_steady_s").value;
      answers.push_back(t <= kPapersWait ? yes() : no());
      longest_wait = std::max(longest_wait, t);
      ++n_settled;
    } else {
      answers.push_back(run.scalar("sim_seconds").value > kPapersWait ? no() : unknown("a run still relaxes"));
    }
  }
  std::string found = fmt::format("{} of {} runs at ℓ = 4.5 mm are steady", n_settled, set.size());
  if (n_settled > 0) found += fmt::format(", from {:.0f} s on at the latest", longest_wait);
  return conclude_everywhere(answers, std::move(found));
}

Finding ordered_when_dense(const Library& runs) {
  const RunSet here = of(runs, "phases", kLongest, 0.75);
  if (here.empty()) return {};
  const Estimate s = mean_scalar(here, "order.mean");
  return conclude({close_to(s, 0.9, 0.05)}, "S = " + text(s, 3));
}

Finding disordered_when_dilute(const Library& runs) {
  const RunSet all = where(longest_in_all_boxes(runs), kPacking, 0.45);
  const RunSet here = with_extreme(all, "box.side", true);
  if (here.empty()) return {};
  const Estimate s = mean_scalar(here, "order.mean"), far = far_g2(here), power = power_of_size(all);
  // Whatever its correlations, a disordered state of N >> 1 independent regions has S ~ 1/sqrt(N), that is 1/L; an
  // ordered one has the same S in every box.
  return conclude({below(s, kOrdered), close_to(far, 0, 0.05), below(power, -0.5)},
                  fmt::format("S = {} in {:.1f} mm; G₂ at half a box {}; S ~ L^x with x = {} (disorder: −1)",
                              text(s, 3), here.front().number("box.side"), text(far, 3), text(power)));
}

Finding short_rods_do_not_order(const Library& runs) {
  Evidence evidence;
  for (const double length : {2.5, 3.0}) {
    double largest = -1;
    std::string words;
    for (const double fraction : values_of(runs["phases"], kPacking)) {
      const RunSet here = in_largest_box(runs, length, fraction);
      if (here.empty()) continue;
      const Estimate s = mean_scalar(here, "order.mean");
      Answer answer = below(s, kOrdered);
      if (answer == no() && !is_papers_box(here)) answer = unknown("order in a box narrower than the paper's");
      evidence.answer(std::move(answer));
      if (!is_known(s) || s.value <= largest) continue;
      largest = s.value;
      words = fmt::format("largest S = {} at {}, {}, in {:.1f} mm", text(s), value_label(kLength, length),
                          value_label(kPacking, fraction), here.front().number("box.side"));
    }
    evidence.say(words);
  }
  return conclude_everywhere(evidence.answers, evidence.found);
}

Finding transition_falls_with_length(const Library& runs) {
  std::vector<Point> passed;
  std::string found;
  for (const double length : {3.5, 4.0, 4.5}) {
    const RunSet column = where(runs["phases"], kLength, length);
    if (column.empty()) continue;
    const Estimate phi = transition(column);
    found =
        listed(std::move(found), value_label(kLength, length) + ": " + (is_known(phi) ? text(phi, 3) : "not passed"));
    passed.push_back({length, phi});
  }
  return passed.empty() ? Finding{} : conclude({trend(passed, false)}, found);
}

Finding transition_rises_with_size(const Library& runs) {
  const RunSet all = longest_in_all_boxes(runs);
  std::vector<Point> passed;
  for (const double side : values_of(all, "box.side")) {
    const RunSet here = where(all, "box.side", side);
    if (values_of(here, kPacking).size() > 1) passed.push_back({side, transition(here)});
  }
  if (passed.size() < 2) return {};
  return conclude({trend(passed, true)}, "S = 0.5 is passed at " + text(passed, "box.side", 3));
}

Finding saturates(const Library& runs) {
  Evidence evidence;
  for (const double length : {4.0, 4.5}) {
    const std::vector<Point> points = scalar_points(where(runs["phases"], kLength, length), kPacking, "order.mean");
    if (points.size() < 2) continue;
    evidence.answer(trend(points, true));
    evidence.answer(close_to(points.back().estimate, 0.95, 0.1));
    evidence.say(fmt::format("{}: from {} to {}", value_label(kLength, length), text(points.front().estimate),
                             text(points.back().estimate)));
  }
  return conclude(evidence);
}

Finding broadest_at_the_transition(const Library& runs) {
  const RunSet all = longest(runs);
  const Estimate phi = transition(all);
  double widest = 0, place = NAN;
  for (const double fraction : values_of(all, kPacking)) {
    const double spread = order_spread(where(all, kPacking, fraction));
    if (!(spread > widest)) continue;
    widest = spread;
    place = fraction;
  }
  if (std::isnan(place)) return {};
  // as near as the steps of the sweep allow
  return conclude({close_to(phi, place, 0.055)},
                  fmt::format("S scatters most, by {:.3f}, at {}; the transition is at {}", widest,
                              value_label(kPacking, place), text(phi, 3)));
}

Finding one_peak(const Library& runs) {
  Evidence evidence;
  for (const FinishedRun& run : longest(runs)) {
    const auto& density = run.array("/order/pdf/density");
    if (density.empty()) continue;
    const int peaks = n_peaks(smoothed(density));
    const std::string doubtful = doubt(run.scalar("order.mean"));
    const double n = run.scalar("order.n_effective").value;
    evidence.answer(!doubtful.empty()          ? unknown(doubtful)
                    : !(n > kSamplesForAShape) ? unknown("too few independent samples for the shape of P[S]")
                    : peaks == 1               ? yes()
                                               : no());
    evidence.say(fmt::format("{} ({:.0f} samples) at {}", peaks, n, value_label(kPacking, run.number(kPacking))));
  }
  return conclude_everywhere(evidence.answers, "peaks (of so many independent samples): " + evidence.found);
}

Finding long_range(const Library& runs) {
  const RunSet set = where(longest_in_all_boxes(runs), kPacking, 0.70);
  const std::vector<Point> points = scalar_points(set, "box.side", "order.mean");
  if (points.size() < 2) return {};
  const Estimate power = power_of_size(set);
  // Quasi-long-range order is a small power too, at most L^-1/8 in an equilibrium nematic (Kosterlitz & Thouless 1973):
  // boxes like these can rule long-range order out, not prove it.
  const bool refuted = below(power, -0.125) == yes() || below(points.back().estimate, kOrdered) == yes();
  const std::string why = doubt(power);
  return conclude({refuted ? no() : unknown(why.empty() ? "a small power of L is not ruled out" : why)},
                  "S = " + text(points, "box.side", 3) + "; S ~ L^x with x = " + text(power, 3));
}

Finding oblique_axis(const Library& runs) {
  const RunSet here = layers(runs, 3.5, 0.85);
  if (here.empty()) return {};
  const Estimate s = mean_scalar(here, "order.mean"), angle = angle_to_side(here.front());
  const Answer ordered = above(s, kOrdered);
  const std::string found = fmt::format("S = {}, director {}° from the nearest side", text(s), text(angle, 0));
  if (ordered != yes()) return conclude({ordered}, found);
  const Answer oblique = above(angle, 10);
  return conclude({oblique == no() ? unknown("the start lies along a side") : oblique}, found);
}

Finding activity(const Library& runs) {
  const RunSet shortest = with_extreme(runs["shaking"], kLength, false);
  if (values_of(shortest, "plates.gamma").size() < 2) return {};
  const std::vector<Point> d = scalar_points(shortest, "plates.gamma", "diffusion_mm2_s");
  const RunSet still = where(runs["rest"], "plates.gamma", 0);
  std::vector<Answer> answers{trend(d, true)};
  std::string found = "D = " + text(d, "plates.gamma") + " (mm²/s)";
  if (still.empty()) {
    answers.push_back(unknown("Γ = 0 was not run"));
  } else {
    // That nothing moves has no error and no steady state to come to: the way itself tells.
    const auto& way = still.front().array("/msd/total_mm2");
    const double farthest = way.empty() ? NAN : *std::max_element(way.begin(), way.end());
    answers.push_back(std::isnan(farthest) ? unknown("not measured everywhere") : farthest < 0.01 ? yes() : no());
    found += fmt::format("; at Γ = 0 rods move by {:.2g} mm² at most", farthest);
  }
  return conclude(answers, found);
}

}  // namespace shaken::study
