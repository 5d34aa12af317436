// SPDX-License-Identifier: MIT
// Whatever is written: an answer, never a crash, and either a plan that can be written and read again or a problem.
#include <array>
#include <random>

#include "scene/canonical.h"
#include "scene/sweeps/sweep.h"
#include "tests/support/effort.h"
#include "tests/unit/scene/mutated.h"
#include "tests/unit/scene/scene_support.h"

namespace shaken::scene {
namespace {

void check(const std::string& text) {
  const Loaded<RunPlan> scene = load_scene(text, "f");
  ASSERT_TRUE(scene || !scene.error().empty()) << text;
  if (scene) {
    const Loaded<RunPlan> again = load_scene(to_json(*scene).dump(), "f");
    ASSERT_TRUE(again) << text << "\n" << to_string(again.error());
    ASSERT_EQ(*again, *scene) << text;
  }
  const Loaded<Sweep> sweep = load_sweep(text, "f");
  ASSERT_TRUE(sweep || !sweep.error().empty()) << text;
  ASSERT_TRUE(!sweep || !sweep->points.empty()) << text;
}

TEST(Mutation, TheOriginalsAreValid) {
  EXPECT_TRUE(load_scene(kScene, "f")) << to_string(load_scene(kScene, "f").error());
  for (const std::string_view sweep : {kSweep, kSweeps}) {
    EXPECT_TRUE(load_sweep(sweep, "f")) << to_string(load_sweep(sweep, "f").error());
  }
}

TEST(Mutation, NothingCrashes) {
  std::mt19937_64 random(20240801);
  for (int i = 0; i < test::draws(30000); ++i) {
    const std::string text = mutated(std::array{kScene, kSweep, kSweeps}[static_cast<std::size_t>(i % 3)], random);
    ASSERT_NO_THROW(check(text)) << text;
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(Mutation, SettingsNeitherCrash) {
  std::mt19937_64 random(20240802);
  constexpr auto kSettings =
      std::to_array<std::string_view>({"rods.length=2.5,3.5", "measure={\"order\":{}}", "box.gap=1.2:1.4:0.1 mm",
                                       "movie.size=[640,480]", "stream=null"});
  for (int i = 0; i < test::draws(5000); ++i) {
    const std::vector<std::string> settings{mutated(kSettings[random() % kSettings.size()], random)};
    ASSERT_NO_THROW({
      const auto scene = load_scene("{}", "f", settings);
      ASSERT_TRUE(scene || !scene.error().empty()) << settings[0];
      const auto sweep = load_sweep(kSweep, "f", settings);
      ASSERT_TRUE(sweep || !sweep.error().empty()) << settings[0];
    }) << settings[0];
  }
}

}  // namespace
}  // namespace shaken::scene
