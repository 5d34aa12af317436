#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "sim/checkpoint.h"
#include "sim/effects/registry.h"
#include "sim/simulation.h"
#include "tests/support/everything_on.h"

namespace shaken {
namespace {

Simulation stepped(const System& system, Tick ticks) {
  auto simulation = Simulation::start(system);
  EXPECT_TRUE(static_cast<bool>(simulation)) << simulation.error().message;
  EXPECT_FALSE(simulation->advance_to(ticks).has_value());
  return std::move(simulation).value();
}

const Effect& effect_named(std::string_view name) {
  for (const Effect& effect : all_effects()) {
    if (effect.name == name) return effect;
  }
  throw std::out_of_range(std::string(name));
}

TEST(Effects, NamesAreUnique) {
  std::set<std::string_view> names;
  for (const Effect& effect : all_effects()) {
    EXPECT_TRUE(names.insert(effect.name).second) << effect.name;
    EXPECT_FALSE(effect.what.empty()) << effect.name;
    EXPECT_FALSE(effect.unit.empty()) << effect.name;
  }
}

TEST(Effects, WorkWhenTheyAreOn) {
  const Simulation simulation = stepped(test::everything_on(), 10000);
  for (const Effect& effect : all_effects()) {
    EXPECT_TRUE(effect.is_on(simulation.world().system)) << effect.name;
    EXPECT_GT(effect.work(simulation.world()), 0) << effect.name;
  }
}

class EffectOff : public ::testing::TestWithParam<const char*> {};

TEST_P(EffectOff, DoesNoWorkInEitherStepper) {
  const Effect& effect = effect_named(GetParam());
  System off = test::everything_on();
  effect.switch_off(off);
  EXPECT_FALSE(effect.is_on(off));

  const Simulation without = stepped(off, 6000);
  EXPECT_EQ(effect.work(without.world()), 0);
  EXPECT_NE(without.state_hash(), stepped(test::everything_on(), 6000).state_hash()) << "it did not matter";

  off.stepper = StepperKind::kReference;
  EXPECT_EQ(without.state_hash(), stepped(off, 6000).state_hash());
}

std::vector<const char*> can_be_off() {
  std::vector<const char*> names;
  for (const Effect& effect : all_effects()) {
    if (effect.switch_off != nullptr) names.push_back(effect.name.data());
  }
  return names;
}
INSTANTIATE_TEST_SUITE_P(All, EffectOff, ::testing::ValuesIn(can_be_off()),
                         [](const auto& about) { return std::string(about.param); });

TEST(Effects, NoiseIsOnWhereRodsOfAnySpeciesThatIsThereHaveIt) {
  const Effect& noise = effect_named("rotational_noise");
  System system;
  system.added_noise[1] = 0.2;
  EXPECT_FALSE(noise.is_on(system)) << "no rods_3";
  system.added[1] = AddedRods{};
  EXPECT_TRUE(noise.is_on(system));
  system.rotational_noise = 0.1;
  EXPECT_EQ(system.noise_of(1), 0.1) << "as the first species";
  system.rotational_noise = 0;
  system.added_noise[1] = 0;
  EXPECT_FALSE(noise.is_on(system));
}

TEST(Effects, FrictionlessRodsDoNotSpin) {
  System system = test::everything_on();
  effect_named("spin").switch_off(system);
  const Simulation without = stepped(system, 20000);
  for (const Flight& rod : without.world().rods) EXPECT_LT(std::abs(rod.spin), 1e-9);
  double fastest = 0;
  const Simulation with = stepped(test::everything_on(), 20000);
  for (const Flight& rod : with.world().rods) fastest = std::max(fastest, std::abs(rod.spin));
  EXPECT_GT(fastest, 1.0);
}

// Without gravity nothing pulls a rod down: only the plates can turn its vertical velocity round.
TEST(Effects, WithoutGravityARodFliesStraight) {
  System system = test::everything_on();
  system.gravity = 0;
  system.amplitude = 0;
  system.walls.reset();
  system.posts.reset();
  system.added = {};
  system.n_rods = 1;
  system.gap = 20;
  auto simulation = Simulation::start(system);
  ASSERT_TRUE(static_cast<bool>(simulation));
  const Snapshot before = simulation->snapshot();
  ASSERT_FALSE(simulation->advance_to(10000).has_value());
  const Snapshot after = simulation->snapshot();
  EXPECT_EQ(after.velocity[0], before.velocity[0]);
  EXPECT_NEAR(after.position[0].z() - before.position[0].z(), 0.04 * before.velocity[0].z(), 1e-12);
}

}  // namespace
}  // namespace shaken
