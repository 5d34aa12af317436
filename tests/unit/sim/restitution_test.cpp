// Restitution that falls with speed, and contacts that species have of their own: known answers of single impacts.
#include "sim/contact/restitution.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/tick/rod_impacts.h"
#include "sim/tick/surface_impacts.h"
#include "tests/support/random_rods.h"

namespace shaken {
namespace {

const RodShape kBall{.length = 0.8, .mid_diameter = 0.8, .end_diameter = 0.8, .n_beads = 1};
const RodShape kHeavyBall{.length = 0.6, .mid_diameter = 0.6, .end_diameter = 0.6, .n_beads = 1, .density = 40};

TEST(FifthRoot, AgreesWithLongDouble) {
  test::Draw draw(1);
  for (int k = 0; k < 100000; ++k) {
    const double x = std::pow(10.0, draw.uniform(-300, 300));
    const double exact = static_cast<double>(std::pow(static_cast<long double>(x), 0.2L));
    ASSERT_NEAR(fifth_root(x), exact, 7e-16 * exact) << x;
  }
  EXPECT_EQ(fifth_root(0.0), 0.0);
  EXPECT_NEAR(fifth_root(1.0), 1.0, 7e-16);
  const double least =
      static_cast<double>(std::pow(static_cast<long double>(5e-324), 0.2L));  // of the smallest number there is
  EXPECT_NEAR(fifth_root(5e-324), least, 2e-15 * least);
}

TEST(FallingRestitution, HasTheLawsKnownValues) {
  const double e = 0.6, v = 40;
  EXPECT_NEAR(falling_restitution(e, v, v), e, 1e-15);
  EXPECT_NEAR(falling_restitution(e, v / 32, v), 1 - 0.4 / 2, 1e-15);
  EXPECT_NEAR(falling_restitution(e, v / 243, v), 1 - 0.4 / 3, 1e-15);
  EXPECT_EQ(falling_restitution(e, 16 * v, v), e / 2);
  EXPECT_EQ(falling_restitution(e, 0, v), 1);
  EXPECT_NEAR(falling_restitution(1, 81 * v, v), 1.0 / 3, 1e-15);
  double before = 1;
  for (double speed = 1e-6; speed < 1e6; speed *= 1.1) {
    const double now = falling_restitution(e, speed, v);
    EXPECT_LT(now, before);
    EXPECT_GT(now, 0);
    before = now;
  }
}

TEST(FallingRestitution, IsOffByDefaultAndOfRodsThatDoNotBounce) {
  EXPECT_EQ(restitution_at({0.1, 0.7}, 123), 0.7);
  EXPECT_EQ(restitution_at({0.1, 0.0, 50}, 1), 0.0);
  EXPECT_EQ(restitution_at({0.1, 0.5, 50}, 800), 0.25);
}

struct Rebound {
  double speed;  ///< after an impact on the base
  double lost;   ///< energy
  double mass;
};

/// A ball that falls onto a base at rest.
Rebound drop(const System& system, double speed) {
  const World world = empty_world(system);
  const TickRules rules(world);
  const PlateState plates = world.plates.at(0);
  Flight flight;
  flight.position = {10, 10, plates.base + 0.4 - 1e-4};
  flight.velocity = {0, 0, -speed};
  flight.prepare();
  RodAtTick rod = rod_at_tick(flight, 0, rules);
  Counters counters;
  EXPECT_FALSE(meet_surfaces(0, rod, flight, plates, 0, rules, counters).has_value());
  return {rod.motion.velocity.z(), counters.ledger.lost_surfaces.value(), world.species[0].mass};
}

TEST(FallingRestitution, ABallReboundsFromThePlateByItsSpeedWithEveryLaw) {
  for (const ImpulseLaw law : {ImpulseLaw::kNewton, ImpulseLaw::kPoisson, ImpulseLaw::kEnergetic}) {
    for (const double friction : {0.0, 0.3}) {
      System system;
      system.rod = kBall;
      system.n_rods = 1;
      system.amplitude = system.gravity = 0;
      system.law = law;
      system.rod_base = {friction, 0.6};
      system.rod_base.restitution_speed = 20;
      for (const auto& [speed, e] : {std::pair{20.0 / 32, 0.8}, std::pair{20.0, 0.6}, std::pair{320.0, 0.3}}) {
        const Rebound after = drop(system, speed);
        EXPECT_NEAR(after.speed, e * speed, 1e-12 * speed) << friction;
        EXPECT_NEAR(after.lost, 0.5 * after.mass * speed * speed * (1 - e * e), 1e-9);
      }
    }
  }
}

/// Two balls that meet head on while they slip past each other: velocities afterwards.
std::array<Vec3, 2> collide(const System& system, std::uint8_t first, std::uint8_t second) {
  System with_two = system;
  with_two.n_rods = 1;
  World world = empty_world(with_two);
  world.shape_of_rod = {first, second};
  const TickRules rules(world);
  const double touch = rules.species_of(0).bead_radius[0] + rules.species_of(1).bead_radius[0];
  world.rods.resize(2);
  world.rods[0].position = {10, 10, 1};
  world.rods[0].velocity = {30, 500, 0};
  world.rods[1].position = {10 + touch - 1e-3, 10, 1};
  std::vector<RodAtTick> rods;
  for (Flight& flight : world.rods) {
    flight.prepare();
    rods.push_back(rod_at_tick(flight, 0, rules));
  }
  EXPECT_FALSE(collide_rods({{0, 1, {0, 0, 1e-3, Vec3::UnitX()}}}, rods, world, 0, rules).has_value());
  return {rods[0].motion.velocity, rods[1].motion.velocity};
}

System two_species() {
  System system;
  system.rod = kBall;
  system.added[0] = AddedRods{kHeavyBall, 1};
  system.gravity = system.amplitude = 0;
  system.rod_rod = {0.05, 0.3};
  system.rod_rod.own[Contacts::place(0, 1)] = {0.2, 0.9, {}};
  system.rod_rod.own[Contacts::place(1, 1)] = {0.4, {}, 480.0};
  return system;
}

TEST(SpeciesContacts, EachPairOfSpeciesHasItsOwnImpulse) {
  const System system = two_species();
  const double mass[] = {make_species(kBall).mass, make_species(kHeavyBall).mass};
  // two heavy balls at 30 mm/s, 1/16 of the speed at which restitution is 0.3
  const double slow = 1 - 0.7 * std::pow(1.0 / 16, 0.2);
  struct Known {
    std::uint8_t i, j;
    double friction, restitution;
  };
  for (const auto& [i, j, mu, e] :
       {Known{0, 0, 0.05, 0.3}, Known{0, 1, 0.2, 0.9}, Known{1, 0, 0.2, 0.9}, Known{1, 1, 0.4, slow}}) {
    const auto velocity = collide(system, i, j);
    const double p = (1 + e) * 30 / (1 / mass[i] + 1 / mass[j]);  // of a central impact that slips
    EXPECT_NEAR((velocity[1] - Vec3(p, mu * p, 0) / mass[j]).norm(), 0, 1e-11) << int{i} << int{j};
    EXPECT_NEAR((velocity[0] - Vec3(30, 500, 0) + Vec3(p, mu * p, 0) / mass[i]).norm(), 0, 1e-11) << int{i} << int{j};
  }
}

TEST(SpeciesContacts, TheNumbersOfSpeciesDoNotMatter) {
  const System system = two_species();
  System exchanged = system;
  exchanged.rod = kHeavyBall;
  exchanged.added[0]->rod = kBall;
  exchanged.rod_rod = Contacts(system.rod_rod.of(1, 1));
  exchanged.rod_rod.own[Contacts::place(0, 1)] = system.rod_rod.own[Contacts::place(0, 1)];
  exchanged.rod_rod.own[Contacts::place(0, 1)].restitution_speed = 0.0;
  exchanged.rod_rod.own[Contacts::place(1, 1)] = {0.05, 0.3, 0.0};
  for (const std::uint8_t i : {0, 1}) {
    for (const std::uint8_t j : {0, 1})
      EXPECT_EQ(collide(system, i, j), collide(exchanged, 1 - i, 1 - j)) << int{i} << int{j};
  }
}

TEST(SpeciesContacts, ASpeciesThatIsLeftOutIsNotCounted) {
  System system = two_species();
  system.added = {std::nullopt, AddedRods{kHeavyBall, 1}};
  system.rod_rod = {0.05, 0.3};
  system.rod_rod.own[Contacts::place(0, 2)].friction = 0.2;
  system.rod_base.own[Contacts::place(0, 2)].restitution = 0.7;
  system.rod_base.own[Contacts::place(0, 1)].restitution = 0.1;
  const TickRules rules(empty_world(system));
  ASSERT_EQ(rules.species.size(), 2U);
  EXPECT_EQ(rules.species[0].rods[2].friction, 0.2);
  EXPECT_EQ(rules.species[1].rods[0].friction, 0.2);
  EXPECT_EQ(rules.species[1].rods[2].friction, 0.05);
  EXPECT_EQ(rules.species[1].base.restitution, 0.7);
  EXPECT_EQ(rules.species[0].base.restitution, 0.3);
}

}  // namespace
}  // namespace shaken
