// SPDX-License-Identifier: MIT
// How rods swim, diffuse and turn, and how defects move.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/claim_checks.h"
#include "study/panels.h"

namespace shaken::study {
namespace {

/// A scalar of motion at each packing: from the runs that were made for it where there are any, in the largest box;
/// otherwise from those of the phase diagram.
std::vector<Point> motion(const Library& runs, double length, const std::string& scalar, double from = 0,
                          double to = 1) {
  std::vector<Point> points;
  const RunSet both = where(joined(runs["phases"], runs["diffusion"]), kLength, length);
  for (const double fraction : values_of(both, kPacking)) {
    if (fraction < from - 1e-6 || fraction > to + 1e-6) continue;
    const RunSet made_for_it = of(runs, "diffusion", length, fraction);
    const RunSet here = made_for_it.empty() ? of(runs, "phases", length, fraction) : made_for_it;
    points.push_back({fraction, mean_scalar(with_extreme(here, "box.side", true), scalar)});
  }
  return points;
}

/// A trend of a scalar with packing.
Finding packing_trend(const std::vector<Point>& points, bool rising, int digits, const std::string& unit) {
  if (points.size() < 2) return {};
  return conclude({trend(points, rising)}, text(points, kPacking, digits) + unit);
}

/// A scalar of the shortest, or the longest, rods of the phase diagram at each packing.
std::vector<Point> of_shortest(const Library& runs, const std::string& scalar) {
  return scalar_points(where(runs["phases"], kLength, 2.5), kPacking, scalar);
}
std::vector<Point> of_longest(const Library& runs, const std::string& scalar) {
  return scalar_points(where(runs["phases"], kLength, 4.5), kPacking, scalar);
}

/// The estimate at a packing; unknown if it is not among the points.
Estimate at_packing(const std::vector<Point>& points, double fraction) {
  for (const Point& point : points) {
    if (std::abs(point.at - fraction) < 1e-6) return point.estimate;
  }
  return {};
}

/// Weighted mean of v along the rod over tilts from `from` to `to`, both hands taken together.
Estimate speed_between(const FinishedRun& run, double from, double to) {
  const auto &n_z = run.array("/tilt/folded/n_z"), &v = run.array("/tilt/folded/v_along_mm_s"),
             &errors = run.array("/tilt/folded/v_along_sem_mm_s");
  double sum = 0, weights = 0;
  for (std::size_t k = 0; k < std::min({n_z.size(), v.size(), errors.size()}); ++k) {
    if (n_z[k] < from || n_z[k] > to || !(errors[k] > 0) || !std::isfinite(v[k])) continue;
    sum += v[k] / (errors[k] * errors[k]);
    weights += 1 / (errors[k] * errors[k]);
  }
  if (weights == 0) return {};
  return run.estimate(sum / weights, 1 / std::sqrt(weights));
}

/// The run in which the paper looks at the way rods swim; none if it is not there.
RunSet swimming(const Library& runs) { return where(runs["mechanism"], kPacking, 0.60); }

}  // namespace

Finding tilt_and_velocity(const Library& runs) {
  const RunSet here = swimming(runs);
  if (here.empty()) return {};
  const FinishedRun& run = here.front();
  const Estimate speed = run.scalar("tilt_fastest_mm_s"), beyond = speed_between(run, 0.31, 0.40);
  // the place of the maximum, to a bin
  const auto& bins = run.array("/tilt/folded/n_z");
  Estimate place = run.scalar("tilt_fastest_n_z");
  place.value = std::abs(place.value);
  place.sem = bins.size() > 1 && doubt(speed).empty() ? bins[1] - bins[0] : NAN;
  return conclude({below(speed, 0), close_to(place, 0.2, 0.06), above(beyond, 0)},
                  fmt::format("fastest at n_z = ±{:.2f}, {} mm/s along the tilt; beyond ±0.31 {} mm/s", place.value,
                              text(speed), text(beyond)));
}

Finding no_motion_sideways(const Library& runs) {
  const RunSet here = swimming(runs);
  if (here.empty()) return {};
  const FinishedRun& run = here.front();
  const auto &v = run.array("/tilt/v_across_mm_s"), &errors = run.array("/tilt/v_across_sem_mm_s");
  double chi2 = 0, noise = 0, n = 0;
  for (std::size_t k = 0; k < std::min(v.size(), errors.size()); ++k) {
    if (!(errors[k] > 0) || !std::isfinite(v[k])) continue;
    chi2 += v[k] * v[k] / (errors[k] * errors[k]);
    noise += errors[k] * errors[k];
    n += 1;
  }
  if (v.empty()) return {};
  // chi2 of n independent bins at zero is n ± sqrt(2 n)
  const Estimate excess = run.estimate(n > 0 ? chi2 / n : 0, n > 0 ? std::sqrt(2 / n) : NAN);
  const double error = std::sqrt(noise / n), speed = std::abs(run.scalar("tilt_fastest_mm_s").value);
  const std::string found = fmt::format(
      "χ² per bin {} about 0, errors of {:.2f} mm/s; fastest along the rod {:.2f} mm/s", text(excess), error, speed);
  if (!doubt(excess).empty()) return conclude({unknown(doubt(excess))}, found);
  if (above(excess, 1) == yes()) return conclude({no()}, found);
  return conclude({error < 0.2 * speed ? yes() : unknown("the errors are too large")}, found);
}

Finding tilt_switches(const Library& runs) {
  const std::vector<Point> times = scalar_points(runs["mechanism"], kPacking, "n_z_switching_time_s");
  if (times.empty()) return {};
  std::vector<Answer> answers;
  answers.reserve(times.size());
  // several times within the 30 s over which the paper follows a rod
  for (const Point& point : times) answers.push_back(below(point.estimate, 10));
  return conclude(answers, "n_z keeps its sign for " + text(times, kPacking) + " (s)");
}

Finding persists_when_dense(const Library& runs) {
  Evidence evidence;
  for (const auto& [scalar, unit] :
       {std::pair{"persistence_time_s", " (s)"}, std::pair{"persistence_length_mm", " (mm)"}}) {
    std::vector<Point> points = scalar_points(runs["mechanism"], kPacking, scalar);
    std::erase_if(points, [](const Point& point) { return point.at < 0.64; });
    if (points.size() < 2) continue;
    evidence.answer(trend(points, true));
    evidence.say(text(points, kPacking) + unit);
  }
  return conclude(evidence);
}

Finding diffusion_rises(const Library& runs) {
  return packing_trend(motion(runs, 2.5, "diffusion_mm2_s", 0.64), true, 1, " (mm²/s)");
}

Finding diffusion_law(const Library& runs) {
  Evidence evidence;
  for (const auto& [fraction, d] : motion(runs, 2.5, "diffusion_mm2_s", 0.64)) {
    const double law = papers_diffusion(fraction);
    evidence.answer(close_to(d, law, 0.2 * law));
    evidence.say(fmt::format("{} ({:.1f}) at {}", text(d, 1), law, value_label(kPacking, fraction)));
  }
  return conclude(evidence, "D in mm²/s (the paper's fit): ");
}

Finding diffusion_is_normal(const Library& runs) {
  Evidence evidence;
  for (const std::string when : {"short", "long"}) {
    const std::vector<Point> points = motion(runs, 2.5, "alpha_" + when);
    for (const Point& point : points) evidence.answer(close_to(point.estimate, 1, 0.1));
    if (!points.empty()) evidence.say(when + ": " + text(points, kPacking));
  }
  return conclude(evidence, "exponents at times that are ");
}

Finding diffusion_along_the_director(const Library& runs) {
  const std::vector<Point> along = motion(runs, 4.5, "diffusion_along_mm2_s", 0.70),
                           across = motion(runs, 4.5, "diffusion_across_mm2_s", 0.70);
  if (along.size() < 2 || across.size() < 2) return {};
  return conclude({larger(at_packing(along, 0.80), at_packing(along, 0.70)),
                   larger(at_packing(along, 0.80), at_packing(along, 0.85)),
                   larger(at_packing(across, 0.70), at_packing(across, 0.80)),
                   larger(at_packing(along, 0.80), at_packing(across, 0.80))},
                  "along: " + text(along, kPacking) + "; across: " + text(across, kPacking) + " (mm²/s)");
}

Finding no_superdiffusion_across(const Library& runs) {
  Evidence evidence;
  for (const std::string when : {"short", "long"}) {
    const std::vector<Point> points = motion(runs, 4.5, "alpha_across_" + when, 0.60);
    if (points.empty()) continue;
    for (const Point& point : points) evidence.answer(below(point.estimate, 1.05));
    if (when == "short") evidence.answer(trend(points, false));
    evidence.say(when + ": " + text(points, kPacking));
  }
  return conclude(evidence, "exponents across at times that are ");
}

Finding slower_when_denser(const Library& runs) {
  const std::vector<Point> c2 = of_shortest(runs, "c2_decay_s"), c_v = of_shortest(runs, "velocity_correlation_s");
  if (c2.size() < 2 || c_v.size() < 2) return {};
  return conclude({trend(c2, true), trend(c_v, true)},
                  "C₂: " + text(c2, kPacking) + " s. C_v: " + text(c_v, kPacking) + " s");
}

Finding c2_levels_off(const Library& runs) {
  std::vector<Point> plateau = of_longest(runs, "c2_plateau");
  std::erase_if(plateau, [](const Point& point) { return point.at < 0.59; });
  if (plateau.size() < 2) return {};
  return conclude({trend(plateau, true), close_to(plateau.back().estimate, 1, 0.15)}, text(plateau, kPacking));
}

Finding velocity_along_grows(const Library& runs) {
  const std::vector<Point> points = motion(runs, 4.5, "velocity_variance_along_mm2_s2", 0.60, 0.80);
  return packing_trend(points, true, 2, " (mm²/s²)");
}

Finding rotation_slows(const Library& runs) {
  return packing_trend(of_shortest(runs, "rotational_diffusion_rad2_s"), false, 3, " (rad²/s)");
}

Finding rotation_subdiffusive(const Library& runs) {
  const std::vector<Point> alpha = of_shortest(runs, "alpha_rotation_short");
  if (alpha.size() < 2) return {};
  std::vector<Answer> answers{trend(alpha, false)};
  for (const Point& point : alpha) answers.push_back(below(point.estimate, 1));
  return conclude(answers, "exponent " + text(alpha, kPacking));
}

Finding turning_saturates(const Library& runs) {
  std::vector<Answer> answers;
  std::vector<Point> asked = of_longest(runs, "alpha_rotation_long");
  std::erase_if(asked, [](const Point& point) { return point.at >= 0.46 && point.at <= 0.74; });
  answers.reserve(asked.size());
  for (const auto& [fraction, alpha] : asked) {
    answers.push_back(fraction < 0.46 ? close_to(alpha, 1, 0.1) : below(alpha, 0.25));
  }
  return conclude(answers, "exponent at long times " + text(asked, kPacking));
}

Finding defects_move(const Library& runs) {
  const RunSet here = with_most_defects(runs["defects"]);
  if (here.empty()) return {};
  const Estimate plus = mean_scalar(here, "lasting_defect_speed_plus_mm_s"),
                 minus = mean_scalar(here, "lasting_defect_speed_minus_mm_s"),
                 along = mean_scalar(here, "lasting_defect_speed_plus_along_mm_s");
  const std::string found =
      fmt::format("{}, {}: +1/2 move at {} mm/s, −1/2 at {} mm/s; +1/2 towards their own tail: {} mm/s",
                  label_of(here, kLength), label_of(here, kPacking), text(plus), text(minus), text(along, 3));
  // Which way is not said: along its own axis, either way. That it does not is known where that is less than a tenth of
  // the speed at which the other kind jitters.
  Estimate either_way = along;
  either_way.value = std::abs(along.value);
  const Answer moves = above(either_way, 0);
  const bool still = moves != yes() && below(either_way, 0.1 * minus.value) == yes();
  return conclude({still ? no() : moves}, found);
}

}  // namespace shaken::study
