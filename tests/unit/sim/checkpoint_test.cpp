// SPDX-License-Identifier: MIT
#include "sim/checkpoint.h"

#include <gtest/gtest.h>

#include <string>

#include "sim/physics_version.h"
#include "sim/simulation.h"
#include "tests/support/short_rods.h"

namespace shaken {
namespace {

TEST(Checkpoint, RestoredRunIsBitwiseTheStraightRun) {
  const System system = test::short_rods(63);
  auto straight = Simulation::start(system);
  ASSERT_TRUE(static_cast<bool>(straight));
  for (const Tick stop : {Tick{1}, Tick{4777}, Tick{10003}}) {
    ASSERT_FALSE(straight->advance_to(stop).has_value());
    auto resumed = Simulation::resume(system, straight->checkpoint());
    ASSERT_TRUE(static_cast<bool>(resumed)) << resumed.error().message;
    EXPECT_EQ(resumed->state_hash(), straight->state_hash());
    ASSERT_FALSE(resumed->advance_to(stop + 4000).has_value());
    ASSERT_FALSE(straight->advance_to(stop + 4000).has_value());
    EXPECT_EQ(resumed->state_hash(), straight->state_hash());
    EXPECT_EQ(resumed->world().counters.impulses_rod_rod, straight->world().counters.impulses_rod_rod);
    EXPECT_EQ(resumed->world().counters.max_overlap(), straight->world().counters.max_overlap());
    EXPECT_EQ(resumed->world().counters.ledger.virial[1].value(), straight->world().counters.ledger.virial[1].value());
  }
  EXPECT_GT(straight->world().counters.impulses_rod_rod, 100);
}

TEST(Checkpoint, RefusesAnotherSceneAndDamage) {
  const System system = test::short_rods(63);
  auto simulation = Simulation::start(system);
  ASSERT_TRUE(static_cast<bool>(simulation));
  auto bytes = simulation->checkpoint();
  System other = system;
  other.gap = 1.3;
  EXPECT_FALSE(static_cast<bool>(Simulation::resume(other, bytes)));
  EXPECT_FALSE(static_cast<bool>(Simulation::resume(system, std::span(bytes).first(bytes.size() - 1))));
  bytes.push_back(std::byte{0});
  EXPECT_FALSE(static_cast<bool>(Simulation::resume(system, bytes)));
  EXPECT_FALSE(static_cast<bool>(Simulation::resume(system, {})));
}

TEST(Checkpoint, EachByteThatIsTakenIsSavedAsItWas) {
  System system = test::short_rods(63);
  system.n_rods = 4;
  auto simulation = Simulation::start(system);
  ASSERT_TRUE(static_cast<bool>(simulation));
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
  auto straight = Simulation::start(system);
  ASSERT_TRUE(static_cast<bool>(straight));
  ASSERT_FALSE(straight->advance_to(5000).has_value());
  auto bytes = straight->checkpoint();
  constexpr std::ptrdiff_t kContent = 8 + 8 + 3 * 8, kVirial = 4 * (8 + 8 + 1);
  const auto end = bytes.end() - static_cast<std::ptrdiff_t>(state_bytes(straight->world()).size()) - kContent;
  bytes.erase(end - kVirial, end);
  ASSERT_EQ(bytes[7], std::byte{'4'});
  bytes[7] = std::byte{'3'};
  auto resumed = Simulation::resume(system, bytes);
  ASSERT_TRUE(static_cast<bool>(resumed)) << resumed.error().message;
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
  auto simulation = Simulation::start(system);
  ASSERT_TRUE(static_cast<bool>(simulation));
  auto bytes = simulation->checkpoint();
  const int version = physics_version(system);
  ASSERT_EQ(bytes[8], static_cast<std::byte>(version));  // behind the magic
  bytes[8] = static_cast<std::byte>(version - 1);
  const auto resumed = Simulation::resume(system, bytes);
  ASSERT_FALSE(static_cast<bool>(resumed));
  EXPECT_NE(resumed.error().message.find("physics version " + std::to_string(version - 1)), std::string::npos)
      << resumed.error().message;
  EXPECT_NE(resumed.error().message.find("version " + std::to_string(version)), std::string::npos);
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
  auto simulation = Simulation::start(test::short_rods(63));
  ASSERT_TRUE(static_cast<bool>(simulation));
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
