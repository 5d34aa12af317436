// SPDX-License-Identifier: MIT
// How errors shrink with the tick. An impact is found at the tick that follows it, so it is late by up to one tick, and
// where the rods are afterwards is off by that delay times the change of velocity: order 1.
#include <gtest/gtest.h>

#include <limits>

#include "bench/accuracy/accuracy.h"

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

Json measured(const std::string& name, const Variant& variant = variants().front()) {
  ConvergenceEffort effort;
  effort.steps = {1e-6, 2e-6, 4e-6, 8e-6, 16e-6, 32e-6};
  effort.members = 64;
  return measure_convergence(start_named(name), variant, effort);
}

/// Of what `measured` says of a norm: "order", "floor/upper".
double found(const Json& of, const char* norm, const char* member) {
  const Json& value = member_of(of.at("order").at(norm), member);
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

/// The median error of a norm at one of the steps.
double error_of(const Json& row, const char* norm) { return row.at("error").at(norm).at("median"); }

TEST(Convergence, OneImpactIsOfOrderOne) {
  const Json of = measured("crossing");
  for (const char* norm : kNormNames) {
    EXPECT_NEAR(found(of, norm, "order"), 1.0, 0.15) << norm;
    EXPECT_GE(found(of, norm, "points"), 5) << norm;
  }
  for (const Json& row : of.at("rows")) {
    // rods that approach at 100 mm/s and bounce off: about 100 mm/s times half a tick
    const double dt = row.at("dt_s");
    EXPECT_LT(error_of(row, "position"), 100 * dt);
    EXPECT_GT(error_of(row, "position"), 5 * dt);
    EXPECT_TRUE(row.at("states_equal").get<bool>());
  }
}

TEST(Convergence, ARodThatTouchesBothPlatesIsToo) {
  const Json of = measured("wedged");
  EXPECT_NEAR(found(of, "position", "order"), 1.0, 0.25);
  EXPECT_GT(of.at("order").at("impulses"), 100) << "chatters between the plates";
}

TEST(Convergence, AtTheirInstantImpactsAreOfOrderTwo) {
  const Json late = measured("rattling");
  const Json of = measured("rattling", variant_named("instant"));
  for (const char* norm : kNormNames) {
    EXPECT_NEAR(found(of, norm, "order"), 2.0, 0.25) << norm;
    // two ways to one limit: as far apart as the way of order 1 still is from it
    EXPECT_LT(found(of, norm, "from_first/median"), 3 * found(late, norm, "floor/upper")) << norm;
    EXPECT_LT(error_of(of.at("rows").at(0), norm), 0.01 * error_of(late.at("rows").at(0), norm)) << norm;
  }
}

TEST(Convergence, OtherLawsAreOfOrderOneToo) {
  for (const char* law : {"poisson", "energetic"}) {
    EXPECT_NEAR(found(measured("crossing", variant_named(law)), "position", "order"), 1.0, 0.15) << law;
  }
}

}  // namespace
}  // namespace shaken::bench
