// SPDX-License-Identifier: MIT
#include "study/run_set.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/failure.h"
#include "tests/unit/study/made_up_run.h"
#include "tests/unit/study/run_directories.h"

namespace shaken::study {
namespace {

TEST(FinishedRun, KnowsSceneSummaryAndArrays) {
  Runs runs;
  const FinishedRun run =
      runs.make(4.5, 0.75, 0.9, 0.01,
                {{"theta_m_deg", {{"value", 10.5}, {"sem", 0.5}}}, {"unknown", {{"value", nullptr}, {"sem", nullptr}}}},
                {{"/g2/r_mm", {1, 2}}});
  EXPECT_EQ(run.number("rods.length"), 4.5);
  EXPECT_TRUE(std::isnan(run.number("rods.colour")));
  EXPECT_EQ(run.scalar("order.mean").value, 0.9);
  EXPECT_EQ(run.scalar("order.mean").sem, 0.01);
  EXPECT_EQ(run.scalar("theta_m_deg").value, 10.5);
  EXPECT_EQ(run.scalar("theta_m_deg").sem, 0.5);
  EXPECT_FALSE(is_known(run.scalar("unknown")));
  EXPECT_FALSE(is_known(run.scalar("never heard of")));
  EXPECT_EQ(run.array("/g2/r_mm"), (std::vector<double>{1, 2}));
  EXPECT_TRUE(run.array("/g2/nothing").empty());
  EXPECT_TRUE(run::is_done(run::RunDirectory{run.directory()}));
  EXPECT_FALSE(run::is_done(run::RunDirectory{runs.path()}));
  EXPECT_THROW(FinishedRun(runs.path()), Failure);
}

TEST(MeanScalar, OfReplicasHasTheLargerOfBothErrors) {
  Runs runs;
  const auto set = [&](double a, double b, double sem) {
    return RunSet{runs.make(4.5, 0.75, a, sem), runs.make(4.5, 0.75, b, sem)};
  };
  EXPECT_NEAR(mean_scalar(set(0.8, 0.9, 0.001), "order.mean").value, 0.85, 1e-12);
  EXPECT_NEAR(mean_scalar(set(0.8, 0.9, 0.001), "order.mean").sem, 0.05, 1e-12) << "the scatter between them";
  EXPECT_NEAR(mean_scalar(set(0.85, 0.85, 0.02), "order.mean").sem, 0.02 / std::sqrt(2.0), 1e-12) << "their own";
  EXPECT_NEAR(mean_scalar({runs.make(4.5, 0.75, 0.8, 0.02)}, "order.mean").sem, 0.02, 1e-12);
  EXPECT_FALSE(is_known(mean_scalar({}, "order.mean")));
}

TEST(MeanScalar, OfReplicasIsAsSteadyAsTheWorstOfThem) {
  const MadeUp steady = MadeUp(4.5, 0.75).order(0.9), relaxing = MadeUp(4.5, 0.75).order(0.9).relaxing(),
               untested = MadeUp(4.5, 0.75).order(0.9).untested();
  const auto of = [](const MadeUp& a, const MadeUp& b) { return mean_scalar({a.run(), b.run()}, "order.mean").steady; };
  EXPECT_EQ(of(steady, steady), true);
  EXPECT_EQ(of(steady, relaxing), false);
  EXPECT_EQ(of(steady, untested), std::nullopt);
  EXPECT_EQ(of(untested, relaxing), false);
}

TEST(FinishedRun, NumbersAreAsSteadyAsTheySayAndTheirRun) {
  const auto of = [](const Json& run, const Json& own) {
    const Json scalar{{"value", 1.0}, {"sem", 0.1}, {"steady", own}};
    return FinishedRun(Json::object(), Json{{"steady", run}, {"measured", {{"x", scalar}}}}, {}).scalar("x").steady;
  };
  EXPECT_EQ(of(true, nullptr), true) << "no average over time: as its run";
  EXPECT_EQ(of(true, true), true);
  EXPECT_EQ(of(nullptr, true), true) << "S was not measured";
  EXPECT_EQ(of(true, false), false);
  EXPECT_EQ(of(false, true), false);
  EXPECT_EQ(of(nullptr, nullptr), std::nullopt);
}

TEST(Crossing, IsInterpolatedWithItsError) {
  const auto at = [](double x, double y, double sem) { return Point{x, {.value = y, .sem = sem, .steady = true}}; };
  const std::vector<Point> points{at(0.7, 0.9, 0.03), at(0.5, 0.1, 0.01), at(0.6, 0.3, 0.03)};
  const Estimate found = crossing(points, 0.5);
  EXPECT_NEAR(found.value, 0.6 + 0.1 * 0.2 / 0.6, 1e-12);
  // y at that place has the error of 2/3 and 1/3 of its neighbours; the slope is 6
  EXPECT_NEAR(found.sem, std::hypot(2.0 / 3 * 0.03, 1.0 / 3 * 0.03) / 6, 1e-12);
  EXPECT_EQ(found.steady, true);
  EXPECT_FALSE(is_known(crossing(points, 0.95)));
  EXPECT_FALSE(is_known(crossing({at(0, 1, 0), at(1, 0, 0)}, 0.5))) << "it falls";
  EXPECT_FALSE(is_known(crossing({}, 0.5)));
}

}  // namespace
}  // namespace shaken::study
