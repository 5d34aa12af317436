// SPDX-License-Identifier: MIT
// The books close: energy and momentum that rods have are what they had, got and lost, entered impact by impact.
#include <gtest/gtest.h>

#include "sim/effects/side_walls.h"
#include "sim/simulation.h"

namespace shaken {
namespace {

constexpr double kRounding = 1e-11;  ///< of all energy that changed hands; 1e5 impacts, each right to 1e-16

Scene rods() {
  Scene scene;
  scene.rod = {.length = 2.5, .n_beads = 9};
  scene.box_side = 12;
  scene.n_rods = 60;
  return scene;
}

struct Case {
  const char* name;
  void (*set)(Scene&);
};

class LedgerOf : public testing::TestWithParam<Case> {};

TEST_P(LedgerOf, Closes) {
  Scene scene = rods();
  GetParam().set(scene);
  auto simulation = Simulation::start(scene);
  ASSERT_TRUE(static_cast<bool>(simulation)) << simulation.error().message;
  const double momentum_scale = simulation->world().species[0].mass * 50 * scene.n_all_rods();
  for (const Tick k : {1, 5000, 25000}) {
    ASSERT_FALSE(simulation->advance_to(k).has_value());
    const Balance books = balance(simulation->world());
    EXPECT_LT(books.energy_error(), kRounding) << "tick " << k;
    EXPECT_LT(books.momentum_unexplained.norm(), 1e-9 * momentum_scale) << "tick " << k;
    if (k == 5000) simulation = Simulation::resume(scene, simulation->checkpoint());  // books go on
  }
  const Balance books = balance(simulation->world());
  EXPECT_GT(books.energy_lost_rod_rod, 0);
  // an error of a millionth in what the impacts lose would show
  EXPECT_GT(1e-6 * books.energy_lost_rod_rod, 10 * std::abs(books.energy_unexplained));
}

INSTANTIATE_TEST_SUITE_P(Scenes, LedgerOf,
                         testing::Values(Case{"Paper", [](Scene&) {}},
                                         Case{"Frictionless",
                                              [](Scene& s) {
                                                s.rod_rod.friction = s.rod_base.friction = s.rod_lid.friction = 0;
                                              }},
                                         Case{"PlatesAtRest", [](Scene& s) { s.amplitude = 0; }},
                                         Case{"RoughAndSticky",
                                              [](Scene& s) {
                                                s.rod_rod.friction = s.rod_base.friction = 0.5;
                                                s.rotational_noise = 0.1;
                                              }},
                                         Case{"AtInstant", [](Scene& s) { s.impacts = ImpactTime::kAtInstant; }},
                                         Case{"EnergeticLaw",
                                              [](Scene& s) {
                                                s.law = ImpulseLaw::kEnergetic;
                                                s.rod_rod.friction = 1;
                                              }},
                                         Case{"SpheresInADisc",
                                              [](Scene& s) {
                                                s.walls = SideWalls{Arena::kDisc, 11.0, 1.0, {0.2, 0.3}};
                                                s.n_rods = 15;
                                                s.added[0] = AddedRods{{.length = 0.8, .n_beads = 1}, 20};
                                                s.start = Start::kRandom;
                                              }}),
                         [](const auto& about) { return std::string(about.param.name); });

// Side walls take what friction with them does not.
TEST(Ledger, MomentumOfTheDiscComesFromItsWall) {
  Scene scene = rods();
  scene.walls = SideWalls{Arena::kDisc, 11.0, 1.0, {0.0, 0.3}};
  scene.n_rods = 30;
  scene.rod_base.friction = scene.rod_lid.friction = 0;
  auto simulation = Simulation::start(scene);
  ASSERT_TRUE(static_cast<bool>(simulation)) << simulation.error().message;
  ASSERT_FALSE(simulation->advance_to(25000).has_value());
  const World& world = simulation->world();
  EXPECT_GT(world.counters.impulses_rod_wall, 10);
  for (std::size_t i = 0; i < world.rods.size(); ++i) {
    const Snapshot now = simulation->snapshot();
    EXPECT_GT(distance_to_walls(*scene.walls, scene.box_side, now.position[i]), 0.0) << "rod " << i << " is outside";
  }
}

}  // namespace
}  // namespace shaken
