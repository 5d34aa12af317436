// SPDX-License-Identifier: MIT
#include "run/loop/ending.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "base/scratch_folder.h"
#include "run/files/observables_file.h"

namespace shaken::run {
namespace {

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
  EXPECT_THAT(text, HasSubstr("S = 0.94961 +- 0.00092, from 1.5 s on, 11 independent samples: steady\n"));
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
  EXPECT_THAT(text, HasSubstr("the change of S from the first half of that time to the second, -0.0213 +- 0.0040"));
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
