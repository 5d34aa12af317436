#include "sim/close_up.h"

#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <utility>

#include "sim/contact/bead_contacts.h"
#include "sim/neighbors/neighbor_list.h"
#include "sim/simulation.h"
#include "tests/support/good.h"
#include "tests/support/short_rods.h"

namespace shaken {
namespace {

System dense_scene() {
  System system = test::short_rods(80);
  system.dt = 2e-5;
  return system;
}

TEST(CloseUp, ShowsEveryRodAsTheSnapshotDoesAndEveryContactOnce) {
  auto simulation = test::good(Simulation::start(dense_scene()));
  std::vector<int> everyone;
  for (int i = 0; i < 80; ++i) everyone.push_back(79 - i);
  int n_contacts = 0;
  for (Tick tick = 3000; tick < 3050; ++tick) {
    ASSERT_FALSE(simulation->advance_to(tick).has_value());
    const World& world = simulation->world();
    const Snapshot all = simulation->snapshot();
    const CloseUp seen = look_closely(world, tick, everyone);
    ASSERT_EQ(seen.rods.size(), 80U);
    for (int i = 0; i < 80; ++i) {
      EXPECT_EQ(seen.rods[i].rod, i);
      EXPECT_EQ(seen.rods[i].pose.director, all.director[i]);
      EXPECT_EQ(seen.rods[i].motion.velocity, all.velocity[i]);
      EXPECT_EQ(seen.rods[i].motion.angular_velocity, all.angular_velocity[i]);
    }
    std::map<std::pair<int, int>, int> contacts;
    for (const CloseUp::Contact& contact : seen.contacts) {
      if (contact.other >= 0) ++contacts[std::minmax(contact.rod, contact.other)];
    }
    std::vector<BeadContact> found;
    for (int i = 0; i < 80; ++i) {
      for (int j = i + 1; j < 80; ++j) {
        found.clear();
        find_bead_contacts(world.species[0], all.director[i], world.species[0], all.director[j],
                           nearest_image(all.position[i], all.position[j], world.system.box_side), found);
        EXPECT_EQ((contacts[{i, j}]), static_cast<int>(found.size())) << i << " " << j;
        n_contacts += static_cast<int>(found.size());
      }
    }
  }
  EXPECT_GT(n_contacts, 10);
}

TEST(CloseUp, OfOneRodShowsItsNeighbours) {
  auto simulation = Simulation::start(dense_scene());
  ASSERT_FALSE(simulation->advance_to(100).has_value());
  const CloseUp seen = look_closely(simulation->world(), 100, {7});
  ASSERT_GT(seen.rods.size(), 3U);
  ASSERT_LT(seen.rods.size(), 20U);
  EXPECT_EQ(seen.rods[0].rod, 7);
  EXPECT_TRUE(seen.rods[0].concerned);
  for (std::size_t k = 1; k < seen.rods.size(); ++k) EXPECT_FALSE(seen.rods[k].concerned);
}

TEST(CloseUp, LeavesOutFlightsThatBeganLater) {
  auto simulation = Simulation::start(dense_scene());
  ASSERT_FALSE(simulation->advance_to(3000).has_value());
  int rod = 0;  // one that has been hit since tick 0
  while (simulation->world().rods[rod].since == 0) ++rod;
  const CloseUp seen = look_closely(simulation->world(), 0, {rod});
  EXPECT_EQ(seen.unknown, std::vector<int>{rod});
  EXPECT_TRUE(seen.rods.empty());
}

/// The world one tick before `now`, with one rod much too fast for what it is going to do at `now`.
World with_a_runaway(World world, int rod, Tick now) {
  Flight& flight = world.rods[static_cast<std::size_t>(rod)];
  const Species& species = world.species_of(static_cast<std::size_t>(rod));
  const double ratio = species.inertia_par / species.inertia_perp;
  const double tau = static_cast<double>(now - 1 - flight.since) * world.system.dt;
  const Pose pose = pose_after(flight, tau, world.system.gravity);
  Motion motion = motion_after(flight, tau, world.system.gravity, pose.director, ratio);
  motion.velocity.x() = 1e5;
  begin_flight(flight, now - 1, pose, motion, world.system.box_side, ratio);
  return world;
}

// Trouble that is met where flights are stored leaves all of them as they were: the world is that of one tick before,
// and a close-up of it shows every neighbour.
TEST(CloseUp, AfterTroubleWhileStoringNoRodIsUnknown) {
  System system = dense_scene();
  system.box_side = 60;  // room enough for the runaway to meet the plates alone
  system.n_rods = 200;
  int n_troubles = 0, n_others = 0;
  for (const StepperKind stepper : {StepperKind::kReference, StepperKind::kScheduled}) {
    system.stepper = stepper;
    auto simulation = test::good(Simulation::start(system));
    ASSERT_FALSE(simulation->advance_to(2000).has_value());
    for (Tick now = 2001; now < 2700; ++now) {
      const World before = simulation->world();
      ASSERT_FALSE(simulation->advance_to(now).has_value());
      std::vector<int> hit;
      for (int i = 0; i < 200; ++i) {
        if (simulation->world().rods[static_cast<std::size_t>(i)].since == now) hit.push_back(i);
      }
      if (hit.size() < 2) continue;
      const int runaway = hit.back();  // the others are stored before it
      Simulation fatal = Simulation::start_from(with_a_runaway(before, runaway, now));
      const auto trouble = fatal.advance_to(now);
      if (!trouble || trouble->what.find("a speed of") == std::string::npos) continue;
      ++n_troubles;
      n_others += static_cast<int>(hit.size()) - 1;
      EXPECT_EQ(trouble->rods, std::vector<int>{runaway});
      for (const Flight& flight : fatal.world().rods) EXPECT_LT(flight.since, now);
      std::vector<int> everyone(200);
      std::iota(everyone.begin(), everyone.end(), 0);
      const CloseUp seen = look_closely(fatal.world(), now - 1, everyone);
      EXPECT_EQ(seen.rods.size(), 200U);
      EXPECT_TRUE(seen.unknown.empty());
    }
  }
  EXPECT_GT(n_troubles, 10);
  EXPECT_GT(n_others, 10);
}

}  // namespace
}  // namespace shaken
