// Both steppers over everything that a scene may say: 300 cases at night, any number by `./dev fuzz steppers`.
#include "tests/support/random_scenes.h"

#include <gtest/gtest.h>

#include "tests/support/effort.h"

namespace shaken {
namespace {

TEST(RandomScenes, SteppersAgreeInAllThatTheValidatorAccepts) {
  constexpr int kFirstSeed = 1'000'000;
  const int wanted = test::draws(300);
  int n_valid = 0, n_in_full = 0, n_drawn = 0;
  for (; n_valid < wanted && n_drawn < 10 * wanted; ++n_drawn) {
    const test::SceneCase one = test::draw_scene_case(static_cast<std::uint64_t>(kFirstSeed + n_drawn));
    const test::CaseResult result = test::compare_steppers(one);
    if (!result.is_valid) continue;
    ++n_valid;
    n_in_full += result.in_full;
    ASSERT_EQ(result.difference, "") << test::shrink(one, 100).to_json().dump(2);
  }
  EXPECT_EQ(n_valid, wanted) << "of " << n_drawn;
  EXPECT_GT(n_in_full, 0.7 * wanted) << "too many end in numerical trouble";
}

// Rods that ride on sticky plates at a low frequency, in touch with each other: what the beads of two rods approach by
// is next to nothing beside what both move at.
TEST(RandomScenes, SteppersAgreeWhereRodsRideOnStickyPlates) {
  for (int seed = 1; seed <= 20; ++seed) {
    test::SceneCase one;
    one.scene = nlohmann::ordered_json::parse(R"({
      "rods": {"length": "4.5 mm", "count": 8}, "box": {"side": "10 mm"}, "plates": {"gamma": 10, "frequency": "50 Hz"},
      "contacts": {"rod_rod": {"restitution": 0}, "rod_base": {"restitution": 0, "friction": 0.3},
                   "rod_lid": {"restitution": 0, "friction": 0.3}},
      "time": {"step": "32 us", "steady": 0, "measure": "0.8 s"}, "measure": {}})");
    one.scene["time"]["seed"] = seed;
    one.ticks = 25000;
    one.stop = 7001;
    const test::CaseResult result = test::compare_steppers(one);
    ASSERT_TRUE(result.is_valid) << result.problem;
    EXPECT_EQ(result.difference, "") << "seed " << seed;
  }
}

// An impact at its instant on one bead presses another, which recedes, deeper into the lid than any bead was found.
TEST(RandomScenes, SteppersAgreeOnHowDeepAnImpactPressesOtherBeads) {
  test::SceneCase one;
  one.scene = nlohmann::ordered_json::parse(R"({
    "rods": {"bead_diameters": [0.743, 0.698, 0.496, 0.599, 0.627, 0.71, 0.703, 0.6, 0.47, 0.55, 0.729, 0.794, 0.742,
                                0.686, 0.546, 0.741, 0.569, 0.8], "count": 1},
    "box": {"gap": 0.832}, "plates": {"frequency": 331, "gamma": 28.7},
    "time": {"step": "62.3 us", "impacts": "at_instant"}})");
  one.ticks = 5;
  one.stop = 4;
  one.begin = 8589930663;  // the lid is where it cannot be at the start
  const test::CaseResult result = test::compare_steppers(one);
  ASSERT_TRUE(result.is_valid) << result.problem;
  EXPECT_EQ(result.difference, "");
}

}  // namespace
}  // namespace shaken
