#include "bench/case.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/failure.h"
#include "base/files.h"
#include "base/scratch_folder.h"
#include "bench/hard/hard.h"
#include "sim/balance.h"
#include "tests/support/good.h"

namespace shaken::bench {
namespace {

using testing::HasSubstr;

/// A dozen rods for two milliseconds.
Case small_case(double warm_up = 0.002) { return make_case(4.5, 0.3, 10, kPaperStep, warm_up); }

TEST(Case, HasTheScenesDefaults) {
  const Case made = make_case(4.5, 0.75, 41.865, kPaperStep, 0.5);
  EXPECT_EQ(made.system().n_rods, 527);
  EXPECT_EQ(made.system().rod.n_beads, 15);
  EXPECT_EQ(made.warm_up_ticks(), 125'000);
  EXPECT_EQ(made.period_ticks(), 1250);
  EXPECT_DOUBLE_EQ(made.rod_seconds(1250), 527 * 0.005);
}

template <class Act>
std::string refusal_of(const Act& act) {
  return test::said_with(ExitCode::kBadInput, test::thrown_by<Failure>(act));
}

TEST(Case, WhatASceneRefusesIsBadInput) {
  EXPECT_THAT(refusal_of([] { make_case(4.5, 0.75, 5, kPaperStep, 0.5); }), HasSubstr("too small for rods"));
}

TEST(Case, IsWhatASceneSays) {
  const Case made = case_of({{"rods", {{"count", 40}}},
                             {"rods_2", {{"length", "2.5 mm"}, {"count", 30}}},
                             {"box", {{"side", "25 mm"}}},
                             {"time", {{"step", "8 us"}, {"impacts", "at_instant"}}}},
                            0.5, "mixture");
  EXPECT_EQ(made.label, "mixture");
  EXPECT_EQ(made.length, 4.5);
  EXPECT_EQ(made.side, 25);
  EXPECT_EQ(made.dt, 8e-6);
  EXPECT_NEAR(made.area_fraction, 0.75 * 40 / 527 * (41.865 * 41.865) / (25 * 25), 1e-3);
  EXPECT_TRUE(made.system().has_impacts_at_instant());
  EXPECT_EQ(made.plan.total_time(), 0.5);
  EXPECT_EQ(made.warm_up_ticks(), 62'500);
}

TEST(Case, IsReadFromAFileWithoutWhatItMeasures) {
  const ScratchFolder folder;
  const std::filesystem::path file = folder.path() / "scene.json";
  std::ofstream(file) << R"(// a comment
    {"rods": {"count": 40, "length_spread": 0.2}, "time": {"step": "8 us", "steady": "2 s", "measure": "10 s"},
     "measure": {"msd": {}}, "movie": {"every": "20 ms"}})";
  const Case made = read_case(file, 0.5);
  EXPECT_EQ(made.label, file.string());
  EXPECT_EQ(made.n_rods(), 40);
  EXPECT_EQ(made.dt, 8e-6);
  EXPECT_EQ(made.plan.total_time(), 0.5);
  EXPECT_FALSE(made.plan.msd || made.plan.order);
  EXPECT_FALSE(made.plan.movie);
  EXPECT_TRUE(made.system().rod.spread.length > 0);

  const auto refusal = [&](const char* scene) {
    std::ofstream(file) << scene;
    return refusal_of([&] { read_case(file, 0.5); });
  };
  EXPECT_THAT(refusal(R"({"rods": {"count": 40, "lenght": 3}, "boks": {}})"),
              AllOf(HasSubstr("lenght"), HasSubstr("boks")));
  EXPECT_THAT(refusal(R"({"start": {"run": "7b26405de457a366", "time": "10 s"}})"), HasSubstr("start"));
}

TEST(Case, CountsRodsOfAllSpecies) {
  const Case made = case_of({{"rods", {{"count", 40}}}, {"rods_2", {{"count", 30}}}}, 0.5, "mixture");
  EXPECT_EQ(made.n_rods(), 70);
  EXPECT_DOUBLE_EQ(made.rod_seconds(1250), 70 * 0.005);
}

TEST(Case, NamesTheSceneThatIsRefused) {
  EXPECT_THAT(refusal_of([] {
                case_of({{"rods", {{"lenght", 4.5}}}}, 0.5, "mistyped");
              }),
              testing::StartsWith("mistyped: /rods/lenght: "));
}

class SteadyStates : public ::testing::Test {
 protected:
  /// The only file in the cache.
  std::filesystem::path file() const { return file_in(cache_.path()); }
  static std::filesystem::path file_in(const std::filesystem::path& cache) {
    return std::filesystem::directory_iterator(cache)->path() / "checkpoint.bin";
  }
  static std::string content(const std::filesystem::path& file) { return *read_file(file); }
  static void write(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
  }
  ScratchFolder cache_;
};

TEST_F(SteadyStates, AreMadeOnceAndThenReadBack) {
  const SteadyState made = steady_state(small_case(), cache_.path());
  EXPECT_FALSE(made.was_cached);
  const SteadyState read = steady_state(small_case(), cache_.path());
  EXPECT_TRUE(read.was_cached);
  EXPECT_EQ(read.checkpoint, made.checkpoint);
  EXPECT_EQ(resumed(small_case(), read, StepperKind::kReference).tick(), small_case().warm_up_ticks());
}

TEST_F(SteadyStates, OfAnotherWarmUpAreOthers) {
  steady_state(small_case(0.002), cache_.path());
  EXPECT_FALSE(steady_state(small_case(0.003), cache_.path()).was_cached);
}

TEST_F(SteadyStates, DamagedAreMadeAnew) {
  const SteadyState made = steady_state(small_case(), cache_.path());
  const std::string whole = content(file());
  std::string flipped = whole;
  flipped[whole.size() / 2] = static_cast<char>(flipped[whole.size() / 2] ^ 1);
  for (const std::string& damaged : {flipped, whole.substr(0, whole.size() - 1), whole + "x", std::string()}) {
    write(file(), damaged);
    const SteadyState again = steady_state(small_case(), cache_.path());
    EXPECT_FALSE(again.was_cached);
    EXPECT_EQ(again.checkpoint, made.checkpoint);
  }
}

TEST_F(SteadyStates, OfAnotherSceneUnderOurNameAreMadeAnew) {
  const SteadyState made = steady_state(small_case(), cache_.path());
  const std::filesystem::path ours = file();
  ScratchFolder elsewhere;
  steady_state(small_case(0.003), elsewhere.path());
  write(ours, content(file_in(elsewhere.path())));
  const SteadyState again = steady_state(small_case(), cache_.path());
  EXPECT_FALSE(again.was_cached);
  EXPECT_EQ(again.checkpoint, made.checkpoint);
}

TEST_F(SteadyStates, NeedAFolderThatCanBeWritten) {
  write(cache_ / "file", "");
  EXPECT_THROW(steady_state(small_case(), cache_ / "file"), Failure);
}

System a_few_rods() {
  System scene;
  scene.rod = {.length = 2.5, .n_beads = 9};
  scene.box_side = 10;
  scene.n_rods = 5;
  scene.start = Start::kRandom;
  scene.dt = 20e-6;
  return scene;
}

TEST(HardHistory, IsThatOfTheRun) {
  constexpr double kSeconds = 0.4;
  double done = 0;
  const std::vector<HistoryPoint> history = history_of(a_few_rods(), kSeconds, [&](double now) {
    EXPECT_GT(now, done);
    done = now;
  });
  EXPECT_EQ(done, 1);
  ASSERT_EQ(history.size(), static_cast<std::size_t>(kHistoryPoints));
  auto simulation = Simulation::start(a_few_rods());
  ASSERT_TRUE(static_cast<bool>(simulation));
  for (std::size_t k = 0; k < history.size(); ++k) {
    ASSERT_FALSE(simulation->advance_to(100 * static_cast<Tick>(k + 1)));
    const World& world = simulation->world();
    EXPECT_NEAR(history[k].time, 2e-3 * static_cast<double>(k + 1), 1e-12);
    EXPECT_EQ(history[k].overlap, world.counters.max_overlap() / thinnest_radius(world)) << "the deepest so far";
    EXPECT_EQ(history[k].energy_error, balance(world).energy_error());
    EXPECT_GT(history[k].kinetic_energy, 0);
    EXPECT_GT(history[k].order, 0);
    EXPECT_LE(history[k].order, 1);
  }
}

TEST(HardHistory, OfRodsInFreeFlightIsFlat) {
  System scene = a_few_rods();
  scene.n_rods = 1;
  scene.gravity = scene.amplitude = 0;
  scene.base = scene.lid = false;
  const std::vector<HistoryPoint> history = history_of(scene, 0.1, [](double) {});
  for (const HistoryPoint& point : history) {
    EXPECT_NEAR(point.kinetic_energy, history.front().kinetic_energy, 1e-9 * point.kinetic_energy);
    EXPECT_NEAR(point.order, 1, 1e-12) << "one rod is parallel to itself";
    EXPECT_EQ(point.overlap, 0);
  }
}

TEST(HardHistory, TroubleIsAFailure) {
  System scene = a_few_rods();
  scene.amplitude *= 100;
  scene.dt = 1e-4;
  EXPECT_THROW(history_of(scene, 10, [](double) {}), Failure);
}

}  // namespace
}  // namespace shaken::bench
