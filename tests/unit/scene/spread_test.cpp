// Rods of one species that differ in size: what follows from rods.length_spread and rods.end_diameter_spread, and what
// is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/canonical.h"
#include "scene/keys/derived.h"
#include "scene/keys/measured_species.h"
#include "sim/rod/sizes.h"
#include "sim/rod/species.h"
#include "sim/world.h"
#include "tests/unit/scene/scene_support.h"

namespace shaken::scene {
namespace {

using testing::HasSubstr;

TEST(Spread, IsNoneUnlessAskedFor) {
  EXPECT_EQ(plan_of("{}").system.rod.spread, SizeSpread{});
  EXPECT_EQ(to_json(plan_of("{}")).dump().find("spread"), std::string::npos);
  EXPECT_EQ(run_id(plan_of(R"({"rods": {"length_spread": 0}})")), run_id(plan_of("{}")));
  EXPECT_NE(run_id(plan_of(R"({"rods": {"length_spread": 0.05}})")), run_id(plan_of("{}")));
}

TEST(Spread, ReadsBackAsTheIdenticalPlan) {
  for (
      const char* text :
      {R"({"rods": {"length_spread": 0.05}})", R"({"rods": {"end_diameter_spread": 0.1, "count": 400}})",
       R"({"rods": {"length_spread": 0.05, "profile": "polar"}, "rods_3": {"beads": 1, "length_spread": 0.2, "count": 9}})",
       R"({"rods": {"bead_diameters": [0.8, 0.8, 0.8, 0.8, 0.8, 0.8, 0.8, 0.8], "length_spread": 0.1}})"}) {
    const RunPlan plan = plan_of(text);
    EXPECT_EQ(plan_of(to_json(plan).dump()), plan) << text;
  }
}

// The area of a rod is not linear in its length where its ends are round, nor in the diameter of its ends.
TEST(Spread, AreaFractionIsOfTheRodsThatThereAre) {
  const RunPlan plan = plan_of(
      R"({"rods": {"area_fraction": 0.6, "length_spread": 0.2, "end_diameter_spread": 0.3, "start": "compressed"}})");
  const World world = empty_world(plan.system);
  double covered = 0;
  for (std::size_t i = 0; i < world.shape_of_rod.size(); ++i) covered += world.species_of(i).area;
  EXPECT_NEAR(area_fraction_of(plan.system), covered / plan.system.area(), 1e-12);
  EXPECT_NEAR(area_fraction_of(plan.system), 0.6, 3e-4);
  EXPECT_NE(mean_area_of(plan.system.rod), species_of(plan.system.rod).area);
}

TEST(Spread, EverySizeMustBeARodAndFitIntoTheCell) {
  EXPECT_THAT(problem_of(R"({"rods": {"length": 1, "length_spread": 0.2}})"),
              HasSubstr("a rod of length 0.6507756566 mm is not longer than its thickest bead (0.8 mm)"));
  EXPECT_THAT(problem_of(R"({"rods": {"beads": 7, "length_spread": 0.25}})"), HasSubstr("leave holes between them"));
  EXPECT_THAT(problem_of(R"({"rods": {"end_diameter": 0.78, "end_diameter_spread": 0.3}, "box": {"gap": 1.1}})"),
              HasSubstr("too small for rods 1.188592482 mm thick"));
  EXPECT_THAT(problem_of(R"({"rods": {"length_spread": 0.3, "count": 10, "start": "random"}, "box": {"side": 12}})"),
              HasSubstr("at least "));
  EXPECT_THAT(problem_of(R"({"rods": {"length_spread": 0.31}})"), HasSubstr("outside [0, 0.3]"));
}

TEST(Spread, EverySizeIsOneThatASceneCouldGive) {
  EXPECT_THAT(
      problem_of(R"({"rods_2": {"beads": 1, "mid_diameter": "0.06 mm", "length_spread": 0.3, "count": 18}})"),
      HasSubstr("rods of 0.04908070845 mm, 0.04908070845 mm to 0.04908070845 mm thick, are among those that "
                "rods_2.length_spread and rods_2.end_diameter_spread make: lengths are [0.05, 50] mm, diameters "
                "[0.05, 20] mm"));
  EXPECT_THAT(
      problem_of(
          R"({"rods": {"length": 40, "length_spread": 0.2, "beads": 101, "mid_diameter": 4, "end_diameter": 4}, "box": {"gap": 6}})"),
      HasSubstr("rods of 53.96897374 mm"));
  EXPECT_THAT(
      problem_of(
          R"({"rods": {"length": 3, "bead_diameters": [0.3, 0.8, 0.8, 0.8, 0.8, 0.8, 0.8, 0.8, 0.3], "length_spread": 0.25}})"),
      HasSubstr("bead 2 of 0.8 mm would stick out beyond the tips of a rod of 2.250414918 mm"));
}

// The pitch is the largest between neighbouring beads of any size.
TEST(Spread, TheLongestRodsKeepToTheBeadPitch) {
  const RodShape rod = plan_of(R"({"rods": {"length_spread": 0.2, "bead_pitch": 0.3}})").system.rod;
  double longest = 0;
  for (const RodShape& size : sizes_of(rod)) longest = std::max(longest, make_species(size).pitch());
  EXPECT_LE(longest, 0.3);
  EXPECT_GT(longest, 0.3 * (rod.n_beads - 1) / (rod.n_beads + 1)) << "no more beads than needed";
}

TEST(Spread, OfTheEndsNeedsAProfile) {
  EXPECT_THAT(
      problem_of(R"({"rods_2": {"beads": 1, "count": 9, "end_diameter_spread": 0.1}})"),
      HasSubstr("rods_2.end_diameter_spread is of rods whose ends have a diameter of their own, not of spheres; "
                "remove it"));
  EXPECT_THAT(
      problem_of(
          R"({"rods": {"bead_diameters": [0.8, 0.8, 0.8, 0.8, 0.8, 0.8, 0.8, 0.8], "end_diameter_spread": 0.1}})"),
      HasSubstr("not of beads one by one; remove it"));
}

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

}  // namespace
}  // namespace shaken::scene
