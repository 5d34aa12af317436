#include "run/live/messages.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "proto/cell_codec.h"
#include "proto/codec.h"
#include "scene/keys/fields.h"
#include "sim/balance.h"
#include "sim/start/initial.h"
#include "tests/support/good.h"

namespace shaken::run {
namespace {

World small_world() {
  System scene;
  scene.n_rods = 4;
  scene.box_side = 20;
  Result<World> world = test::good(make_world(scene));
  return std::move(world).value();
}

Snapshot two_rods() {
  Snapshot s;
  s.tick = 12;
  s.time = 0.5;
  s.box = 20;
  s.position = {Vec3(1, 2, 0.5), Vec3(19, 0, 0.6)};
  s.director = {Vec3(0.6, 0, 0.8), Vec3(-0.6, 0, 0.8)};
  s.velocity = {Vec3(3, 0, 1), Vec3(0, 4, -1)};
  s.angular_velocity = {Vec3::Zero(), Vec3::Zero()};
  s.image = {{0, 0}, {3, -1}};
  return s;
}

TEST(Messages, FrameShowsEachRodWithItsHead) {
  const proto::Frame frame = make_frame(small_world(), two_rods());
  EXPECT_EQ(frame.tick, 12);
  EXPECT_EQ(frame.sim_time_s, 0.5);
  EXPECT_EQ(frame.box, Box(20));
  EXPECT_NEAR(frame.order, 1, 1e-12);
  EXPECT_NEAR(frame.director_rad, 0, 1e-12);
  ASSERT_EQ(frame.rods.size(), 2U);
  EXPECT_NEAR(frame.rods[0].theta, 0, 1e-12);
  EXPECT_NEAR(frame.rods[0].n_z, 0.8, 1e-12);
  EXPECT_NEAR(std::abs(frame.rods[1].theta), kPi, 1e-12);
  EXPECT_NEAR(frame.rods[1].n_z, 0.8, 1e-12);
}

// Their directors are those of a frame that turns with them, and mean nothing.
TEST(Messages, SpheresHaveNoOrder) {
  System scene;
  scene.n_rods = 4;
  scene.box_side = 20;
  scene.rod.n_beads = 1;
  scene.rod.length = scene.rod.mid_diameter;
  const World world = *make_world(scene);
  EXPECT_FALSE(world.cell().has_axes());
  EXPECT_TRUE(std::isnan(make_frame(world, two_rods()).order));
  EXPECT_EQ(make_frame(world, two_rods()).director_rad, 0);
  EXPECT_TRUE(std::isnan(make_observables(world, two_rods(), {}).order));
  EXPECT_NEAR(make_frame(small_world(), two_rods()).order, 1, 1e-12);
}

TEST(Messages, ObservablesAreRootMeanSquaresInTheirUnits) {
  World world = small_world();
  world.counters.impulses_rod_rod = 3;
  world.counters.impulses_rod_base = 4;
  world.counters.impulses_rod_lid = 5;
  world.counters.max_overlap_rod_surface = 0.125;
  Progress progress;
  progress.sim_time_total = 9;
  progress.sim_rate = 8;
  progress.eta = 7;
  progress.order_running_mean = 0.25;
  const observables_t m = make_observables(world, two_rods(), progress);
  EXPECT_EQ(m.sim_time_s, 0.5);
  EXPECT_NEAR(m.order, 1, 1e-12);
  EXPECT_EQ(m.order_running_mean, 0.25);
  EXPECT_NEAR(m.director_rad, 0, 1e-12);
  EXPECT_EQ(m.max_overlap_mm, 0.125);
  EXPECT_EQ((std::array{m.collisions_rod_rod, m.collisions_rod_base, m.collisions_rod_lid}), (std::array{3L, 4L, 5L}));
  EXPECT_EQ(m.sim_rate, 8);
  EXPECT_EQ(m.n_rods, 2);
  EXPECT_NEAR(m.rms_speed_xy_mm_s, std::sqrt((9 + 16) / 2.0), 1e-12);
  EXPECT_NEAR(m.rms_speed_z_mm_s, 1, 1e-12);
  EXPECT_NEAR(m.rms_n_z, 0.8, 1e-12);
  EXPECT_NEAR(m.kinetic_energy_uJ, kinetic_energy(world).total() * 1e-6, 1e-15);
  EXPECT_EQ(m.sim_time_total_s, 9);
  EXPECT_EQ(m.eta_s, 7);
  EXPECT_TRUE(proto::decode<observables_t>(proto::encode(m)));
}

TEST(Messages, DefectsCanBeSent) {
  DefectSample sample;
  sample.time = 1.5;
  sample.smoothing = 2.25;
  sample.defects = {{Vec2(1, 2), 0.5, 0.1}, {Vec2(3, 4), -0.5, 0.2}};
  const auto defects = test::good(proto::decode<defects_t>(proto::encode(make_defects(sample))));
  EXPECT_EQ(defects->x_mm, (std::vector<double>{1, 3}));
  EXPECT_EQ(defects->y_mm, (std::vector<double>{2, 4}));
  EXPECT_EQ(defects->charge, (std::vector<double>{0.5, -0.5}));
  EXPECT_EQ(defects->direction_rad, (std::vector<double>{0.1, 0.2}));
  EXPECT_EQ(defects->sim_time_s, 1.5);
  EXPECT_EQ(defects->smoothing_mm, 2.25);
}

/// A disc with rods, rods with a head, and spheres.
World mixed_world() {
  System scene;
  scene.n_rods = 3;
  scene.box_side = 40;
  RodShape polar;
  polar.profile = Profile::kPolar;
  polar.length = 3;
  RodShape sphere;
  sphere.n_beads = 1;
  scene.added = {AddedRods{polar, 2}, AddedRods{sphere, 1}};
  scene.walls = SideWalls{};
  scene.walls->size = 30;
  Result<World> world = test::good(make_world(scene));
  return std::move(world).value();
}

TEST(Messages, ACellComesBackFromItsMessage) {
  for (const World& world : {small_world(), mixed_world()}) {
    Cell cell = world.cell();
    const auto sent =
        test::good(proto::decode<frame_static_t>(proto::encode(proto::encode_cell(cell, 6, "rods.length=4.5"))));
    EXPECT_EQ(sent->n_rods, 6);
    EXPECT_EQ(sent->label, "rods.length=4.5");
    EXPECT_EQ(sent->arena, cell.walls ? "disc" : "");
    if (cell.walls) cell.walls = SideWalls{.size = cell.walls->size, .inner = 0};  // all that messages say of a disc
    EXPECT_EQ(proto::decode_cell(*sent), cell);
  }
}

TEST(Messages, AnArenaComesBackWithItsLengths) {
  Cell cell = small_world().cell();
  for (const SideWalls& walls : {SideWalls{.arena = Arena::kAnnulus, .size = 9, .inner = 4},
                                 SideWalls{.arena = Arena::kStadium, .size = 5, .inner = 0, .length = 4.5},
                                 SideWalls{.arena = Arena::kChannel, .size = 9, .inner = 0},
                                 SideWalls{.arena = Arena::kEllipse, .size = 3, .inner = 0, .length = 4.5},
                                 SideWalls{.arena = Arena::kWedge, .size = 3, .inner = 0, .length = 4.5},
                                 SideWalls{Arena::kWedge, 3, 0, Contacts{0.01, 0.3}, 4.5, 1.0 / 3}}) {
    cell.walls = walls;
    const auto sent = test::good(proto::decode<frame_static_t>(proto::encode(proto::encode_cell(cell, 6, ""))));
    if (walls.narrow == 0) {
      EXPECT_EQ(sent->arena, std::string(name_of(walls.arena)) + (walls.arena == Arena::kWedge ? " 0" : ""));
    }
    EXPECT_EQ(proto::decode_cell(*sent), cell);
  }
  frame_static_t other = proto::encode_cell(cell, 6, "");
  for (const char* unknown : {"wedge x", "wedge 1 mm", "wedge ", "disc 3", "hexagon", " "}) {
    other.arena = unknown;
    const auto read = proto::decode_cell(other);
    ASSERT_TRUE(read) << unknown;
    EXPECT_FALSE(read->walls) << unknown;
  }
}

TEST(Messages, PostsComeBackAndFitIntoOneDatagram) {
  StandingPosts posts{.diameter = 2.5, .centres = {{1, 2}, {0.125, 40}}};
  const auto sent = test::good(proto::decode<posts_t>(proto::encode(proto::encode_posts(posts))));
  EXPECT_EQ(proto::decode_posts(*sent), posts);
  const double most = scene::field_at("posts.columns").high * scene::field_at("posts.rows").high;
  posts.centres.resize(static_cast<std::size_t>(most), Vec2(1, 1));
  EXPECT_LT(proto::encode(proto::encode_posts(posts)).size(), 60000U);
}

TEST(Messages, StaticPartOfManyRodsFitsIntoOneDatagram) {
  World world = mixed_world();
  world.shape_of_rod.assign(18000, 1);
  for (Species& species : world.species) {
    species.bead_offset.assign(kMostBeads, 0);
    species.bead_radius.assign(kMostBeads, 1);
  }
  EXPECT_LT(proto::encode(proto::encode_cell(world.cell(), 18000, std::string(200, 'x'))).size(), 60000U);
}

TEST(Messages, OrderIsOfTheFirstKindOfRod) {
  Snapshot s = two_rods();
  s.director = {Vec3(1, 0, 0), Vec3(0, 1, 0)};
  EXPECT_NEAR(make_frame(small_world(), s).order, 0, 1e-12);
  World world = mixed_world();
  world.shape_of_rod = {1, 0};
  EXPECT_NEAR(make_frame(world, s).order, 1, 1e-12);
  EXPECT_NEAR(std::abs(make_frame(world, s).director_rad), kPi / 2, 1e-12);
  EXPECT_EQ(make_frame(world, s).rods.size(), 2U);
  EXPECT_NEAR(make_observables(world, s, {}).order, 1, 1e-12);
}

}  // namespace
}  // namespace shaken::run
