// Scenes that are all right key by key and yet cannot be started, or must end in trouble.
#include "scene/placement.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "sim/simulation.h"
#include "sim/tick/tick.h"
#include "tests/unit/scene/scene_support.h"

namespace shaken::scene {
namespace {

using testing::HasSubstr;

/// A mixture that is too dense for one lattice, though not for its area.
constexpr const char* kMixture = R"({
  "rods": {"area_fraction": 0.5}, "rods_2": {"beads": 1, "count": 250},
  "rods_3": {"length": 2.5, "area_fraction": 0.1}, "box": {"side": "40 mm"}})";

TEST(Placement, WhatCannotBePlacedIsRefused) {
  EXPECT_TRUE(load_sweep(kMixture, "mix.json"));
  const Loaded<Sweep> refused = load_runs(kMixture, "mix.json");
  ASSERT_FALSE(refused);
  ASSERT_EQ(refused.error().size(), 1u);
  EXPECT_THAT(to_string(refused.error().front()), HasSubstr("mix.json: /rods: "));
  EXPECT_THAT(refused.error().front().message, HasSubstr("do not fit into the box: in rows at most "));
}

TEST(Placement, IsWhatTheSimulationSays) {
  int n_refused = 0;
  int n_placed = 0;
  for (const char* start : {"aligned", "random"}) {
    for (const char* walls : {"{}", "null", R"({"arena": "annulus", "inner": 8})"}) {
      for (const double fraction : {0.2, 0.35, 0.45, 0.6, 0.7, 0.8, 0.9}) {
        const std::vector<std::string> settings{"rods.start=" + std::string(start), "walls=" + std::string(walls),
                                                "rods.area_fraction=" + std::to_string(fraction), "box.side=25"};
        const Loaded<RunPlan> plan = load_scene("{}", "s", settings);
        if (!plan) continue;  // beyond what any box takes
        const Result<Simulation> started = Simulation::start(plan->system);
        const Loaded<Sweep> runs = load_runs("{}", "s", settings);
        ASSERT_EQ(static_cast<bool>(runs), static_cast<bool>(started)) << settings[0] << settings[1] << settings[2];
        EXPECT_EQ(placement_problem(*plan, "s").has_value(), !started);
        if (!started) {
          EXPECT_THAT(runs.error().front().message, testing::StartsWith(started.error().message));
        }
        ++(started ? n_placed : n_refused);
      }
    }
  }
  EXPECT_GE(n_refused, 4);
  EXPECT_GE(n_placed, 10);
}

TEST(Placement, AnAngleIsPlacedAndACompressedStartIsLeftToTheRun) {
  const std::vector<std::string> fits{"rods.area_fraction=0.85", "box.side=25", "rods.start_angle=1,30,45"};
  EXPECT_TRUE(load_runs("{}", "s", fits));
  const std::vector<std::string> discs{"rods.beads=1", "rods.area_fraction=0.915", "rods.start_angle=30",
                                       "box.side=20"};
  const Loaded<Sweep> refused = load_runs("{}", "s", discs);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().front().message, HasSubstr("in rows of rods at 30 degrees at most "));
  const std::vector<std::string> large{"rods.start=compressed", "rods.area_fraction=0.85", "box.side=400"};
  EXPECT_TRUE(load_runs("{}", "s", large)) << "54,000 rods, at once";
}

// 49 rods do not fit in rows into a box of 12 mm: where they do is what one wants to know, and that the others are
// fine.
TEST(Placement, ARefusalNamesTheNearestSideThatHoldsTheRodsAndWhatIsFine) {
  const std::vector<std::string> settings{"rods.area_fraction=0.45:0.85:0.1", "rods.length=2.5,4.5"};
  const Loaded<Sweep> refused = load_runs(R"({"box": {"side": "12 mm"}})", "scene.json", settings, 3);
  ASSERT_FALSE(refused);
  const std::string message = refused.error().back().message;
  EXPECT_THAT(message, HasSubstr(" of 30 points are fine"));
  const std::size_t at = message.find("a box.side of ");
  ASSERT_NE(at, std::string::npos) << message;
  const std::string side = message.substr(at + 14, message.find(" mm holds") - at - 14);
  EXPECT_TRUE(load_runs("{}", "scene.json",
                        std::vector<std::string>{"box.side=" + side, "rods.area_fraction=0.85", "rods.length=4.5"}))
      << side;
}

TEST(Placement, EveryPointOfASweepIsPlacedAndNamed) {
  const Loaded<Sweep> runs =
      load_runs(R"({"box": {"side": 25}})", "s.json",
                std::vector<std::string>{"rods.area_fraction=0.5,0.915,0.918", "time.step=4e-6,2e-6"}, 2);
  ASSERT_FALSE(runs);
  ASSERT_EQ(runs.error().size(), 2u) << "the step and the seed do not matter: " << to_string(runs.error());
  EXPECT_THAT(runs.error()[0].message, HasSubstr("rods.area_fraction=0.915 time.step=4e-06 replica=1: "));
  EXPECT_THAT(runs.error()[1].message, HasSubstr("rods.area_fraction=0.918 time.step=4e-06 replica=1: "));
}

/// The bound on the plates' speed is the depth at which the simulation ends a run.
TEST(FastPlates, AreRefusedWhereTheSimulationWouldEnd) {
  const char* scene = R"({"box": {"side": 14}, "rods": {"area_fraction": 0.4}, "time": {"step": "100 us"},
                          "plates": {"frequency": 100}})";
  int n_refused = 0;
  for (const double gamma : {7.0, 60.0, 64.0, 64.2, 80.0, 150.0}) {
    const Loaded<RunPlan> plan = load_scene(scene, "s", std::vector{"plates.gamma=" + std::to_string(gamma)});
    System system = plan_of(scene).system;
    system.amplitude *= gamma / 7;
    const World world = empty_world(system);
    const auto& radius = world.species[0].bead_radius;
    const double deepest = kMaxOverlapFraction * *std::min_element(radius.begin(), radius.end());
    EXPECT_EQ(static_cast<bool>(plan), world.plates.peak_speed() * system.dt <= deepest) << gamma;
    if (plan) continue;
    ++n_refused;
    Result<Simulation> simulation = Simulation::start(system);
    ASSERT_TRUE(static_cast<bool>(simulation));
    EXPECT_TRUE(simulation->advance_to(100000).has_value()) << gamma << ": a thousand periods without trouble";
  }
  EXPECT_EQ(n_refused, 3);
}

}  // namespace
}  // namespace shaken::scene
