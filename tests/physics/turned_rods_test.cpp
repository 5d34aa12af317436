// Which end of an apolar rod is its head is a label (n -> -n): no trajectory and no mean may depend on it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "sim/simulation.h"
#include "sim/start/initial.h"
#include "sim/tick/surface_impacts.h"
#include "tests/support/random_rods.h"
#include "tests/support/short_rods.h"

namespace shaken {
namespace turned_rods_test {

// ---- whole runs: their twins with rods turned end for end are the same, bit by bit

struct Case {
  const char* name;
  void (*set)(System&);
  double area_fraction = 0.7;
};

System scene_of(const Case& about) {
  System system;
  system.rod = {.length = 2.5, .n_beads = 9};
  system.box_side = 12;
  system.n_rods = static_cast<int>(about.area_fraction * 144 / make_species(system.rod).area);
  about.set(system);
  return system;
}

void turn_end_for_end(Flight& flight) {
  flight.director = -flight.director;
  flight.spin = -flight.spin;
  flight.prepare();
}

class TurnedRods : public testing::TestWithParam<Case> {};

TEST_P(TurnedRods, FlyTheSameDownToTheLastBit) {
  auto made = make_world(scene_of(GetParam()));
  ASSERT_TRUE(static_cast<bool>(made)) << made.error().message;
  const World world = std::move(made).value();
  World turned = world;
  std::vector<double> sign(world.rods.size(), 1.0);
  test::Draw draw(3);
  for (std::size_t i = 0; i < sign.size(); ++i) {
    if (draw.integer(0, 1) == 0) continue;
    turn_end_for_end(turned.rods[i]);
    sign[i] = -1.0;
  }
  for (const StepperKind stepper : {StepperKind::kScheduled, StepperKind::kReference}) {
    World one = world;
    World other = turned;
    one.system.stepper = other.system.stepper = stepper;
    Simulation plain = Simulation::start_from(one);
    Simulation twin = Simulation::start_from(other);
    const Tick ticks = stepper == StepperKind::kScheduled ? 20000 : 4000;
    for (const Tick k : {ticks / 20, ticks / 4, ticks}) {
      ASSERT_FALSE(plain.advance_to(k).has_value());
      ASSERT_FALSE(twin.advance_to(k).has_value());
      const Snapshot a = plain.snapshot();
      const Snapshot b = twin.snapshot();
      for (std::size_t i = 0; i < sign.size(); ++i) {
        ASSERT_EQ(a.position[i], b.position[i]) << "rod " << i << " at tick " << k;
        ASSERT_EQ(a.velocity[i], b.velocity[i]) << "rod " << i << " at tick " << k;
        ASSERT_EQ(a.angular_velocity[i], b.angular_velocity[i]) << "rod " << i << " at tick " << k;
        ASSERT_EQ(a.director[i], sign[i] * b.director[i]) << "rod " << i << " at tick " << k;
      }
    }
    EXPECT_GT(plain.world().counters.impulses_rod_rod, 10);
    EXPECT_EQ(plain.world().counters.impulses_rod_rod, twin.world().counters.impulses_rod_rod);
    EXPECT_EQ(plain.world().counters.impulses_rod_wall, twin.world().counters.impulses_rod_wall);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, TurnedRods,
    testing::Values(Case{"Paper", [](System&) {}}, Case{"Packed", [](System&) {}, 0.82},
                    Case{"LongTicks", [](System& s) { s.dt = 16e-6; }},
                    Case{"AtInstant", [](System& s) { s.impacts = ImpactTime::kAtInstant; }},
                    Case{"StickyPlates", [](System& s) { s.rod_base.friction = s.rod_lid.friction = 0.3; }},
                    Case{"Frictionless",
                         [](System& s) { s.rod_rod.friction = s.rod_base.friction = s.rod_lid.friction = 0; }},
                    Case{"Cylinders", [](System& s) { s.rod.end_diameter = s.rod.mid_diameter; }, 0.45},
                    Case{"Rough", [](System& s) { s.rotational_noise = 0.1; }},
                    Case{"Resting", [](System& s) { s.amplitude = 0; }},
                    Case{"Disc",
                         [](System& s) {
                           s.walls = SideWalls{Arena::kDisc, 11.0, 1.0, {0.1, 0.3}};
                           s.n_rods = 26;
                         }},
                    Case{"Square",
                         [](System& s) {
                           s.walls = SideWalls{Arena::kSquare, 11.0, 1.0, {0.1, 0.3}};
                           s.n_rods = 36;
                         }},
                    Case{"WithSpheres",
                         [](System& s) {
                           s.n_rods = 36;
                           s.added[0] = AddedRods{{.length = 0.8, .n_beads = 1}, 20};
                         }},
                    Case{"Planar",
                         [](System& s) {
                           s.base = s.lid = false;
                           s.gravity = 0;
                         }},
                    Case{"Reversed", [](System& s) { s.order = ContactOrder::kReversed; }},
                    Case{"Shuffled", [](System& s) { s.order = ContactOrder::kShuffled; }},
                    Case{"Sweeps", [](System& s) { s.solver_sweeps = 3; }},
                    Case{"Energetic",
                         [](System& s) {
                           s.law = ImpulseLaw::kEnergetic;
                           s.rod_rod.friction = s.rod_base.friction = s.rod_lid.friction = 0.5;
                         }}),
    [](const auto& about) { return std::string(about.param.name); });

// ---- what the plates do to a rod: means, over rods that two of their beads hit in one tick

/// Mean and standard error of numbers added one by one.
class Mean {
 public:
  void add(double x) {
    ++n_;
    sum_ += x;
    squares_ += x * x;
  }
  double value() const { return sum_ / n_; }
  double error() const { return std::sqrt((squares_ / n_ - value() * value()) / (n_ - 1)); }

 private:
  double n_ = 0, sum_ = 0, squares_ = 0;
};

/// A rod that has just hit the base or the lid with its middle and one of its ends, of which either may be the head.
struct TwofoldHit {
  RodAtTick rod;
  Flight flight;

  TwofoldHit(test::Draw& draw, const World& world, const TickRules& rules) {
    const Species& species = world.species[0];
    const double side = draw.integer(0, 1) ? 1.0 : -1.0;
    const PlateState plates = world.plates.at(0);
    // both lie within the depth of a tick, 0.2 um
    const double middle_depth = draw.uniform(0, 2e-4);
    const double end_depth = draw.uniform(0, 2e-4);
    const double lift = (species.mid_radius - middle_depth - (species.end_radius - end_depth)) / species.half_length;
    const double angle = draw.uniform(0, 2 * kPi);
    const double n_z = (draw.integer(0, 1) ? 1 : -1) * lift;
    const double level = std::sqrt(1 - n_z * n_z);
    flight.director = {level * std::cos(angle), level * std::sin(angle), n_z};
    flight.position = {0, 0, (side > 0 ? plates.base : plates.lid) + side * (species.mid_radius - middle_depth)};
    // as plates throw them, rocking; what they do in the plane besides has no mean, and would only hide it
    flight.velocity = {0, 0, -side * (60 + 20 * draw.normal())};
    const Vec3 axis = Vec3::UnitZ().cross(flight.director).normalized();
    flight.precession = 10 * draw.normal() * axis;
    flight.prepare();
    rod = rod_at_tick(flight, 0, rules);
  }
};

TEST(TurnedRods, PlatesPushApolarRodsNeitherWayAndTiltedOnesOppositely) {
  const World world = empty_world(test::short_rods(1, 20));
  const TickRules rules(world);
  test::Draw draw(41);
  Mean push, size, up, down;  // v . n that a tick gives: mean, mean size, where n points up and where it points down
  Counters counters;
  for (int trial = 0; trial < 200000; ++trial) {
    TwofoldHit hit(draw, world, rules);
    const Vec3 n = hit.rod.pose.director;
    ASSERT_FALSE(meet_surfaces(0, hit.rod, hit.flight, world.plates.at(0), 0, rules, counters).has_value());
    if (!hit.rod.changed) continue;  // it did not approach
    const double along = (hit.rod.motion.velocity - hit.flight.velocity).head<2>().dot(n.head<2>());
    push.add(along);
    size.add(std::abs(along));
    (n.z() > 0 ? up : down).add(along);
  }
  std::printf("push along n %.5f +- %.5f mm/s, its size %.5f; n up %.5f, n down %.5f +- %.5f\n", push.value(),
              push.error(), size.value(), up.value(), down.value(), down.error());
  EXPECT_GT(counters.impulses_rod_base + counters.impulses_rod_lid, 220000);  // many are hit twice
  // no drift of apolar rods; a bias of 2 % of what a hit gives would be seen
  EXPECT_LT(4 * push.error(), 0.02 * size.value());
  EXPECT_LT(std::abs(push.value()), 4 * push.error());
  // and the curve of v against n_z is odd
  const double odd_error = std::hypot(up.error(), down.error());
  EXPECT_LT(4 * odd_error, 0.04 * size.value());
  EXPECT_LT(std::abs(up.value() + down.value()), 4 * odd_error);
}

}  // namespace turned_rods_test
}  // namespace shaken
