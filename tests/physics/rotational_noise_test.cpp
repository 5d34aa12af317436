// What rough plates do to a rod, in absolute terms. A rod that is alone between plates without friction has one thing
// that can turn it in the plane, the noise: its angular momentum about the vertical, over I_perp (it does not spin
// about itself), is L = (1 - n_z^2) times the rate of its in-plane angle. Flights and impulses, which are vertical,
// leave L as it is, and a hit at speed u changes it by +-noise u (1 - n_z^2), that is the rate by +-noise u. So L is a
// random walk whose steps are known from the hits, and the angle its integral.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <vector>

#include "sim/simulation.h"
#include "tests/support/short_rods.h"

namespace shaken {
namespace {

constexpr double kGravity = 9810.0;

System scene_of_one(double noise, std::uint64_t seed) {
  System system = test::short_rods(1);
  system.rod_base.friction = system.rod_lid.friction = 0;
  system.rotational_noise = noise;
  system.seed = seed;
  return system;
}

/// A rod alone, followed from tick to tick.
class OneRod {
 public:
  OneRod(double noise, std::uint64_t seed)
      : simulation_(std::move(Simulation::start(scene_of_one(noise, seed))).value()) {}

  /// Goes on by a tick and says at what speed the rod was hit in it, by its own motion and the plate's; nothing if it
  /// was not. Where two beads were hit in one tick (seldom), the speed of the deeper.
  std::optional<double> step() {
    const World& world = simulation_.world();
    const Flight before = world.rods[0];
    const std::int64_t hits_before = hits();
    const bool trouble = simulation_.advance_to(simulation_.tick() + 1).has_value();
    EXPECT_FALSE(trouble);
    n_hits = static_cast<int>(hits() - hits_before);
    if (n_hits == 0) return {};
    // as the rod came: the flight from before to the tick of the hit
    const Species& species = world.species[0];
    const double tau = static_cast<double>(world.tick - before.since) * world.system.dt;
    const Vec3 n = pose_after(before, tau, kGravity).director;
    const Vec3 z = pose_after(before, tau, kGravity).position;
    const Motion came = motion_after(before, tau, kGravity, n, species.inertia_ratio);
    const PlateState plates = world.plates.at(world.tick);
    double deepest = 0, speed = 0;
    for (int bead = 0; bead < species.n_beads(); ++bead) {
      const double height = z.z() + species.bead_offset[bead] * n.z();
      const double overlap = std::max(plates.base - height, height - plates.lid) + species.bead_radius[bead];
      if (overlap <= deepest) continue;
      deepest = overlap;
      speed = std::abs(came.velocity.z() + species.bead_offset[bead] * came.angular_velocity.cross(n).z() -
                       plates.velocity);
    }
    return speed;
  }

  int n_hits = 0;  ///< in the last tick
  Tick tick() const { return simulation_.tick(); }
  std::int64_t kicks() const { return simulation_.world().counters.noise_kicks; }
  /// L: angular momentum about the vertical over I_perp, of a rod without spin [rad/s].
  double turning() const {
    const Flight& rod = simulation_.world().rods[0];
    EXPECT_LT(std::abs(rod.spin), 1e-6);
    return rod.precession.z();
  }
  Vec3 director() const {
    const World& world = simulation_.world();
    const double tau = static_cast<double>(world.tick - world.rods[0].since) * world.system.dt;
    return pose_after(world.rods[0], tau, kGravity).director;
  }

 private:
  std::int64_t hits() const {
    const Counters& counters = simulation_.world().counters;
    return counters.impulses_rod_base + counters.impulses_rod_lid;
  }
  Simulation simulation_;
};

TEST(RoughPlates, EveryHitTurnsTheRateOfTheAngleByNoiseTimesItsSpeed) {
  for (const double noise : {0.002, 0.05}) {
    OneRod rod(noise, 3);
    int n = 0, n_left = 0;
    double before = rod.turning();
    while (rod.tick() < 125000) {
      const std::optional<double> speed = rod.step();
      const double kick = rod.turning() - before;
      before = rod.turning();
      if (!speed) {
        ASSERT_EQ(kick, 0) << "in flight";
        continue;
      }
      if (rod.n_hits > 1) continue;
      const double n_z = rod.director().z();
      const double known = noise * *speed * (1 - n_z * n_z);
      ASSERT_NEAR(std::abs(kick), known, 1e-9 * (1 + std::abs(before) + known)) << rod.tick();
      ++n;
      n_left += kick > 0;
    }
    EXPECT_GT(n, 300);
    EXPECT_LE(n, rod.kicks());
    EXPECT_GT(n, 0.99 * static_cast<double>(rod.kicks()));
    EXPECT_LT(std::abs(n_left - 0.5 * n), 2.25 * std::sqrt(n)) << "four and a half errors";
  }
}

struct Diffusion {
  double turning = 0;      ///< mean square of the change of L, over the sum of the squares of the known kicks
  double angle = 0;        ///< mean square of the angle turned beyond that of a steady turn, over the known one
  double error = 0;        ///< of both by chance
  double rate = 0;         ///< known: mean square of the change of L per time [rad^2/s^3]
  double mean_square = 0;  ///< of the angle [rad^2]
};

constexpr double kStretch = 0.1;  ///< [s]

/// Stretches of a tenth of a second of single rods: the twin walks by the speeds of the hits, of which it takes no
/// notice of how the rod turned. Of a mean square of n Gaussian samples the relative error is sqrt(2 / n).
Diffusion diffusion(double noise, int n_rods, int n_stretches) {
  const auto ticks = static_cast<Tick>(std::lround(kStretch / 4e-6));
  double changes = 0, known_changes = 0, angles = 0, known_angles = 0;
  for (int k = 0; k < n_rods; ++k) {
    OneRod rod(noise, 100 + static_cast<std::uint64_t>(k));
    while (rod.tick() < ticks) rod.step();
    for (int stretch = 0; stretch < n_stretches; ++stretch) {
      const Tick start = rod.tick();
      const double turning = rod.turning();
      Vec3 director = rod.director();
      double angle = 0;                              // turned in the plane
      double steady = 0;                             // what it would be without kicks: the integral of L / (1 - n_z^2)
      std::vector<std::pair<double, double>> kicks;  // size in L, and `stretched` at that time
      double stretched = 0;                          // the integral of 1 / (1 - n_z^2)
      while (rod.tick() < start + ticks) {
        if (const std::optional<double> speed = rod.step()) {
          const double n_z = rod.director().z();
          kicks.emplace_back(noise * *speed * (1 - n_z * n_z), stretched);
        }
        if (rod.tick() % 50 != 0) continue;  // 0.2 ms
        const Vec3 now = rod.director();
        angle += std::atan2(director.x() * now.y() - director.y() * now.x(),
                            director.x() * now.x() + director.y() * now.y());
        director = now;
        stretched += 50 * 4e-6 / (1 - now.z() * now.z());
      }
      steady = turning * stretched;
      changes += std::pow(rod.turning() - turning, 2);
      angles += std::pow(angle - steady, 2);
      for (const auto& [size, at] : kicks) {
        known_changes += size * size;
        known_angles += std::pow(size * (stretched - at), 2);
      }
    }
  }
  const double n = n_rods * n_stretches;
  const Diffusion found{changes / known_changes, angles / known_angles, std::sqrt(2 / n), known_changes / n / kStretch,
                        angles / n};
  std::printf(
      "noise %g rad/mm, %g stretches: %.4g rad^2/s^3; over the known, turning %.3f, angle %.3f, +- %.3f; "
      "mean square angle in 0.1 s %.4g rad^2\n",
      noise, n, found.rate, found.turning, found.angle, found.error, found.mean_square);
  return found;
}

// Mean squares are known to 3 %; an error of 8 % in the noise, 17 % in them, cannot hide. Single kicks, above, are
// exact.
TEST(RoughPlates, AnglesDiffuseAsTheKicksThatTheHitsMustGive) {
  for (const double noise : {0.002, 0.02}) {
    const Diffusion found = diffusion(noise, 40, 60);
    ASSERT_LT(found.error, 0.03);
    EXPECT_NEAR(found.turning, 1, 0.1) << noise;
    EXPECT_NEAR(found.angle, 1, 0.1) << noise;
  }
}

struct Turned {
  double mean_square = 0;  ///< of the angle in half a second [rad^2]
  double error = 0;
};

/// The turning of 60 rods in a dilute gas between plates of the usual friction, in 40 stretches of half a second.
Turned turned(double noise) {
  System system = test::short_rods(60, 30);
  system.start = Start::kRandom;
  system.rotational_noise = noise;
  auto simulation = Simulation::start(system);
  EXPECT_FALSE(simulation->advance_to(125000).has_value());
  Snapshot before = simulation->snapshot();
  constexpr int kStretches = 40;
  double squares = 0, fourths = 0;
  for (int stretch = 0; stretch < kStretches; ++stretch) {
    std::vector<double> angles(before.n_rods(), 0.0);
    for (int look = 0; look < 250; ++look) {
      EXPECT_FALSE(simulation->advance_to(simulation->tick() + 500).has_value());
      const Snapshot now = simulation->snapshot();
      for (std::size_t i = 0; i < angles.size(); ++i) {
        const Vec3 &a = before.director[i], &b = now.director[i];
        angles[i] += std::atan2(a.x() * b.y() - a.y() * b.x(), a.x() * b.x() + a.y() * b.y());
      }
      before = now;
    }
    for (const double angle : angles) {
      squares += angle * angle;
      fourths += std::pow(angle, 4);
    }
  }
  const double n = 60.0 * kStretches;
  const Turned found{squares / n, std::sqrt((fourths / n - squares * squares / n / n) / n)};
  std::printf("with friction, noise %g rad/mm: mean square angle in 0.5 s %.1f +- %.1f rad^2\n", noise,
              found.mean_square, found.error);
  return found;
}

// With friction and other rods, which slow the turning, no law says how much; it is seen to grow nearly as the square
// of the noise, beyond what rods turn by themselves. The errors leave the ratio open by 1.
TEST(RoughPlates, TurnRodsWithFrictionNearlyAsTheSquareOfTheNoise) {
  const Turned none = turned(0), little = turned(0.02), more = turned(0.06);
  EXPECT_GT(little.mean_square, none.mean_square + 5 * std::hypot(little.error, none.error));
  const double ratio = (more.mean_square - none.mean_square) / (little.mean_square - none.mean_square);
  EXPECT_GT(ratio, 5);
  EXPECT_LT(ratio, 12);
}

}  // namespace
}  // namespace shaken
