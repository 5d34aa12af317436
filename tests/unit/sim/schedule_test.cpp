#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "sim/schedule/pair_schedule.h"
#include "sim/schedule/timing_wheel.h"
#include "sim/simulation.h"
#include "sim/stepping/work_counts.h"
#include "tests/support/random_rods.h"

namespace shaken {
namespace {

constexpr double kDt = 4e-6;
constexpr Direction kAlongX{1, 0, 0};

/// Two rods that approach each other along x, 0.1 mm apart at tick `start`, with a bound of 2,500 ticks.
struct Approach {
  static constexpr Tick kStart = (Tick{1} << 32) - 300;  // a tick's last 32 bits come round on the way
  static constexpr float kGap = 0.1F;
  static constexpr int kTicks = 2500;
  static constexpr float kClosing = kGap / (kTicks * static_cast<float>(kDt));  ///< 10 mm/s

  PairSchedule table{2, kDt};

  Approach() {
    table.make_room(1);
    table.add(0, {0, 1}, 0);
    table.set_bound(0, kStart, kTicks, kAlongX, {kClosing, 0});
  }
  /// The rod on the left (0) or on the right (1) flies faster to the right by so much [mm/s]. False: a new bound is
  /// due.
  bool hit(int rod, double more, Tick after) {
    const VelocityJump change({more, 0, 0}, Vec3::Zero(), 0, 0, 1);
    bool holds = true;
    table.spend(rod, change, kStart + after, [&](int p) { holds = table.shorten_bound(p, kStart + after); });
    return holds;
  }
  /// Ticks after the start at which the pair comes up,
  Tick comes_up(Tick from = 0) {
    std::vector<int> up;
    Tick now = kStart + from;
    while (up.empty() && now < kStart + 2 * kTicks) table.wheel().pop(++now, up);
    return now - kStart;
  }
  /// and at which its bound does not hold any more.
  Tick ends(Tick from = 0) {
    Tick now = kStart + comes_up(from);
    while (table.is_apart(0, now)) ++now;
    return now - kStart;
  }
};

TEST(PairSchedule, APairComesUpWhileABudgetRemainsAndIsApartUntilItsBoundEnds) {
  Approach approach;
  const Tick end = approach.ends();
  EXPECT_LE(end, Approach::kTicks + 1);
  EXPECT_GE(end, Approach::kTicks - 8);
  EXPECT_EQ(Approach().comes_up(), Approach::kTicks - GapBudgets::kMostBeyond + 1);
}

TEST(PairSchedule, ATouchingPairIsNotApart) {
  Approach approach;
  const Tick up = Approach::kStart + approach.comes_up();
  EXPECT_TRUE(approach.table.is_apart(0, up));
  approach.table.toggle_touching(0);
  EXPECT_FALSE(approach.table.is_apart(0, up));
}

// A rod at rest is hit at every tick: of the budget it gets the larger part once its bound has been shortened.
TEST(PairSchedule, TheRodThatSpendsGetsTheBudget) {
  const auto hits_until_overspent = [](int first, int then) {
    Approach approach;
    int overspent = 0, n_hits = 0;
    const auto hit = [&](int rod) {
      const VelocityJump change({rod == 0 ? 0.05 : -0.05, 0, 0}, Vec3::Zero(), 0, 0, 1);
      approach.table.spend(rod, change, Approach::kStart + 100, [&](int) { ++overspent; });
    };
    while (overspent == 0) hit(first);
    EXPECT_TRUE(approach.table.shorten_bound(0, Approach::kStart + 100));
    while (overspent == 1) hit(then), ++n_hits;
    return n_hits;
  };
  for (const int rod : {0, 1}) EXPECT_GT(hits_until_overspent(rod, rod), 3 * hits_until_overspent(rod, 1 - rod));
}

TEST(PairSchedule, AHitThatClosesTheGapFasterEndsTheBoundInTime) {
  for (const int rod : {0, 1}) {
    Approach approach;
    // 0.08 mm are left, which close at 40 mm/s
    EXPECT_TRUE(approach.hit(rod, rod == 0 ? 30 : -30, 500));
    const Tick end = approach.ends(500);
    EXPECT_LE(end, 500 + 500 + 1);
    EXPECT_GE(end, 500 + 500 - 10);
  }
}

TEST(PairSchedule, ManySmallHitsTakeTheirTime) {
  Approach approach;
  for (Tick after = 1; after <= 400; ++after) EXPECT_TRUE(approach.hit(0, 0.01, after));
  // on average the gap closed at 12 mm/s for 1.6 ms, and closes at 14 mm/s from then on
  const double end = 400 + (0.1 - 12 * 400 * kDt) / (14 * kDt);
  const auto found = static_cast<double>(approach.ends(400));
  EXPECT_LE(found, end + 1);
  EXPECT_GE(found, 0.98 * end);
}

TEST(PairSchedule, WhatOpensTheGapMakesNoBoundLonger) {
  Approach approach;
  EXPECT_TRUE(approach.hit(0, -8, 500));
  EXPECT_TRUE(approach.hit(1, 5, 600));
  const Tick end = approach.ends(600);
  EXPECT_LE(end, Approach::kTicks + 1);
  EXPECT_GE(end, Approach::kTicks - 8);
}

TEST(PairSchedule, AHitThatLeavesLittleTimeAsksForANewBound) {
  Approach approach;
  EXPECT_FALSE(approach.hit(0, 30000, 500));
}

TEST(PairSchedule, ABoundWithoutALineEndsWithTheFirstHit) {
  Approach approach;
  approach.table.set_bound(0, Approach::kStart, 100, kAlongX, {});
  EXPECT_FALSE(approach.hit(1, -1e-6, 50));
  EXPECT_EQ(approach.ends(), 101);
}

TEST(PairSchedule, APairThatIsSearchedAgainAsksForNothing) {
  Approach approach;
  approach.table.poll(0, Approach::kStart + 7);
  EXPECT_TRUE(approach.hit(0, 1000, 7));
  EXPECT_EQ(approach.ends(7), 8);
}

/// Who owns an item may change while it is not in.
TEST(TimingWheel, BringsEachItemUpAtItsLastTickAndOnlyThenToItsOwner) {
  constexpr int kOwners = 3;
  test::Draw draw(31);
  TimingWheel wheel(50, kOwners);
  std::map<std::int32_t, int> owners;
  std::map<std::int32_t, Tick> due;  // the twin
  std::vector<std::int32_t> popped;
  Tick furthest = 0;
  for (Tick now = 0; now < 30000; ++now) {
    if (now == 10000) wheel.make_room(80);
    const int n_items = now < 10000 ? 50 : 80;
    for (int k = 0; k < 3; ++k) {
      const std::int32_t item = draw.integer(0, n_items - 1);
      if (draw.integer(0, 9) == 0) {
        wheel.remove(item);
        due.erase(item);
      } else {
        const Tick at = now + draw.integer(1, draw.integer(0, 3) ? 30 : static_cast<int>(TimingWheel::horizon()));
        if (!due.contains(item)) owners[item] = draw.integer(0, kOwners - 1);
        wheel.set(item, at, owners[item]);
        due[item] = at;
        furthest = std::max(furthest, at - now);
      }
    }
    popped.clear();
    for (int owner = 0; owner < kOwners; ++owner) {
      const std::size_t first = popped.size();
      wheel.pop(now + 1, popped, owner);
      for (std::size_t k = first; k < popped.size(); ++k) EXPECT_EQ(owners[popped[k]], owner);
    }
    std::sort(popped.begin(), popped.end());
    std::vector<std::int32_t> expected;
    for (const auto& [item, at] : due) {
      if (at == now + 1) expected.push_back(item);
    }
    ASSERT_EQ(popped, expected) << "tick " << now + 1;
    for (const std::int32_t item : popped) due.erase(item);
  }
  EXPECT_GT(furthest, 4000);
}

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
  EXPECT_GT(of(WorkKind::kPairsApart), 0);
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
