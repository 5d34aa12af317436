// SPDX-License-Identifier: MIT
// How errors shrink with the tick. An impact is found at the tick that follows it, so it is late by up to one tick, and
// where the rods are afterwards is off by that delay times the change of velocity: order 1.
#include "bench/accuracy/convergence.h"

#include <gtest/gtest.h>

namespace shaken::bench {
namespace {

const StartCase& start_named(const std::string& name) {
  for (const StartCase& start : start_cases()) {
    if (start.name == name) return start;
  }
  throw std::logic_error("no start " + name);
}

const Variant& variant_named(const std::string& name) {
  for (const Variant& variant : variants()) {
    if (variant.name == name) return variant;
  }
  throw std::logic_error("no variant " + name);
}

Convergence measured(const std::string& name, const Variant& variant = variants().front()) {
  ConvergenceEffort effort;
  effort.steps = {1e-6, 2e-6, 4e-6, 8e-6, 16e-6, 32e-6};
  effort.members = 64;
  return measure_convergence(start_named(name), variant, effort);
}

TEST(Convergence, OneImpactIsOfOrderOne) {
  const Convergence of = measured("crossing");
  for (int n = 0; n < kNorms; ++n) {
    ASSERT_TRUE(of.orders[n]) << kNormNames[n];
    EXPECT_NEAR(of.orders[n]->order, 1.0, 0.15) << kNormNames[n];
    EXPECT_GE(of.orders[n]->points, 5) << kNormNames[n];
  }
  for (const StepErrors& step : of.steps) {
    // rods that approach at 100 mm/s and bounce off: about 100 mm/s times half a tick
    EXPECT_LT(step.errors[0].median, 100 * step.dt);
    EXPECT_GT(step.errors[0].median, 5 * step.dt);
    EXPECT_TRUE(step.states_equal);
  }
}

TEST(Convergence, ARodThatTouchesBothPlatesIsToo) {
  const Convergence of = measured("wedged");
  ASSERT_TRUE(of.orders[0]);
  EXPECT_NEAR(of.orders[0]->order, 1.0, 0.25);
  EXPECT_GT(of.impulses, 100) << "chatters between the plates";
}

TEST(Convergence, AtTheirInstantImpactsAreOfOrderTwo) {
  const Convergence late = measured("rattling");
  const Convergence of = measured("rattling", variant_named("instant"));
  for (int n = 0; n < kNorms; ++n) {
    ASSERT_TRUE(of.orders[n]) << kNormNames[n];
    EXPECT_NEAR(of.orders[n]->order, 2.0, 0.25) << kNormNames[n];
    // two ways to one limit: as far apart as the way of order 1 still is from it
    EXPECT_LT((*of.from_first)[n].median, 3 * late.floor[n].upper) << kNormNames[n];
    EXPECT_LT(of.steps.front().errors[n].median, 0.01 * late.steps.front().errors[n].median) << kNormNames[n];
  }
}

TEST(Convergence, OtherLawsAreOfOrderOneToo) {
  for (const char* law : {"poisson", "energetic"}) {
    const Convergence of = measured("crossing", variant_named(law));
    ASSERT_TRUE(of.orders[0]) << law;
    EXPECT_NEAR(of.orders[0]->order, 1.0, 0.15) << law;
  }
}

}  // namespace
}  // namespace shaken::bench
