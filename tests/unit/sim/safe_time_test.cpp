#include "sim/bounds/safe_time.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/bounds/bead_safe_time.h"
#include "sim/bounds/hull_safe_time.h"
#include "sim/bounds/plate_safe_time.h"
#include "sim/bounds/velocity_jump.h"
#include "sim/contact/bead_contacts.h"
#include "sim/contact/impulse.h"
#include "sim/motion/flight.h"
#include "sim/motion/plates.h"
#include "sim/schedule/pair_schedule.h"
#include "tests/support/any_width.h"
#include "tests/support/effort.h"
#include "tests/support/flying_rod.h"
#include "tests/support/random_rods.h"
#include "tests/support/safe_time_twins.h"

namespace shaken {
namespace {

constexpr double kG = 9810;

/// Two rods near each other, moving as they do in a shaken layer; the tilt goes as far as a gap of 1.2 mm lets it.
struct FlyingPair {
  Species species;
  double ratio;
  Flight flight[2];
  Vec3 D;
  FlightBound bound[2];

  explicit FlyingPair(test::Draw& draw) {
    const double length = draw.uniform(2.5, 4.5);
    species = make_species({.length = length,
                            .end_diameter = draw.integer(0, 4) == 0 ? 0.8 : draw.uniform(0.2, 0.6),
                            .n_beads = beads_for_pitch(length, 0.4, 0.3)});
    ratio = species.inertia_ratio;
    const double tilt = draw.integer(0, 1) ? 0.38 : 0.1;
    const Vec3 n = draw.flat_direction(tilt);
    // dense systems are nearly parallel; dilute ones cross at any angle
    const Vec3 m = draw.integer(0, 2) ? (n + draw.vector(0.1)).normalized() : draw.flat_direction(tilt);
    const Vec3 side = Vec3(-n.y(), n.x(), 0).normalized();
    D = draw.uniform(-length, length) * n + (draw.integer(0, 1) ? 1 : -1) * draw.uniform(0.4, 1.0) * side +
        Vec3(0, 0, draw.uniform(-0.4, 0.4));
    begin(draw, {n, m}, 25, 12);
  }

  /// Gives both rods directions and velocities at random, of these scales.
  void begin(test::Draw& draw, const std::array<Vec3, 2>& directors, double speed, double turning) {
    for (std::size_t r = 0; r < 2; ++r)
      begin_flight(flight[r], 0, {Vec3::Zero(), directors[r]}, {draw.vector(speed), draw.vector(turning)}, 1e9, ratio);
    place(draw);
  }

  /// Puts both rods, D apart, where only their distance matters, and gives them a common velocity: no bound may depend
  /// on either (Galilean invariance). Places are up to 10 m from the origin, speeds up to 1,000 mm/s.
  void place(test::Draw& draw) {
    const Vec3 origin(draw.uniform(100, 9900), draw.uniform(100, 9900), 0);
    const Vec3 common =
        draw.integer(0, 2) ? Vec3(std::pow(10.0, draw.uniform(0, 3)) * draw.direction()) : Vec3(Vec3::Zero());
    for (int r = 0; r < 2; ++r) {
      Flight& f = flight[r];
      f.position = origin + (r == 1 ? D : Vec3(Vec3::Zero()));
      f.velocity += common;
      f.prepare();
      see(r);
    }
    D = flight[1].position - flight[0].position;  // as rounded
  }

  /// What bounds know of the rod as it flies now.
  void see(int r) {
    const Flight& f = flight[r];
    bound[r] = flight_bound(f, f.velocity, f.director, 1e9F);
  }

  struct HullBound {
    double time;
    Vec3 direction;
    float gap, gap_at_end;
  };
  HullBound hull_bound(double horizon) const {
    const Hull hull(species);
    PairLanes lanes{};
    constexpr int kLane = 5;  // any will do
    lanes.set(kLane, D, bound[0], bound[1]);
    HullSafeTimes safe;
    hull_safe_times(hull, hull, lanes, kLane + 1, static_cast<float>(horizon), safe);
    return {safe.time[kLane],
            {safe.direction[0][kLane], safe.direction[1][kLane], safe.direction[2][kLane]},
            safe.gap[kLane],
            safe.gap_at_end[kLane]};
  }
  BeadSafeTime bead_bound(double horizon) const {
    const BeadLanes lanes(species);
    return bead_safe_time(lanes, bound[0], lanes, bound[1], D, static_cast<float>(horizon));
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

/// From 16 ms, the stepper's horizon at 4 us, to the 400 ms of ticks of 100 us: slower rods, further apart, and skewed
/// ones among them.
struct FarPair : FlyingPair {
  double horizon;

  explicit FarPair(test::Draw& draw) : FlyingPair(draw), horizon(16e-3 * std::pow(25.0, draw.uniform(0, 1))) {
    switch (draw.integer(0, 3)) {
      case 0:
        species = make_species({.length = 2.5, .bead_diameters{0.9, 0.8, 0.6, 0.4, 0.5, 0.7, 0.5, 0.3}});
        break;
      case 1:
        species = make_species({.length = 3.0, .mid_diameter = 0.9, .n_beads = 11, .profile = Profile::kPolar});
        break;
      case 2:
        species = make_species({.length = 4.5, .mid_diameter = 0.2, .end_diameter = 0.1, .n_beads = 101});
        break;
      default:
        break;
    }
    ratio = species.inertia_ratio;
    const double slow = 0.1 / horizon;  // a tenth of a millimetre or of a rod length in all that time, or more
    const double fast = std::pow(10.0, draw.uniform(0, 2)) * slow;
    D *= draw.uniform(1, 3);
    for (Flight& f : flight) {
      const Vec3 director = f.director;
      begin_flight(f, 0, {Vec3::Zero(), director},
                   {draw.vector(fast), draw.vector(draw.integer(0, 1) ? 0.1 * fast : fast)}, 1e9, ratio);
    }
    place(draw);
  }
};

TEST(SafeTime, NoPairCollidesBeforeItsBoundOverLongHorizons) {
  test::Draw draw(27);
  test::AnyWidth width;
  std::int64_t n_long = 0, n_limited = 0, n_skewed = 0;
  for (int trial = 0; trial < test::draws(100000); ++trial) {
    width.draw(draw);
    const FarPair pair(draw);
    const double hull = pair.hull_bound(pair.horizon).time;
    const double bead = pair.bead_bound(std::min(pair.horizon, 20e-3)).time;  // asked no further ahead
    n_long += hull > 16e-3;
    n_limited += hull > 0 && hull < 0.999 * pair.horizon;
    n_skewed += hull > 0 && pair.species.tail.length != pair.species.head.length;
    for (const double safe : {hull, bead}) {
      if (safe <= 0) continue;
      ASSERT_FALSE(pair.collides_at(safe)) << "trial " << trial << " collides at its bound of " << safe << " s";
      ASSERT_FALSE(pair.collides_at(safe * draw.uniform(0, 1))) << "trial " << trial;
      ASSERT_FALSE(pair.collides_at(safe * draw.uniform(0.9, 1))) << "trial " << trial;
    }
  }
  EXPECT_GT(n_long, test::draws(15000));
  EXPECT_GT(n_limited, test::draws(15000));
  EXPECT_GT(n_skewed, test::draws(15000));
}

TEST(ImageSafeTime, NoOtherImageTouchesBeforeIt) {
  test::Draw draw(28);
  int n_short = 0, n_full = 0, n_away = 0;
  for (int trial = 0; trial < test::draws(100000); ++trial) {
    const double reach = draw.uniform(0.5, 5);
    const double side = 2.2 * reach * (draw.integer(0, 1) ? 1 : draw.uniform(1, 3));
    const double horizon = 16e-3 * std::pow(25.0, draw.uniform(0, 1));
    const Vec3 D{draw.uniform(-0.5, 0.5) * side, draw.uniform(-0.5, 0.5) * side, draw.uniform(-0.3, 0.3)};
    FlightBound i{}, j{};
    const double fast = std::pow(10.0, draw.uniform(-4, 3));
    const Vec3 common = draw.integer(0, 2) ? Vec3(std::pow(10.0, draw.uniform(0, 3)) * draw.direction()) : Vec3::Zero();
    const Vec3 velocity[2] = {common + draw.vector(fast), common + draw.vector(fast)};
    set_velocity(i, velocity[0]);
    set_velocity(j, velocity[1]);
    const double safe = image_safe_time(D, i, j, side, reach, static_cast<float>(horizon));
    ASSERT_GT(safe, 0.0);
    ASSERT_LE(safe, static_cast<double>(static_cast<float>(horizon)));
    ++(safe < static_cast<double>(static_cast<float>(horizon)) ? n_short : n_full);
    // and for whatever motion below a speed that keeps the others away
    const double slow = draw.uniform(0, 1) * side / horizon;
    const bool stay_away = images_stay_away(D, side, reach, slow, horizon);
    n_away += stay_away;
    // the slow twin: every other image, at the last safe instant
    for (int x = -2; x <= 2; ++x) {
      for (int y = -2; y <= 2; ++y) {
        if (x == 0 && y == 0) continue;
        const Vec3 image = D + side * Vec3(x, y, 0);
        Vec3 at = image;
        for (int c = 0; c < 2; ++c) at[c] = std::abs(at[c] + (velocity[1][c] - velocity[0][c]) * safe);
        ASSERT_GE(std::max(at.x(), at.y()), reach) << "trial " << trial << ", image " << x << ' ' << y;
        if (!stay_away) continue;
        const double farther = std::max(std::abs(image.x()), std::abs(image.y()));
        ASSERT_GE(farther - 2 * slow * horizon, reach) << "trial " << trial << ", image " << x << ' ' << y;
      }
    }
  }
  EXPECT_GT(n_short, test::draws(10000));
  EXPECT_GT(n_full, test::draws(10000));
  EXPECT_GT(n_away, test::draws(5000));
}

TEST(GapBound, LeavesNoMoreThanThereIs) {
  test::Draw draw(32);
  for (int trial = 0; trial < test::draws(1000000); ++trial) {
    const auto now = static_cast<float>(std::pow(10.0, draw.uniform(-4, 2)));
    const auto then = static_cast<float>(now * draw.uniform(-1, 1));
    const auto time = static_cast<float>(std::pow(10.0, draw.uniform(-5, -1)));
    const auto until = time * static_cast<float>(draw.uniform(0, 1));
    const GapBound line = GapBound::between(now, then, time, until, false);
    const double exact = now - (static_cast<double>(now) - then) / time * until;
    ASSERT_LE(line.residual, std::max(0.0, exact)) << "trial " << trial << ": " << now << " mm to " << then;
  }
}

TEST(SafeTime, NoPairCollidesBeforeItsBound) {
  test::Draw draw(20);
  test::AnyWidth width;
  std::int64_t n_hull = 0, n_bead = 0;
  for (int trial = 0; trial < test::draws(1000000); ++trial) {
    width.draw(draw);
    const FlyingPair pair(draw);
    const double hull = pair.hull_bound(kHorizon).time;
    const double bead = pair.bead_bound(kHorizon).time;
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
  EXPECT_GT(n_hull, test::draws(300000));
  EXPECT_GT(n_bead, test::draws(500000));
}

/// Rods whose two ends differ, as near to each other as FlyingPair, often with an end next to an end.
struct SkewedPair : FlyingPair {
  explicit SkewedPair(test::Draw& draw) : FlyingPair(draw) {
    const double length = draw.uniform(2.0, 4.5);
    const double thick = draw.uniform(0.5, 0.9);
    if (draw.integer(0, 2) == 0) {
      std::vector<double> diameters(draw.integer(3, 15));
      for (double& diameter : diameters) diameter = thick * draw.uniform(0.3, 1.0);
      species = make_species({.length = length, .bead_diameters = diameters});
    } else {
      species = make_species({.length = length,
                              .mid_diameter = thick,
                              .end_diameter = thick * draw.uniform(0.1, 1.0),
                              .n_beads = draw.integer(5, 25),
                              .profile = Profile::kPolar});
    }
    ratio = species.inertia_ratio;
    if (draw.integer(0, 1)) {
      const Vec3 a = draw.integer(0, 1) ? species.bead_offset.front() * flight[0].director
                                        : Vec3(species.bead_offset.back() * flight[0].director);
      const Vec3 b = draw.integer(0, 1) ? species.bead_offset.front() * flight[1].director
                                        : Vec3(species.bead_offset.back() * flight[1].director);
      D = a - b + draw.vector(1.0);
    }
    begin(draw, {flight[0].director, flight[1].director}, 25, 12);
  }
};

TEST(SafeTime, NoSkewedPairCollidesBeforeItsBound) {
  test::Draw draw(29);
  test::AnyWidth width;
  std::int64_t n_bead = 0, n_short = 0;
  for (int trial = 0; trial < test::draws(200000); ++trial) {
    width.draw(draw);
    const SkewedPair pair(draw);
    const double bead = pair.bead_bound(kHorizon).time;
    n_bead += bead > 0;
    n_short += bead > 0 && bead < 0.99 * kHorizon;
    if (bead <= 0) continue;
    ASSERT_FALSE(pair.collides_at(bead)) << "trial " << trial << " collides at its bound of " << bead << " s";
    ASSERT_FALSE(pair.collides_at(bead * draw.uniform(0, 1))) << "trial " << trial;
  }
  EXPECT_GT(n_bead, test::draws(100000));
  EXPECT_GT(n_short, test::draws(20000));
}

/// Rods in touch that ride along together: beads overlap by very little, and the speed at which those come nearer to
/// each other, or recede, is next to nothing beside that at which they slide, turn, and move together. Thin rods as
/// long as a scene may have among them: where their beads are is rounded by what is small beside the rod, not the bead.
struct RidingPair : FlyingPair {
  explicit RidingPair(test::Draw& draw) : FlyingPair(draw) {
    if (draw.integer(0, 1)) {
      const double thickness = 40 * std::pow(10.0, draw.uniform(-2.5, -1.7));
      species =
          make_species({.length = 40, .mid_diameter = thickness, .end_diameter = 0.5 * thickness, .n_beads = 101});
      ratio = species.inertia_ratio;
    }
    const int last = species.n_beads() - 1;
    const int m = draw.integer(0, last);
    const int n = draw.integer(0, last);
    const Vec3 n_i = flight[0].director;
    const Vec3 n_j = flight[1].director;
    const Vec3 along = draw.direction();
    const Vec3 e = (along - along.dot(n_i) * n_i).normalized();
    const double overlap = std::pow(10.0, draw.uniform(-6, -3));
    D = species.bead_offset[m] * n_i - species.bead_offset[n] * n_j +
        (species.bead_radius[m] + species.bead_radius[n] - overlap) * e;
    const Vec3 slide = std::pow(10.0, draw.uniform(-3, 1.5)) * draw.direction();
    const double recede = (draw.integer(0, 1) ? 1 : -1) * std::pow(10.0, draw.uniform(-9, -2));
    const double turns = draw.integer(0, 2) ? 0 : std::pow(10.0, draw.uniform(-3, 1));
    Vec3 velocity[2];  // of the two beads that overlap
    velocity[0].setZero();
    velocity[1] = slide - slide.dot(e) * e + recede * e;
    for (int r = 0; r < 2; ++r) {
      Flight& f = flight[r];
      const Vec3 director = f.director;
      const Vec3 angular_velocity = draw.vector(turns);
      const Vec3 arm = species.bead_offset[r == 0 ? m : n] * director;
      begin_flight(f, 0, {Vec3::Zero(), director}, {velocity[r] - angular_velocity.cross(arm), angular_velocity}, 1e9,
                   ratio);
    }
    place(draw);
  }
};

TEST(SafeTime, NoPairThatRidesAlongTogetherCollidesBeforeItsBound) {
  test::Draw draw(31);
  test::AnyWidth width;
  std::int64_t n_bound = 0, n_approaching = 0;
  for (int trial = 0; trial < test::draws(60000); ++trial) {
    width.draw(draw);
    const RidingPair pair(draw);
    n_approaching += pair.collides_at(0);
    for (const double safe : {pair.hull_bound(kHorizon).time, static_cast<double>(pair.bead_bound(kHorizon).time)}) {
      if (safe <= 1e-7) continue;  // no scene has a shorter tick
      ++n_bound;
      for (const double t : {1e-7, safe, safe * draw.uniform(0, 1)})
        ASSERT_FALSE(pair.collides_at(t)) << "trial " << trial << " collides after " << t << " of " << safe << " s";
    }
  }
  EXPECT_GT(n_bound, test::draws(2500));
  EXPECT_GT(n_approaching, test::draws(20000));
}

/// Two polar rods along x, end to end with a gap, fly towards each other at 10 mm/s.
BeadSafeTime bound_in_line(bool thick_ends, double gap) {
  const Species species = make_species({.profile = Profile::kPolar});
  const double to_tail = -species.bead_offset.front() + species.bead_radius.front();
  const double to_head = species.bead_offset.back() + species.bead_radius.back();
  const double end = thick_ends ? to_tail : to_head;
  const Vec3 D(2 * end + gap, 0, 0);
  const double ratio = species.inertia_ratio;
  FlightBound bound[2];
  for (int r = 0; r < 2; ++r) {
    // the director points to the head, the thin end
    const Vec3 director((r == 0) == thick_ends ? -1 : 1, 0, 0);
    Flight flight;
    begin_flight(flight, 0, {Vec3(1000, 1000, 0) + r * D, director}, {Vec3(r == 0 ? 5 : -5, 0, 0), Vec3::Zero()}, 1e9,
                 ratio);
    bound[r] = flight_bound(flight, flight.velocity, flight.director, 1e9F);
  }
  const BeadLanes lanes(species);
  return bead_safe_time(lanes, bound[0], lanes, bound[1], D, 0.1F);
}

TEST(SafeTime, EndsOfPolarRodsInLineAreApartUntilTheyMeet) {
  for (const bool thick_ends : {true, false}) {
    for (const double gap : {0.05, 0.2, 0.8}) {
      const BeadSafeTime safe = bound_in_line(thick_ends, gap);
      EXPECT_NEAR(static_cast<double>(safe.gap), gap, 1e-4) << "thick " << thick_ends;
      EXPECT_NEAR(static_cast<double>(safe.time), gap / 10, 0.01 * gap / 10)
          << "thick " << thick_ends << " gap " << gap;
    }
  }
}

/// A pair that waits for its bound in a table of its own, while its rods are hit now and then.
struct WaitingPair {
  FlyingPair pair;
  double dt;
  PairSchedule table;
  Tick now = 0;
  Tick end = 0;  ///< of the bound, if no rod is hit

  WaitingPair(test::Draw& draw, bool of_beads)
      : pair(draw), dt(draw.integer(0, 2) ? 4e-6 : draw.uniform(4e-6, 100e-6)), table(2, dt) {
    const FlyingPair::HullBound hull = pair.hull_bound(kHorizon);
    const BeadSafeTime beads = pair.bead_bound(kHorizon);
    const float time = of_beads ? beads.time : static_cast<float>(hull.time);
    const float gap = of_beads ? beads.gap : hull.gap;
    const float at_end = of_beads ? 0.0F : hull.gap_at_end;
    const auto ticks = static_cast<int>(static_cast<double>(time) / dt * (1 - 1e-5));
    table.make_room(1);
    table.add(0, {0, 1}, 0);
    Direction direction;
    for (std::size_t c = 0; c < 3; ++c) direction[c] = static_cast<float>(hull.direction[static_cast<Eigen::Index>(c)]);
    const auto t = static_cast<float>(ticks) * static_cast<float>(dt);
    table.set_bound(0, 0, ticks, direction, gap > 0 ? GapBound::between(gap, at_end, time, t, of_beads) : GapBound{});
    end = ticks;
  }
  Tick due() const { return const_cast<PairSchedule&>(table).wheel().due(0, now); }

  /// Both rods fly on.
  void fly(Tick ticks) {
    now += ticks;
    for (Flight& f : pair.flight) fly(f, static_cast<double>(ticks) * dt);
  }
  void fly(Flight& f, double seconds) const {
    const Pose pose = pose_after(f, seconds, kG);
    begin_flight(f, 0, pose, motion_after(f, seconds, kG, pose.director, pair.ratio), 1e9, pair.ratio);
  }
  /// Hits a rod: by a plate at one of its ends, or by whatever, now or a little before. False if the bound must be made
  /// anew.
  bool hit(int r, double strength, test::Draw& draw) {
    Flight& f = pair.flight[r];
    const Flight before = f;
    const double ago = draw.integer(0, 2) == 0 ? draw.uniform(0, dt) : 0.0;
    fly(f, -ago);
    Motion motion = motion_after(f, 0, kG, f.director, pair.ratio);
    if (draw.integer(0, 1)) {
      motion.velocity += draw.vector(strength);
      motion.angular_velocity += draw.vector(strength);
    } else {
      const Vec3 arm = (draw.integer(0, 1) ? 1 : -1) * pair.species.half_length * f.director;
      apply_impulse(motion, inverse_inertia(pair.species), f.director, arm,
                    strength * pair.species.mass * Vec3::UnitZ());
    }
    begin_flight(f, 0, {f.position, f.director}, motion, 1e9, pair.ratio);
    fly(f, ago);
    const Vec3 turning = f.precession.cross(f.director) - before.precession.cross(before.director);
    VelocityJump change(f.velocity - before.velocity, turning, before.rate, f.rate, pair.species.half_length);
    if (ago > 0) change.displace(f.position - before.position, f.director - before.director, pair.species.half_length);
    bool is_used_up = false;
    table.spend(r, change, now, [&](int) { is_used_up = true; });
    if (!is_used_up) return true;
    ++n_shortened;
    return table.shorten_bound(0, now);
  }
  /// Flies to where the pair comes up, or so many ticks beyond, and says whether its bound holds.
  bool is_apart_when_due(Tick beyond) {
    fly(due() + beyond - now);
    return table.is_apart(0, now);
  }
  int n_shortened = 0;
  bool collides_in(Tick ticks) const { return pair.collides_at(static_cast<double>(ticks) * dt); }
};

TEST(SafeTime, TightenedBoundsHoldForRodsThatAreHit) {
  test::Draw draw(21);
  test::AnyWidth width;
  std::int64_t n_hits_held = 0, n_shortened = 0, n_apart = 0, n_collided = 0;
  for (int trial = 0; trial < test::draws(200000); ++trial) {
    width.draw(draw);
    WaitingPair waiting(draw, draw.integer(0, 1));
    // now and then, or in every tick by very little
    const bool rests = draw.integer(0, 3) == 0;
    const int n_hits = rests ? 40 : 4;
    for (int k = 0; k < n_hits; ++k) {
      if (waiting.due() - waiting.now < 3 || draw.integer(0, 9) == 0) {
        if (waiting.is_apart_when_due(draw.integer(0, 2) ? 0 : draw.integer(1, 20))) {
          ASSERT_FALSE(waiting.collides_in(0)) << "trial " << trial << ", hit " << k;
          ++n_apart;
        }
        break;
      } else {
        waiting.fly(rests ? 1 : draw.integer(1, static_cast<int>((waiting.due() - waiting.now - 1) / 2)));
      }
      const double strength = rests ? std::pow(10.0, draw.uniform(-4, 0)) : std::pow(10.0, draw.uniform(-2, 2.5));
      const int r = draw.integer(0, 1);
      bool holds = waiting.hit(r, strength, draw);
      if (holds && draw.integer(0, 3) == 0) holds = waiting.hit(1 - r, strength, draw);
      if (!holds) break;
      ++n_hits_held;
      // the last tick that is said to be safe, and one on the way
      const Tick safe = waiting.due() - 1 - waiting.now;
      for (const Tick ticks : {safe, static_cast<Tick>(draw.integer(0, static_cast<int>(safe)))})
        ASSERT_FALSE(waiting.collides_in(ticks)) << "trial " << trial << ", hit " << k << ", " << ticks << '/' << safe;
      n_collided += waiting.end > waiting.now && waiting.collides_in(waiting.end - waiting.now);
    }
    n_shortened += waiting.n_shortened;
  }
  EXPECT_GT(n_hits_held, test::draws(200000));
  EXPECT_GT(n_shortened, test::draws(50000));
  EXPECT_GT(n_apart, test::draws(10000));
  EXPECT_GT(n_collided, test::draws(1000));  // where the bound, had nothing been taken, would have missed it
}

TEST(SafeTime, BoundsAreTight) {
  // share of the true time to the first collision, found by marching at 1 us
  test::Draw draw(22);
  std::vector<double> share;
  for (int trial = 0; trial < test::draws(6000) && share.size() < 600; ++trial) {
    const FlyingPair pair(draw);
    if (pair.collides_at(0)) continue;
    const double bound = std::max<double>(pair.hull_bound(kHorizon).time, pair.bead_bound(kHorizon).time);
    double contact = 0;
    while (contact < kHorizon && !pair.collides_at(contact)) contact += 1e-6;
    if (contact >= kHorizon) continue;
    share.push_back(bound / contact);
  }
  ASSERT_GT(share.size(), static_cast<std::size_t>(test::draws(300)));
  test::expect_tight("pairs", share, 0.8);
}

/// Both kinds of bound, near their twins and never beyond.
TEST(SafeTime, LanesMatchTheirTwins) {
  // further ahead the beads that the lanes leave out shorten the bound; the stepper does not ask further ahead
  constexpr double kNear = 4e-4;
  test::Draw draw(23);
  test::AnyWidth width;
  std::vector<double> hull_share, bead_share;
  for (int trial = 0; trial < test::draws(100000); ++trial) {
    width.draw(draw);
    const FlyingPair pair(draw);
    const FlyingPair::HullBound hull = pair.hull_bound(kHorizon);
    const BeadSafeTime bead = pair.bead_bound(kNear);
    ASSERT_NEAR(hull.direction.norm(), 1, 1e-6);
    const double hull_twin =
        test::hull_safe_time_twin(pair.species, pair.bound[0], pair.bound[1], pair.D, hull.direction, kHorizon);
    const double bead_twin = test::bead_safe_time_twin(pair.species, pair.bound[0], pair.bound[1], pair.D, kNear);
    ASSERT_LE(hull.time, hull_twin * (1 + 1e-6)) << "trial " << trial;
    ASSERT_LE(bead.time, bead_twin * (1 + 1e-6)) << "trial " << trial;
    if (hull_twin > 1e-5) hull_share.push_back(hull.time / hull_twin);
    if (bead_twin > 1e-5) bead_share.push_back(bead.time / bead_twin);
  }
  for (auto* share : {&hull_share, &bead_share}) {
    std::sort(share->begin(), share->end());
    std::printf("lanes / twin: lowest %.3f, 10 %% quantile %.3f, median %.3f\n", share->front(),
                (*share)[share->size() / 10], (*share)[share->size() / 2]);
    EXPECT_GT((*share)[share->size() / 10], 0.8);
    EXPECT_GT((*share)[share->size() / 2], 0.97);
  }
}

TEST(BeadsMayOverlap, NamesEveryBeadThatDoes) {
  test::Draw draw(26);
  test::AnyWidth width;
  int n_contacts = 0, n_named = 0, n_pairs = 0;
  for (int trial = 0; trial < test::draws(60000); ++trial) {
    width.draw(draw);
    FlyingPair pair(draw);
    switch (draw.integer(0, 2)) {
      case 0:  // longer rods than a vector has lanes, up to a whole number of them
        pair.species = make_species({.length = 6.0, .n_beads = draw.integer(0, 1) ? 33 : 31});
        break;
      case 1: {  // thin for their length, and touching near their ends by very little
        const double thickness = 40 * std::pow(10.0, draw.uniform(-2.5, -1.7));
        pair.species =
            make_species({.length = 40, .mid_diameter = thickness, .end_diameter = 0.5 * thickness, .n_beads = 101});
        const auto& s = pair.species;
        const int m = draw.integer(0, 1) ? draw.integer(0, 10) : draw.integer(90, 100);
        const int n = draw.integer(0, 1) ? draw.integer(0, 10) : draw.integer(90, 100);
        const double overlap = std::pow(10.0, draw.uniform(-6, -4));
        const Vec3 along = draw.vector(1).normalized();
        const Vec3 &n_i = pair.flight[0].director, &n_j = pair.flight[1].director;
        const Vec3 e = (along - along.dot(n_i) * n_i).normalized();
        pair.D = s.bead_offset[m] * n_i - s.bead_offset[n] * n_j + (s.bead_radius[m] + s.bead_radius[n] - overlap) * e;
        break;
      }
      default:
        break;
    }
    const Species& s = pair.species;
    const BeadLanes lanes(s);
    const Vec3 &n = pair.flight[0].director, &m = pair.flight[1].director;
    const BeadRange range = beads_may_overlap(lanes, n, lanes, m, pair.D);
    ASSERT_TRUE(range.from >= 0 && range.to <= s.n_beads());
    std::vector<BeadContact> all, some;
    find_bead_contacts(s, n, s, m, pair.D, all);
    find_bead_contacts(s, n, s, m, pair.D, range, some);
    ASSERT_EQ(all.size(), some.size()) << "trial " << trial;
    for (std::size_t c = 0; c < all.size(); ++c) {
      ASSERT_TRUE(all[c].bead_i == some[c].bead_i && all[c].bead_j == some[c].bead_j &&
                  all[c].overlap == some[c].overlap && all[c].normal == some[c].normal);
    }
    n_contacts += static_cast<int>(all.size());
    n_pairs += !all.empty();
    if (!all.empty()) n_named += range.to - range.from;
  }
  EXPECT_GT(n_contacts, test::draws(20000));
  EXPECT_LT(n_named, 12 * n_pairs);  // a few, not the whole rod
}

/// Rods that fly between the same plates.
struct FlyingRods {
  Species species;
  double ratio;
  PlateMotion plates;
  std::vector<Flight> flights;
  double dt;
  Tick start;

  explicit FlyingRods(test::Draw& draw) : plates(0, 0, 0, 1) {
    const double length = draw.uniform(2.5, 4.5);
    species = make_species({.length = length,
                            .end_diameter = draw.integer(0, 4) == 0 ? 0.9 : 0.4,
                            .n_beads = draw.integer(0, 9) == 0 ? 1 : 9});
    ratio = species.inertia_ratio;
    dt = draw.integer(0, 1) ? 4e-6 : draw.uniform(1e-6, 4e-5);
    const double gamma = draw.integer(0, 5) == 0 ? 0.0 : draw.uniform(0, 15);
    const double frequency = draw.integer(0, 1) ? 200 : draw.uniform(50, 300);
    const double omega = 2 * kPi * frequency;
    System system;
    system.amplitude = gamma * kG / (omega * omega);
    system.frequency = frequency;
    system.gap = draw.uniform(1.0, 1.6);
    system.dt = dt;
    if (draw.integer(0, 3) == 0) system.second = SecondVibration{draw.uniform(0, 0.03), draw.uniform(50, 400), 30.0};
    if (draw.integer(0, 3) == 0) system.lid_motion = LidMotion{draw.uniform(0, 0.05), draw.uniform(-180, 180)};
    plates = PlateMotion(system);
    start = draw.integer(0, 1000000);
    const PlateState now = plates.at(start);
    flights.resize(draw.integer(1, kLanes));
    for (Flight& f : flights) {
      begin_flight(f, start, {Vec3(0, 0, draw.uniform(now.base + 0.35, now.lid - 0.35)), draw.flat_direction(0.3)},
                   {draw.vector(30), draw.vector(10)}, 1e9, ratio);
    }
  }

  std::array<Tick, kLanes> bounds() const {
    PlateLanes lanes{};
    for (std::size_t l = 0; l < flights.size(); ++l) {
      const Flight& f = flights[l];
      lanes.z[l] = static_cast<float>(f.position.z());
      lanes.velocity[l] = static_cast<float>(f.velocity.z());
      lanes.n_z[l] = static_cast<float>(f.director.z());
      lanes.n_z_rate[l] = static_cast<float>(f.precession.cross(f.director).z());
      lanes.rate2[l] = static_cast<float>(f.rate * f.rate);
    }
    std::array<Tick, kLanes> safe{};
    plate_safe_ticks(species, plates, lanes, static_cast<int>(flights.size()), kG, dt, start, 4000, safe.data());
    return safe;
  }
  /// As tick.h has it: the ends and the centre.
  bool collides_at(const Flight& flight, Tick k) const {
    const double t = static_cast<double>(k - start) * dt;
    const Pose pose = pose_after(flight, t, kG);
    const Motion motion = motion_after(flight, t, kG, pose.director, ratio);
    const PlateState plate = plates.at(k);
    for (const int b : {0, species.n_beads() / 2, species.n_beads() - 1}) {
      const double z = pose.position.z() + species.bead_offset[b] * pose.director.z();
      const double v = motion.velocity.z() + species.bead_offset[b] * motion.angular_velocity.cross(pose.director).z();
      if (z - species.bead_radius[b] < plate.base && v < plate.velocity) return true;
      if (z + species.bead_radius[b] > plate.lid && v > plate.lid_velocity) return true;
    }
    return false;
  }
};

TEST(PlateSafeTicks, NoRodHitsAPlateBeforeItsBound) {
  test::Draw draw(25);
  test::AnyWidth width;
  std::vector<double> share;
  int n_rods = 0;
  for (int trial = 0; n_rods < test::draws(1000000); ++trial) {
    width.draw(draw);
    const FlyingRods rods(draw);
    const auto bounds = rods.bounds();
    for (std::size_t l = 0; l < rods.flights.size(); ++l) {
      const Flight& flight = rods.flights[l];
      const Tick safe = bounds[l];
      ++n_rods;
      if (safe > 0) {
        const int between = draw.integer(1, static_cast<int>(safe));
        ASSERT_FALSE(rods.collides_at(flight, rods.start + safe)) << "trial " << trial << " rod " << l;
        ASSERT_FALSE(rods.collides_at(flight, rods.start + between)) << "trial " << trial << " rod " << l;
      }
      if (n_rods % 1000 == 0 && !rods.collides_at(flight, rods.start + 1)) {
        Tick hit = 1;
        while (hit < 4000 && !rods.collides_at(flight, rods.start + hit)) ++hit;
        share.push_back(static_cast<double>(safe) / static_cast<double>(hit));
      }
    }
  }
  test::expect_tight("plates", share, 0.8);
}

}  // namespace
}  // namespace shaken
