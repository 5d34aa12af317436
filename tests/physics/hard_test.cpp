// The hard cases of `shaken bench hard`: those made by hand in full, the scenes for a short while.
#include "bench/hard/hard.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

#include "bench/bench.h"

namespace shaken::bench {
namespace {

const std::filesystem::path kFolder = SHAKEN_SOURCE_DIR "/configs/hard";

void expect_ok(const HardCase& of) {
  ASSERT_FALSE(of.outcomes.empty());
  for (const Outcome& outcome : of.outcomes) {
    EXPECT_TRUE(outcome.ok()) << of.name << ": " << outcome.holds << ": " << outcome.worst << ", limit "
                              << outcome.limit << "; " << outcome.note;
  }
}

class MadeByHand : public testing::TestWithParam<MadeCase> {};
TEST_P(MadeByHand, Holds) { expect_ok(GetParam().run()); }
INSTANTIATE_TEST_SUITE_P(Hard, MadeByHand, testing::ValuesIn(made_cases()), [](const auto& test) {
  std::string name = test.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

const Outcome& outcome_about(const std::string& words, const HardCase& of) {
  for (const Outcome& outcome : of.outcomes) {
    if (outcome.holds.find(words) != std::string::npos) return outcome;
  }
  ADD_FAILURE() << "nothing about " << words;
  return of.outcomes.front();
}
const Outcome& energy_made(const HardCase& of) { return outcome_about("energy made", of); }

// One box of rough elastic rods between plates at rest, which only a law of impacts can give energy: Newton's gives
// some thousandth of it within 2 ms, the others none beyond rounding. Nothing else about the scenes differs, and both
// limits are those of the bench.
TEST(EnergyOfRoughImpacts, NewtonsLawMakesSomeAndTheOthersNone) {
  const scene::RunPlan newtons = read_hard_scene(kFolder, "elastic-rough-newton");
  ASSERT_EQ(newtons.system.law, ImpulseLaw::kNewton);
  for (const ImpulseLaw law : {ImpulseLaw::kNewton, ImpulseLaw::kPoisson, ImpulseLaw::kEnergetic}) {
    const bool is_newtons = law == ImpulseLaw::kNewton;
    double most = 0;
    for (const std::uint64_t seed : {1, 2, 3, 4}) {
      scene::RunPlan plan = newtons;
      plan.system.law = law;
      plan.system.seed = seed;
      const auto run = [&](bool makes_energy) {
        return run_scene_case({"", "", 0.1, makes_energy}, plan, plan.total_time(), [](double) {});
      };
      // what holds of the laws that make none holds of them all, and not of Newton's
      const Outcome makes_none = energy_made(run(false));
      EXPECT_EQ(makes_none.ok(), !is_newtons) << seed << ": " << makes_none.worst;
      most = std::max(most, makes_none.worst);
    }
    const Outcome makes_some = energy_made(run_scene_case({"", "", 0.1, true}, newtons, 1e9, [](double) {}));
    EXPECT_EQ(most >= makes_some.limit, is_newtons) << most;
    std::printf("law %d: at most %.2g of the energy made in 2 ms\n", static_cast<int>(law), most);
  }
}

class SceneOfFile : public testing::TestWithParam<SceneCase> {};
TEST_P(SceneOfFile, HoldsForAWhile) {
  const scene::RunPlan plan = read_hard_scene(kFolder, GetParam().name);
  const double seconds = GetParam().name == "rest" ? 10.0 : GetParam().makes_energy ? plan.total_time() : 0.05;
  const HardCase found = run_scene_case(GetParam(), plan, seconds, [](double) {});
  expect_ok(found);
  const System& system = plan.system;
  const double mass = make_species(system.rod).mass, fall = system.gravity * system.dt;
  if (GetParam().name == "rest") {
    EXPECT_DOUBLE_EQ(outcome_about("bouncing", found).limit, mass * fall * fall);
  }
  if (GetParam().name != "strong") return;
  // thrown by both plates in turn, down through the gap, and at the speed of the start
  const double e = system.rod_base.restitution, peak = empty_world(system).plates.peak_speed();
  const double speed = (1 + e) / (1 - e) * peak + std::sqrt(2 * system.gravity * system.gap) + std::sqrt(3.0) * 20;
  EXPECT_NEAR(outcome_about("kinetic", found).limit / (mass * speed * speed / 2), 1, 1e-12);
}
INSTANTIATE_TEST_SUITE_P(Hard, SceneOfFile, testing::ValuesIn(scene_cases()), [](const auto& test) {
  std::string name = test.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

// As `shaken bench hard --seconds 0.02` has it: too short for what takes time, which is then not asked.
TEST(SceneCases, HoldInAShortRunToo) {
  for (const SceneCase& scene : scene_cases()) {
    if (scene.name != "rest" && !scene.makes_energy) continue;
    expect_ok(run_scene_case(scene, read_hard_scene(kFolder, scene.name), 0.02, [](double) {}));
  }
}

/// What fits into a test: a fortieth of what the bench spends, and so bounds that are seven times wider, that of the
/// drift as large as itself.
constexpr OrderEffort kBriefly{.replicas = 10, .seconds = 1.65, .slack = 7};

TEST(OrderOfContacts, LeavesMeansAsTheyAreWithinWideBounds) {
  expect_ok(run_order_case(kFolder, kBriefly, [](double) {}));
}

// Nothing is said that was not seen: the bounds of the bench are beyond so few replicas.
TEST(OrderOfContacts, IsLeftOpenByTooFewReplicas) {
  for (const int replicas : {1, 2}) {
    const HardCase found = run_order_case(kFolder, {.replicas = replicas, .seconds = 0.05}, [](double) {});
    ASSERT_EQ(found.outcomes.size(), 6u);
    for (const Outcome& outcome : found.outcomes) {
      EXPECT_FALSE(outcome.ok()) << outcome.holds << ": " << outcome.note;
      EXPECT_NE(outcome.note.find("open"), std::string::npos) << outcome.holds << ": " << outcome.note;
    }
  }
  CLI::App app;
  Work work;
  add_hard(app, work);
  app.parse("hard order --replicas 2 --seconds 0.02 --cases " + kFolder.string());
  testing::internal::CaptureStdout();
  EXPECT_EQ(work(), ExitCode::kFailed);
  EXPECT_NE(testing::internal::GetCapturedStdout().find("\norder: S: difference / mean, 95 % sure: "),
            std::string::npos);
}

// The scenes again, the last of them shaken harder by 4 %, whose rods have 8 % more energy.
TEST(OrderOfContacts, ABiasThatIsPlantedIsSeen) {
  const std::filesystem::path folder = testing::TempDir() + "shaken-order-biased";
  std::filesystem::create_directories(folder);
  std::ifstream in(kFolder / "order.json");
  std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::string shuffled = "\"contacts.order\": \"shuffled\"";
  ASSERT_NE(text.find(shuffled), std::string::npos);
  text.replace(text.find(shuffled), shuffled.size(), shuffled + ", \"plates.gamma\": 7.28");
  std::ofstream(folder / "order.json") << text;
  const HardCase found = run_order_case(folder, {.replicas = 5, .seconds = 1.1, .slack = 5}, [](double) {});
  std::filesystem::remove_all(folder);
  ASSERT_EQ(found.outcomes.size(), 6u);
  const Outcome& energy_across = found.outcomes[2];
  EXPECT_FALSE(energy_across.ok());
  EXPECT_NE(energy_across.note.find("different"), std::string::npos) << energy_across.note;
}

// The scenes of the bench are those of the test above.
TEST(EnergyOfRoughImpacts, ScenesDifferInTheLawOnly) {
  const System newtons = read_hard_scene(kFolder, "elastic-rough-newton").system;
  for (const auto& [name, law] : {std::pair{"elastic-rough-poisson", ImpulseLaw::kPoisson},
                                  std::pair{"elastic-rough-energetic", ImpulseLaw::kEnergetic}}) {
    System scene = read_hard_scene(kFolder, name).system;
    EXPECT_EQ(scene.law, law);
    scene.law = newtons.law;
    EXPECT_EQ(scene, newtons) << name;
  }
}

TEST(HardOutcome, KnowsWhatDoesNotHold) {
  EXPECT_TRUE((Outcome{"", 1, 2}.ok()));
  EXPECT_FALSE((Outcome{"", 3, 2}.ok()));
  EXPECT_FALSE((Outcome{"", std::numeric_limits<double>::quiet_NaN(), 2}.ok()));
  EXPECT_TRUE((Outcome{"", 2, 2, true}.ok()));
  EXPECT_FALSE((Outcome{"", 1, 2, true}.ok()));
  EXPECT_EQ((Outcome{"", 1, 2}.margin()), 2);
}

}  // namespace
}  // namespace shaken::bench
