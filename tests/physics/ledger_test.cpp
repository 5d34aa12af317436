// The budgets close: energy and momentum that rods have are what they had, got and lost, entered impact by impact.
#include <gtest/gtest.h>

#include "sim/balance.h"
#include "sim/motion/side_walls.h"
#include "sim/simulation.h"
#include "tests/support/good.h"
#include "tests/support/short_rods.h"

namespace shaken {
namespace {

constexpr double kRounding = 1e-11;  ///< of all energy that changed hands; 1e5 impacts, each right to 1e-16

struct Case {
  const char* name;
  void (*set)(System&);
};

class LedgerOf : public testing::TestWithParam<Case> {};

TEST_P(LedgerOf, Closes) {
  System system = test::short_rods(60);
  GetParam().set(system);
  auto simulation = test::good(Simulation::start(system));
  const double momentum_scale = simulation->world().species[0].mass * 50 * system.n_all_rods();
  for (const Tick k : {1, 5000, 25000}) {
    ASSERT_FALSE(simulation->advance_to(k).has_value());
    const Balance budget = balance(simulation->world());
    EXPECT_LT(budget.energy_error(), kRounding) << "tick " << k;
    EXPECT_LT(budget.momentum_unexplained.norm(), 1e-9 * momentum_scale) << "tick " << k;
    if (k == 5000) simulation = Simulation::resume(system, simulation->checkpoint());  // the budget goes on
  }
  const Balance budget = balance(simulation->world());
  EXPECT_GT(budget.energy_lost_rod_rod, 0);
  // an error of a millionth in what the impacts lose would show
  EXPECT_GT(1e-6 * budget.energy_lost_rod_rod, 10 * std::abs(budget.energy_unexplained));
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, LedgerOf,
    testing::Values(Case{"Paper", [](System&) {}},
                    Case{"Frictionless",
                         [](System& s) { s.rod_rod.friction = s.rod_base.friction = s.rod_lid.friction = 0; }},
                    Case{"PlatesAtRest", [](System& s) { s.amplitude = 0; }},
                    Case{"RoughAndSticky",
                         [](System& s) {
                           s.rod_rod.friction = s.rod_base.friction = 0.5;
                           s.rotational_noise = 0.1;
                         }},
                    Case{"HorizontalVibration",
                         [](System& s) {
                           s.horizontal_amplitude = 0.05;
                           s.horizontal_phase = 70;
                           s.horizontal_angle = 30;
                         }},
                    Case{"SecondVibration",
                         [](System& s) {
                           s.second = SecondVibration{0.02, 317.0, 40.0};
                         }},
                    Case{"LidByItself",
                         [](System& s) {
                           s.lid_motion = LidMotion{0.06, 120.0};
                         }},
                    Case{"Inclined",
                         [](System& s) {
                           s.inclination = 20;
                           s.inclination_angle = 30;
                         }},
                    Case{"AtInstant", [](System& s) { s.impacts = ImpactTime::kAtInstant; }},
                    Case{"EnergeticLaw",
                         [](System& s) {
                           s.law = ImpulseLaw::kEnergetic;
                           s.rod_rod.friction = 1;
                         }},
                    Case{"RestitutionOfSpeed",
                         [](System& s) {
                           s.rod_rod.restitution_speed = 20;
                           s.rod_base.restitution_speed = s.rod_lid.restitution_speed = 60;
                         }},
                    Case{"SpeciesOfTheirOwn",
                         [](System& s) {
                           s.n_rods = 40;
                           s.added[1] = AddedRods{{.length = 0.8, .n_beads = 1}, 20};
                           s.rod_rod.own[Contacts::place(0, 2)] = {0.5, 0.9, {}};
                           s.rod_base.own[Contacts::place(0, 2)] = {0.3, {}, 40.0};
                         }},
                    Case{"AsHeavyAsAllowed",
                         [](System& s) {
                           s.rod = {.length = 40, .mid_diameter = 15, .end_diameter = 12, .n_beads = 9, .density = 100};
                           s.n_rods = 12;
                           s.box_side = 125;
                           s.gap = 20;
                           s.frequency = 50;
                           s.amplitude = 3;
                         }},
                    Case{"SpheresInADisc",
                         [](System& s) {
                           s.walls = SideWalls{Arena::kDisc, 11.0, 1.0, {0.2, 0.3}};
                           s.n_rods = 15;
                           s.added[0] = AddedRods{{.length = 0.8, .n_beads = 1}, 20};
                           s.start = Start::kRandom;
                         }}),
    [](const auto& about) { return std::string(about.param.name); });

/// Momentum of all rods in the plane, and their angular momentum about the middle of the box, upwards.
struct InThePlane {
  Vec2 momentum = Vec2::Zero();  ///< [mg mm/s]
  double angular = 0;            ///< [mg mm^2/s]
};
InThePlane in_the_plane(const World& world) {
  const Snapshot now = snapshot(world);
  InThePlane sum;
  for (std::size_t i = 0; i < now.n_rods(); ++i) {
    const Species& species = world.species_of(i);
    const Vec3& n = now.director[i];
    const Vec3& spin = now.angular_velocity[i];
    const Vec3 arm = now.position[i] - Vec3(0.5, 0.5, 0) * world.system.box_side;
    const Vec3 turning = species.inertia_perp * spin + (species.inertia_par - species.inertia_perp) * spin.dot(n) * n;
    sum.momentum += species.mass * now.velocity[i].head<2>();
    sum.angular += species.mass * arm.cross(now.velocity[i]).z() + turning.z();
  }
  return sum;
}

/// 30 rods in a disc without friction, that lose little to each other.
System rods_in_a_disc() {
  System system = test::short_rods(60);
  system.walls = SideWalls{Arena::kDisc, 11.0, 1.0, {0.0, 0.9}};
  system.n_rods = 30;
  system.rod_rod = {0.0, 0.9};
  system.rod_base.friction = system.rod_lid.friction = 0;
  return system;
}

// With plates that have no friction, the wall alone gives momentum in the plane.
TEST(Ledger, MomentumOfTheDiscComesFromItsWall) {
  auto simulation = test::good(Simulation::start(rods_in_a_disc()));
  const World& world = simulation->world();
  const double scale = world.species[0].mass * 20 * world.system.n_rods;
  Vec2 before = in_the_plane(world).momentum;
  std::int64_t n_before = 0;
  int n_changes = 0;
  for (Tick k = 1; k <= 25000; ++k) {
    ASSERT_FALSE(simulation->advance_to(k).has_value());
    const std::int64_t n_now = world.counters.impulses_rod_wall;
    const Vec2 now = in_the_plane(world).momentum;
    if (n_now == n_before) {
      ASSERT_LT((now - before).norm(), 1e-12 * scale) << "no wall was met at tick " << k;
    } else {
      n_changes += (now - before).norm() > 1e-4 * scale;
    }
    before = now;
    n_before = n_now;
  }
  EXPECT_GT(n_changes, 50);
  const Ledger& ledger = world.counters.ledger;
  const Vec2 booked(ledger.momentum[0].value(), ledger.momentum[1].value());
  EXPECT_LT((before - world.start.momentum.head<2>() - booked).norm(), 1e-9 * scale);
  EXPECT_GT(booked.norm(), 1e-2 * scale);
}

// A round wall without friction pushes towards the middle only: nothing turns the rods about it.
TEST(Ledger, ARoundWallWithoutFrictionGivesNoAngularMomentum) {
  for (const double friction : {0.0, 0.1}) {
    System system = rods_in_a_disc();
    system.base = system.lid = false;
    system.gravity = 0;
    system.walls->contact.friction = friction;
    auto simulation = test::good(Simulation::start(system));
    const World& world = simulation->world();
    const double scale = world.species[0].mass * 20 * 5 * system.n_rods;
    const double start = in_the_plane(world).angular;
    ASSERT_FALSE(simulation->advance_to(50000).has_value());
    EXPECT_GT(world.counters.impulses_rod_wall, 50);
    EXPECT_GT(world.counters.impulses_rod_rod, 50);
    const double change = std::abs(in_the_plane(world).angular - start);
    if (friction > 0) {
      EXPECT_GT(change, 1e-6 * scale) << "friction does turn them: the twin that shows that this test can fail";
    } else {
      EXPECT_LT(change, 1e-11 * scale);
    }
    const Snapshot now = simulation->snapshot();
    for (const Vec3& position : now.position)
      EXPECT_GT(distance_to_walls(*system.walls, system.box_side, position), 0.0) << "a rod is outside";
  }
}

}  // namespace
}  // namespace shaken
