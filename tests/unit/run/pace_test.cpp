#include "run/live/pace.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "base/scratch_folder.h"
#include "run/files/observables_file.h"
#include "run/loop/words_of_run.h"

namespace shaken::run {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(Pacer, ComesRoundOncePerPeriod) {
  const WallClock::time_point start{};
  Pacer pacer(WallSeconds(0.5), start);
  EXPECT_TRUE(pacer.take(start));
  EXPECT_FALSE(pacer.take(start));
  EXPECT_FALSE(pacer.take(start + milliseconds(499)));
  EXPECT_TRUE(pacer.take(start + milliseconds(500)));
  EXPECT_TRUE(pacer.take(start + seconds(60))) << "late";
  EXPECT_FALSE(pacer.take(start + seconds(60) + milliseconds(1))) << "what was missed is not made up for";
}

TEST(RateMeter, KnowsAConstantRateAtOnce) {
  const WallClock::time_point start{};
  RateMeter meter(100.0, start);
  EXPECT_EQ(meter.rate(), 0);
  EXPECT_LT(meter.eta(200), 0) << "unknown";
  for (int i = 1; i <= 20; ++i) {
    meter.update(100.0 + 0.25 * i, start + milliseconds(500 * i));
    EXPECT_NEAR(meter.rate(), 0.5, 1e-12);
  }
  EXPECT_NEAR(meter.eta(110), 10, 1e-9);
}

TEST(RateMeter, IsNotFooledByCallsInQuickSuccession) {
  const WallClock::time_point start{};
  RateMeter meter(0, start);
  meter.update(0, start + milliseconds(1));
  meter.update(1, start + seconds(1));
  EXPECT_NEAR(meter.rate(), 1, 1e-12);
  meter.update(1, start + seconds(1) + milliseconds(1));
  EXPECT_NEAR(meter.rate(), 1, 1e-12);
}

TEST(RateMeter, FollowsAChangeWithinTenSeconds) {
  const WallClock::time_point start{};
  RateMeter meter(0, start);
  double sim = 0;
  for (int i = 1; i <= 120; ++i) meter.update(sim += 1, start + seconds(i));
  for (int i = 121; i <= 135; ++i) meter.update(sim += 0.1, start + seconds(i));
  EXPECT_NEAR(meter.rate(), 0.1, 0.1);
}

TEST(DescribeProgress, ShowsHowFarAndHowLong) {
  Progress progress;
  progress.sim_time = 5;
  progress.sim_time_total = 10;
  progress.sim_rate = 0.02;
  progress.eta = 250;
  progress.order = 0.913;
  EXPECT_EQ(describe_progress(progress),
            "████████████············  50.0 %  5 of 10 s  0.02 s/s  ETA 4 min 10 s  S 0.913");
  progress.state = "rendering";
  progress.drawn = 0.4;
  EXPECT_EQ(describe_progress(progress),
            "████████████············  50.0 %  5 of 10 s  drawing 40 %  ETA 4 min 10 s  S 0.913");
  progress.state = "stopped";
  EXPECT_EQ(describe_progress(progress), "████████████············  50.0 %  5 of 10 s  stopped  S 0.913");
  progress.order = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(describe_progress(progress), "████████████············  50.0 %  5 of 10 s  stopped") << "spheres";
}

using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

Json summary(const Json& steady) {
  return {{"n_rods", 120},
          {"sim_seconds", 2.0},
          {"cpu_seconds", 12.25},
          {"steady", steady},
          {"order",
           {{"mean", 0.94961},
            {"sem", 0.00092},
            {"t_steady_s", 1.5},
            {"n_effective", 11.0},
            {"drift", {{"value", -0.0213}, {"sem", 0.004}}}}}};
}

TEST(Ending, SaysWhatCameOutAndWhereItIs) {
  const ScratchFolder folder;
  std::ofstream(folder.path() / "summary.json") << "{}";
  const std::string text = describe_ending(summary(true), folder.path());
  EXPECT_THAT(text, HasSubstr("120 rods, 2 s, in 12 s of CPU time\n"));
  EXPECT_THAT(text, HasSubstr("S = 0.9496 +- 0.0009, from 1.5 s on, 11 independent samples: steady\n"));
  EXPECT_THAT(text, HasSubstr("  summary.json    all numbers"));
  EXPECT_THAT(text, Not(HasSubstr("trajectory.h5"))) << "only what is there";
  EXPECT_THAT(text, HasSubstr("next: shaken plot " + folder.path().string()));
  EXPECT_THAT(text, Not(HasSubstr("relaxing")));
}

TEST(Ending, NamesTheCurvesThatWereMeasured) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_observables(folder / "observables.h5",
                                {{"/order/time_s", {0, 1}}, {"/order/order", {1, 1}}, {"/msd/total_mm2", {1}}}, {}));
  EXPECT_THAT(describe_ending(summary(true), folder.path()), HasSubstr("observables.h5  curves of order, msd\n"));
  ASSERT_TRUE(write_observables(folder / "observables.h5", {{"/rods/trace/time_s", {0}}}, {}));
  EXPECT_THAT(describe_ending(summary(true), folder.path()), HasSubstr("observables.h5  curves of rods\n"));
}

TEST(Ending, ARunThatRelaxesIsToldSoWithAWayOut) {
  const std::string text = describe_ending(summary(false), "runs/a");
  EXPECT_THAT(text, HasSubstr("\n~ still relaxing\n"));
  EXPECT_THAT(text, HasSubstr("the change of S from the first half of that time to the second, -0.021 +- 0.004"));
  EXPECT_THAT(text, HasSubstr("-s time.measure=8\n"));
  EXPECT_THAT(text, Not(HasSubstr(": steady")));
}

// What the log says while the run ends, its summary and its last words are one sentence.
TEST(Ending, SaysTheReasonThatTheSummarySays) {
  Json known = summary(false);
  known["order"]["why_not_steady"] = "still relaxing: S was on its way until 1.5 s of 2 s; measure longer";
  EXPECT_THAT(describe_ending(known, "runs/a"),
              HasSubstr("\n~ still relaxing: S was on its way until 1.5 s of 2 s; measure longer\n"));
}

TEST(Ending, WhatIsNotKnownIsNotClaimed) {
  EXPECT_THAT(describe_ending(summary(nullptr), "a"), HasSubstr("\n? not known to be steady\n"));
  Json without_error = summary(true);
  without_error["order"]["sem"] = nullptr;
  EXPECT_THAT(describe_ending(without_error, "a"), HasSubstr("S = 0.95 (error unknown)"));
  Json relaxing = summary(false);
  relaxing["order"]["sem"] = nullptr;
  EXPECT_THAT(describe_ending(relaxing, "a"), Not(HasSubstr("the error holds"))) << "there is none";
  EXPECT_THAT(describe_ending(Json{{"n_rods", 3}, {"order", nullptr}}, "a"), HasSubstr("S was not measured"));
}

}  // namespace
}  // namespace shaken::run
