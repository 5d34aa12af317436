// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "bench/accuracy/errors.h"

namespace shaken::bench {
namespace {

TEST(StartCases, LastWholeNumbersOfTheLongestStep) {
  for (const StartCase& start : start_cases()) {
    const double steps = start.duration / kLongestStep;
    EXPECT_NEAR(steps, std::round(steps), 1e-9) << start.name;
  }
}

TEST(StartCases, BeginApartAndThenHit) {
  for (const StartCase& start : start_cases()) {
    for (int member = 0; member < 3; ++member) {
      const std::vector<Flight> rods = start.rods(member);
      ASSERT_EQ(rods.size(), static_cast<std::size_t>(start.scene.n_rods)) << start.name;
      Simulation simulation = begin(start, rods, variants().front(), StepperKind::kScheduled, 1e-6);
      if (start.name != "hundred") {  // which is caught in the middle of its motion
        ASSERT_FALSE(simulation.advance_to(1));
        EXPECT_EQ(simulation.world().counters.max_overlap(), 0) << start.name << " begins with an overlap";
      }
      ASSERT_FALSE(simulation.advance_to(std::llround(start.duration / 1e-6))) << start.name;
      const Counters& done = simulation.world().counters;
      EXPECT_GT(done.impulses_rod_rod + done.impulses_rod_base + done.impulses_rod_lid, 0) << start.name;
    }
  }
}

TEST(StartCases, MembersDiffer) {
  for (const StartCase& start : start_cases()) {
    EXPECT_NE(start.rods(0)[0].velocity, start.rods(1)[0].velocity) << start.name;
  }
}

TEST(StartCases, AreTheSameAtAnyStep) {
  // up to the first impact flight is exact, whatever the step
  const StartCase& start = start_cases().front();
  const std::vector<Flight> rods = start.rods(0);
  Simulation coarse = begin(start, rods, variants().front(), StepperKind::kReference, kLongestStep);
  Simulation fine = begin(start, rods, variants().front(), StepperKind::kScheduled, kLongestStep / 16);
  ASSERT_FALSE(coarse.advance_to(4));
  ASSERT_FALSE(fine.advance_to(64));
  EXPECT_LT((coarse.snapshot().position[0] - fine.snapshot().position[0]).norm(), 1e-13);
}

}  // namespace
}  // namespace shaken::bench
