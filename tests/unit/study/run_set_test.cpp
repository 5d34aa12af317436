// SPDX-License-Identifier: MIT
#include "study/run_set.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/failure.h"
#include "run/files/done.h"
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

TEST(FinishedRun, IsSteadyWhereSHardlyDrifts) {
  const auto of = [](const Json& told, double drift, double error) {
    const Json order{{"mean", 0.9}, {"sem", 0.01}, {"steady", told}, {"drift", {{"value", drift}, {"sem", error}}}};
    return FinishedRun(Json::object(), Json{{"steady", told}, {"order", order}}, {});
  };
  EXPECT_EQ(of(nullptr, 0.01, 0.01).steady(), true);
  EXPECT_EQ(of(nullptr, -0.01, 0.01).steady(), true);
  EXPECT_EQ(of(nullptr, 0.01, 0.02).steady(), std::nullopt) << "the drift may be 0.06";
  EXPECT_EQ(of(nullptr, -0.04, 0.01).steady(), std::nullopt);
  EXPECT_EQ(of(false, 0.0, 0.001).steady(), false);
  EXPECT_EQ(of(true, 0.1, 0.1).steady(), true);
  const Estimate order = of(nullptr, 0.01, 0.02).scalar("order.mean");
  EXPECT_EQ(order.steady, std::nullopt);
  EXPECT_NEAR(judged_error(order), std::sqrt(0.01 * 0.01 + 0.01 * 0.01 + 0.02 * 0.02), 1e-12);
  EXPECT_EQ(of(nullptr, 0.01, 0.01).scalar("order.mean").steady, std::nullopt) << "it knows its own drift";
}

TEST(JudgedError, HoldsForMeansThatStillRelaxAsItSays) {
  // x = exp(-t / tau) over [0, T] has the mean tau / T (1 - exp(-T / tau)), and the truth is 0.
  const auto mean = [](double tau, double from, double to) {
    return tau / (to - from) * (std::exp(-from / tau) - std::exp(-to / tau));
  };
  const auto covered = [&](double tau) {
    const Estimate estimate{
        .value = mean(tau, 0, 1), .sem = 0, .drift = mean(tau, 0.5, 1) - mean(tau, 0, 0.5), .drift_sem = 0};
    return estimate.value <= 1.1 * judged_error(estimate);
  };
  for (const double tau : {0.01, 0.1, 0.2, 0.3, 0.4, 0.5}) EXPECT_TRUE(covered(tau)) << tau;
  EXPECT_FALSE(covered(1)) << "nobody sees a relaxation that takes longer than the run";
}

TEST(MeanScalar, OfReplicasDriftsAsTheyDo) {
  const auto of = [](double drift, double error) {
    return Estimate{.value = 1, .sem = 0.1, .drift = drift, .drift_sem = error};
  };
  const std::vector<Estimate> replicas{of(0.1, 0.03), of(0.3, 0.04)};
  EXPECT_NEAR(mean_of(replicas).drift, 0.2, 1e-12) << "what all do does not average out";
  EXPECT_NEAR(mean_of(replicas).drift_sem, 0.025, 1e-12);
  const std::vector<Estimate> one_steady{{.value = 1, .sem = 0.1, .steady = true}, of(0.3, 0.04)};
  EXPECT_NEAR(mean_of(one_steady).drift, 0.15, 1e-12) << "what is steady need not know its drift";
  EXPECT_EQ(mean_of(one_steady).steady, std::nullopt);
}

TEST(RunSet, JoinedHoldsEachRunOnce) {
  const auto run = [](const char* id) { return MadeUp(4.5, 0.75).number(Json::json_pointer("/run_id"), id).run(); };
  const RunSet all = joined({run("a"), run("b")}, {run("b"), run("c")});
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[2].id(), "c");
  EXPECT_EQ(joined({MadeUp(4.5, 0.75).run()}, {MadeUp(4.5, 0.75).run()}).size(), 2u) << "without an id they may differ";
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
