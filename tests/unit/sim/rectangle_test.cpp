#include <gtest/gtest.h>

#include "sim/balance.h"
#include "sim/checkpoint.h"
#include "sim/simulation.h"
#include "sim/start/initial.h"
#include "tests/support/good.h"

namespace shaken {
namespace {

/// A world of copies of `one`, side by side along y.
World side_by_side(const World& one, int copies) {
  System system = one.system;
  system.n_rods *= copies;
  system.box_aspect = copies;
  World world = empty_world(system);
  for (int copy = 0; copy < copies; ++copy) {
    for (Flight rod : one.rods) {
      rod.position.y() += copy * one.system.box().y();
      world.rods.push_back(rod);
    }
  }
  world.start = content(world);
  return world;
}

System small_scene(StepperKind stepper) {
  System system;
  system.rod.n_beads = 15;
  system.n_rods = 70;
  system.box_side = 16;
  system.dt = 8e-6;
  system.stepper = stepper;
  return system;
}

// Three boxes beside each other, each with the same rods in the same places, are one box three times as high: the rods
// of each go on as those of the one box, up to rounding.
TEST(Rectangle, OfCopiesEachFliesAsTheOneBox) {
  for (const StepperKind stepper : {StepperKind::kScheduled, StepperKind::kReference}) {
    const Result<World> made = test::good(make_world(small_scene(stepper)));
    Simulation one = Simulation::start_from(*made);
    Simulation three = Simulation::start_from(side_by_side(*made, 3));
    ASSERT_FALSE(one.advance_to(2000));
    ASSERT_FALSE(three.advance_to(2000));
    const Snapshot a = one.snapshot(), b = three.snapshot();
    EXPECT_GT(one.world().counters.impulses_rod_rod, 200);
    EXPECT_EQ(3 * one.world().counters.impulses_rod_rod, three.world().counters.impulses_rod_rod);
    EXPECT_EQ(b.box, Box(16, 48));
    const auto unwrapped = [](const Snapshot& rods, std::size_t i) -> Vec3 {
      return rods.position[i] + Vec3(rods.image[i][0] * rods.box.x(), rods.image[i][1] * rods.box.y(), 0);
    };
    for (std::size_t copy = 0; copy < 3; ++copy) {
      for (std::size_t i = 0; i < 70; ++i) {
        const std::size_t k = 70 * copy + i;
        const Vec3 shift(0, 16.0 * static_cast<double>(copy), 0);
        EXPECT_LT((unwrapped(b, k) - unwrapped(a, i) - shift).norm(), 1e-6) << i;
        EXPECT_LT((b.director[k] - a.director[i]).norm(), 1e-6) << i;
      }
    }
  }
}

TEST(Rectangle, ACheckpointBelongsToItsShape) {
  System system = small_scene(StepperKind::kScheduled);
  system.box_aspect = 2;
  const Result<World> made = test::good(make_world(system));
  const std::vector<std::byte> saved = save_checkpoint(*made);
  EXPECT_TRUE(restore_checkpoint(system, saved));
  system.box_aspect = 1;
  EXPECT_FALSE(restore_checkpoint(system, saved));
  system.box_side = 32;
  system.box_aspect = 0.5;
  EXPECT_FALSE(restore_checkpoint(system, saved));
}

TEST(Simulation, OfAWorldNeedsAFlightForEachRod) {
  World world = *test::good(make_world(small_scene(StepperKind::kScheduled)));
  world.rods.pop_back();
  EXPECT_THROW(Simulation::start_from(world), std::logic_error);
}

}  // namespace
}  // namespace shaken
