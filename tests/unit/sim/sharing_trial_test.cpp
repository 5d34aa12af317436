#include "sim/schedule/sharing_trial.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/random_rods.h"

namespace shaken {
namespace {

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

TEST(SharingTrial, TheFasterWayIsChosen) {
  Machine machine;
  machine.shared = 0.8 * machine.alone;
  machine.run(kTrial);
  EXPECT_EQ(machine.run(SharingTrial::kLeastWait), SharingTrial::kLeastWait);
  Machine busy;
  busy.shared = 1.2 * busy.alone;
  busy.run(kTrial);
  EXPECT_EQ(busy.run(SharingTrial::kLeastWait), 0);
}

TEST(SharingTrial, OneThreadDoesWhatTwoDoAsFast) {
  Machine machine;
  machine.shared = 0.97 * machine.alone;
  machine.run(kTrial);
  EXPECT_EQ(machine.run(SharingTrial::kLeastWait), 0);
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

TEST(SharingTrial, TimesThatScatterAreAveraged) {
  for (const double shared : {0.8, 1.25}) {
    Machine machine;
    machine.noise = 4;  // a tick takes one to five times as long
    machine.shared = shared * machine.alone;
    machine.run(kTrial);
    EXPECT_EQ(machine.run(SharingTrial::kLeastWait), shared < 1 ? SharingTrial::kLeastWait : 0) << shared;
  }
}

}  // namespace
}  // namespace shaken
