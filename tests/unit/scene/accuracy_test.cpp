// SPDX-License-Identifier: MIT
#include "scene/accuracy.h"

#include "scene/canonical.h"
#include "scene/fields.h"
#include "scene/sweep.h"
#include "tests/unit/scene/support.h"

namespace shaken::scene {
namespace {

TEST(Accuracy, LevelsGoFromCoarseToFineAndAreAllowedSteps) {
  double last = 1;
  for (const AccuracyLevel& level : accuracy_levels()) {
    EXPECT_LT(level.step, last) << level.name;
    EXPECT_TRUE(is_allowed(field_at("time.step"), level.step)) << level.name;
    EXPECT_EQ(accuracy_level(level.name), &level);
    last = level.step;
  }
  EXPECT_EQ(accuracy_level("sloppy"), nullptr);
}

TEST(Accuracy, StandsForAStep) {
  for (const AccuracyLevel& level : accuracy_levels()) {
    const std::string setting = "accuracy=" + std::string(level.name);
    const RunPlan plan = plan_of("{}", {setting});
    EXPECT_EQ(plan.system.dt, level.step);
    // the run is that of the step: its name says nothing of the word
    EXPECT_EQ(run_id(plan), run_id(plan_of("{}", {"time.step=" + std::to_string(level.step * 1e6) + " us"})));
    EXPECT_FALSE(to_json(plan).contains("accuracy"));
    EXPECT_EQ(to_json(plan)["time"]["step"], level.step);
  }
  EXPECT_EQ(run_id(plan_of(R"({"accuracy": "paper"})")), run_id(plan_of("{}")));
  EXPECT_EQ(plan_of(R"({"accuracy": null})"), plan_of("{}"));
}

TEST(Accuracy, ContradictingTheStepIsRefused) {
  EXPECT_EQ(plan_of(R"({"accuracy": "paper", "time": {"step": "4 us"}})"), plan_of("{}"));
  EXPECT_EQ(
      problem_of(R"({"accuracy": "fine", "time": {"step": "4 us"}})"),
      "run.json:1:14: /accuracy: accuracy \"fine\" is a time.step of 1 us, but time.step 4 us is given; remove one");
  EXPECT_EQ(problem_of(R"({"accuracy": "fin"})"),
            "run.json:1:14: /accuracy: \"fin\" is not one of \"draft\", \"paper\", \"fine\"; did you mean fine?");
  EXPECT_NE(problem_of(R"({"accuracy": "draft", "plates": {"frequency": "5 kHz"}})").find("at most 10 us"),
            std::string::npos);
}

TEST(Accuracy, CanBeSwept) {
  const auto sweep = load_sweep(R"({"scene": {}, "sweep": {"grid": {"accuracy": ["draft", "fine"]}}})", "s.json");
  ASSERT_TRUE(sweep) << to_string(sweep.error());
  ASSERT_EQ(sweep->points.size(), 2u);
  EXPECT_EQ(sweep->points[0].label, "accuracy=draft");
  EXPECT_EQ(sweep->points[0].plan.system.dt, accuracy_level("draft")->step);
  EXPECT_EQ(sweep->points[1].plan.system.dt, accuracy_level("fine")->step);
}

}  // namespace
}  // namespace shaken::scene
