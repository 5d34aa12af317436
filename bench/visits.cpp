// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/plot.h"
#include "bench/bench.h"
#include "bench/case.h"
#include "bench/nearest_beads.h"
#include "sim/contact/bead_safe_time.h"
#include "sim/contact/hull_safe_time.h"
#include "sim/neighbors/neighbor_list.h"

namespace shaken::bench {
namespace {

constexpr const char* kVisitsFooter =
    R"(Follows pairs of neighbouring rods through a real state, takes the one that collides after the longest approach,
and draws its gap, the ticks at which it is visited because its bound has run out, and the hits that renew the bound.

Example:
  shaken bench visits --out visits      visits/visits.png, .dat and .gp)";

/// A pair of rods as it is at some ticks, one after the other.
struct Course {
  int rod[2];
  std::vector<double> gap;            ///< between the nearest beads [mm]
  std::vector<float> bounds;          ///< made at that tick
  std::vector<std::uint8_t> was_hit;  ///< one of the rods, at that tick
};

/// The rod's flight as a bound sees it; nothing has drifted yet.
MotionBound bound(const World& world, int i, const Vec3& director) {
  const Flight& flight = world.rods[i];
  Vec3 velocity = flight.velocity;
  velocity.z() -= world.system.gravity * static_cast<double>(world.tick - flight.since) * world.system.dt;
  MotionBound bound{};
  set_vector(bound.director, director);
  set_vector(bound.velocity, velocity);
  set_vector(bound.turning, flight.precession.cross(director));
  bound.half_rate2 = static_cast<float>(0.5 * flight.rate * flight.rate);
  return bound;
}

void follow(const Simulation& simulation, const Snapshot& now, float horizon, std::vector<Course>& courses) {
  const World& world = simulation.world();
  const Hull hull(world.species[0]);
  const BeadLanes lanes(world.species[0]);
  PairLanes pair_lanes{};
  HullSafeTimes hull_safe;
  for (Course& course : courses) {
    const auto& [i, j] = course.rod;
    const Vec3 D = nearest_image(now.position[i], now.position[j], world.system.box_side);
    const MotionBound o_i = bound(world, i, now.director[i]);
    const MotionBound o_j = bound(world, j, now.director[j]);
    pair_lanes.set(0, D, o_i, o_j);
    hull_safe_times(hull, hull, pair_lanes, 1, horizon, hull_safe);
    const BeadSafeTime beads = bead_safe_time(lanes, o_i, lanes, o_j, D, horizon);
    course.gap.push_back(nearest_beads(world.species[0], now.director[i], now.director[j], D).gap);
    course.bounds.push_back(std::max(hull_safe.time[0], beads.time));
    course.was_hit.push_back(world.rods[i].since == world.tick || world.rods[j].since == world.tick);
  }
}

/// Ticks, counted from the start of the course, at which the pair is visited: when a bound has run out or a rod was
/// hit.
std::vector<std::size_t> visits(const Course& course, double dt) {
  std::vector<std::size_t> at;
  double due = 0;
  for (std::size_t k = 0; k < course.gap.size(); ++k) {
    if (static_cast<double>(k) < due && !course.was_hit[k]) continue;
    at.push_back(k);
    due = static_cast<double>(k) + 1 + std::floor(static_cast<double>(course.bounds[k]) / dt * (1 - 1e-5));
  }
  return at;
}

/// How long the pair approaches before its first collision; 0 if there is none.
std::size_t approach(const Course& course) {
  const auto contact = std::find_if(course.gap.begin(), course.gap.end(), [](double gap) { return gap < 0; });
  if (contact == course.gap.end() || course.gap.front() < 0.02) return 0;
  const auto widest = std::max_element(course.gap.begin(), contact);
  return static_cast<std::size_t>(contact - widest);
}

/// Pairs of rods that are near each other now.
std::vector<Course> near_pairs(const Simulation& simulation, const Snapshot& now) {
  const World& world = simulation.world();
  std::vector<Course> courses;
  for (int i = 0; i < static_cast<int>(now.n_rods()); ++i) {
    for (int j = i + 1; j < static_cast<int>(now.n_rods()); ++j) {
      const Vec3 D = nearest_image(now.position[i], now.position[j], world.system.box_side);
      if (nearest_beads(world.species[0], now.director[i], now.director[j], D).gap < 0.3)
        courses.push_back({{i, j}, {}, {}, {}});
    }
  }
  if (courses.empty())
    throw Failure(ExitCode::kFailed, "no two rods are near each other: take a larger --area-fraction");
  return courses;
}

void draw_visits(const std::filesystem::path& folder, const Course& course, const std::vector<std::size_t>& at,
                 double dt, double window) {
  const auto ms = [&](std::size_t k) { return 1e3 * static_cast<double>(k) * dt; };
  std::string data;
  for (std::size_t k = 0; k < course.gap.size(); ++k)
    data += fmt::format("{:.6f} {:.5f}\n", ms(k), 1e3 * course.gap[k]);
  data += "\n\n";
  for (const std::size_t k : at) {
    const double safe = std::min(1e3 * static_cast<double>(course.bounds[k]), 1e3 * window - ms(k));
    data += fmt::format("{:.6f} {:.5f} {:.6f} {}\n", ms(k), 1e3 * course.gap[k], safe, course.was_hit[k]);
  }
  const auto n_hits = std::count(course.was_hit.begin(), course.was_hit.end(), 1);
  const std::string script = fmt::format(
      R"gp(set title "One pair of rods for {:g} ms: {} ticks, {} visits ({} hits on its rods, by plates mostly)"
set xlabel "time [ms]"
set ylabel "gap between the nearest beads [um]"
set key outside below horizontal
set xrange [0:{:g}]
set xzeroaxis lt -1
plot "visits.dat" index 0 using 1:2 with lines lw 2 lc rgb "#4477aa" title "gap", \
     "visits.dat" index 1 using 1:2:3:(0) with vectors nohead lw 1.5 lc rgb "#ccbb44" title "no contact before", \
     "visits.dat" index 1 using 1:($4==1?$2:1/0) with points pt 7 ps 0.7 lc rgb "#bbbbbb" title "a rod was hit", \
     "visits.dat" index 1 using 1:($4==0?$2:1/0) with points pt 7 ps 0.9 lc rgb "#ee6677" title "bound ran out"
)gp",
      1e3 * window, course.gap.size(), at.size(), n_hits, 1e3 * window);
  const auto picture = draw_plot(folder, "visits", data, plot_head("visits", {1000, 520}) + plot_axes("y") + script);
  fmt::print("{} ticks, {} visits, {} of them because a rod was hit: {}\n", course.gap.size(), at.size(), n_hits,
             picture.string());
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
    Snapshot now = simulation.snapshot();
    std::vector<Course> courses = near_pairs(simulation, now);
    const auto ticks = static_cast<Tick>(window / wanted.dt);
    for (Tick k = 0; k < ticks; ++k) {
      follow(simulation, now, static_cast<float>(window), courses);
      advance(simulation, 1);
      now = simulation.snapshot();
    }
    const Course& best = *std::max_element(courses.begin(), courses.end(),
                                           [](const Course& a, const Course& b) { return approach(a) < approach(b); });
    draw_visits(out, best, visits(best, wanted.dt), wanted.dt, window);
    return ExitCode::kOk;
  }
};

}  // namespace

void add_visits(CLI::App& app, Work& work) {
  add_bench<VisitsBench>(app, work, "visits", "A picture of how seldom the scheduled stepper visits a pair",
                         kVisitsFooter);
}

}  // namespace shaken::bench
