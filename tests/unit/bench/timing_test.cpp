#include "bench/timing.h"

#include <gtest/gtest.h>

#include "base/clock.h"
#include "base/scratch_folder.h"
#include "bench/rates.h"

namespace shaken::bench {
namespace {

class SmallBox : public ::testing::Test {
 protected:
  SmallBox() {
    case_ = make_case(4.5, 0.6, 12, kPaperStep, 0.01);
    state_ = steady_state(case_, cache_.path());
  }
  ScratchFolder cache_;
  Case case_;
  SteadyState state_;
};

TEST(CpuClock, ReadingsCostNextToNothing) {
  const double start = thread_cpu_seconds_without_readings();
  for (int i = 0; i < 10'000; ++i) thread_cpu_seconds_without_readings();
  EXPECT_LT(thread_cpu_seconds_without_readings() - start, 0.01);
}

TEST(CpuClock, NeverRunsBackWhereAReadingCostsLessThanMeasured) {
  TimeWithoutReadings time(10, 0.25);
  EXPECT_DOUBLE_EQ(time.at(11), 0.75);
  for (int i = 1; i <= 100; ++i) EXPECT_DOUBLE_EQ(time.at(11 + 0.125 * i), 0.75);
  EXPECT_DOUBLE_EQ(time.at(25), 2);
}

TEST_F(SmallBox, AStretchCountsWhatHappensInIt) {
  Simulation simulation = resumed(case_, state_, StepperKind::kScheduled);
  const Counters before = simulation.world().counters;
  StepperSpeed speed;
  time_stretch(simulation, case_, 1250, speed);
  const Counters after = simulation.world().counters;
  EXPECT_EQ(simulation.tick(), case_.warm_up_ticks() + 1250);
  EXPECT_EQ(speed.rod_impulses, after.impulses_rod_rod - before.impulses_rod_rod);
  EXPECT_EQ(speed.plate_impulses,
            after.impulses_rod_base + after.impulses_rod_lid - before.impulses_rod_base - before.impulses_rod_lid);
  EXPECT_GT(speed.impulses(), 0);
  EXPECT_GT(speed.rate(), 0);
  EXPECT_GE(speed.bytes_per_rod, sizeof(Flight));
  EXPECT_EQ(speed.spread(), 1);
  EXPECT_EQ(speed.max_overlap, after.max_overlap());
}

TEST_F(SmallBox, ImpulsesFromSideWallsCount) {
  const Case disc = case_of({{"rods", {{"area_fraction", 0.4}}}, {"walls", {{"size", "12 mm"}}}}, 0.01, "disc");
  Simulation simulation = resumed(disc, steady_state(disc, cache_.path()), StepperKind::kScheduled);
  const Counters before = simulation.world().counters;
  StepperSpeed speed;
  time_stretch(simulation, disc, 5000, speed);
  EXPECT_GT(speed.wall_impulses, 0);
  EXPECT_EQ(speed.wall_impulses, simulation.world().counters.impulses_rod_wall - before.impulses_rod_wall);
  EXPECT_EQ(speed.impulses(), speed.plate_impulses + speed.wall_impulses + speed.rod_impulses);
}

TEST_F(SmallBox, LongStretchesAreWholeVibrations) {
  const Tick ticks = ticks_for(0.02, case_, state_, StepperKind::kScheduled);
  EXPECT_GE(ticks, 1);
  EXPECT_TRUE(ticks < case_.period_ticks() || ticks % case_.period_ticks() == 0) << ticks;
}

TEST_F(SmallBox, ContendersTakeTurnsFromTheirStates) {
  Contender one{.scene = case_, .state = state_, .ticks = 500};
  Contender other = one;
  other.stepper = StepperKind::kReference;
  std::vector<Contender> both{one, other};
  time_in_turn("", both, 3);
  for (const Contender& of : both) {
    EXPECT_EQ(of.speed.cpu.size(), 3u);
    EXPECT_EQ(of.speed.ticks, 500);
  }
  EXPECT_EQ(both[0].hash, both[1].hash);
  EXPECT_NE(both[0].hash, 0u);
}

TEST(CpuRatio, IsOfTheBestWithAnErrorFromTheScatter) {
  StepperSpeed of, other;
  of.rod_seconds = 2;
  other.rod_seconds = 4;
  of.cpu = {3, 1};
  other.cpu = {2, 2};
  const Estimate ratio = cpu_ratio(of, other);
  EXPECT_DOUBLE_EQ(ratio.value, 1);  // 1 / 2 a rod-second over 2 / 4
  EXPECT_DOUBLE_EQ(ratio.sem, 1);    // of 3 and 1
}

TEST_F(SmallBox, WorkIsCountedByTheStepper) {
  const CountedWork work = count_work({.scene = case_, .state = state_, .ticks = 1250});
  const auto count = [&](WorkKind kind) { return work.counts[static_cast<std::size_t>(kind)]; };
  EXPECT_DOUBLE_EQ(work.rod_seconds, case_.rod_seconds(1250));
  EXPECT_GT(count(WorkKind::kRodsVisited), 0);
  EXPECT_GE(count(WorkKind::kRodsVisited), count(WorkKind::kRodsHit));
  EXPECT_GT(work.cpu, 0);
  EXPECT_NE(work.phases[static_cast<std::size_t>(Phase::kSurfaces)], 0);
}

}  // namespace
}  // namespace shaken::bench
