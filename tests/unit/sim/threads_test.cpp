// The short form of what steppers_agree_test does at length: small enough for the thread sanitizer.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/lanes/lanes.h"
#include "sim/schedule/sharing_trial.h"
#include "sim/simulation.h"

namespace shaken {
namespace {

void expect_same_by_several(System system) {
  system.n_rods = 120;
  system.box_side = std::sqrt(system.n_rods * make_species(system.rod).area / 0.75);
  auto one = Simulation::start(system);
  ASSERT_TRUE(one) << one.error().message;
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
    auto several = Simulation::resume(system, begin);
    ASSERT_TRUE(several) << several.error().message;
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

}  // namespace
}  // namespace shaken
