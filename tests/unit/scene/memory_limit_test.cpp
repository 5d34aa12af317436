// SPDX-License-Identifier: MIT
// How large the estimate is against what a run really holds, tests/unit/run/memory_test.cpp says.
#include "scene/memory_limit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/keys/observables.h"
#include "scene/load.h"
#include "scene/placement.h"

namespace shaken::scene {
namespace {

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

}  // namespace
}  // namespace shaken::scene
