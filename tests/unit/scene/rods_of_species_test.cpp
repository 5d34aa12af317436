// SPDX-License-Identifier: MIT
#include "scene/rods_of_species.h"

#include <gtest/gtest.h>

#include "scene/canonical.h"
#include "tests/unit/scene/scene_support.h"

namespace shaken::scene {
namespace rods_of_species_test {

constexpr const char* kMixture = R"({
  "rods": {"length": 3, "count": 20, "length_spread": 0.1}, "rods_3": {"length": 2, "count": 7, "profile": "polar"},
  "box": {"side": 40, "gap": 1.5}, "gravity": 9000, "walls": {"friction": 0.4},
  "plates": {"gamma": 5, "noise": 0.02, "rods_3": {"noise": 0.07}},
  "contacts": {"rod_base": {"friction": 0.1, "rods_3": {"friction": 0.3}}, "rod_lid": {"restitution": 0.5},
               "rod_rod": {"friction": 0.2, "rods_rods_3": {"friction": 0.6}, "rods_3_rods_3": {"friction": 0.8}},
               "law": "poisson"},
  "time": {"step": "8 us", "impacts": "at_instant", "seed": 5},
  "measure": {"msd": {}}, "trajectory": {}, "movie": {}})";

TEST(RodsOfSpecies, AreTheMeanRodsWithTheContactsAndTheNoiseOfTheirSpecies) {
  const RunPlan third = rods_of_species(plan_of(kMixture), 2);
  // written out by hand
  EXPECT_EQ(third, plan_of(R"({
    "rods": {"length": 2, "count": 7, "profile": "polar", "start": "random"}, "box": {"side": 40, "gap": 1.5},
    "gravity": 9000, "plates": {"gamma": 5, "noise": 0.07},
    "contacts": {"rod_base": {"friction": 0.3}, "rod_lid": {"restitution": 0.5}, "rod_rod": {"friction": 0.8},
                 "law": "poisson"},
    "time": {"step": "8 us", "impacts": "at_instant", "seed": 5}, "measure": {"order": null}, "stream": null})"));

  const RunPlan first = rods_of_species(plan_of(kMixture), 0);
  EXPECT_FALSE(first.system.rod.spread.is_any());
  EXPECT_EQ(first.system.rod.length, 3);
  EXPECT_EQ(first.system.n_rods, 20);
  EXPECT_EQ(first.system.rotational_noise, 0.02);
  EXPECT_EQ(first.system.rod_base.friction, 0.1);
  EXPECT_EQ(first.system.rod_rod.friction, 0.2);
  EXPECT_FALSE(first.system.walls.has_value());
}

TEST(RodsOfSpecies, CanBeWrittenAndReadAgain) {
  for (const std::size_t number : {0, 2}) {
    const RunPlan alone = rods_of_species(plan_of(kMixture), number);
    EXPECT_EQ(plan_of(to_json(alone).dump()), alone);
  }
}

}  // namespace rods_of_species_test
}  // namespace shaken::scene
