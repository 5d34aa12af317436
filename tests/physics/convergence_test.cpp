// How errors shrink with the tick. An impact is found at the tick that follows it, so it is late by up to one tick, and
// where the rods are afterwards is off by that delay times the change of velocity: order 1.
#include <gtest/gtest.h>

#include <cmath>

#include "bench/accuracy/errors.h"

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

/// The median error of a norm at one of the steps.
double error_of(const Json& row, const char* norm) { return row.at("error").at(norm).at("median"); }

/// The slope of the medians in log-log over all steps, by least squares.
double order_of(const Json& of, const char* norm) {
  const auto n = static_cast<double>(of.at("rows").size());
  double x = 0, y = 0, xx = 0, xy = 0;
  for (const Json& row : of.at("rows")) {
    const double step = std::log(row.at("dt_s").get<double>()), error = std::log(error_of(row, norm));
    x += step / n;
    y += error / n;
    xx += step * step / n;
    xy += step * error / n;
  }
  return (xy - x * y) / (xx - x * x);
}

/// A value of the converged solution: "error/position/upper".
double converged(const Json& of, const std::string& path) { return member_of(of.at("converged"), path); }

TEST(Convergence, OneImpactIsOfOrderOne) {
  const Json of = measured("crossing");
  for (const char* norm : kNormNames) {
    EXPECT_NEAR(order_of(of, norm), 1.0, 0.15) << norm;
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
  EXPECT_NEAR(order_of(of, "position"), 1.0, 0.25);
  EXPECT_GT(converged(of, "impulses"), 100) << "chatters between the plates";
}

TEST(Convergence, AtTheirInstantImpactsAreOfOrderTwo) {
  const Json late = measured("rattling");
  const Json of = measured("rattling", variant_named("instant"));
  for (const char* norm : kNormNames) {
    EXPECT_NEAR(order_of(of, norm), 2.0, 0.25) << norm;
    // two ways to one limit: as far apart as the way of order 1 still is from it
    EXPECT_LT(converged(of, "from_first/" + std::string(norm) + "/median"),
              3 * converged(late, "error/" + std::string(norm) + "/upper"))
        << norm;
    EXPECT_LT(error_of(of.at("rows").at(0), norm), 0.01 * error_of(late.at("rows").at(0), norm)) << norm;
  }
}

TEST(Convergence, OtherLawsAreOfOrderOneToo) {
  for (const char* law : {"poisson", "energetic"}) {
    EXPECT_NEAR(order_of(measured("crossing", variant_named(law)), "position"), 1.0, 0.15) << law;
  }
}

}  // namespace
}  // namespace shaken::bench
