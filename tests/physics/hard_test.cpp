// SPDX-License-Identifier: MIT
// The hard cases of `shaken bench hard`: those made by hand in full, the scenes for a short while.
#include <gtest/gtest.h>

#include "bench/hard/made_cases.h"
#include "bench/hard/scene_cases.h"
#include "sim/simulation.h"

namespace shaken::bench {
namespace {

const std::filesystem::path kFolder = SHAKEN_SOURCE_DIR "/configs/hard";

void expect_ok(const HardCase& of) {
  ASSERT_FALSE(of.outcomes.empty());
  for (const Outcome& outcome : of.outcomes) {
    EXPECT_TRUE(outcome.ok()) << of.name << ": " << outcome.holds << ": " << outcome.worst << ", limit "
                              << outcome.limit << "; " << outcome.note;
  }
}

class MadeByHand : public testing::TestWithParam<MadeCase> {};
TEST_P(MadeByHand, Holds) { expect_ok(GetParam().run()); }
INSTANTIATE_TEST_SUITE_P(Hard, MadeByHand, testing::ValuesIn(made_cases()), [](const auto& test) {
  std::string name = test.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

class SceneOfFile : public testing::TestWithParam<SceneCase> {};
TEST_P(SceneOfFile, HoldsForAWhile) {
  const scene::RunPlan plan = read_hard_scene(kFolder, GetParam().name);
  const double seconds = GetParam().name == "rest" ? 10.0 : 0.05;
  if (GetParam().makes_energy) GTEST_SKIP() << "takes longer to show";
  expect_ok(run_scene_case(GetParam(), plan, seconds, [](double) {}));
}
TEST_P(SceneOfFile, BothEnginesGiveTheSame) {
  Scene scene = read_hard_scene(kFolder, GetParam().name).system;
  scene.engine = Engine::kReference;
  auto reference = Simulation::start(scene);
  scene.engine = Engine::kScheduled;
  auto scheduled = Simulation::start(scene);
  ASSERT_TRUE(reference && scheduled);
  ASSERT_FALSE(reference->advance_to(1500).has_value());
  ASSERT_FALSE(scheduled->advance_to(1500).has_value());
  EXPECT_EQ(reference->state_hash(), scheduled->state_hash());
}
INSTANTIATE_TEST_SUITE_P(Hard, SceneOfFile, testing::ValuesIn(scene_cases()), [](const auto& test) {
  std::string name = test.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(HardOutcome, KnowsWhatDoesNotHold) {
  EXPECT_TRUE((Outcome{"", 1, 2}.ok()));
  EXPECT_FALSE((Outcome{"", 3, 2}.ok()));
  EXPECT_FALSE((Outcome{"", std::numeric_limits<double>::quiet_NaN(), 2}.ok()));
  EXPECT_TRUE((Outcome{"", 2, 2, true}.ok()));
  EXPECT_FALSE((Outcome{"", 1, 2, true}.ok()));
  EXPECT_EQ((Outcome{"", 1, 2}.margin()), 2);
}

}  // namespace
}  // namespace shaken::bench
