// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "bench/bench.h"
#include "bench/case.h"
#include "bench/pairs/following.h"
#include "bench/report.h"

namespace shaken::bench {
namespace {

constexpr const char* kVisitsFooter =
    R"(Follows pairs of neighbouring rods through a real state, takes the one that collides after the longest approach,
and draws its gap, the ticks at which it is visited because its bound has run out, and the hits that make the bound
shorter or a new one necessary.

Example:
  shaken bench visits --out visits      visits/visits.png, .csv and .json)";

/// A pair of rods as it is at some ticks, one after the other.
struct Course {
  /// What happens to it, at which tick.
  struct Bounded {
    std::size_t at;  ///< tick, counted from the start of the course
    Following::Bounded what;
  };
  std::vector<double> gap;  ///< between the nearest beads [mm]
  std::vector<Bounded> bounds;
};

/// How long the pair approaches before its first collision; 0 if there is none.
std::size_t approach(const Course& course) {
  const auto contact = std::find_if(course.gap.begin(), course.gap.end(), [](double gap) { return gap < 0; });
  if (contact == course.gap.end() || course.gap.front() < 0.02) return 0;
  const auto widest = std::max_element(course.gap.begin(), contact);
  return static_cast<std::size_t>(contact - widest);
}

/// Rows: what happens to the bound of a pair, and when. "gap_um": its gap at each tick.
Report visits_report(const Course& course, double dt, double window) {
  const auto ms = [&](std::size_t k) { return 1e3 * static_cast<double>(k) * dt; };
  constexpr const char* kEvents[] = {"ran out", "tightened", "anew"};
  Report report("visits", "visits");
  std::size_t n[3] = {0, 0, 0};
  for (const Course::Bounded& bounded : course.bounds) {
    const auto event = static_cast<std::size_t>(bounded.what.event);
    report.json["rows"].push_back({{"time_ms", ms(bounded.at)},
                                   {"gap_um", 1e3 * course.gap[bounded.at]},
                                   {"safe_ms", std::min(1e3 * bounded.what.safe, 1e3 * window - ms(bounded.at))},
                                   {"event", kEvents[event]}});
    ++n[event];
  }
  report.json["dt_s"] = dt;
  report.json["window_s"] = window;
  report.json["visits"] = n[0];
  report.json["hits"] = n[1] + n[2];
  report.json["gap_um"] = Json::array();
  for (const double gap : course.gap) report.json["gap_um"].push_back(1e3 * gap);
  report.text = fmt::format("{} ticks, {} visits, {} hits and {} new bounds at these\n", course.gap.size(), n[0],
                            n[1] + n[2], n[2]);
  return report;
}

struct VisitsBench {
  CaseOptions scene{.side = 20};
  double window = 0.008;
  Cache cache;
  Output output;

  void declare(CLI::App& app) {
    scene.declare(app);
    add_number(app, "--window", window, "S", {1e-4, 0.1}, "Time that is drawn");
    cache.declare(app);
    output.declare(app);
  }

  ExitCode run() const {
    const Case wanted = scene.read();
    Simulation simulation = resumed(wanted, cache(wanted), StepperKind::kScheduled);
    const std::vector<PairRods> pairs = near_pairs(simulation, 0.3);
    if (pairs.empty())
      throw Failure(ExitCode::kFailed, "no two rods are near each other: take a larger --area-fraction");
    std::vector<Course> courses(pairs.size());
    const auto ticks = static_cast<std::size_t>(window / wanted.dt);
    Following following(simulation, pairs);
    for (std::size_t k = 0; k < ticks; ++k) {
      for (const Following::Bounded& bounded : following.look()) courses[bounded.pair].bounds.push_back({k, bounded});
      const Snapshot now = simulation.snapshot();
      for (std::size_t p = 0; p < pairs.size(); ++p)
        courses[p].gap.push_back(gap_of(pairs[p], now, simulation.world()));
      advance(simulation, 1);
    }
    const Course& best = *std::max_element(courses.begin(), courses.end(),
                                           [](const Course& a, const Course& b) { return approach(a) < approach(b); });
    output.give(visits_report(best, wanted.dt, window));
    return ExitCode::kOk;
  }
};

}  // namespace

void add_visits(CLI::App& app, Work& work) {
  add_bench<VisitsBench>(app, work, "visits", "A picture of how seldom the scheduled stepper visits a pair",
                         kVisitsFooter);
}

}  // namespace shaken::bench
