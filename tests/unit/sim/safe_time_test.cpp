// SPDX-License-Identifier: MIT
#include "sim/contact/safe_time.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sim/contact/bead_contacts.h"
#include "sim/motion/flight.h"
#include "sim/motion/plate_safe_time.h"
#include "sim/motion/plates.h"
#include "tests/support/bead_safe_time_twin.h"
#include "tests/support/random_rods.h"

namespace shaken {
namespace {

constexpr double kG = 9810;

/// Two rods near each other, moving as they do in a shaken layer; the tilt goes as far as a gap of 1.2 mm lets it.
struct FlyingPair {
  Species species;
  double ratio;
  Flight flight[2];
  Vec3 D;

  explicit FlyingPair(test::Draw& draw) {
    const double length = draw.uniform(2.5, 4.5);
    species = make_species({.length = length,
                            .end_diameter = draw.integer(0, 4) == 0 ? 0.8 : draw.uniform(0.2, 0.6),
                            .n_beads = beads_for_pitch(length, 0.4, 0.3)});
    ratio = species.inertia_par / species.inertia_perp;
    const double tilt = draw.integer(0, 1) ? 0.38 : 0.1;
    const Vec3 n = draw.flat_direction(tilt);
    // dense systems are nearly parallel; dilute ones cross at any angle
    const Vec3 m = draw.integer(0, 2) ? (n + draw.vector(0.1)).normalized() : draw.flat_direction(tilt);
    const Vec3 side = Vec3(-n.y(), n.x(), 0).normalized();
    D = draw.uniform(-length, length) * n + (draw.integer(0, 1) ? 1 : -1) * draw.uniform(0.4, 1.0) * side +
        Vec3(0, 0, draw.uniform(-0.4, 0.4));
    const Vec3 directors[2] = {n, m};
    for (int r = 0; r < 2; ++r) {
      Flight& f = flight[r];
      // 1,000 mm stands for a place far from the border: flights are not wrapped here
      begin_flight(f, 0, {Vec3(1000, 1000, 0) + (r == 1 ? D : Vec3(Vec3::Zero())), directors[r]},
                   {draw.vector(25), draw.vector(12)}, 1e9, ratio);
    }
  }

  FlightState state(int r) const {
    return {flight[r].director, flight[r].velocity, flight[r].precession.cross(flight[r].director),
            flight[r].rate * flight[r].rate};
  }
  double hull_bound(const Allowance& allowance, double horizon) const {
    const Hull hull(species);
    const Vec3 d = separating_direction(hull, flight[0].director, hull, flight[1].director, D);
    const auto axis = [&](int r) {
      const FlightState s = state(r);
      return AxisCosine{s.director.dot(d), s.turning.dot(d), 0.5 * s.rate2, 0};
    };
    return hull_safe_time(hull, axis(0), hull, axis(1), D.dot(d), (flight[1].velocity - flight[0].velocity).dot(d),
                          allowance, horizon);
  }
  double bead_bound(const Allowance& allowance, double horizon) const {
    const BeadLanes lanes(species);
    return bead_safe_time(lanes, state(0), lanes, state(1), D, allowance, horizon);
  }

  /// Beads that overlap and approach at time t of the flights.
  bool collides_at(double t) const {
    Pose pose[2];
    Motion motion[2];
    for (int r = 0; r < 2; ++r) {
      pose[r] = pose_after(flight[r], t, kG);
      motion[r] = motion_after(flight[r], t, kG, pose[r].director, ratio);
    }
    std::vector<BeadContact> contacts;
    find_bead_contacts(species, pose[0].director, species, pose[1].director, pose[1].position - pose[0].position,
                       contacts);
    for (const BeadContact& c : contacts) {
      const Vec3 v0 =
          motion[0].velocity + species.bead_offset[c.bead_i] * motion[0].angular_velocity.cross(pose[0].director);
      const Vec3 v1 =
          motion[1].velocity + species.bead_offset[c.bead_j] * motion[1].angular_velocity.cross(pose[1].director);
      if ((v1 - v0).dot(c.normal) < 0) return true;
    }
    return false;
  }
};

constexpr double kHorizon = 4e-3;
constexpr Allowance kStrict{0, 0};

TEST(SafeTime, NoPairCollidesBeforeItsBound) {
  test::Draw draw(20);
  std::int64_t n_hull = 0, n_bead = 0;
  for (int trial = 0; trial < 500000; ++trial) {
    const FlyingPair pair(draw);
    const double hull = pair.hull_bound(kStrict, kHorizon);
    const double bead = pair.bead_bound(kStrict, kHorizon);
    n_hull += hull > 0;
    n_bead += bead > 0;
    // the last instant that is said to be safe, and one on the way
    for (const double safe : {hull, bead}) {
      if (safe <= 0) continue;
      ASSERT_FALSE(pair.collides_at(safe)) << "trial " << trial << " collides at its bound of " << safe << " s";
    }
    const double longest = std::max(hull, bead);
    ASSERT_FALSE(longest > 0 && pair.collides_at(longest * draw.uniform(0, 1))) << "trial " << trial;
  }
  EXPECT_GT(n_hull, 150000);
  EXPECT_GT(n_bead, 250000);
}

TEST(SafeTime, AllowanceCoversEveryChangeOfMotionWithinIt) {
  test::Draw draw(21);
  const Allowance allowance{1.0, 0.5};
  for (int trial = 0; trial < 100000; ++trial) {
    FlyingPair pair(draw);
    const double safe = std::max(pair.hull_bound(allowance, kHorizon), pair.bead_bound(allowance, kHorizon));
    if (safe <= 0) continue;
    // both rods are pushed and turned, by the whole allowance together, at some times on the way
    double t = 0;
    for (int kick = 0; kick < 2; ++kick) {
      const double wait = draw.uniform(0, 0.5) * (safe - t);
      t += wait;
      for (Flight& f : pair.flight) {
        const Pose pose = pose_after(f, wait, kG);
        Motion motion = motion_after(f, wait, kG, pose.director, pair.ratio);
        motion.velocity += 0.5 * allowance.velocity * draw.direction();
        // across the rod the change of angular velocity is the change of precession
        Vec3 turn = draw.vector(1);
        turn -= turn.dot(pose.director) * pose.director;
        motion.angular_velocity += 0.5 * allowance.precession * turn.normalized();
        begin_flight(f, 0, pose, motion, 1e9, pair.ratio);
      }
    }
    ASSERT_FALSE(pair.collides_at(safe - t)) << "trial " << trial;
    ASSERT_FALSE(pair.collides_at((safe - t) * draw.uniform(0, 1))) << "trial " << trial;
  }
}

TEST(SafeTime, BoundsAreTight) {
  // share of the true time to the first collision, found by marching at 1 us
  test::Draw draw(22);
  std::vector<double> share;
  for (int trial = 0; trial < 6000 && share.size() < 600; ++trial) {
    const FlyingPair pair(draw);
    if (pair.collides_at(0)) continue;
    const double bound = std::max(pair.hull_bound(kStrict, kHorizon), pair.bead_bound(kStrict, kHorizon));
    double contact = 0;
    while (contact < kHorizon && !pair.collides_at(contact)) contact += 1e-6;
    if (contact >= kHorizon) continue;
    share.push_back(bound / contact);
  }
  ASSERT_GT(share.size(), 300u);
  std::sort(share.begin(), share.end());
  std::printf("bound / true time to contact: median %.3f, lower quartile %.3f, lowest %.3f (%zu pairs)\n",
              share[share.size() / 2], share[share.size() / 4], share.front(), share.size());
  EXPECT_LE(share.back(), 1.0);
  EXPECT_GT(share[share.size() / 2], 0.6);
}

TEST(SafeTime, LanesMatchTheirTwin) {
  // further ahead the beads that the lanes leave out shorten the bound; the stepper does not ask further ahead
  constexpr double kNear = 4e-4;
  test::Draw draw(23);
  std::vector<double> share;
  for (int trial = 0; trial < 100000; ++trial) {
    const FlyingPair pair(draw);
    const Allowance allowance{draw.uniform(0, 2), draw.uniform(0, 1)};
    const double lanes = pair.bead_bound(allowance, kNear);
    const double twin =
        test::bead_safe_time_twin(pair.species, pair.state(0), pair.species, pair.state(1), pair.D, allowance, kNear);
    ASSERT_LE(lanes, twin * (1 + 1e-12)) << "trial " << trial;
    if (twin > 1e-5) share.push_back(lanes / twin);
  }
  std::sort(share.begin(), share.end());
  std::printf("lanes / twin: lowest %.3f, 10 %% quantile %.3f, median %.3f\n", share.front(), share[share.size() / 100],
              share[share.size() / 2]);
  EXPECT_GT(share[share.size() / 10], 0.9);
  EXPECT_GT(share[share.size() / 2], 0.97);
}

TEST(SafeTime, RecordsOfDifferentAgeBoundTheCosine) {
  test::Draw draw(24);
  for (int trial = 0; trial < 20000; ++trial) {
    FlyingPair pair(draw);
    const Flight& f = pair.flight[0];
    const Vec3 d = draw.direction();
    const AxisCosine axis{f.director.dot(d), f.precession.cross(f.director).dot(d), 0.5 * f.rate * f.rate, 0};
    const double s = draw.uniform(0, 0.1);
    const double true_cosine = std::abs(pose_after(f, s, kG).director.dot(d));
    EXPECT_LE(true_cosine, std::abs(axis.c + axis.rate * s) + axis.half_rate2 * s * s + 1e-12);
  }
}

/// A rod that flies between the plates.
struct FlyingRod {
  Species species;
  double ratio;
  PlateMotion plates;
  Flight flight;
  double dt;
  Tick start;

  explicit FlyingRod(test::Draw& draw) : plates(0, 0, 0, 1) {
    const double length = draw.uniform(2.5, 4.5);
    species = make_species({.length = length,
                            .end_diameter = draw.integer(0, 4) == 0 ? 0.9 : 0.4,
                            .n_beads = draw.integer(0, 9) == 0 ? 1 : 9});
    ratio = species.inertia_par / species.inertia_perp;
    dt = draw.integer(0, 1) ? 4e-6 : draw.uniform(1e-6, 4e-5);
    const double gamma = draw.integer(0, 5) == 0 ? 0.0 : draw.uniform(0, 15);
    const double frequency = draw.integer(0, 1) ? 200 : draw.uniform(50, 300);
    const double omega = 2 * kPi * frequency;
    plates = PlateMotion(gamma * kG / (omega * omega), frequency, draw.uniform(1.0, 1.6), dt);
    start = draw.integer(0, 1000000);
    const PlateState now = plates.at(start);
    begin_flight(flight, start, {Vec3(0, 0, draw.uniform(now.base + 0.35, now.lid - 0.35)), draw.flat_direction(0.3)},
                 {draw.vector(30), draw.vector(10)}, 1e9, ratio);
  }

  Tick bound() const {
    return plate_safe_ticks(species, plates, flight.position.z(), flight.velocity.z(), flight.director.z(),
                            flight.precession.cross(flight.director).z(), flight.rate * flight.rate, kG, dt, start,
                            4000);
  }
  /// As tick.h has it: the ends and the centre.
  bool collides_at(Tick k) const {
    const double t = static_cast<double>(k - start) * dt;
    const Pose pose = pose_after(flight, t, kG);
    const Motion motion = motion_after(flight, t, kG, pose.director, ratio);
    const PlateState plate = plates.at(k);
    for (const int b : {0, species.n_beads() / 2, species.n_beads() - 1}) {
      const double z = pose.position.z() + species.bead_offset[b] * pose.director.z();
      const double v = motion.velocity.z() + species.bead_offset[b] * motion.angular_velocity.cross(pose.director).z() -
                       plate.velocity;
      if (z - species.bead_radius[b] < plate.base && v < 0) return true;
      if (z + species.bead_radius[b] > plate.lid && v > 0) return true;
    }
    return false;
  }
};

TEST(PlateSafeTicks, NoRodHitsAPlateBeforeItsBound) {
  test::Draw draw(25);
  std::vector<double> share;
  for (int trial = 0; trial < 500000; ++trial) {
    const FlyingRod rod(draw);
    const Tick safe = rod.bound();
    if (safe > 0) {
      ASSERT_FALSE(rod.collides_at(rod.start + safe)) << "trial " << trial;
      ASSERT_FALSE(rod.collides_at(rod.start + 1 + draw.integer(0, static_cast<int>(safe) - 1))) << "trial " << trial;
    }
    if (trial % 1000 == 0 && !rod.collides_at(rod.start + 1)) {
      Tick hit = 1;
      while (hit < 4000 && !rod.collides_at(rod.start + hit)) ++hit;
      share.push_back(static_cast<double>(safe) / static_cast<double>(hit));
    }
  }
  std::sort(share.begin(), share.end());
  std::printf("plate bound / true time: median %.3f, lower quartile %.3f\n", share[share.size() / 2],
              share[share.size() / 4]);
  EXPECT_GT(share[share.size() / 2], 0.8);
  EXPECT_LE(share.back(), 1.0);
}

}  // namespace
}  // namespace shaken
