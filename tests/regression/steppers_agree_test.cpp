// The main test of the steppers: the scheduled stepper gives bitwise the reference stepper's trajectory.
#include <gtest/gtest.h>

#include <tuple>

#include "sim/simulation.h"
#include "tests/support/compare_steppers.h"

namespace shaken {
namespace steppers_agree_test {

using test::compare;
using test::compare_threads;
using test::problem;

struct Case {
  double length, area_fraction, gap, gamma, restitution, friction, dt_us;
  int n_rods;
  Tick ticks;
  Start start = Start::kAligned;
  double end_diameter = 0.4;
  int n_beads = 0;  ///< 0: pitch 0.3 mm
  ImpulseLaw law = ImpulseLaw::kNewton;
  ContactOrder order = ContactOrder::kSorted;

  friend void PrintTo(const Case& one, std::ostream* out) {
    *out << one.n_rods << " rods of " << one.length << " mm, " << one.n_beads << " beads, end " << one.end_diameter
         << ", area fraction " << one.area_fraction << ", gap " << one.gap << ", gamma " << one.gamma
         << ", restitution " << one.restitution << ", friction " << one.friction << ", step " << one.dt_us
         << " us, law " << static_cast<int>(one.law) << ", order " << static_cast<int>(one.order) << ", start "
         << static_cast<int>(one.start);
  }
};

System scene_of(const Case& c, std::uint64_t seed) {
  System system;
  system.rod.length = c.length;
  system.rod.end_diameter = c.end_diameter;
  system.rod.n_beads = c.n_beads > 0 ? c.n_beads : beads_for_pitch(c.length, c.end_diameter, 0.3);
  system.n_rods = c.n_rods;
  const double length = system.rod.n_beads == 1 ? system.rod.mid_diameter : c.length;
  system.box_side = std::max(2.2 * length + 1.0, std::sqrt(c.n_rods * make_species(system.rod).area / c.area_fraction));
  system.gap = c.gap;
  const double omega = 2 * kPi * system.frequency;
  system.amplitude = c.gamma * system.gravity / (omega * omega);
  system.rod_rod = system.rod_base = system.rod_lid = {c.friction, c.restitution};
  system.dt = c.dt_us * 1e-6;
  system.start = c.start;
  system.law = c.law;
  system.order = c.order;
  system.seed = seed;
  return system;
}

class SteppersAgree : public testing::TestWithParam<Case> {};

TEST_P(SteppersAgree, BitForBit) {
  const System system = scene_of(GetParam(), 7);
  ASSERT_TRUE(static_cast<bool>(Simulation::start(system))) << Simulation::start(system).error().message;
  EXPECT_EQ(problem(compare(system, GetParam().ticks, GetParam().ticks / 3 + 11)), "");
  EXPECT_EQ(problem(compare_threads(system, 1500)), "");
}

constexpr Start kRandomStart = Start::kRandom;
INSTANTIATE_TEST_SUITE_P(
    Scenes, SteppersAgree,
    testing::Values(
        // the paper's scenes
        Case{4.5, 0.45, 1.2, 7, 0.3, 0.05, 4, 100, 10000}, Case{4.5, 0.60, 1.2, 7, 0.3, 0.05, 4, 100, 10000},
        Case{4.5, 0.75, 1.2, 7, 0.3, 0.05, 4, 120, 10000}, Case{4.5, 0.85, 1.2, 7, 0.3, 0.05, 4, 140, 10000},
        Case{4.5, 0.75, 1.2, 7, 0.3, 0.05, 4, 600, 5000}, Case{2.5, 0.45, 1.2, 7, 0.3, 0.05, 4, 80, 20000},
        Case{2.5, 0.60, 1.2, 7, 0.3, 0.05, 4, 80, 50000}, Case{2.5, 0.75, 1.2, 7, 0.3, 0.05, 4, 80, 20000},
        Case{2.5, 0.85, 1.2, 7, 0.3, 0.05, 4, 100, 20000}, Case{3.0, 0.60, 1.2, 7, 0.3, 0.05, 4, 80, 10000},
        Case{3.5, 0.85, 1.2, 7, 0.3, 0.05, 4, 100, 10000}, Case{4.0, 0.70, 1.2, 7, 0.3, 0.05, 4, 100, 10000},
        // packed and dilute
        Case{4.5, 0.90, 1.2, 7, 0.3, 0.05, 4, 144, 8000}, Case{2.5, 0.90, 1.2, 7, 0.3, 0.05, 4, 104, 8000},
        Case{4.5, 0.20, 1.2, 7, 0.3, 0.05, 4, 60, 20000}, Case{2.5, 0.20, 1.2, 7, 0.3, 0.05, 4, 60, 20000},
        // gaps
        Case{4.5, 0.75, 0.9, 7, 0.3, 0.05, 4, 100, 10000}, Case{4.5, 0.75, 1.4, 7, 0.3, 0.05, 4, 100, 10000},
        Case{2.5, 0.70, 1.6, 7, 0.3, 0.05, 4, 80, 20000}, Case{2.5, 0.85, 0.9, 7, 0.3, 0.05, 4, 80, 10000},
        // shaking
        Case{4.5, 0.70, 1.2, 0, 0.3, 0.05, 4, 80, 20000}, Case{2.5, 0.60, 1.2, 1, 0.3, 0.05, 4, 80, 20000},
        Case{2.5, 0.60, 1.2, 3, 0.3, 0.05, 4, 80, 20000}, Case{4.5, 0.75, 1.2, 15, 0.3, 0.05, 4, 80, 10000},
        // restitution
        Case{4.5, 0.70, 1.2, 7, 0.0, 0.05, 4, 80, 10000}, Case{2.5, 0.60, 1.2, 7, 0.05, 0.05, 4, 80, 10000},
        Case{4.5, 0.70, 1.2, 3, 0.9, 0.05, 4, 80, 10000}, Case{2.5, 0.60, 1.2, 0, 1.0, 0.0, 4, 80, 20000},
        // friction
        Case{4.5, 0.70, 1.2, 7, 0.3, 0.0, 4, 80, 10000}, Case{4.5, 0.70, 1.2, 7, 0.3, 0.3, 4, 80, 10000},
        Case{2.5, 0.60, 1.2, 7, 0.3, 1.0, 4, 80, 10000},
        // impulse laws
        Case{4.5, 0.70, 1.2, 7, 0.3, 1.0, 4, 80, 10000, Start::kAligned, 0.4, 0, ImpulseLaw::kPoisson},
        Case{4.5, 0.70, 1.2, 7, 0.3, 1.0, 4, 80, 10000, Start::kAligned, 0.4, 0, ImpulseLaw::kEnergetic},
        Case{2.5, 0.60, 1.2, 7, 0.9, 1.0, 4, 80, 10000, Start::kAligned, 0.4, 0, ImpulseLaw::kPoisson},
        Case{2.5, 0.60, 1.2, 7, 0.9, 1.0, 4, 80, 10000, Start::kAligned, 0.4, 0, ImpulseLaw::kEnergetic},
        // orders of contacts
        Case{4.5, 0.80, 1.2, 7, 0.3, 0.05, 16, 80, 5000, Start::kAligned, 0.4, 0, ImpulseLaw::kNewton,
             ContactOrder::kReversed},
        Case{4.5, 0.80, 1.2, 7, 0.3, 0.05, 16, 80, 5000, Start::kAligned, 0.4, 0, ImpulseLaw::kNewton,
             ContactOrder::kShuffled},
        // ticks
        Case{4.5, 0.70, 1.2, 7, 0.3, 0.05, 1, 60, 20000}, Case{2.5, 0.60, 1.2, 7, 0.3, 0.05, 1, 60, 20000},
        Case{4.5, 0.70, 1.2, 7, 0.3, 0.05, 16, 80, 5000}, Case{2.5, 0.60, 1.2, 7, 0.3, 0.05, 40, 80, 5000},
        Case{4.5, 0.80, 1.2, 7, 0.3, 0.05, 40, 80, 5000}, Case{3.5, 0.60, 1.2, 7, 0.3, 0.05, 3.7, 80, 10000},
        // shapes: spheres, no taper, strong taper, few beads, wider at the ends
        Case{0.8, 0.50, 1.2, 7, 0.3, 0.05, 4, 150, 20000, kRandomStart, 0.8, 1},
        Case{4.5, 0.65, 1.2, 7, 0.3, 0.05, 4, 80, 10000, Start::kAligned, 0.8},
        Case{2.5, 0.50, 1.2, 7, 0.3, 0.05, 4, 80, 10000, Start::kAligned, 0.8},
        Case{4.5, 0.60, 1.2, 7, 0.3, 0.05, 4, 80, 10000, Start::kAligned, 0.2},
        Case{2.5, 0.50, 1.2, 7, 0.3, 0.05, 4, 80, 10000, Start::kAligned, 0.4, 3},
        Case{3.5, 0.50, 1.3, 7, 0.3, 0.05, 4, 60, 10000, Start::kAligned, 1.0},
        // so much room that rods fly over many boxes between two hits, stand upright, and leave their neighbours in a
        // moment
        Case{0.8, 0.50, 20, 30, 0.95, 0.5, 20, 150, 20000, kRandomStart, 0.8, 1},
        Case{0.8, 0.50, 5, 30, 0.95, 0.5, 20, 150, 20000, kRandomStart, 0.8, 1},
        Case{1.6, 0.40, 20, 30, 0.9, 0.1, 4, 60, 20000, kRandomStart, 0.4},
        Case{4.5, 0.40, 6, 15, 0.5, 0.05, 4, 40, 20000, kRandomStart},
        // random starts, few rods
        Case{4.5, 0.35, 1.2, 7, 0.3, 0.05, 4, 60, 10000, kRandomStart},
        Case{2.5, 0.40, 1.2, 7, 0.3, 0.05, 4, 80, 10000, kRandomStart}, Case{4.5, 0.20, 1.2, 7, 0.3, 0.05, 4, 1, 50000},
        Case{4.5, 0.30, 1.2, 7, 0.3, 0.05, 4, 2, 50000},
        Case{2.5, 0.30, 1.6, 12, 0.5, 0.1, 4, 5, 50000, kRandomStart}));

// A rod that rests on the base is visited at each tick without a bound, and may slide far meanwhile: one strikes
// another that rests, and that slides into a third, of which the neighbour list knew nothing.
TEST(SteppersAgree, WhereRodsSlideThatRest) {
  for (const auto& [length, end_diameter, n_beads] :
       {std::tuple{0.8, 0.8, 1}, std::tuple{4.5, 0.8, 15}, std::tuple{4.5, 0.4, 15}}) {
    for (const double speed : {20.0, 50.0}) {
      System system;
      system.rod = {.length = length, .mid_diameter = 0.8, .end_diameter = end_diameter, .n_beads = n_beads};
      system.n_rods = 3;
      system.box_side = 30;
      system.amplitude = 0;
      system.gap = 1.2;
      system.rod_rod = {0, 1};
      system.rod_base = system.rod_lid = {0, 0.3};
      World world = empty_world(system);
      world.rods.resize(3);
      constexpr double kY[3] = {10, 11.5, 13.3};
      for (int i = 0; i < 3; ++i) {
        Flight& rod = world.rods[i];
        rod.position = {15, kY[i], world.plates.at(0).base + 0.4};
        rod.velocity = {0, i == 0 ? speed : 0.0, 0};
        rod.prepare();
      }
      EXPECT_EQ(problem(compare(world, 40000, 4000)), "") << length << " mm, " << speed << " mm/s";
      Simulation simulation = Simulation::start_from(world);
      ASSERT_FALSE(simulation.advance_to(40000).has_value());
      EXPECT_GE(simulation.world().counters.impulses_rod_rod, 2) << length << " mm, " << speed << " mm/s";
    }
  }
}

// Four thousand million ticks into a run, ticks no longer fit into 32 bits; on either side of that, and begun anew just
// before it, where a stepper has seen next to nothing yet.
TEST(SteppersAgree, WhereTicksOutgrow32Bits) {
  constexpr Tick kBorder = Tick{1} << 32;
  const System system = scene_of({4.5, 0.75, 1.2, 7, 0.3, 0.05, 4, 200, 0}, 7);
  // what a stepper that begins so many ticks before the border does at the border's last tick of 32 bits
  const auto hits_at_border = [](const World& world) {
    Simulation simulation = Simulation::start_from(world);
    const auto hits = [&] {
      return simulation.world().counters.impulses_rod_base + simulation.world().counters.impulses_rod_lid;
    };
    EXPECT_FALSE(simulation.advance_to(kBorder - 2).has_value());
    const auto before = hits();
    EXPECT_FALSE(simulation.advance_to(kBorder - 1).has_value());
    return hits() - before;
  };
  for (const Tick ahead : {2, 3, 40, 900}) {
    auto early = Simulation::start(system);
    ASSERT_TRUE(static_cast<bool>(early)) << early.error().message;
    const Tick period = early->world().plates.period_ticks();
    ASSERT_GT(period, 0);
    int n_hits = 0;
    for (Tick n_periods = 4; n_periods < 40 && n_hits == 0; ++n_periods) {
      ASSERT_FALSE(early->advance_to(n_periods * period + (kBorder - ahead) % period).has_value());
      World world = early->world();
      const Tick later = kBorder - ahead - world.tick;  // whole periods: the plates are where they were
      world.tick += later;
      for (Flight& rod : world.rods) rod.since += later;
      n_hits = static_cast<int>(hits_at_border(world));
      if (n_hits == 0) continue;
      EXPECT_EQ(problem(compare(world, 3000, 1500)), "") << ahead << " ticks before";
    }
    EXPECT_GT(n_hits, 0);
  }
}

}  // namespace steppers_agree_test
}  // namespace shaken
