#include "sim/stepping/work_counts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/simulation.h"

namespace shaken {
namespace {

/// A dense scene off its lattice, and what is counted in the ticks after.
WorkCounts counts_of(Tick ticks, int n_threads) {
  System system;
  system.n_rods = 60;
  system.box_side = std::sqrt(system.n_rods * make_species(system.rod).area / 0.75);
  auto simulation = Simulation::start(system);
  EXPECT_TRUE(simulation) << simulation.error().message;
  simulation->use_threads(n_threads, 1);
  EXPECT_FALSE(simulation->advance_to(ticks));
  return simulation->work_counts();
}

TEST(WorkCounts, AddUp) {
  const WorkCounts counts = counts_of(10000, 1);
  const auto of = [&](WorkKind kind) { return counts.of(kind); };
  EXPECT_GT(of(WorkKind::kRodsPolled), 0);
  EXPECT_GE(of(WorkKind::kRodsHit), of(WorkKind::kRodsPolled));
  EXPECT_GE(of(WorkKind::kRodsVisited), of(WorkKind::kRodsHit));
  // every visited rod gets a bound or is polled; those that others hit get one, too
  EXPECT_GE(of(WorkKind::kRodsBounded), of(WorkKind::kRodsVisited) - of(WorkKind::kRodsPolled));
  EXPECT_GT(of(WorkKind::kPairsTouching), 0);
  EXPECT_GT(of(WorkKind::kPairsSearched), of(WorkKind::kPairsTouching));
  // what was searched gets a bound
  EXPECT_GE(of(WorkKind::kBoundsWhenDue), of(WorkKind::kPairsSearched));
  EXPECT_GT(of(WorkKind::kPairsBounded), of(WorkKind::kBoundsWhenDue));
  EXPECT_GT(of(WorkKind::kBoundsByBeads), 0);
  EXPECT_GE(of(WorkKind::kPairsBounded), of(WorkKind::kBoundsByBeads));
  EXPECT_GE(of(WorkKind::kPairsBounded), of(WorkKind::kBoundsOfNoTick));
  // each hit is told to pairs, and few pairs have to be brought up sooner for it
  EXPECT_GE(of(WorkKind::kVelocityJumps), of(WorkKind::kRodsHit));
  EXPECT_GT(of(WorkKind::kBoundsShortened), 0);
  EXPECT_LT(of(WorkKind::kBoundsShortened), 3 * of(WorkKind::kVelocityJumps));
  EXPECT_GT(of(WorkKind::kPairsDeferred), 0);
}

TEST(WorkCounts, OfThreadsAreAdded) {
  const WorkCounts one = counts_of(3000, 1);
  const WorkCounts three = counts_of(3000, 3);
  // what is hit is physics; how bounds are shortened may depend on the order of hits
  EXPECT_EQ(three.of(WorkKind::kRodsHit), one.of(WorkKind::kRodsHit));
  EXPECT_EQ(three.of(WorkKind::kRodsPolled), one.of(WorkKind::kRodsPolled));
  EXPECT_GT(three.of(WorkKind::kPairsBounded), one.of(WorkKind::kPairsBounded) / 2);
}

}  // namespace
}  // namespace shaken
