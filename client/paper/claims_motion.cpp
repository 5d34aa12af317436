// SPDX-License-Identifier: MIT
// How rods swim, diffuse and turn, and how defects move.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "client/paper/claims.h"
#include "client/paper/figures.h"
#include "client/paper/panels.h"

namespace shaken::client {
namespace {

RunSet shortest(const Library& runs) { return where(runs["phases"], "rods.length", 2.5); }
RunSet longest(const Library& runs) { return where(runs["phases"], "rods.length", 4.5); }

/// A scalar of motion at each packing: from the runs that were made for it where there are any, in the largest box;
/// otherwise from those of the phase diagram.
std::vector<Point> motion(const Library& runs, double length, const std::string& scalar, double from = 0,
                          double to = 1) {
  std::vector<Point> points;
  const RunSet both = where(joined(runs["phases"], runs["diffusion"]), "rods.length", length);
  for (const double fraction : values_of(both, "rods.area_fraction")) {
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
  return conclude({trend(points, rising)}, text(points, "rods.area_fraction", digits) + unit);
}

/// Weighted mean of v along the rod over tilts from `from` to `to`, both hands taken together.
Quantity speed_between(const FinishedRun& run, double from, double to) {
  const auto &n_z = run.array("/tilt/folded/n_z"), &v = run.array("/tilt/folded/v_along_mm_s"),
             &errors = run.array("/tilt/folded/v_along_sem_mm_s");
  double sum = 0, weights = 0;
  for (std::size_t k = 0; k < std::min({n_z.size(), v.size(), errors.size()}); ++k) {
    if (n_z[k] < from || n_z[k] > to || !(errors[k] > 0) || !std::isfinite(v[k])) continue;
    sum += v[k] / (errors[k] * errors[k]);
    weights += 1 / (errors[k] * errors[k]);
  }
  if (weights == 0) return {};
  return {sum / weights, 1 / std::sqrt(weights), run.steadiness()};
}

Finding tilt_and_velocity(const Library& runs) {
  const RunSet here = where(runs["mechanism"], "rods.area_fraction", 0.60);
  if (here.empty()) return {};
  const FinishedRun& run = here.front();
  const Quantity speed = run.scalar("tilt_fastest_mm_s"), beyond = speed_between(run, 0.31, 0.40);
  // the place of the maximum, to a bin
  const auto& bins = run.array("/tilt/folded/n_z");
  Quantity place = run.scalar("tilt_fastest_n_z");
  place.value = std::abs(place.value);
  place.sem = bins.size() > 1 && doubt(speed).empty() ? bins[1] - bins[0] : NAN;
  return conclude({below(speed, 0), close_to(place, 0.2, 0.06), above(beyond, 0)},
                  fmt::format("fastest at n_z = ±{:.2f}, {} mm/s along the tilt; beyond ±0.31 {} mm/s", place.value,
                              text(speed), text(beyond)));
}

Finding no_motion_sideways(const Library& runs) {
  const RunSet here = where(runs["mechanism"], "rods.area_fraction", 0.60);
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
  const Quantity excess{n > 0 ? chi2 / n : 0, n > 0 ? std::sqrt(2 / n) : NAN, run.steadiness()};
  const double blur = std::sqrt(noise / n), speed = std::abs(run.scalar("tilt_fastest_mm_s").value);
  const std::string found = fmt::format(
      "χ² per bin {} about 0, errors of {:.2f} mm/s; fastest along the rod {:.2f} mm/s", text(excess), blur, speed);
  if (!doubt(excess).empty()) return conclude({unknown(doubt(excess))}, found);
  if (above(excess, 1) == yes()) return conclude({no()}, found);
  return conclude({blur < 0.2 * speed ? yes() : unknown("the errors are too large")}, found);
}

Finding tilt_switches(const Library& runs) {
  const std::vector<Point> times = scalar_points(runs["mechanism"], "rods.area_fraction", "n_z_switching_time_s");
  if (times.empty()) return {};
  std::vector<Answer> answers;
  answers.reserve(times.size());
  // several times within the 30 s over which the paper follows a rod
  for (const Point& point : times) answers.push_back(below(point.quantity, 10));
  return conclude(answers, "n_z keeps its sign for " + text(times, "rods.area_fraction") + " (s)");
}

Finding persists_when_dense(const Library& runs) {
  const RunSet& all = runs["mechanism"];
  std::vector<Answer> answers;
  std::string found;
  for (const char* scalar : {"persistence_time_s", "persistence_length_mm"}) {
    std::vector<Point> points = scalar_points(all, "rods.area_fraction", scalar);
    std::erase_if(points, [](const Point& point) { return point.at < 0.64; });
    if (points.size() < 2) continue;
    answers.push_back(trend(points, true));
    found = listed(std::move(found),
                   text(points, "rods.area_fraction") + (std::string_view(scalar).ends_with("_s") ? " (s)" : " (mm)"));
  }
  return conclude(answers, found);
}

Finding diffusion_rises(const Library& runs) {
  return packing_trend(motion(runs, 2.5, "diffusion_mm2_s", 0.64), true, 1, " (mm²/s)");
}

Finding diffusion_law(const Library& runs) {
  std::vector<Answer> answers;
  std::string found;
  for (const auto& [fraction, d] : motion(runs, 2.5, "diffusion_mm2_s", 0.64)) {
    const double law = papers_diffusion(fraction);
    found = listed(std::move(found),
                   fmt::format("{} ({:.1f}) at {}", text(d, 1), law, value_label("rods.area_fraction", fraction)));
    answers.push_back(close_to(d, law, 0.2 * law));
  }
  return conclude(answers, "D in mm²/s (the paper's fit): " + found);
}

Finding diffusion_is_normal(const Library& runs) {
  std::vector<Answer> answers;
  std::string found;
  for (const char* scalar : {"alpha_short", "alpha_long"}) {
    const std::vector<Point> points = motion(runs, 2.5, scalar);
    for (const Point& point : points) answers.push_back(close_to(point.quantity, 1, 0.1));
    if (points.empty()) continue;
    found = listed(std::move(found), std::string(std::string_view(scalar).ends_with("short") ? "short: " : "long: ") +
                                         text(points, "rods.area_fraction"));
  }
  return conclude(answers, "exponents at times that are " + found);
}

Finding diffusion_along_the_director(const Library& runs) {
  const std::vector<Point> along = motion(runs, 4.5, "diffusion_along_mm2_s", 0.70),
                           across = motion(runs, 4.5, "diffusion_across_mm2_s", 0.70);
  if (along.size() < 2 || across.size() < 2) return {};
  const auto at = [](const std::vector<Point>& points, double phi) {
    for (const Point& point : points) {
      if (std::abs(point.at - phi) < 1e-6) return point.quantity;
    }
    return Quantity{};
  };
  return conclude(
      {larger(at(along, 0.80), at(along, 0.70)), larger(at(along, 0.80), at(along, 0.85)),
       larger(at(across, 0.70), at(across, 0.80)), larger(at(along, 0.80), at(across, 0.80))},
      "along: " + text(along, "rods.area_fraction") + "; across: " + text(across, "rods.area_fraction") + " (mm²/s)");
}

Finding no_superdiffusion_across(const Library& runs) {
  std::vector<Answer> answers;
  std::string found;
  for (const char* scalar : {"alpha_across_short", "alpha_across_long"}) {
    const std::vector<Point> points = motion(runs, 4.5, scalar, 0.60);
    if (points.empty()) continue;
    for (const Point& point : points) answers.push_back(below(point.quantity, 1.05));
    const bool is_short = std::string_view(scalar).ends_with("short");
    if (is_short) answers.push_back(trend(points, false));
    found = listed(std::move(found), (is_short ? "short: " : "long: ") + text(points, "rods.area_fraction"));
  }
  return conclude(answers, "exponents across at times that are " + found);
}

Finding slower_when_denser(const Library& runs) {
  const std::vector<Point> c2 = scalar_points(shortest(runs), "rods.area_fraction", "c2_decay_s"),
                           c_v = scalar_points(shortest(runs), "rods.area_fraction", "velocity_correlation_s");
  if (c2.size() < 2 || c_v.size() < 2) return {};
  return conclude({trend(c2, true), trend(c_v, true)},
                  "C₂: " + text(c2, "rods.area_fraction") + " s. C_v: " + text(c_v, "rods.area_fraction") + " s");
}

Finding c2_levels_off(const Library& runs) {
  std::vector<Point> plateau = scalar_points(longest(runs), "rods.area_fraction", "c2_plateau");
  std::erase_if(plateau, [](const Point& point) { return point.at < 0.59; });
  if (plateau.size() < 2) return {};
  return conclude({trend(plateau, true), close_to(plateau.back().quantity, 1, 0.15)},
                  text(plateau, "rods.area_fraction"));
}

Finding velocity_along_grows(const Library& runs) {
  const std::vector<Point> points = motion(runs, 4.5, "velocity_variance_along_mm2_s2", 0.60, 0.80);
  return packing_trend(points, true, 2, " (mm²/s²)");
}

Finding rotation_slows(const Library& runs) {
  return packing_trend(scalar_points(shortest(runs), "rods.area_fraction", "rotational_diffusion_rad2_s"), false, 3,
                       " (rad²/s)");
}

Finding rotation_subdiffusive(const Library& runs) {
  const std::vector<Point> alpha = scalar_points(shortest(runs), "rods.area_fraction", "alpha_rotation_short");
  if (alpha.size() < 2) return {};
  std::vector<Answer> answers{trend(alpha, false)};
  for (const Point& point : alpha) answers.push_back(below(point.quantity, 1));
  return conclude(answers, "exponent " + text(alpha, "rods.area_fraction"));
}

Finding turning_saturates(const Library& runs) {
  std::vector<Answer> answers;
  const std::vector<Point> alpha = scalar_points(longest(runs), "rods.area_fraction", "alpha_rotation_long");
  std::vector<Point> asked;
  for (const Point& point : alpha) {
    if (point.at < 0.46) {
      answers.push_back(close_to(point.quantity, 1, 0.1));
    } else if (point.at > 0.74) {
      answers.push_back(below(point.quantity, 0.25));
    } else {
      continue;
    }
    asked.push_back(point);
  }
  return conclude(answers, "exponent at long times " + text(asked, "rods.area_fraction"));
}

Finding defects_move(const Library& runs) {
  const RunSet here = with_most_defects(runs["defects"]);
  if (here.empty()) return {};
  const Quantity plus = mean_scalar(here, "lasting_defect_speed_plus_mm_s"),
                 minus = mean_scalar(here, "lasting_defect_speed_minus_mm_s"),
                 along = mean_scalar(here, "lasting_defect_speed_plus_along_mm_s");
  const std::string found =
      fmt::format("{}, {}: +1/2 move at {} mm/s, −1/2 at {} mm/s; +1/2 towards their own tail: {} mm/s",
                  value_label("rods.length", here.front().number("rods.length")),
                  value_label("rods.area_fraction", here.front().number("rods.area_fraction")), text(plus), text(minus),
                  text(along, 3));
  // Which way is not said: along its own axis, either way. That it does not is known where that is less than a tenth of
  // the speed at which the other kind jitters.
  const Quantity either_way{std::abs(along.value), along.sem, along.steadiness};
  const Answer moves = above(either_way, 0);
  const bool still = moves != yes() && below(either_way, 0.1 * minus.value) == yes();
  return conclude({still ? no() : moves}, found);
}

}  // namespace

std::vector<Claim> motion_claims() {
  return {
      {"tilt", "8", "Rods swim against their tilt, fastest near n_z = ±0.2, the other way beyond 0.3",
       tilt_and_velocity},
      {"sideways", "8", "Across the rod ⟨v⟩ = 0 at every tilt", no_motion_sideways},
      {"switching", "8", "The tilt of a rod switches from one sign to the other", tilt_switches},
      {"persistence", "8", "Ways of single rods persist longer at 0.85 than at 0.65", persists_when_dense},
      {"diffusion-rises", "9", "Short rods diffuse faster when denser", diffusion_rises},
      {"diffusion-law", "9", "D = 1.7 + 480 (φ − 0.64)² mm²/s for ℓ = 2.5 mm", diffusion_law, Reach::kEitherWay,
       "the paper prints MSD = 2Dt; read here as 4Dt in the plane, which fits at 0.65"},
      {"diffusion-normal", "9", "Short rods diffuse normally at short and at long times", diffusion_is_normal},
      {"diffusion-along", "9",
       "Along the director D rises up to 0.80, then falls; across it D falls, and is smaller (ℓ = 4.5 mm)",
       diffusion_along_the_director},
      {"diffusion-across", "9", "Across the director nothing is super-diffusive, and the exponent at short times falls",
       no_superdiffusion_across},
      {"memory", "10", "C₂ and C_v decay more slowly when denser (ℓ = 2.5 mm)", slower_when_denser},
      {"c2-plateau", "10", "C₂ of long rods levels off, near 1 when dense", c2_levels_off},
      {"velocity-along", "10", "C_v along the director grows with packing up to 0.80 (ℓ = 4.5 mm)",
       velocity_along_grows},
      {"rotation", "10", "The rotational diffusion constant falls with packing (ℓ = 2.5 mm)", rotation_slows},
      {"rotation-short", "10", "At short times rotation is sub-diffusive, the more so the denser",
       rotation_subdiffusive},
      {"rotation-saturates", "10",
       "The angle turned levels off in the nematic and grows linearly in disorder (ℓ = 4.5 mm)", turning_saturates},
      {"defects", "defects",
       "Defects of a system that is ordered here and there move by themselves (ℓ = 3.0 mm at 0.85)", defects_move,
       Reach::kEitherWay, "the paper's text has ℓ = 0.3 mm, its caption 3.0 mm"},
  };
}

}  // namespace shaken::client
