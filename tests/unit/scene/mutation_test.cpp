// SPDX-License-Identifier: MIT
// Whatever is written: an answer, never a crash, and either a plan that can be written and read again or a problem.
#include <array>
#include <random>

#include "scene/canonical.h"
#include "scene/sweep.h"
#include "tests/support/effort.h"
#include "tests/unit/scene/support.h"

namespace shaken::scene {
namespace {

constexpr std::string_view kScene = R"({ // a comment
  "rods":  { "length": "4.5 mm", "mid_diameter": 0.8, "end_diameter": "400 um", "beads": 15, "area_fraction": 0.5 },
  "box":   { "side": "40 mm", "gap": 1.2 }, "plates": { "gamma": 7.0, "frequency": "200 Hz" }, "gravity": "9.81 m/s^2",
  "contacts": { "rod_rod": { "friction": 0.05, "restitution": 0.3 }, "law": "newton", "sweeps": 2 },
  "time":  { "step": "4 us", "steady": "auto", "measure": "6000 s", "seed": 1 }, /* more */
  "measure": { "order": {"every": "10 ms"}, "g2": {}, "msd": null, "defects": {"grid": 1} },
  "stream": { "rate": "20 Hz" }, "movie": { "every": "50 ms", "size": [1280, 720] } })";

constexpr std::string_view kSweep = R"({ "name": "x", "scene": { "box": {"side": 40} }, "sweep": {
  "grid": { "rods.length": [2.5, "3.5 mm"], "rods.area_fraction": "0.45:0.55:0.1" },
  "zip": { "box.gap": [1.2, 1.4], "plates.gamma": {"from": 6, "to": 7, "n": 2} },
  "list": [ {"time.step": "2 us"} ], "random": { "n": 1, "seed": 1, "contacts.rod_rod.friction": {"from": 0, "to": 1} },
  "replicas": 2 } })";

constexpr auto kPieces = std::to_array<std::string_view>(
    {"{",  "}",     "[",    "]",      ",",       ":",          "\"",        "\\",       "/*",
     "*/", "//",    "\n",   " ",      "0",       "9",          "-",         ".",        "e",
     "e9", "1e308", "null", "true",   "NaN",     "mm",         " us",       "\"rods\"", "\"length\":",
     "{}", "[]",    "\xff", "\u00b5", "0:1:0.1", "\"sweep\":", "\"grid\":", "1",        "999999999999999999",
     "-0"});

/// A few pieces cut out, doubled, swapped or put in.
std::string mutated(std::string_view original, std::mt19937_64& random) {
  std::string text(original);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  for (std::size_t n = 1 + below(4); n > 0 && !text.empty(); --n) {
    const std::size_t at = below(text.size());
    const std::size_t length = 1 + below(below(4) == 0 ? 60 : 4);
    switch (below(5)) {
      case 0:
        text.erase(at, length);
        break;
      case 1:
        text.insert(at, text.substr(below(text.size()), length));
        break;
      case 2:
        text.insert(at, kPieces[below(kPieces.size())]);
        break;
      case 3:
        text[at] = static_cast<char>(random() % 256);
        break;
      default:
        text.replace(at, length, kPieces[below(kPieces.size())]);
        break;
    }
  }
  return text;
}

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
  EXPECT_TRUE(load_sweep(kSweep, "f")) << to_string(load_sweep(kSweep, "f").error());
}

TEST(Mutation, NothingCrashes) {
  std::mt19937_64 random(20240801);
  for (int i = 0; i < test::draws(20000); ++i) {
    const std::string text = mutated(i % 2 == 0 ? kScene : kSweep, random);
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
