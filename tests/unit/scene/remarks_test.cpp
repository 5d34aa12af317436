#include "scene/remarks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/keys/observables.h"
#include "scene/load.h"
#include "scene/memory_limit.h"
#include "scene/placement.h"
#include "tests/unit/scene/scene_support.h"

namespace shaken::scene {
namespace remarks_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Remarks, AreOfWhatIsHardlyMeant) {
  EXPECT_THAT(remarks(plan_of("{}")), IsEmpty());
  EXPECT_THAT(remarks(plan_of(R"({"trajectory": {"every": "10 s"}, "movie": {"every": 10}, "time": {"measure": 10}})")),
              IsEmpty());
  EXPECT_THAT(remarks(plan_of(R"({"trajectory": {"every": "10.1 s"}, "time": {"measure": 10}})")),
              ElementsAre("trajectory.every 10.1 s is longer than the run, 10 s: there will be a single frame, of the "
                          "start"));
  EXPECT_THAT(remarks(plan_of(R"({"movie": {"every": "10 s"}, "time": {"steady": 4, "measure": 5}})")),
              ElementsAre("movie.every 10 s is longer than the run, 9 s: there will be a single frame, of the start"));
  EXPECT_THAT(
      remarks(plan_of(R"({"measure": {"order": {"every": "100 s"}}, "time": {"measure": 10}})")),
      ElementsAre("measure.order.every 100 s is longer than the run, 10 s: there will be a single sample, of the "
                  "start"));
  EXPECT_THAT(remarks(plan_of(R"({"measure": {"order": {"every": "10 s"}}, "time": {"measure": 10}})")), IsEmpty());
  EXPECT_THAT(remarks(plan_of(R"({"plates": {"gamma": 0.9}})")),
              ElementsAre("plates.gamma is 0.9: below 1 the base never falls faster than the rods, which come to rest "
                          "on it"));
  EXPECT_THAT(remarks(plan_of(R"({"plates": {"gamma": 1}})")), IsEmpty());
  EXPECT_THAT(remarks(plan_of(R"({"gravity": 0, "plates": {"amplitude": 0, "base": false, "lid": false}})")),
              IsEmpty());
}

TEST(Remarks, NameRodsThatMayPileUpOrBeCrushed) {
  EXPECT_THAT(remarks(plan_of(R"({"box": {"gap": 9}, "contacts": {"rod_rod": {"restitution": 0}}})")),
              ElementsAre("box.gap 9 mm leaves room for rods on top of each other, and rods have a restitution of 0: "
                          "where they pile up they may sink into each other until the run ends; take contacts.sweeps "
                          "4"));
  for (const char* scene : {R"({"box": {"gap": 9}})", R"({"contacts": {"rod_rod": {"restitution": 0}}})",
                            R"({"box": {"gap": 9}, "contacts": {"sweeps": 4, "rod_rod": {"restitution": 0}}})",
                            R"({"plates": {"lid_motion": {"amplitude": 0.1}}})"})
    EXPECT_THAT(remarks(plan_of(scene)), IsEmpty()) << scene;
  EXPECT_THAT(remarks(plan_of(R"({"plates": {"lid_motion": {"amplitude": 0.35, "phase": 180}}})")),
              ElementsAre(HasSubstr("by more than a rod's radius")));
}

// The angle of friction 0.01 is 0.573 degrees.
TEST(Remarks, NameSlopesThatRodsMaySlideDown) {
  EXPECT_THAT(
      remarks(plan_of(R"({"plates": {"inclination": 1}})")),
      ElementsAre("plates.inclination 1 degrees is steeper than the friction of the plates, whose angle is 0.573 "
                  "degrees: without walls rods may slide down faster and faster, until the run ends because one is too "
                  "fast"));
  EXPECT_THAT(remarks(plan_of(R"({"gravity": 0, "plates": {"amplitude": 0, "inclination": 1}})")),
              ElementsAre(HasSubstr("without gravity nothing pulls the rods")));
  EXPECT_THAT(remarks(plan_of(R"({"plates": {"inclination_angle": 30}})")),
              ElementsAre(HasSubstr("the plates are level")));
  EXPECT_THAT(
      remarks(plan_of(
          R"({"gravity": 0, "plates": {"amplitude": 0, "base": false, "lid": false, "second": {}}, "walls": {}})")),
      ElementsAre(HasSubstr("no plates that could vibrate")));
  for (const char* scene : {R"({"plates": {"inclination": 0.5}})", R"({"plates": {"inclination": 1}, "walls": {}})",
                            R"({"plates": {"inclination": 5}, "contacts": {"rod_base": {"friction": 0.1}}})"})
    EXPECT_THAT(remarks(plan_of(scene)), IsEmpty()) << scene;
}

// Rods come to rest where all that moves the base together is weaker than gravity across it.
TEST(Remarks, CountBothVibrationsAgainstGravityAcrossThePlates) {
  EXPECT_THAT(remarks(plan_of(R"({"plates": {"gamma": 0.9, "second": {"amplitude": "10 um", "frequency": 400}}})")),
              IsEmpty());
  EXPECT_THAT(
      remarks(plan_of(R"({"plates": {"gamma": 0.9, "inclination": 30}, "contacts": {"rod_base": {"friction": 1}}})")),
      IsEmpty());
  EXPECT_THAT(
      remarks(plan_of(R"({"plates": {"gamma": 0.4, "inclination": 60}, "contacts": {"rod_base": {"friction": 9}}})")),
      ElementsAre("the largest acceleration of the base over that of gravity across it is 0.8: below 1 the base "
                  "never falls faster than the rods, which come to rest on it"));
}

// Of 40 mm four posts of 9.3 mm leave 0.7 mm between each two, and rods are 0.8 mm thick.
TEST(Remarks, NamePostsThatNoRodGetsBetween) {
  EXPECT_THAT(remarks(plan_of(R"({"box": {"side": 40}, "posts": {"diameter": 9.3}, "rods": {"count": 4}})")),
              ElementsAre("the posts leave gaps of at most 0.7 mm, through which no rod gets: each stays between the "
                          "posts where it starts"));
  for (const char* more : {R"("diameter": 9.1)", R"("diameter": 9.3, "rows": 3)"}) {
    const std::string posts = R"("posts": {)" + std::string(more) + "}";
    EXPECT_THAT(remarks(plan_of(R"({"box": {"side": 40}, "rods": {"count": 4}, )" + posts + "}")), IsEmpty());
  }
}

// What points to the head says little of rods without one.
TEST(Remarks, NamePolarOrderOfRodsWithoutHeads) {
  const std::string none = "measure.polar: no rod that is measured has a head, so which end counts as one is arbitrary";
  const std::string polar = R"("rods": {"profile": "polar"})";
  const std::string added = R"("rods_2": {"count": 3, "profile": "polar"})";
  EXPECT_THAT(remarks(plan_of(R"({"measure": {"polar": {}}})")), ElementsAre(none));
  EXPECT_THAT(remarks(plan_of("{" + polar + R"(, "measure": {"polar": {}}})")), IsEmpty());
  EXPECT_THAT(remarks(plan_of("{" + added + R"(, "measure": {"polar": {}}})")),
              ElementsAre(none + "; observables are those of the first species (measure.of)"));
  EXPECT_THAT(remarks(plan_of("{" + added + R"(, "measure": {"of": "each", "polar": {}}})")), IsEmpty());
  EXPECT_THAT(remarks(plan_of(R"({"rods": {"beads": 1, "length": 0.8}, "measure": {"polar": {}}})")),
              ElementsAre(HasSubstr("this is not measured: measure.polar")));
  EXPECT_THAT(remarks(plan_of("{" + polar + R"(, "measure": {"polar": {"phases": "locked", "every": "1 s"}}})")),
              ElementsAre(HasSubstr("measure.polar.phases \"spread\"")));
  EXPECT_THAT(remarks(plan_of(R"({"measure": {"stress": {"phases": "locked", "every": "1 s"}}})")),
              ElementsAre(HasSubstr("measure.stress.phases \"spread\"")));
  EXPECT_THAT(remarks(plan_of(R"({"measure": {"temperatures": {"phases": "locked", "every": "1 s"}}})")),
              ElementsAre(HasSubstr("measure.temperatures.phases \"spread\"")));
}

TEST(Remarks, NameVibrationInThePlaneThatReachesNoRod) {
  const auto scene = [](const char* friction) {
    return std::string(R"({"plates": {"horizontal_amplitude": 0.05}, "contacts": {"rod_base": {"friction": 0}, )") +
           R"("rod_lid": {"friction": )" + friction + "}}}";
  };
  EXPECT_THAT(remarks(plan_of(scene("0"))),
              ElementsAre(HasSubstr("plates.horizontal_amplitude: no plate has friction")));
  EXPECT_THAT(remarks(plan_of(scene("0.1"))), IsEmpty());
}

// A body without an axis has neither order nor defects.
TEST(Remarks, NameWhatSpheresCannotBeMeasuredFor) {
  const std::string sphere = R"("rods": {"beads": 1, "length": 0.8})";
  EXPECT_THAT(remarks(plan_of("{" + sphere + R"(, "measure": {"order": {}, "defects": {}, "g2": {}, "msd": {}}})")),
              ElementsAre("spheres (rods.beads 1) have no axis, so this is not measured: measure.order, "
                          "measure.defects"));
  EXPECT_THAT(remarks(plan_of("{" + sphere + R"(, "measure": {"order": null, "g2": {}}})")), IsEmpty());
  EXPECT_THAT(remarks(plan_of("{" + sphere + R"(, "rods_2": {"count": 3}, "measure": {"order": {}}})")),
              ElementsAre("spheres (rods.beads 1) have no axis, so this is not measured: measure.order; "
                          "observables are those of the first species (measure.of)"));
  EXPECT_THAT(remarks(plan_of("{" + sphere + R"(, "rods_2": {"count": 3}, "measure": {"of": "each", "order": {}}})")),
              ElementsAre("spheres (rods.beads 1) have no axis, so this is not measured: measure.order"));
  EXPECT_THAT(remarks(plan_of(R"({"rods_3": {"count": 3, "beads": 1, "length": 0.8},
                                  "measure": {"of": "each", "order": {}}})")),
              ElementsAre("spheres (rods_3.beads 1) have no axis, so this is not measured: measure.order"));
  EXPECT_THAT(remarks(plan_of(R"({"rods_2": {"count": 3, "beads": 1, "length": 0.8}})")), IsEmpty());
  EXPECT_THAT(problem_of("{" + sphere + R"(, "until": {"order_sem": 0.01, "at_most": 100}})"),
              HasSubstr("spheres have no S"));
}

// How large the estimate is against what a run really holds, tests/unit/run/memory_test.cpp says.

using ::testing::HasSubstr;

RunPlan plan_of(const std::vector<std::string>& settings) {
  const auto plan = load_scene(R"({"rods": {"count": 100}, "box": {"side": 25}})", "s.json", settings);
  EXPECT_TRUE(plan) << to_string(plan.error());
  return *plan;
}

TEST(MeasureMemory, OfEachSpeciesIsThatOfItsRods) {
  const std::vector<std::string> both{"measure={\"msd\": {}, \"rotation\": {}}", "rods_2.count=50", "rods_2.beads=1",
                                      "rods_2.mid_diameter=0.8"};
  std::vector<std::string> each = both;
  each.push_back("measure.of=each");
  auto first = measure_memory(plan_of(both)), all = measure_memory(plan_of(each));
  ASSERT_EQ(first.size(), 2u);
  ASSERT_EQ(all.size(), 2u) << "one row an observable";
  // 100 rods and 50 spheres, of which each takes as much, beside the sums against lag
  EXPECT_GT(all["msd"].state, 1.5 * first["msd"].state);
  EXPECT_LT(all["msd"].state, 2 * first["msd"].state);
  EXPECT_EQ(all["rotation"].state, first["rotation"].state) << "spheres do not rotate";
}

TEST(MeasureMemory, PeakIsTheStatesAndTheLargerOfCopiesAndScratch) {
  EXPECT_EQ(peak_of({}), 0);
  EXPECT_EQ(peak_of({{"a", {10, 0}}, {"b", {20, 0}}}), 30 + 30);
  EXPECT_EQ(peak_of({{"a", {10, 1000}}, {"b", {20, 2000}}}), 30 + 2000) << "one samples at a time";
}

TEST(MemoryProblem, NamesTheLargestAndTheRemedy) {
  const RunPlan plan = plan_of({"measure={\"order\": {}, \"defects\": {\"grid\": \"0.01 mm\"}}"});
  const auto problem = memory_problem(plan, 1e8, "s.json", "replica=2");
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->path, "/measure/defects");
  // 2500 x 2500 nodes of 5 doubles
  EXPECT_THAT(problem->message, HasSubstr("replica=2: the measurements of this run would take about 25"));
  EXPECT_THAT(problem->message, HasSubstr("a process may have 100 MB here; smaller with a coarser `grid`"));
  EXPECT_FALSE(memory_problem(plan, 1e9, "s.json"));
}

TEST(MemoryProblem, WhatNoMachineHasIsRefusedBeforeItStarts) {
  const std::vector<std::string> cases[] = {
      {"box.side=2000", "measure.defects={\"grid\": 0.01}"},
      {"time.measure=10000", "measure.rods={\"count\": 1000, \"every\": \"4 us\", \"duration\": 10000}",
       "rods.count=1000", "box.side=100"},
      {"time.measure=10000", "measure.velocity={\"every\": \"4 us\", \"window\": 10000}", "rods.count=1000",
       "box.side=100"},
  };
  for (const auto& settings : cases) {
    const auto runs = load_runs(R"({"rods": {"count": 100}})", "s.json", settings);
    ASSERT_FALSE(runs);
    ASSERT_EQ(runs.error().size(), 1u) << to_string(runs.error());
    EXPECT_THAT(runs.error()[0].message, HasSubstr("the measurements of this run would take about"));
  }
}

TEST(MemoryAllowed, IsSomethingThatAMachineHas) {
  EXPECT_GT(memory_allowed(), 1e8);
  EXPECT_LT(memory_allowed(), 1e15);
}

}  // namespace remarks_test
}  // namespace shaken::scene
