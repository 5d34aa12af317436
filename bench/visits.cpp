// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "base/plot.h"
#include "bench/bench.h"
#include "bench/case.h"
#include "bench/nearest_beads.h"
#include "sim/neighbors/neighbor_list.h"
#include "sim/stepping/motion_change.h"
#include "sim/stepping/pair_search.h"
#include "sim/stepping/pair_table.h"

namespace shaken::bench {
namespace {

constexpr const char* kVisitsFooter =
    R"(Follows pairs of neighbouring rods through a real state, takes the one that collides after the longest approach,
and draws its gap, the ticks at which it is visited because its bound has run out, and the hits that make the bound
shorter or a new one necessary.

Example:
  shaken bench visits --out visits      visits/visits.png, .dat and .gp)";

/// What happens to a pair of rods at a tick, and for how long nothing can happen from then on.
enum class Event : std::uint8_t { kRanOut, kTightened, kRenewed };
struct Bounded {
  std::size_t at;  ///< tick, counted from the start of the course
  Event event;
  double safe;  ///< [s]
};

/// A pair of rods as it is at some ticks, one after the other.
struct Course {
  int rod[2];
  std::vector<double> gap;  ///< between the nearest beads [mm]
  std::vector<Bounded> bounds;
};

/// Does with some pairs what the scheduled stepper does with all of them.
class Following {
 public:
  Following(const Simulation& simulation, std::vector<Course>& courses)
      : world_(simulation.world()),
        rules_(world_),
        search_(rules_),
        courses_(courses),
        pairs_(world_.rods.size()),
        before_(world_.rods),
        rods_(world_.rods.size()),
        motions_(world_.rods.size()) {
    pairs_.make_room(courses.size());
    for (std::size_t p = 0; p < courses.size(); ++p)
      pairs_.add(static_cast<int>(p), {courses[p].rod[0], courses[p].rod[1]}, 0);
  }

  void look(const Snapshot& now) {
    for (std::size_t i = 0; i < rods_.size(); ++i) {
      rods_[i] = rod_at_tick(world_.rods[i], world_.tick, rules_);
      motions_[i] = motion_bound(world_.rods[i], velocity_at(world_.rods[i], world_.tick, rules_),
                                 rods_[i].pose.director, search_.slow());
    }
    due_.clear();
    pairs_.wheel().pop(world_.tick, due_);
    for (std::size_t p = 0; p < courses_.size(); ++p) {
      Course& course = courses_[p];
      const Vec3 D = nearest_image(now.position[course.rod[0]], now.position[course.rod[1]], world_.system.box_side);
      course.gap.push_back(
          nearest_beads(world_.species[0], now.director[course.rod[0]], now.director[course.rod[1]], D).gap);
      look_at(static_cast<int>(p), course);
    }
    before_ = world_.rods;
  }

 private:
  void look_at(int p, Course& course) {
    const std::size_t k = course.gap.size() - 1;
    bool renew = k == 0 || std::find(due_.begin(), due_.end(), p) != due_.end();
    if (renew) {
      course.bounds.push_back({k, Event::kRanOut, 0});
    } else {
      for (const int i : course.rod) {
        if (renew || world_.rods[i].since != world_.tick) continue;
        renew = !pairs_.tighten(p, i, change(i), world_.tick, static_cast<float>(rules_.dt));
        course.bounds.push_back({k, renew ? Event::kRenewed : Event::kTightened, 0});
      }
    }
    if (renew) {
      PairBounds bounds;
      search_.bound(std::span(&pairs_.rods(p), 1), rods_, motions_, lanes_, bounds);
      pairs_.direction(p) = bounds.direction[0];
      pairs_.set_line(p, bounds.line[0], bounds.all_round[0]);
      pairs_.set_due(p, world_.tick + 1 + bounds.ticks[0]);
    }
    if (!course.bounds.empty() && course.bounds.back().at == k)
      course.bounds.back().safe = static_cast<double>(pairs_.wheel().due(p, world_.tick) - world_.tick) * rules_.dt;
  }

  MotionChange change(int i) const {
    const Flight& flight = world_.rods[i];
    return {flight.velocity - velocity_at(before_[i], world_.tick, rules_),
            flight.precession - before_[i].precession,
            flight.director,
            before_[i].rate,
            flight.rate,
            rules_.species_of(i).half_length,
            0};
  }

  const World& world_;
  TickRules rules_;
  PairSearch search_;
  std::vector<Course>& courses_;
  PairTable pairs_;
  std::vector<Flight> before_;
  std::vector<RodAtTick> rods_;
  std::vector<MotionBound> motions_;
  PairLanes lanes_{};
  std::vector<std::int32_t> due_;
};

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
        courses.push_back({{i, j}, {}, {}});
    }
  }
  if (courses.empty())
    throw Failure(ExitCode::kFailed, "no two rods are near each other: take a larger --area-fraction");
  return courses;
}

void draw_visits(const std::filesystem::path& folder, const Course& course, double dt, double window) {
  const auto ms = [&](std::size_t k) { return 1e3 * static_cast<double>(k) * dt; };
  std::string data;
  for (std::size_t k = 0; k < course.gap.size(); ++k)
    data += fmt::format("{:.6f} {:.5f}\n", ms(k), 1e3 * course.gap[k]);
  data += "\n\n";
  std::size_t n[3] = {0, 0, 0};
  for (const Bounded& bounded : course.bounds) {
    const double safe = std::min(1e3 * bounded.safe, 1e3 * window - ms(bounded.at));
    data += fmt::format("{:.6f} {:.5f} {:.6f} {}\n", ms(bounded.at), 1e3 * course.gap[bounded.at], safe,
                        static_cast<int>(bounded.event));
    ++n[static_cast<std::size_t>(bounded.event)];
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
    Snapshot now = simulation.snapshot();
    std::vector<Course> courses = near_pairs(simulation, now);
    const auto ticks = static_cast<Tick>(window / wanted.dt);
    Following following(simulation, courses);
    for (Tick k = 0; k < ticks; ++k) {
      following.look(now);
      advance(simulation, 1);
      now = simulation.snapshot();
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
