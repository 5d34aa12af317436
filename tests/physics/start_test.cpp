// The steady state does not depend on the start: S from rows and from the compressed, disordered start agree, at area
// fraction 0.55 and l = 4.5 mm, once the rows are forgotten. Before, they differ.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "sim/simulation.h"

namespace shaken {
namespace {

double order_of(const Snapshot& rods) {
  double c = 0, s = 0;
  for (const Vec3& director : rods.director) {
    const Vec2 along = director.head<2>().normalized();
    c += along.x() * along.x() - along.y() * along.y();
    s += 2 * along.x() * along.y();
  }
  return std::hypot(c, s) / static_cast<double>(rods.n_rods());
}

struct Mean {
  double value = 0;
  double sem = 0;
};

Mean mean_of(const std::vector<double>& all) {
  const double n = static_cast<double>(all.size());
  Mean mean;
  for (const double one : all) mean.value += one / n;
  for (const double one : all) mean.sem += (one - mean.value) * (one - mean.value) / (n * (n - 1));
  mean.sem = std::sqrt(mean.sem);
  return mean;
}

/// Means of S over stretches of time, and their errors from replicas.
struct Course {
  Mean begin;   ///< the first 50 ms
  Mean steady;  ///< from kForgotten on
};

constexpr double kForgotten = 6, kEnd = 12;  // [s]

Course course_from(Start start) {
  constexpr int kReplicas = 8;
  std::vector<double> early, late;
  for (int replica = 0; replica < kReplicas; ++replica) {
    System system;
    system.rod = {.length = 4.5, .n_beads = 15};
    system.box_side = 11;
    system.n_rods = static_cast<int>(std::round(0.55 * 11 * 11 / make_species(system.rod).area));
    system.dt = 16e-6;
    system.start = start;
    system.seed = 100 + static_cast<std::uint64_t>(replica);
    Simulation simulation = std::move(Simulation::start(system)).value();
    double sum_early = 0, n_early = 0, sum_late = 0, n_late = 0;
    const auto period = static_cast<Tick>(std::llround(0.01 / system.dt));
    while (simulation.time() < kEnd) {
      EXPECT_FALSE(simulation.advance_to(simulation.tick() + period));
      const double order = order_of(simulation.snapshot());
      if (simulation.time() < 0.055) sum_early += order, n_early += 1;
      if (simulation.time() > kForgotten) sum_late += order, n_late += 1;
    }
    early.push_back(sum_early / n_early);
    late.push_back(sum_late / n_late);
  }
  return {mean_of(early), mean_of(late)};
}

TEST(Start, TheSteadyStateForgetsIt) {
  const Course rows = course_from(Start::kAligned), compressed = course_from(Start::kCompressed);
  for (const auto& [name, course] : {std::pair{"rows", rows}, std::pair{"compressed", compressed}}) {
    std::printf("%s: S = %.3f +- %.3f at the start, %.3f +- %.3f from %g to %g s\n", name, course.begin.value,
                course.begin.sem, course.steady.value, course.steady.sem, kForgotten, kEnd);
  }
  const auto errors_apart = [](const Mean& one, const Mean& other) {
    return std::abs(one.value - other.value) / std::hypot(one.sem, other.sem);
  };
  EXPECT_GT(errors_apart(rows.begin, compressed.begin), 5) << "the starts differ, and the test could tell";
  EXPECT_LT(errors_apart(rows.steady, compressed.steady), 3);
  EXPECT_LT(std::hypot(rows.steady.sem, compressed.steady.sem), 0.06) << "or it would agree with anything";
}

}  // namespace
}  // namespace shaken
