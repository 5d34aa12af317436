// The short form of what steppers_agree_test does at length: small enough for the thread sanitizer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/core/thread_team.h"
#include "sim/lanes/lanes.h"
#include "sim/schedule/sharing_trial.h"
#include "sim/simulation.h"
#include "tests/support/good.h"
#include "tests/support/random_rods.h"

namespace shaken {
namespace {

void expect_same_by_several(System system) {
  system.n_rods = 120;
  system.box_side = std::sqrt(system.n_rods * make_species(system.rod).area / 0.75);
  auto one = test::good(Simulation::start(system));
  constexpr Tick kBegin = 10000;  // off the lattice: by then rods hit each other all the time
  constexpr Tick kEnd = kBegin + 400;
  ASSERT_FALSE(one->advance_to(kBegin));
  const auto begin = one->checkpoint();
  const auto n_begin = one->world().counters.impulses_rod_rod;
  ASSERT_FALSE(one->advance_to(kEnd));
  EXPECT_GT(one->world().counters.impulses_rod_rod - n_begin, 40);
  const int widest = lanes::detail::machine_width;
  for (const int n_threads : {2, 3, 4}) {
    // the thread sanitizer sees accesses of up to 16 bytes: vectors of four floats
    lanes::detail::machine_width = n_threads == 3 ? widest : 4;
    auto several = test::good(Simulation::resume(system, begin));
    several->use_threads(n_threads, 1);
    ASSERT_FALSE(several->advance_to((kBegin + kEnd) / 2));
    several->use_threads(n_threads - 1, 1);  // a new stepper, half way
    ASSERT_FALSE(several->advance_to(kEnd));
    EXPECT_EQ(several->state_hash(), one->state_hash()) << n_threads << " threads";
    EXPECT_EQ(several->world().counters.impulses_rod_rod, one->world().counters.impulses_rod_rod);
  }
  lanes::detail::machine_width = widest;
}

TEST(Threads, ShareATickWithoutChangingABit) { expect_same_by_several({}); }

TEST(Threads, ShareATickOfImpactsAtTheirInstant) {
  System system;
  system.impacts = ImpactTime::kAtInstant;
  expect_same_by_several(system);
}

// Rods at rest, whose pairs are searched in every tick.
TEST(Threads, ShareATickOfWeakPlates) {
  System system;
  system.amplitude *= 0.8 / 7;
  expect_same_by_several(system);
}

const Simulation* g_simulation = nullptr;
Tick g_read_at = 0;
double g_time = 0;
int g_readings = 0;

// By this clock the second and the third of four stretches of ticks take less time than the others. Trials begin at
// another of the four each time, so that one finds that sharing is faster, and the next that it is not.
TEST(Threads, ATrialThatChangesItsMindDoesNotChangeABit) {
  System system;
  system.n_rods = 120;
  system.box_side = std::sqrt(system.n_rods * make_species(system.rod).area / 0.75);
  auto one = Simulation::start(system);
  auto several = Simulation::start(system);
  ASSERT_TRUE(one && several);
  several->use_threads(2, 1);
  g_simulation = &*several;
  several->share_where_faster([] {
    ++g_readings;
    for (; g_read_at < g_simulation->tick(); ++g_read_at) {
      const Tick stretch = g_read_at / SharingTrial::kStretch % 4;
      g_time += stretch == 1 || stretch == 2 ? 0.6 : 1.0;
    }
    return g_time;
  });
  constexpr Tick kEnd = 60'000;
  ASSERT_FALSE(one->advance_to(kEnd));
  ASSERT_FALSE(several->advance_to(kEnd));
  EXPECT_GT(g_readings, 4 * SharingTrial::kStretch) << "several trials, with stretches that are shared";
  EXPECT_EQ(several->state_hash(), one->state_hash());
}

TEST(ThreadTeam, CallsEachThreadOnce) {
  for (const int n_threads : {1, 2, 3, 4}) {
    ThreadTeam team(n_threads);
    EXPECT_EQ(team.size(), n_threads);
    for (int round = 0; round < 300; ++round) {
      std::vector<int> calls(n_threads, 0);
      std::vector<std::thread::id> threads(n_threads);
      team.run([&](int thread) {
        ++calls.at(thread);
        threads.at(thread) = std::this_thread::get_id();
      });
      EXPECT_EQ(calls, std::vector<int>(n_threads, 1));
      EXPECT_EQ(threads[0], std::this_thread::get_id());
    }
  }
}

TEST(ThreadTeam, WhatACallWritesIsSeenByTheNext) {
  ThreadTeam team(4);
  std::vector<std::int64_t> values(1000);
  std::iota(values.begin(), values.end(), 0);
  for (int round = 0; round < 200; ++round) {
    std::vector<std::int64_t> next(values.size());
    team.run([&](int thread) {
      for (std::size_t k = thread; k < values.size(); k += 4) next[k] = values[values.size() - 1 - k] + 1;
    });
    values = next;
  }
  for (std::size_t k = 0; k < values.size(); ++k) EXPECT_EQ(values[k], static_cast<std::int64_t>(k) + 200);
}

TEST(ThreadTeam, SleepersWakeUp) {
  ThreadTeam team(2);
  std::atomic<int> calls{0};
  for (int round = 0; round < 3; ++round) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // far longer than anyone spins
    team.run([&](int) { ++calls; });
  }
  EXPECT_EQ(calls, 6);
}

double g_now = 0;

/// A machine on which ticks take made-up times.
struct Machine {
  double alone = 1e-4;  ///< time of a tick [s]
  double shared = 1e-4;
  double noise = 0;  ///< each tick takes up to so much more, in parts of its time
  test::Draw draw{5};
  SharingTrial trial;

  Machine() {
    trial.use([] { return g_now; });
  }

  /// Returns how many of the next ticks were shared.
  int run(int ticks) {
    int n_shared = 0;
    for (int tick = 0; tick < ticks; ++tick) {
      const bool shares = trial.next_tick();
      n_shared += shares ? 1 : 0;
      g_now += (shares ? shared : alone) * (1 + noise * draw.uniform(0, 1));
    }
    return n_shared;
  }
};

constexpr int kTrial = 2 * SharingTrial::kPairs * SharingTrial::kStretch;
constexpr int kShortTrial = 2 * SharingTrial::kLeastPairs * SharingTrial::kStretch;

TEST(SharingTrial, WithoutAClockEveryTickIsShared) {
  SharingTrial trial;
  for (int tick = 0; tick < 2 * kTrial; ++tick) EXPECT_TRUE(trial.next_tick());
  trial.use([] { return g_now; });
  EXPECT_FALSE(trial.next_tick());  // the first stretch is one alone
  trial.use(nullptr);
  EXPECT_TRUE(trial.next_tick());
}

TEST(SharingTrial, HalfOfATrialIsShared) {
  Machine machine;
  EXPECT_EQ(machine.run(SharingTrial::kStretch), 0);
  EXPECT_EQ(machine.run(2 * SharingTrial::kStretch), 2 * SharingTrial::kStretch);
  EXPECT_EQ(machine.run(kTrial - 3 * SharingTrial::kStretch), kTrial / 2 - 2 * SharingTrial::kStretch);
}

// One thread does what two do as fast. Times that scatter are averaged: a tick takes one to five times as long.
TEST(SharingTrial, TheFasterWayIsChosen) {
  for (const auto& [shared, noise] : {std::pair{0.8, 0.0}, {0.97, 0.0}, {1.2, 0.0}, {0.8, 4.0}, {1.25, 4.0}}) {
    Machine machine;
    machine.noise = noise;
    machine.shared = shared * machine.alone;
    machine.run(kTrial);
    EXPECT_EQ(machine.run(SharingTrial::kLeastWait), shared < 0.9 ? SharingTrial::kLeastWait : 0) << shared;
  }
}

TEST(SharingTrial, AClearAnswerEndsTheTrialEarly) {
  Machine machine;
  machine.shared = 3 * machine.alone;
  machine.run(kShortTrial);
  EXPECT_EQ(machine.run(SharingTrial::kLeastWait), 0);
  EXPECT_GT(machine.run(2 * SharingTrial::kStretch), 0);  // the next trial begins
}

TEST(SharingTrial, TrialsBecomeRareWhileTheAnswerStaysTheSame) {
  Machine machine;
  machine.shared = 3 * machine.alone;
  machine.run(kShortTrial);
  for (int wait = SharingTrial::kLeastWait; wait < 4 * SharingTrial::kMostWait; wait *= 2) {
    EXPECT_EQ(machine.run(std::min(wait, SharingTrial::kMostWait)), 0) << wait;
    EXPECT_EQ(machine.run(kShortTrial), kShortTrial / 2) << wait;
  }
  // of all ticks in the long run, so many are done in the slower way
  const int many = 20 * SharingTrial::kMostWait;
  EXPECT_LT(machine.run(many), many / 100);
}

TEST(SharingTrial, AnotherLoadChangesTheAnswer) {
  Machine machine;
  machine.shared = 0.6 * machine.alone;
  machine.run(kShortTrial);
  EXPECT_EQ(machine.run(SharingTrial::kLeastWait), SharingTrial::kLeastWait);
  machine.shared = 2.5 * machine.alone;  // other programs begin
  machine.run(kShortTrial);
  EXPECT_EQ(machine.run(SharingTrial::kLeastWait), 0);
  machine.shared = 0.6 * machine.alone;  // and end: trials had become frequent again
  machine.run(kShortTrial);
  EXPECT_EQ(machine.run(SharingTrial::kLeastWait), SharingTrial::kLeastWait);
}

TEST(SharingTrial, AHopelessTrialIsCutShort) {
  Machine machine;
  machine.shared = 100 * machine.alone;  // all cores are taken
  machine.run(SharingTrial::kStretch);
  const double before = g_now;
  const int most = static_cast<int>(SharingTrial::kHopeless * SharingTrial::kStretch / 100) + 2;
  EXPECT_LE(machine.run(SharingTrial::kLeastWait), most);
  EXPECT_LT(g_now - before, 1.1 * SharingTrial::kLeastWait * machine.alone);
}

TEST(SharingTrial, SharingEndsSoonWhereALoadBegins) {
  Machine machine;
  machine.shared = 0.6 * machine.alone;
  machine.run(kShortTrial);
  machine.run(SharingTrial::kLeastWait / 2 + 100);
  machine.shared = 1.2 * machine.alone;  // other programs begin
  EXPECT_LE(machine.run(SharingTrial::kLeastWait), 2 * SharingTrial::kWatch);
  machine.shared = 0.6 * machine.alone;
  machine.run(2 * SharingTrial::kWatch + kShortTrial);
  EXPECT_EQ(machine.run(SharingTrial::kLeastWait / 2), SharingTrial::kLeastWait / 2);
}

}  // namespace
}  // namespace shaken
