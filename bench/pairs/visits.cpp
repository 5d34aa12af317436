// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "base/plot.h"
#include "bench/bench.h"
#include "bench/case.h"
#include "bench/pairs/following.h"

namespace shaken::bench {
namespace {

constexpr const char* kVisitsFooter =
    R"(Follows pairs of neighbouring rods through a real state, takes the one that collides after the longest approach,
and draws its gap, the ticks at which it is visited because its bound has run out, and the hits that make the bound
shorter or a new one necessary.

Example:
  shaken bench visits --out visits      visits/visits.png, .dat and .gp)";

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

void draw_visits(const std::filesystem::path& folder, const Course& course, double dt, double window) {
  const auto ms = [&](std::size_t k) { return 1e3 * static_cast<double>(k) * dt; };
  std::string data;
  for (std::size_t k = 0; k < course.gap.size(); ++k)
    data += fmt::format("{:.6f} {:.5f}\n", ms(k), 1e3 * course.gap[k]);
  data += "\n\n";
  std::size_t n[3] = {0, 0, 0};
  for (const Course::Bounded& bounded : course.bounds) {
    const double safe = std::min(1e3 * bounded.what.safe, 1e3 * window - ms(bounded.at));
    const auto event = static_cast<std::size_t>(bounded.what.event);
    data += fmt::format("{:.6f} {:.5f} {:.6f} {}\n", ms(bounded.at), 1e3 * course.gap[bounded.at], safe, event);
    ++n[event];
  }
  const std::string script = fmt::format(
      R"gp(set title "One pair of rods for {:g} ms: {} ticks, {} visits, {} hits"
set xlabel "time [ms]"
set ylabel "gap of the nearest beads [um]"
set key outside below horizontal
set xrange [0:{:g}]
set xzeroaxis lt -1
plot "visits.dat" index 0 using 1:2 with lines lw 2 lc rgb "#4477aa" title "gap", \
     "visits.dat" index 1 using 1:2:3:(0) with vectors nohead lw 1.5 lc rgb "#ccbb44" title "no contact before", \
     "visits.dat" index 1 using 1:($4==1?$2:1/0) with points pt 7 ps 0.5 lc rgb "#bbbbbb" title "hit: bound tightened", \
     "visits.dat" index 1 using 1:($4==2?$2:1/0) with points pt 7 ps 0.7 lc rgb "#666666" title "hit: bound made anew", \
     "visits.dat" index 1 using 1:($4==0?$2:1/0) with points pt 7 ps 0.9 lc rgb "#ee6677" title "bound ran out: visit"
)gp",
      1e3 * window, course.gap.size(), n[0], n[1] + n[2], 1e3 * window);
  const auto picture = draw_plot(folder, "visits", data, plot_head("visits", {1000, 520}) + plot_axes("y") + script);
  fmt::print("{} ticks, {} visits, {} hits and {} new bounds at these: {}\n", course.gap.size(), n[0], n[1] + n[2],
             n[2], picture.string());
}

struct VisitsBench {
  CaseOptions scene{.side = 20};
  double window = 0.008;
  Cache cache;
  std::string out;

  void declare(CLI::App& app) {
    scene.declare(app);
    add_number(app, "--window", window, "S", {1e-4, 0.1}, "Time that is drawn");
    cache.declare(app);
    add_path(app, "-o,--out", out, "DIR", "Where the picture goes")->required();
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
    draw_visits(out, best, wanted.dt, window);
    return ExitCode::kOk;
  }
};

}  // namespace

void add_visits(CLI::App& app, Work& work) {
  add_bench<VisitsBench>(app, work, "visits", "A picture of how seldom the scheduled stepper visits a pair",
                         kVisitsFooter);
}

}  // namespace shaken::bench
