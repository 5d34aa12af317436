#include "sim/checkpoint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "sim/physics_version.h"
#include "sim/simulation.h"
#include "tests/support/compare_steppers.h"
#include "tests/support/everything_on.h"
#include "tests/support/good.h"

namespace shaken {
namespace {

TEST(Checkpoint, RestoredRunIsBitwiseTheStraightRun) {
  for (const System& system : {test::short_rods(63), test::everything_on()}) {
    auto straight = test::good(Simulation::start(system));
    for (const Tick stop : {Tick{1}, Tick{4777}, Tick{10003}}) {
      ASSERT_FALSE(straight->advance_to(stop).has_value());
      auto resumed = test::good(Simulation::resume(system, straight->checkpoint()));
      EXPECT_EQ(resumed->state_hash(), straight->state_hash());
      ASSERT_FALSE(resumed->advance_to(stop + 4000).has_value());
      ASSERT_FALSE(straight->advance_to(stop + 4000).has_value());
      EXPECT_EQ(resumed->state_hash(), straight->state_hash());
      EXPECT_TRUE(test::same(resumed->world().counters, straight->world().counters));
    }
    EXPECT_GT(straight->world().counters.impulses_rod_rod, 100);
  }
}

TEST(Checkpoint, RefusesAnotherSceneAndDamage) {
  const System system = test::short_rods(63);
  auto simulation = test::good(Simulation::start(system));
  auto bytes = simulation->checkpoint();
  System other = system;
  other.gap = 1.3;
  EXPECT_FALSE(static_cast<bool>(Simulation::resume(other, bytes)));
  EXPECT_FALSE(static_cast<bool>(Simulation::resume(system, std::span(bytes).first(bytes.size() - 1))));
  bytes.push_back(std::byte{0});
  EXPECT_FALSE(static_cast<bool>(Simulation::resume(system, bytes)));
  EXPECT_FALSE(static_cast<bool>(Simulation::resume(system, {})));
}

TEST(Checkpoint, FitsNoSceneThatDiffersInOneKey) {
  const System system = test::everything_on();
  auto simulation = test::good(Simulation::start(system));
  const auto bytes = simulation->checkpoint();
  ASSERT_TRUE(static_cast<bool>(Simulation::resume(system, bytes)));
  const std::map<std::string, void (*)(System&)> changes{
      {"n_rods", [](System& s) { s.n_rods += 1; }},
      {"rod.n_beads", [](System& s) { s.rod.n_beads += 2; }},
      {"rod.length", [](System& s) { s.rod.length *= 1.01; }},
      {"rod.mid_diameter", [](System& s) { s.rod.mid_diameter *= 1.01; }},
      {"rod.end_diameter", [](System& s) { s.rod.end_diameter *= 1.01; }},
      {"rod.density", [](System& s) { s.rod.density *= 1.01; }},
      {"rod.profile", [](System& s) { s.rod.profile = Profile::kPolar; }},
      {"rod.inertia", [](System& s) { s.rod.inertia = Inertia::kBeads; }},
      {"rod.spread.length", [](System& s) { s.rod.spread.length *= 1.01; }},
      {"rod.spread.end_diameter", [](System& s) { s.rod.spread.end_diameter *= 1.01; }},
      {"added.count", [](System& s) { s.added[0]->count -= 1, s.added[1]->count += 1; }},
      {"added.length", [](System& s) { s.added[0]->rod.length *= 1.01; }},
      {"seed", [](System& s) { s.seed += 1; }},
      {"base", [](System& s) { s.base = false; }},
      {"lid", [](System& s) { s.lid = false; }},
      {"walls", [](System& s) { s.walls.reset(); }},
      {"walls.size", [](System& s) { s.walls->size *= 1.01; }},
      {"walls.arena", [](System& s) { s.walls->arena = Arena::kDisc; }},
      {"posts", [](System& s) { s.posts.reset(); }},
      {"posts.diameter", [](System& s) { s.posts->diameter *= 1.01; }},
      {"posts.columns", [](System& s) { s.posts->columns += 1; }},
      {"box_side", [](System& s) { s.box_side *= 1.01; }},
      {"gap", [](System& s) { s.gap *= 1.01; }},
      {"amplitude", [](System& s) { s.amplitude *= 1.01; }},
      {"frequency", [](System& s) { s.frequency *= 1.01; }},
      {"horizontal_amplitude", [](System& s) { s.horizontal_amplitude *= 1.01; }},
      {"horizontal_phase", [](System& s) { s.horizontal_phase += 1; }},
      {"horizontal_angle", [](System& s) { s.horizontal_angle += 1; }},
      {"second.amplitude", [](System& s) { s.second->amplitude *= 1.01; }},
      {"second.frequency", [](System& s) { s.second->frequency *= 1.01; }},
      {"second.phase", [](System& s) { s.second->phase += 1; }},
      {"lid_motion.amplitude", [](System& s) { s.lid_motion->amplitude *= 1.01; }},
      {"lid_motion.phase", [](System& s) { s.lid_motion->phase += 1; }},
      {"gravity", [](System& s) { s.gravity *= 1.01; }},
      {"inclination", [](System& s) { s.inclination *= 1.01; }},
      {"inclination_angle", [](System& s) { s.inclination_angle += 1; }},
      {"dt", [](System& s) { s.dt *= 1.01; }},
  };
  for (const auto& [key, change] : changes) {
    System other = system;
    change(other);
    EXPECT_FALSE(static_cast<bool>(Simulation::resume(other, bytes))) << key;
  }
}

TEST(Checkpoint, EachByteThatIsTakenIsSavedAsItWas) {
  System system = test::short_rods(63);
  system.n_rods = 4;
  auto simulation = test::good(Simulation::start(system));
  const auto whole = save_checkpoint(simulation->world());
  int taken = 0;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    auto bytes = whole;
    bytes[i] = std::byte{0x63};  // also where a yes or no is expected
    const auto world = restore_checkpoint(system, bytes);
    if (!world) continue;
    ++taken;
    EXPECT_TRUE(save_checkpoint(*world) == bytes) << "byte " << i;
  }
  EXPECT_GT(taken, 100);
}

// Those of before virials were summed lack these; all else goes on as it would have.
TEST(Checkpoint, OfTheFormerFormatIsReadWithoutVirials) {
  const System system = test::short_rods(63);
  auto straight = test::good(Simulation::start(system));
  ASSERT_FALSE(straight->advance_to(5000).has_value());
  auto bytes = straight->checkpoint();
  constexpr std::ptrdiff_t kContent = 8 + 8 + 3 * 8, kVirial = 4 * (8 + 8 + 1);
  const auto end = bytes.end() - static_cast<std::ptrdiff_t>(state_bytes(straight->world()).size()) - kContent;
  bytes.erase(end - kVirial, end);
  ASSERT_EQ(bytes[7], std::byte{'4'});
  bytes[7] = std::byte{'3'};
  auto resumed = test::good(Simulation::resume(system, bytes));
  const Ledger& read = resumed->world().counters.ledger;
  EXPECT_EQ(read.given.value(), straight->world().counters.ledger.given.value());
  EXPECT_EQ(read.momentum[2].value(), straight->world().counters.ledger.momentum[2].value());
  EXPECT_EQ(read.virial[0].value(), 0);
  EXPECT_GT(straight->world().counters.ledger.virial[0].value(), 0);
  ASSERT_FALSE(resumed->advance_to(9000).has_value());
  ASSERT_FALSE(straight->advance_to(9000).has_value());
  EXPECT_EQ(resumed->state_hash(), straight->state_hash());
}

TEST(Checkpoint, RefusesAnotherPhysicsVersionByName) {
  const System system = test::short_rods(63);
  auto simulation = test::good(Simulation::start(system));
  auto bytes = simulation->checkpoint();
  const int version = physics_version(system);
  ASSERT_EQ(bytes[8], static_cast<std::byte>(version));  // behind the magic
  bytes[8] = static_cast<std::byte>(version - 1);
  EXPECT_THAT(test::refusal(Simulation::resume(system, bytes)),
              testing::AllOf(testing::HasSubstr("physics version " + std::to_string(version - 1)),
                             testing::HasSubstr("version " + std::to_string(version))));
}

TEST(PhysicsVersion, IsThatOfTheLastChangeThatConcernedTheScene) {
  System system = test::short_rods(1);
  EXPECT_EQ(physics_version(system), 3);
  system.amplitude = 0;
  EXPECT_EQ(physics_version(system), 4) << "rods rest";
  system.rod_base.friction = 0;
  EXPECT_EQ(physics_version(system), 3) << "they rest without friction";
  system.added[1] = AddedRods{system.rod, 1};
  system.rod_base.own[Contacts::place(0, 2)].friction = 0.1;
  EXPECT_EQ(physics_version(system), 4) << "some of them rub";
  system.gravity = 0;
  EXPECT_EQ(physics_version(system), 3) << "they float";
}

TEST(StateHash, SeesEveryRod) {
  auto simulation = test::good(Simulation::start(test::short_rods(63)));
  World world = simulation->world();
  const auto hash = state_hash(world);
  for (std::size_t i : {std::size_t{0}, world.rods.size() - 1}) {
    World changed = world;
    changed.rods[i].velocity.x() = std::nextafter(changed.rods[i].velocity.x(), 1e9);
    EXPECT_NE(state_hash(changed), hash);
  }
}

}  // namespace
}  // namespace shaken
