// Every hard case of `shaken bench hard` by both steppers: states, counters and ledgers must be the same to the last
// bit, and so must the trouble in which some of them end.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "bench/hard/hard.h"
#include "tests/support/compare_steppers.h"
#include "tests/support/effort.h"

namespace shaken::bench {
namespace {

const std::filesystem::path kFolder = SHAKEN_SOURCE_DIR "/configs/hard";

/// Rods times ticks that the reference stepper goes through in one case: about one second of CPU time, at night.
const Tick kAffordable = test::draws(2'500'000);

/// Ticks to be compared, of each of `n_worlds` alike.
Tick stretch(const World& world, Tick at_most, std::size_t n_worlds = 1) {
  const auto n = static_cast<Tick>(world.rods.size() * n_worlds);
  return std::clamp<Tick>(kAffordable / n, 200, at_most);
}

std::string name_for_test(std::string name) {
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

class HardScene : public testing::TestWithParam<std::string> {};
TEST_P(HardScene, IsTheSameByBothSteppers) {
  const scene::RunPlan plan = read_hard_scene(kFolder, GetParam());
  const auto started = Simulation::start(plan.system);
  ASSERT_TRUE(static_cast<bool>(started)) << started.error().message;
  const World& world = started->world();
  const auto whole = static_cast<Tick>(plan.total_time() / plan.system.dt);
  const Tick ticks = stretch(world, whole);
  EXPECT_EQ(test::problem(test::compare(world, ticks, ticks / 3)), "");
}
std::vector<std::string> scene_names() {
  std::vector<std::string> names{"order-sorted", "order-reversed", "order-shuffled"};
  for (const SceneCase& of : scene_cases()) names.push_back(of.name);
  return names;
}
INSTANTIATE_TEST_SUITE_P(Hard, HardScene, testing::ValuesIn(scene_names()),
                         [](const auto& test) { return name_for_test(test.param); });

class HardStart : public testing::TestWithParam<MadeCase> {};
TEST_P(HardStart, IsTheSameByBothSteppers) {
  const std::vector<World> starts = GetParam().starts();
  EXPECT_EQ(starts.empty(), GetParam().name == "does-not-fit");
  for (const World& start : starts) {
    const Tick ticks = stretch(start, 25'000, starts.size());
    // some must end in trouble long before: at the same tick, with the same rods
    EXPECT_EQ(test::compare(start, ticks, ticks / 3).difference, "");
  }
}
INSTANTIATE_TEST_SUITE_P(Hard, HardStart, testing::ValuesIn(made_cases()),
                         [](const auto& test) { return name_for_test(test.param.name); });

}  // namespace
}  // namespace shaken::bench
