#include "sim/motion/side_walls.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/effort.h"
#include "tests/support/flying_rod.h"
#include "tests/support/random_rods.h"

namespace shaken {
namespace side_walls_test {

/// A flying rod that is about as far from a wall as asked.
struct RodByWall : test::FlyingRod {
  SideWalls walls;
  double box_side;

  RodByWall(test::Draw& draw, double gap) {
    species = test::random_species(draw);
    walls.arena = static_cast<Arena>(draw.integer(0, kArenaNames.size() - 1));
    const double middle = walls.arena == Arena::kAnnulus ? draw.uniform(0.1, 12) : 0.0;
    walls.inner = middle;
    walls.size = middle + (draw.integer(0, 3) ? 4.4 : 30.0) * species.reach();
    const bool is_long = walls.has_length() && draw.integer(0, 3);  // or as long as wide, and the stadium is a disc
    const double least = walls.arena == Arena::kStadium ? 0.0 : walls.size;
    walls.length = is_long ? least + draw.uniform(0, 2) * walls.size : least;
    walls.narrow = draw.integer(0, 2) * 0.5 * walls.size;
    box_side = walls.size + walls.length + draw.uniform(1, 3);
    // from where it is free on to the nearest wall that way
    const double angle = draw.uniform(0, 2 * kPi);
    const Vec3 outwards(std::cos(angle), std::sin(angle), 0);
    const double start = walls.arena == Arena::kAnnulus ? 0.25 * (walls.size + walls.inner) : 0.0;
    const Vec3 way = draw.integer(0, 1) ? outwards : Vec3(-outwards);
    const double beside = 0.5 * (walls.extent().x() - walls.size) * draw.uniform(-1, 1);
    const Vec3 middle_of_box(0.5 * box_side + beside, 0.5 * box_side, 0);
    Pose pose{middle_of_box + start * outwards, draw.flat_direction(draw.integer(0, 3) ? 0.38 : 1)};
    for (int step = 0; step < 60; ++step) {
      const Vec3 moved = pose.position - (overlap(pose) + gap) * way;
      if ((moved - middle_of_box).norm() > walls.size + walls.length) break;  // there may be no such place that way
      pose.position = moved;
    }
    begin(draw, pose, box_side);
  }

  /// The overlap of the deepest bead, negative if all are free: every bead is looked at [mm].
  double overlap(const Pose& pose) const {
    double most = -INFINITY;
    for (int b = 0; b < species.n_beads(); ++b) {
      const WallsSeen seen = see_walls(walls, box_side, pose.position + species.bead_offset[b] * pose.director);
      for (int w = 0; w < seen.n; ++w) most = std::max(most, species.bead_radius[b] - seen.walls[w].distance);
    }
    return most;
  }
  double safe_time() const {
    return wall_safe_time(walls, box_side, species, pose(), flight, horizon, gravity.along_size());
  }
};

void expect_wall(const SideWalls& walls, const Box& box, const Vec2& point, double distance, const Vec2& normal) {
  const WallsSeen seen = see_walls(walls, box, {point.x(), point.y(), 0.3});
  ASSERT_EQ(seen.n, 1);
  EXPECT_NEAR(seen.walls[0].distance, distance, 1e-12) << point.transpose();
  EXPECT_LT((seen.walls[0].normal - Vec3(normal.x(), normal.y(), 0)).norm(), 1e-12) << point.transpose();
  EXPECT_NEAR(distance_to_walls(walls, box, {point.x(), point.y(), 0.3}), distance, 1e-12);
}

// Round ends of radius 10 about (15, 20) and (25, 20), straight walls between them.
TEST(SeeWalls, OfAStadium) {
  const SideWalls walls{.arena = Arena::kStadium, .size = 20, .length = 10};
  expect_wall(walls, 40, {25, 23}, 7, {0, -1});
  expect_wall(walls, 40, {18, 12}, 2, {0, 1});
  expect_wall(walls, 40, {28, 24}, 5, {-0.6, -0.8});
  expect_wall(walls, 40, {6, 32}, -5, {0.6, -0.8});
  expect_wall(walls, 40, {37, 20}, -2, {-1, 0});
  EXPECT_EQ(distance_to_walls(walls, 40, {20, 20, 0}), 10);
}

// A triangle whose slanting walls rise by 3 on 4, with corners at (0, -12), (0, 12) and (16, 0) from (12, 20).
TEST(SeeWalls, OfAWedge) {
  const SideWalls walls{.arena = Arena::kWedge, .size = 24, .length = 16};
  const auto expect = [&](const Vec2& point, const std::array<double, 3>& distances, double end) {
    const WallsSeen seen = see_walls(walls, 40, {point.x() + 12, point.y() + 20, 0.3});
    ASSERT_EQ(seen.n, 3);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(seen.walls[k].distance, distances[k], 1e-12) << k;
    EXPECT_EQ(seen.walls[0].normal, Vec3(end, 0, 0));
    EXPECT_LT((seen.walls[1].normal - Vec3(-0.6, -0.8, 0)).norm(), 1e-12);
    EXPECT_LT((seen.walls[2].normal - Vec3(-0.6, 0.8, 0)).norm(), 1e-12);
    EXPECT_NEAR(distance_to_walls(walls, 40, {point.x() + 12, point.y() + 20, 0}), *std::ranges::min_element(distances),
                1e-12);
  };
  expect({2, 0}, {2, 8.4, 8.4}, 1);
  expect({11, 0}, {5, 3, 3}, -1);
  expect({4, 9}, {4, 0, 14.4}, 1);
  expect({7, -8}, {7, 11.8, -1}, 1);
  const SideWalls blunt{.arena = Arena::kWedge, .size = 24, .length = 8, .narrow = 12};  // the left half of it
  EXPECT_NEAR(distance_to_walls(blunt, 40, {23.5, 20, 0}), 0.5, 1e-12);
  const SideWalls rectangle{.arena = Arena::kWedge, .size = 10, .length = 20, .narrow = 10};
  EXPECT_EQ(distance_to_walls(rectangle, 40, {26, 23, 0}), 2);
  EXPECT_EQ(distance_to_walls(rectangle, 40, {29, 21, 0}), 1);
}

TEST(SeeWalls, OfAnEllipse) {
  const SideWalls walls{.arena = Arena::kEllipse, .size = 6, .length = 10};
  expect_wall(walls, 20, {10, 11}, 2, {0, -1});
  expect_wall(walls, 20, {5.5, 10}, 0.5, {1, 0});
  expect_wall(walls, 20, {16, 10}, -1, {-1, 0});
}

TEST(SeeWalls, WithinItsReachAnEllipseIsTheSame) {
  test::Draw draw(45);
  const SideWalls walls{.arena = Arena::kEllipse, .size = 12, .length = 30};
  int n_left_out = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Vec3 point(draw.uniform(4, 36), draw.uniform(13, 27), 0);
    const double reach = draw.uniform(0, 2);
    const WallsSeen all = see_walls(walls, 40, point), near = see_walls(walls, 40, point, reach);
    ASSERT_EQ(all.n, 1);
    if (near.n == 0) {
      ++n_left_out;
      ASSERT_GT(all.walls[0].distance, reach);
      ASSERT_GT(distance_to_walls(walls, 40, point, reach), reach);
    } else {
      ASSERT_EQ(near.walls[0].distance, all.walls[0].distance);
      ASSERT_EQ(near.walls[0].normal, all.walls[0].normal);
    }
  }
  EXPECT_GT(n_left_out, 500);
}

TEST(SeeWalls, OfAChannel) {
  const SideWalls walls{.arena = Arena::kChannel, .size = 20};
  const Box box(40, 30);
  expect_wall(walls, box, {7, 21}, 4, {0, -1});
  expect_wall(walls, box, {100, 3}, -2, {0, 1});
  EXPECT_EQ(period_of(box, walls), Vec2(40, 0));
}

// The share of a fine grid that lies within.
TEST(SideWalls, AreaIsWhatLiesWithin) {
  constexpr double kBox = 41.3;
  constexpr int kGrid = 700;
  for (const auto& [name, arena] : kArenaNames) {
    const double length = arena == Arena::kStadium ? 14 : 37.7;
    const SideWalls walls{.arena = arena, .size = 23, .inner = 9, .length = length, .narrow = 7};
    int within = 0;
    for (int i = 0; i < kGrid * kGrid; ++i) {
      const Vec3 point((i % kGrid + 0.5) * kBox / kGrid, (i / kGrid + 0.5) * kBox / kGrid, 0);
      within += distance_to_walls(walls, kBox, point) >= 0;
    }
    EXPECT_NEAR(within * kBox * kBox / (kGrid * kGrid) / walls.area(kBox), 1, 2e-3) << name;
  }
  EXPECT_DOUBLE_EQ((SideWalls{.arena = Arena::kStadium, .size = 20, .length = 10}.area(50)), 200 + 100 * kPi);
  EXPECT_EQ((SideWalls{.arena = Arena::kChannel, .size = 20}.area(Box(40, 30))), 800);
  EXPECT_DOUBLE_EQ((SideWalls{.arena = Arena::kEllipse, .size = 20, .length = 40}.area(50)), 200 * kPi);
  EXPECT_EQ((SideWalls{.arena = Arena::kWedge, .size = 20, .length = 30}.area(50)), 300);
  EXPECT_EQ((SideWalls{.arena = Arena::kWedge, .size = 20, .length = 30, .narrow = 10}.area(50)), 450);
}

TEST(WallSafeTime, NoBeadBeginsToTouchAWallBeforeItsBound) {
  test::Draw draw(31);
  std::vector<double> share[kArenaNames.size()];
  test::Tried tried;
  for (int trial = 0; trial < test::draws(100000); ++trial) {
    SCOPED_TRACE(trial);
    const RodByWall rod(draw, (draw.integer(0, 9) ? 1 : -1) * std::pow(10.0, draw.uniform(-7, 0.5)));
    auto* timed = trial % test::draws(10) == 0 ? &share[static_cast<int>(rod.walls.arena)] : nullptr;  // in every build
    ASSERT_NO_FATAL_FAILURE(test::expect_free_until_bound(rod, tried, timed));
  }
  EXPECT_GT(tried.n_free, test::draws(80000));
  EXPECT_GT(tried.n_short, test::draws(20000));
  for (const auto& [name, arena] : kArenaNames) test::expect_tight(name, share[static_cast<int>(arena)], 0.4);
}

TEST(WallSafeTime, OfARodThatFliesStraightAtAWall) {
  const Species rod = make_species({.length = 4.5, .n_beads = 15, .profile = Profile::kPolar});
  const Species sphere = make_species({.length = 0.8, .mid_diameter = 0.8, .end_diameter = 0.8, .n_beads = 1});
  constexpr double kBox = 32, kSpeed = 40, kGap = 1.5;
  for (const Species& species : {rod, sphere}) {
    for (const auto& [name, arena] : kArenaNames) {
      for (const double way : {1.0, -1.0}) {  // in an annulus these are its two walls
        const bool is_stadium = arena == Arena::kStadium;
        const SideWalls walls{arena, is_stadium ? 20.0 : 30.0, 6, {}, is_stadium ? 10.0 : 30.0, 24};
        const double head = species.bead_offset.back() + species.bead_radius.back();
        const double wall = arena != Arena::kAnnulus ? way * 15 : way > 0 ? 15.0 : 3.0;
        const Vec3 towards = arena == Arena::kChannel ? Vec3(0, way, 0) : Vec3(way, 0, 0);
        Flight flight;
        flight.position = Vec3(0.5 * kBox, 0.5 * kBox, 0.6) + (way * wall - head - kGap) * towards;
        flight.velocity = kSpeed * towards + Vec3(0, 0, 10);
        flight.director = towards;
        flight.prepare();
        const auto bound = [&](double horizon) {
          return wall_safe_time(walls, kBox, species, {flight.position, flight.director}, flight, horizon, 0);
        };
        constexpr double kTrue = kGap / kSpeed;
        EXPECT_LE(bound(1.0), kTrue) << name;
        EXPECT_GE(bound(1.0), 0.99 * kTrue) << name;
        EXPECT_EQ(bound(0.99 * kTrue), 0.99 * kTrue) << name;
      }
    }
  }
}

// It comes along a chord 9 mm off the middle, at whose end it is 15 mm off: it has 12 mm to go.
TEST(WallSafeTime, OfASphereThatFliesAskewAtARoundWall) {
  const Species sphere = make_species({.length = 0.8, .mid_diameter = 0.8, .end_diameter = 0.8, .n_beads = 1});
  Flight flight;
  flight.position = Vec3(20, 29, 0.6);
  flight.velocity = Vec3(-40, 0, 0);
  flight.prepare();
  const double bound = wall_safe_time(SideWalls{Arena::kDisc, 30.8, 6, {}}, 40, sphere,
                                      {flight.position, flight.director}, flight, 1.0, 0);
  EXPECT_NEAR(bound, 0.3, 1e-6);
  EXPECT_LE(bound, 0.3);
}

TEST(MayTouchWalls, IsNeverDeniedOfARodThatDoes) {
  test::Draw draw(32);
  int n_touch = 0, n_just = 0, n_denied = 0;
  for (int trial = 0; trial < test::draws(200000); ++trial) {
    const double size = std::pow(10.0, draw.integer(0, 1) ? draw.uniform(-16, -8) : draw.uniform(-8, 0.5));
    const RodByWall rod(draw, draw.integer(0, 9) ? draw.integer(0, 1) ? size : -size : 0.0);
    const double overlap = rod.overlap(rod.pose());
    const bool may = may_touch_walls(rod.walls, rod.box_side, rod.species, rod.pose());
    n_touch += overlap > 0;
    n_just += overlap > 0 && overlap < 1e-10;
    n_denied += !may;
    ASSERT_FALSE(overlap > 0 && !may) << "trial " << trial << " overlap " << overlap;
    // at outer walls nothing but rounding is given away
    ASSERT_FALSE(overlap < -1e-6 && rod.walls.arena != Arena::kAnnulus && may) << "trial " << trial;
  }
  EXPECT_GT(n_touch, test::draws(50000));
  EXPECT_GT(n_just, test::draws(10000));
  EXPECT_GT(n_denied, test::draws(30000));
}

TEST(MayTouchWalls, OfARodThatADiscHasNoRoomFor) {
  const Species sphere = make_species({.length = 1.2, .mid_diameter = 1.2, .end_diameter = 1.2, .n_beads = 1});
  const Pose pose{Vec3(1.5, 1.5, 0.6), Vec3::UnitX()};
  for (const auto& [name, arena] : kArenaNames) {
    if (arena == Arena::kAnnulus) continue;
    const SideWalls walls{arena, 1.0, 0.1, {}, arena == Arena::kStadium ? 0.5 : 1.0};
    Flight flight;
    flight.position = pose.position;
    EXPECT_TRUE(may_touch_walls(walls, 3, sphere, pose));
    EXPECT_EQ(wall_safe_time(walls, 3, sphere, pose, flight, 1.0, 0), 0);
  }
}

/// One rod in weightless flight between walls that take nothing from it.
System elastic_rod_within(const SideWalls& walls) {
  System system;
  system.walls = walls;
  system.walls->contact = {0.0, 1.0};
  system.box_side = 42;
  system.n_rods = 1;
  system.gravity = 0;
  system.base = system.lid = false;
  system.start = Start::kRandom;
  system.impacts = ImpactTime::kAtInstant;
  return system;
}

TEST(SideWalls, ARodThatBouncesWithoutLossKeepsItsEnergyAndStaysWithin) {
  for (const auto& [name, arena] : kArenaNames) {
    const double length = arena == Arena::kStadium ? 20 : 40;
    System system = elastic_rod_within({.arena = arena, .size = 20, .inner = 4, .length = length, .narrow = 1});
    system.rod = {.length = 3.0, .n_beads = 9, .profile = Profile::kPolar};
    system.dt = 1e-5;
    auto simulation = test::good(Simulation::start(system));
    World world = simulation->world();
    world.rods[0].velocity = Vec3(70, 50, 0);
    world.rods[0].precession = Vec3(0, 0, 30);
    world.rods[0].prepare();
    world.start = content(world);
    Simulation flying = Simulation::start_from(world);
    const double energy = content(world).energy;
    const Species& rod = world.species[0];
    for (int part = 1; part <= 500; ++part) {
      ASSERT_FALSE(flying.advance_to(1000 * part).has_value());
      const Snapshot now = flying.snapshot();
      for (int b = 0; b < rod.n_beads(); ++b) {
        const Vec3 bead = now.position[0] + rod.bead_offset[b] * now.director[0];
        ASSERT_GT(distance_to_walls(*system.walls, 42, bead), rod.bead_radius[b] - 1e-6) << name << " " << part;
      }
      ASSERT_NEAR(content(flying.world()).energy / energy, 1, 1e-11) << name << " " << part;
    }
    EXPECT_GT(flying.world().counters.impulses_rod_wall, 10) << name;
  }
}

// What leaves a focus of an ellipse passes through the other, whichever way it goes, and then through the first again.
// The wall of the sphere's centre is no ellipse, but nearly one, for the sphere is small.
TEST(SideWalls, AnEllipseSendsASmallSphereFromFocusToFocus) {
  constexpr double kDiameter = 2e-2, kSpeed = 100;
  System system = elastic_rod_within({.arena = Arena::kEllipse, .size = 24, .length = 40});
  system.rod = {.length = kDiameter, .mid_diameter = kDiameter, .end_diameter = kDiameter, .n_beads = 1};
  const Vec3 middle(21, 21, 0.6), foci[] = {middle + Vec3(16, 0, 0), middle - Vec3(16, 0, 0)};
  for (const double angle : {0.3, 1.2, 2.0, 3.0, 4.5}) {
    Simulation simulation = test::flying(system, {{foci[0], kSpeed * Vec3(std::cos(angle), std::sin(angle), 0)}});
    for (int bounce = 1; bounce <= 2; ++bounce) {  // each way is as long as the long axis
      ASSERT_FALSE(simulation.advance_to(static_cast<Tick>(bounce * 40 / kSpeed / system.dt)).has_value());
      EXPECT_EQ(simulation.world().counters.impulses_rod_wall, bounce);
      EXPECT_LT((simulation.snapshot().position[0] - foci[bounce % 2]).norm(), bounce == 1 ? 2 * kDiameter : 0.4)
          << angle << " " << bounce;
    }
  }
}

// Two spheres in weightless flight along a channel, which meet beyond its border.
TEST(SideWalls, AChannelGoesOnAcrossTheBorder) {
  System system;
  system.rod = {.length = 1.0, .mid_diameter = 1.0, .end_diameter = 1.0, .n_beads = 1};
  system.walls = SideWalls{.arena = Arena::kChannel, .size = 5};
  system.box_side = 12;
  system.box_aspect = 0.6;
  system.n_rods = 2;
  system.gravity = 0;
  system.base = system.lid = false;
  system.rod_rod = {0.0, 1.0};
  Simulation simulation =
      test::flying(system, {{Vec3(10, 3.6, 0.6), Vec3(40, 0, 0)}, {Vec3(4, 3.6, 0.6), Vec3(-40, 0, 0)}});
  // they touch after 2.5 mm each, and are then 1.5 mm on the other side of the border, or short of it
  ASSERT_FALSE(simulation.advance_to(static_cast<Tick>(0.1 / system.dt)).has_value());
  const World& now = simulation.world();
  EXPECT_EQ(now.counters.impulses_rod_rod, 1);
  EXPECT_EQ(now.counters.impulses_rod_wall, 0);
  EXPECT_NEAR(now.rods[0].velocity.x(), -40, 1e-9);
  EXPECT_NEAR(now.rods[1].velocity.x(), 40, 1e-9);
  const Snapshot shown = simulation.snapshot();
  EXPECT_NEAR(shown.position[0].x() + 12.0 * shown.image[0][0], 10 + 2.5 - 1.5, 1e-3);
  EXPECT_NEAR(shown.position[1].x() + 12.0 * shown.image[1][0], 4 - 2.5 + 1.5, 1e-3);
}

}  // namespace side_walls_test
}  // namespace shaken
