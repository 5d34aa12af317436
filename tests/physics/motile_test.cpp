// Rods that move by themselves because their ends differ: nothing in the program says that they should, it comes out of
// the impacts.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "sim/simulation.h"

namespace shaken {
namespace {

struct Drift {
  double mean = 0;   ///< of v . n over rods and time [mm/s]
  double error = 0;  ///< standard error, from the rods' own means
};

/// Mean velocity along the director of 20 rods in a dilute gas, after one second of settling, for `seconds` each in
/// gases that differ in their seed.
Drift drift_of(const RodShape& rod, double plate_friction, double seconds, int n_gases) {
  System system;
  system.rod = rod;
  system.n_rods = 20;
  system.box_side = 25;
  system.start = Start::kRandom;
  system.rod_base.friction = system.rod_lid.friction = plate_friction;
  std::vector<double> means;
  for (int gas = 0; gas < n_gases; ++gas) {
    system.seed = 1 + static_cast<std::uint64_t>(gas);
    auto simulation = Simulation::start(system);
    std::vector<double> along(static_cast<std::size_t>(system.n_rods), 0.0);
    int n_frames = 0;
    const auto end = static_cast<Tick>(std::lround((1 + seconds) / system.dt));
    for (Tick k = 250000; k <= end; k += 1000) {
      EXPECT_FALSE(simulation->advance_to(k).has_value());
      const Snapshot now = simulation->snapshot();
      for (std::size_t i = 0; i < along.size(); ++i) along[i] += now.velocity[i].dot(now.director[i]);
      ++n_frames;
    }
    for (const double sum : along) means.push_back(sum / n_frames);
  }
  Drift drift;
  double squares = 0;
  const auto n = static_cast<double>(means.size());
  for (const double mean : means) {
    drift.mean += mean / n;
    squares += mean * mean;
  }
  drift.error = std::sqrt((squares / n - drift.mean * drift.mean) / (n - 1));
  std::printf("plate friction %g: mean of v.n = %.3f +- %.3f mm/s\n", plate_friction, drift.mean, drift.error);
  return drift;
}

/// A rod of beads that lie between those of a rod that is the same fore and aft (0) and those of a polar one (1).
RodShape rod_of(double polarity) {
  RodShape rod{.length = 4.5, .mid_diameter = 0.8, .end_diameter = 0.4, .n_beads = 15};
  for (int bead = 0; bead < rod.n_beads; ++bead) {
    const double x = bead / (rod.n_beads - 1.0);  // 0 at the tail
    const double symmetric = 0.8 - 0.4 * std::abs(2 * x - 1), polar = 0.8 - 0.4 * x;
    rod.bead_diameters.push_back(symmetric + polarity * (polar - symmetric));
  }
  return rod;
}

RodShape polar_rod() {
  return {.length = 4.5, .mid_diameter = 0.8, .end_diameter = 0.4, .n_beads = 15, .profile = Profile::kPolar};
}
RodShape symmetric_rod() { return {.length = 4.5, .mid_diameter = 0.8, .end_diameter = 0.4, .n_beads = 15}; }

TEST(PolarRods, MoveFromTheThickToTheThinEndOnStickyPlates) {
  const Drift polar = drift_of(polar_rod(), 0.3, 4, 1);
  EXPECT_GT(polar.mean, 3.0);
  EXPECT_GT(polar.mean, 6 * polar.error);
}

TEST(PolarRods, MoveTheOtherWayOnSlipperyPlates) {
  const Drift polar = drift_of(polar_rod(), 0.01, 4, 1);
  EXPECT_LT(polar.mean, -0.3);
  EXPECT_LT(polar.mean, -3 * polar.error);
}

/// No drift larger than this may remain unseen [mm/s]: an eightieth of the polar rods' 8.2 mm/s on sticky plates, a
/// seventeenth of their 1.7 on slippery ones.
constexpr double kNoDrift = 0.1;

// Which end is the head is a label, and rods turned end for end fly the same to the last bit (turned_rods_test), so
// there is no drift to be allowed for, only chance: four errors, which must be small enough to see kNoDrift.
TEST(PolarRods, SymmetricOnesDoNot) {
  for (const double friction : {0.01, 0.3}) {
    const Drift symmetric = drift_of(symmetric_rod(), friction, 16, 6);
    EXPECT_LT(std::abs(symmetric.mean), 4 * symmetric.error) << friction;
    EXPECT_LT(4 * symmetric.error, kNoDrift) << friction;
  }
}

// What that would see: rods a fiftieth of the way from symmetric to polar ones, whose ends differ by 2 %.
TEST(PolarRods, NearlySymmetricOnesAreSeenToMove) {
  const Drift planted = drift_of(rod_of(0.02), 0.3, 16, 3);
  EXPECT_GT(std::abs(planted.mean), 4 * planted.error);
}

}  // namespace
}  // namespace shaken
