// SPDX-License-Identifier: MIT
#include "run/messages.h"

#include <gtest/gtest.h>

#include <cmath>

#include "proto/codec.h"

namespace shaken::run {
namespace {

World small_world() {
  Scene scene;
  scene.n_rods = 4;
  scene.box_side = 20;
  Result<World> world = make_world(scene);
  EXPECT_TRUE(world);
  return std::move(world).value();
}

Snapshot two_rods() {
  Snapshot s;
  s.tick = 12;
  s.time = 0.5;
  s.box_side = 20;
  s.position = {Vec3(1, 2, 0.5), Vec3(19, 0, 0.6)};
  s.director = {Vec3(0.6, 0, 0.8), Vec3(-0.6, 0, 0.8)};
  s.velocity = {Vec3(3, 0, 1), Vec3(0, 4, -1)};
  s.angular_velocity = {Vec3::Zero(), Vec3::Zero()};
  s.image = {{0, 0}, {3, -1}};
  return s;
}

TEST(Messages, FrameShowsEachRodFromItsRightHandEnd) {
  const proto::Frame frame = make_frame(two_rods());
  EXPECT_EQ(frame.tick, 12);
  EXPECT_EQ(frame.sim_time_s, 0.5);
  EXPECT_EQ(frame.box_side_mm, 20);
  EXPECT_NEAR(frame.order, 1, 1e-12);
  EXPECT_NEAR(frame.director_rad, 0, 1e-12);
  ASSERT_EQ(frame.rods.size(), 2U);
  EXPECT_NEAR(frame.rods[0].theta, 0, 1e-12);
  EXPECT_NEAR(frame.rods[0].n_z, 0.8, 1e-12);
  EXPECT_NEAR(frame.rods[1].theta, 0, 1e-12);
  EXPECT_NEAR(frame.rods[1].n_z, -0.8, 1e-12) << "seen from the end with theta in [-pi/2, pi/2)";
}

TEST(Messages, ObservablesAreRootMeanSquaresInTheirUnits) {
  const World world = small_world();
  Progress progress;
  progress.sim_time_total = 9;
  progress.eta = 7;
  const observables_t m = make_observables(world, two_rods(), progress);
  EXPECT_EQ(m.n_rods, 2);
  EXPECT_NEAR(m.rms_speed_xy_mm_s, std::sqrt((9 + 16) / 2.0), 1e-12);
  EXPECT_NEAR(m.rms_speed_z_mm_s, 1, 1e-12);
  EXPECT_NEAR(m.rms_n_z, 0.8, 1e-12);
  EXPECT_NEAR(m.kinetic_energy_uJ, kinetic_energy(world).total() * 1e-6, 1e-15);
  EXPECT_EQ(m.sim_time_total_s, 9);
  EXPECT_EQ(m.eta_s, 7);
  EXPECT_TRUE(proto::decode<observables_t>(proto::encode(m)));
}

TEST(Messages, DefectsAndStaticPartCanBeSent) {
  Measurements::DefectSample sample;
  sample.time = 1.5;
  sample.smoothing = 2.25;
  sample.defects = {{Vec2(1, 2), 0.5, 0.1}, {Vec2(3, 4), -0.5, 0.2}};
  const auto defects = proto::decode<defects_t>(proto::encode(make_defects(sample)));
  ASSERT_TRUE(defects);
  EXPECT_EQ(defects->x_mm, (std::vector<double>{1, 3}));
  EXPECT_EQ(defects->charge, (std::vector<double>{0.5, -0.5}));

  const World world = small_world();
  const auto constants = proto::decode<frame_static_t>(proto::encode(make_frame_static(world, "rods.length=4.5")));
  ASSERT_TRUE(constants);
  EXPECT_EQ(constants->n_rods, 4);
  EXPECT_EQ(constants->bead_radius_mm, world.species[0].bead_radius);
  EXPECT_EQ(constants->label, "rods.length=4.5");
}

}  // namespace
}  // namespace shaken::run
