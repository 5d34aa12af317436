#include "sim/motion/flight.h"

#include <gtest/gtest.h>

#include "tests/support/random_rods.h"

namespace shaken {
namespace {

/// Twin: torque-free rigid body by fourth-order Runge-Kutta on dn/dt = omega x n with omega from the constant angular
/// momentum J: omega = J / I_perp + (1/I_par - 1/I_perp)(J . n) n.
Vec3 integrate_director(Vec3 n, const Vec3& J, double perp, double par, double time, int steps) {
  const auto rate = [&](const Vec3& m) -> Vec3 {
    const Vec3 omega = J / perp + (1 / par - 1 / perp) * J.dot(m) * m;
    return omega.cross(m);
  };
  const double h = time / steps;
  for (int k = 0; k < steps; ++k) {
    const Vec3 k1 = rate(n), k2 = rate(n + 0.5 * h * k1), k3 = rate(n + 0.5 * h * k2), k4 = rate(n + h * k3);
    n += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return n;
}

TEST(Flight, MatchesAFineIntegrationOfTheEquationsOfMotion) {
  test::Draw draw(2);
  const Species rod = make_species({});
  const double ratio = rod.inertia_ratio;
  for (int trial = 0; trial < 50; ++trial) {
    const Pose pose{Vec3(10, 20, 0.6), draw.direction()};
    const Motion motion{draw.vector(30), draw.vector(40)};
    Flight flight;
    begin_flight(flight, 100, pose, motion, 83.73, ratio);
    const Vec3& n = pose.director;
    const Vec3 J = rod.inertia_perp * (motion.angular_velocity - motion.angular_velocity.dot(n) * n) +
                   rod.inertia_par * motion.angular_velocity.dot(n) * n;
    const double tau = draw.uniform(0, 0.2);
    const Pose later = pose_after(flight, tau, 9810);
    EXPECT_LT((later.director - integrate_director(n, J, rod.inertia_perp, rod.inertia_par, tau, 4000)).norm(), 1e-9);
    EXPECT_NEAR(later.director.norm(), 1, 1e-14);
    const Vec3 expected = pose.position + motion.velocity * tau - Vec3(0, 0, 0.5 * 9810 * tau * tau);
    EXPECT_LT((later.position - expected).norm(), 1e-11);

    // angular momentum, spin and energy are constants of the motion
    const Motion moving = motion_after(flight, tau, 9810, later.director, ratio);
    const double spin = moving.angular_velocity.dot(later.director);
    const Vec3 J_later =
        rod.inertia_perp * (moving.angular_velocity - spin * later.director) + rod.inertia_par * spin * later.director;
    EXPECT_LT((J_later - J).norm(), 1e-11 * J.norm());
    EXPECT_NEAR(spin, motion.angular_velocity.dot(n), 1e-11);
    EXPECT_NEAR(moving.velocity.z(), motion.velocity.z() - 9810 * tau, 1e-9);
  }
}

TEST(Flight, SplittingAFlightChangesNothing) {
  test::Draw draw(3);
  const Species rod = make_species({});
  const double ratio = rod.inertia_ratio;
  const double dt = 4e-6;
  Flight whole;
  begin_flight(whole, 0, {Vec3(1, 2, 3), draw.direction()}, {draw.vector(30), draw.vector(40)}, 50, ratio);
  Flight pieces = whole;
  for (Tick k = 10; k <= 10000; k += 10) {
    const double tau = static_cast<double>(k - pieces.since) * dt;
    const Pose pose = pose_after(pieces, tau, 9810);
    begin_flight(pieces, k, pose, motion_after(pieces, tau, 9810, pose.director, ratio), 50, ratio);
  }
  const Pose at_end = pose_after(whole, 10000 * dt, 9810);
  EXPECT_LT((pieces.director - at_end.director).norm(), 1e-12);
  EXPECT_NEAR(pieces.director.norm(), 1, 4e-16);
  EXPECT_NEAR(pieces.spin, whole.spin, 1e-11);
  EXPECT_LT((pieces.position + 50.0 * Vec3(pieces.image[0], pieces.image[1], 0) - at_end.position).norm(), 1e-9);
}

TEST(Flight, WrapKeepsCoordinatesInsideAndCounts) {
  for (const double start : {-1e-18, -3.0, 0.0, 9.999, 10.0, 12.5, 20.0, 37.5, -10.0, -10.5, -1e4, 12345.5}) {
    double x = start;
    std::int32_t image = 0;
    wrap(x, image, 10);
    EXPECT_GE(x, 0.0);
    EXPECT_LT(x, 10.0);
    EXPECT_NEAR(x + 10.0 * image, start, 1e-14 * std::max(1.0, std::abs(start)));
  }
}

}  // namespace
}  // namespace shaken
