#include "sim/tick/surface_impacts.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <set>

#include "sim/tick/plate_impacts.h"
#include "tests/support/any_width.h"
#include "tests/support/effort.h"

namespace shaken {
namespace {

/// Rods of one species near the plates, in flight for a few ticks.
struct RodsNearPlates {
  std::set<int> kinds;
  System system;
  World world;
  PlateState plates{};

  static System draw_system(test::Draw& draw) {
    System system;
    if (const int kind = draw.integer(0, 3); kind == 0) {
      system.rod = {.length = 2.5, .mid_diameter = 0.8, .end_diameter = 0.5, .n_beads = 9};
    } else if (kind == 1) {
      system.rod = {.length = 0.8, .mid_diameter = 0.8, .end_diameter = 0.8, .n_beads = 1};
    } else if (kind == 2) {
      system.rod.profile = Profile::kPolar;
    }
    system.n_rods = draw.integer(1, lanes::kDoubleLanes);
    for (ContactParameters* contact : {&system.rod_base, &system.rod_lid})
      *contact = {std::pow(10.0, draw.uniform(-3, 3)), draw.uniform(0, 1)};
    system.base = draw.integer(0, 9) != 0;
    system.lid = draw.integer(0, 9) != 0;
    return system;
  }

  /// What a scene may ask for beside friction by Newton's law.
  static constexpr int kKinds = 10;
  static void add(int kind, test::Draw& draw, System& system) {
    if (kind == 0) system.impacts = ImpactTime::kAtInstant;
    if (kind == 1) system.law = ImpulseLaw::kPoisson;
    if (kind == 2) system.law = ImpulseLaw::kEnergetic;
    if (kind == 3) system.rod_base.friction = 0;
    if (kind == 4) system.rod_lid.friction = 0;
    if (kind == 5) system.rotational_noise = 0.1;
    if (kind == 6) system.amplitude = 0;  // rods rest
    if (kind == 7) system.rod_base.restitution_speed = 50;
    if (kind == 8) system.rod_lid.restitution_speed = 2;
    if (kind == 9) {
      system.horizontal_amplitude = 0.2;
      system.horizontal_phase = draw.uniform(-180, 180);
      system.horizontal_angle = draw.uniform(-180, 180);
    }
  }

  /// Half of the scenes ask for nothing of this; the others for one thing or two, which are noted.
  static System draw_any_system(test::Draw& draw, std::set<int>& kinds) {
    System system = draw_system(draw);
    if (draw.integer(0, 9) == 0) system.rod_base.restitution = 0;
    if (draw.integer(0, 1) == 0) return system;
    for (int n = draw.integer(1, 2); n > 0; --n) {
      const int kind = draw.integer(0, kKinds - 1);
      add(kind, draw, system);
      kinds.insert(kind);
    }
    return system;
  }

  RodsNearPlates(test::Draw& draw, Tick now) : system(draw_any_system(draw, kinds)), world(empty_world(system)) {
    plates = world.plates.at(now);
    const Species& species = world.species.front();
    for (int i = 0; i < system.n_rods; ++i) {
      const Vec3 director = draw.flat_direction(0.2);
      // one end is about to be in a plate, by a little or by far too much, or the rod is at rest, or anywhere
      const double extent = species.max_radius + species.half_length * std::abs(director.z());
      const double height = draw.integer(0, 1) ? plates.base + extent : plates.lid - extent;
      // most often no deeper than it can have come within the tick
      const double apart = draw.integer(0, 3) == 0 ? draw.uniform(-0.3, 0.3)
                                                   : draw.uniform(-0.03, 0.01) * std::pow(10.0, draw.uniform(-3, 0));
      Motion motion{draw.vector(std::pow(10.0, draw.uniform(-6, 3))), draw.vector(std::pow(10.0, draw.uniform(-6, 4)))};
      if (draw.integer(0, 15) == 0) motion = {{0, 0, draw.normal()}, Vec3::Zero()};  // neither turns nor slips
      Flight flight;
      begin_flight(flight, now - draw.integer(0, 40), {{10, 10, height + apart}, director}, motion, system.box_side,
                   species.inertia_par / species.inertia_perp);
      world.rods.push_back(flight);
    }
  }
};

bool are_same(const Vec3& a, const Vec3& b) { return std::memcmp(a.data(), b.data(), sizeof(Vec3)) == 0; }
bool are_same(const ExactSum<34>& a, const ExactSum<34>& b) { return a.low() == b.low() && a.high() == b.high(); }
bool are_same(const ExactSum<44>& a, const ExactSum<44>& b) { return a.low() == b.low() && a.high() == b.high(); }

TEST(PlateImpacts, AreNotInLanesWhereAnEffectIsOnThatTheLanesDoNotKnow) {
  const System system;
  ASSERT_TRUE(lanes_know(system));
  std::vector<Effect> effects(all_effects().begin(), all_effects().end());
  effects.push_back({.name = "sideways_kicks",
                     .what = "Plates kick rods sideways.",
                     .is_on = [](const System&) { return false; },
                     .keys = "plates.kicks",
                     .work = nullptr,
                     .unit = "kicks",
                     .switch_off = nullptr});
  EXPECT_TRUE(lanes_know(system, effects));
  effects.back().is_on = [](const System&) { return true; };
  EXPECT_FALSE(lanes_know(system, effects));
}

TEST(PlateImpacts, InLanesAreBitForBitThoseOfOneRodAfterTheOther) {
  test::Draw draw(71);
  test::AnyWidth width;
  int n_rods = 0, n_unresolved = 0, n_hit = 0, n_met = 0, n_displaced = 0;
  std::array<int, RodsNearPlates::kKinds> n_hit_of{};
  for (int trial = 0; trial < test::draws(40000); ++trial) {
    const Tick now = draw.integer(1000, 4000);
    const RodsNearPlates near(draw, now);
    const TickRules rules(near.world);
    ASSERT_TRUE(lanes_know(near.system));
    width.draw(draw);
    std::vector<int> rods(near.world.rods.size());
    for (std::size_t i = 0; i < rods.size(); ++i) rods[i] = static_cast<int>(rods.size() - 1 - i);
    std::vector<RodAtTick> in_lanes(rods.size());
    Counters counters, expected_counters;
    std::vector<Pose> flight_pose(rods.size());
    const std::uint32_t unresolved =
        meet_plates_in_lanes(rods, near.world.rods, in_lanes, flight_pose, near.plates, now, rules, counters);
    for (std::size_t lane = 0; lane < rods.size(); ++lane) {
      const int i = rods[lane];
      ++n_rods;
      if ((unresolved >> lane) & 1U) {
        ++n_unresolved;
        continue;
      }
      RodAtTick rod = rod_at_tick(near.world.rods[i], now, rules);
      if (rules.system.has_impacts_at_instant()) {
        ASSERT_TRUE(are_same(flight_pose[i].position, rod.pose.position)) << trial;
        ASSERT_TRUE(are_same(flight_pose[i].director, rod.pose.director)) << trial;
      }
      const auto trouble = meet_surfaces(i, rod, near.world.rods[i], near.plates, now, rules, expected_counters);
      ASSERT_FALSE(trouble.has_value()) << trial;
      ASSERT_TRUE(are_same(in_lanes[i].pose.position, rod.pose.position)) << trial;
      ASSERT_TRUE(are_same(in_lanes[i].pose.director, rod.pose.director)) << trial;
      ASSERT_EQ(in_lanes[i].has_motion, rod.has_motion) << trial;
      ASSERT_EQ(in_lanes[i].changed, rod.changed) << trial;
      ASSERT_EQ(in_lanes[i].displaced, rod.displaced) << trial;
      if (!rod.has_motion) continue;
      ASSERT_TRUE(are_same(in_lanes[i].motion.velocity, rod.motion.velocity)) << trial;
      ASSERT_TRUE(are_same(in_lanes[i].motion.angular_velocity, rod.motion.angular_velocity)) << trial;
      n_hit += rod.changed;
      for (const int kind : near.kinds) n_hit_of[static_cast<std::size_t>(kind)] += rod.changed;
      n_met += !rod.changed;
      n_displaced += rod.displaced;
    }
    EXPECT_EQ(counters.impulses_rod_base, expected_counters.impulses_rod_base);
    EXPECT_EQ(counters.impulses_rod_lid, expected_counters.impulses_rod_lid);
    EXPECT_EQ(counters.impacts_at_instant, expected_counters.impacts_at_instant);
    EXPECT_EQ(counters.noise_kicks, expected_counters.noise_kicks);
    EXPECT_TRUE(are_same(counters.ledger.noise, expected_counters.ledger.noise));
    EXPECT_EQ(counters.max_overlap_rod_surface, expected_counters.max_overlap_rod_surface);
    EXPECT_TRUE(are_same(counters.ledger.lost_surfaces, expected_counters.ledger.lost_surfaces));
    EXPECT_TRUE(are_same(counters.ledger.given, expected_counters.ledger.given));
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_TRUE(are_same(counters.ledger.momentum[c], expected_counters.ledger.momentum[c]));
  }
  // most are dealt with, in every way there is
  EXPECT_LT(n_unresolved, n_rods / 3);
  EXPECT_GT(n_hit, n_rods / 12);
  for (const int n : n_hit_of) EXPECT_GT(n, n_hit / 100);
  EXPECT_GT(n_met, n_rods / 100);
  EXPECT_GT(n_displaced, n_rods / 2000);
}

// The director of a rod that turns by far too much is no number in the lanes; its neighbours are still hit.
void expect_no_hit_is_hidden(System system) {
  system.n_rods = 2;
  World world = empty_world(system);
  const Species& species = world.species.front();
  const Tick now = 1000;
  const PlateState plates = world.plates.at(now);
  for (const double turns_at : {0.0, 1e60, -1e60}) {
    for (const bool at_lid : {false, true}) {
      const double height = at_lid ? plates.lid - species.mid_radius + 0.001 : plates.base + species.mid_radius - 0.001;
      world.rods.clear();
      for (const double rate : {turns_at, 0.0}) {
        Flight flight;
        begin_flight(flight, now - 10, {{10, 10, height}, Vec3(1, 0, 1e-6).normalized()}, {{30, 20, 0}, {0, rate, 0}},
                     system.box_side, species.inertia_par / species.inertia_perp);
        world.rods.push_back(flight);
      }
      const TickRules rules(world);
      test::AnyWidth width;
      test::Draw draw(5);
      width.draw(draw);
      std::vector<RodAtTick> in_lanes(2);
      Counters counters;
      const std::vector<int> rods{0, 1};
      std::vector<Pose> flight_pose(2);
      const std::uint32_t unresolved =
          meet_plates_in_lanes(rods, world.rods, in_lanes, flight_pose, plates, now, rules, counters);
      EXPECT_EQ(unresolved & 1U, turns_at != 0 ? 1U : 0U);
      ASSERT_EQ(unresolved & 2U, 0U);
      EXPECT_TRUE(in_lanes[1].has_motion) << (at_lid ? "lid" : "base") << ", turns at " << turns_at;
    }
  }
}
TEST(PlateImpacts, ARodThatTurnsWildlyHidesNoHitOfTheOthers) {
  expect_no_hit_is_hidden({});
  System rarer;
  rarer.law = ImpulseLaw::kPoisson;
  expect_no_hit_is_hidden(rarer);
}

// A sphere in a gap that leaves it 0.02 mm. It is 0.028 mm deep in the base, which it met within this tick, so it has
// bounced off since and would be 0.008 mm deep in the lid: that is a hit of the same tick.
TEST(SurfaceImpacts, ARodThatTheBaseDisplacesMeetsTheLidInTheSameTick) {
  System system;
  system.rod = {.length = 0.8, .mid_diameter = 0.8, .end_diameter = 0.8, .n_beads = 1};
  system.n_rods = 1;
  system.box_side = 20;
  system.gap = 0.82;
  system.amplitude = 0;
  system.gravity = 0;
  system.dt = 64e-6;
  system.impacts = ImpactTime::kAtInstant;
  system.rod_base = system.rod_lid = {0, 1};
  const World world = empty_world(system);
  const TickRules rules(world);
  const PlateState plates = world.plates.at(0);
  constexpr double kSpeed = 500;
  Flight flight;
  flight.position = {10, 10, plates.base + 0.4 - 0.028};
  flight.velocity = {0, 0, -kSpeed};
  flight.prepare();
  RodAtTick rod = rod_at_tick(flight, 0, rules);
  Counters counters;

  ASSERT_FALSE(meet_surfaces(0, rod, flight, plates, 0, rules, counters).has_value());

  EXPECT_EQ(counters.impulses_rod_base, 1);
  EXPECT_EQ(counters.impulses_rod_lid, 1);
  EXPECT_NEAR(rod.motion.velocity.z(), -kSpeed, 1e-9);
  EXPECT_NEAR(rod.pose.position.z(), plates.lid - 0.4 - 0.008, 1e-9);
}

// All beads of a level cylinder are equally deep. Those that are seen first must not depend on which end is the first.
TEST(SurfaceImpacts, ALevelRodMeetsTheBaseTheSameWayTurnedEndForEnd) {
  System system;
  system.rod = {.length = 3, .mid_diameter = 0.8, .end_diameter = 0.8, .n_beads = 5};
  system.n_rods = 1;
  system.box_side = 20;
  system.amplitude = 0;
  system.rod_base = {0.3, 0.5};
  const World world = empty_world(system);
  const TickRules rules(world);
  const PlateState plates = world.plates.at(0);
  const auto motion_after = [&](const Vec3& director) {
    Flight flight;
    flight.position = {10, 10, plates.base + 0.4 - 0.001};
    flight.velocity = {20, 7, -30};
    flight.director = director;
    flight.precession = {0, 0, 5};
    flight.prepare();
    RodAtTick rod = rod_at_tick(flight, 0, rules);
    Counters counters;
    EXPECT_FALSE(meet_surfaces(0, rod, flight, plates, 0, rules, counters).has_value());
    EXPECT_GT(counters.impulses_rod_base, 1);
    return rod.motion;
  };
  const Motion one = motion_after({0.6, 0.8, 0}), other = motion_after({-0.6, -0.8, 0});
  EXPECT_EQ(one.velocity, other.velocity);
  EXPECT_EQ(one.angular_velocity, other.angular_velocity);
}

}  // namespace
}  // namespace shaken
