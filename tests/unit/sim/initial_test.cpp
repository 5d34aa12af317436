#include "sim/start/initial.h"

#include <gtest/gtest.h>

#include <tuple>

#include "base/core/sincos.h"
#include "sim/balance.h"
#include "sim/simulation.h"
#include "tests/support/free_rods.h"
#include "tests/support/good.h"

namespace shaken {
namespace {

System scene_at(double length, double area_fraction, double side, Start start = Start::kAligned) {
  return test::scene_at(length, area_fraction, side, start);
}

Result<std::vector<Flight>> flights_of(const System& system) {
  const World world = empty_world(system);
  return initial_flights(system, world.species, world.shape_of_rod);
}

void expect_free(const System& system, const std::vector<Flight>& flights) {
  World world = empty_world(system);
  world.rods = flights;
  test::expect_free(world);
}

TEST(InitialFlights, AlignedReaches085ForAllLengths) {
  for (const double length : {2.5, 3.0, 3.5, 4.0, 4.5}) {
    for (const double fraction : {0.45, 0.70, 0.85}) {
      const System system = scene_at(length, fraction, 41.865);
      SCOPED_TRACE(testing::Message() << "l = " << length << ", area fraction " << fraction);
      const auto flights = test::good(flights_of(system));
      expect_free(system, *flights);
      for (const Flight& flight : *flights) EXPECT_EQ(flight.director.y(), 0.0);
    }
  }
}

// Wide and high ones: rows along x, at an angle, and at random.
TEST(InitialFlights, FillRectangles) {
  for (const double aspect : {0.3, 0.5, 2.0, 6.0}) {
    for (const auto& [start, angle, fraction] :
         {std::tuple(Start::kAligned, 0.0, 0.85), {Start::kAligned, 30.0, 0.7}, {Start::kRandom, 0.0, 0.3}}) {
      System system = scene_at(4.5, fraction, 22 / std::min(1.0, aspect), start);
      system.box_aspect = aspect;
      system.start_angle = angle;
      system.n_rods = static_cast<int>(std::round(system.n_rods * aspect));
      SCOPED_TRACE(testing::Message() << "aspect " << aspect << ", angle " << angle << ", area fraction " << fraction);
      const auto flights = test::good(flights_of(system));
      expect_free(system, *flights);
      Vec2 reached = Vec2::Zero();
      for (const Flight& flight : *flights) reached = reached.cwiseMax(flight.position.head<2>());
      EXPECT_GT(reached.x(), 0.75 * system.box().x());
      EXPECT_GT(reached.y(), 0.85 * system.box().y());
    }
  }
}

// 4.5 mm go four times into 22 mm, and four millimetres are left over: rows that close in themselves hold fewer rods.
TEST(InitialFlights, RowsWindAroundABoxThatNoWholeNumberFills) {
  for (double side = 16; side < 26; side += 0.5) {
    const System system = scene_at(4.5, 0.85, side);
    SCOPED_TRACE(testing::Message() << side << " mm");
    const auto flights = flights_of(system);
    if (side == 22) {
      ASSERT_TRUE(static_cast<bool>(flights)) << flights.error().message;
    }
    if (flights) expect_free(system, *flights);
  }
}

TEST(InitialFlights, AtAnAngleReaches085WithoutASeam) {
  for (const double side : {33.492, 41.865}) {
    for (const double angle : {30.0, -30.0, 17.3, 45.0, 90.0}) {
      System system = scene_at(3.5, 0.85, side);
      system.start_angle = angle;
      SCOPED_TRACE(testing::Message() << side << " mm, " << angle << " degrees");
      const auto flights = test::good(flights_of(system));
      expect_free(system, *flights);
      const SinCos along = sincos(angle * kPi / 180.0);
      for (const Flight& flight : *flights) {
        EXPECT_NEAR(flight.director.x() * along.sin, flight.director.y() * along.cos, 1e-12) << "exactly as asked";
        EXPECT_GE(flight.position.x(), 0);
        EXPECT_LT(flight.position.x(), side);
      }
    }
  }
}

TEST(InitialFlights, AtAnAngleHaveRoomForPolarRodsAndOtherSpecies) {
  System system = scene_at(3.5, 0.3, 25);
  system.start_angle = 40;
  system.rod.profile = Profile::kPolar;
  system.added[0] = AddedRods{{.length = 2.5, .mid_diameter = 0.9, .n_beads = 11}, 40};
  const auto flights = test::good(flights_of(system));  // which itself looks for overlaps
  int n_back = 0;
  for (const Flight& flight : *flights) n_back += flight.director.x() < 0;
  EXPECT_GT(n_back, 10) << "polar rods point either way";
}

/// The number that a refusal says can be placed.
int promised(const System& system, const std::string& before = "in rows at most ") {
  const auto flights = flights_of(system);
  if (flights) return -1;
  const std::string& message = flights.error().message;
  const std::size_t at = message.find(before);
  return at == std::string::npos ? -1 : std::stoi(message.substr(at + before.size()));
}

TEST(InitialFlights, AtAnAngleAreRefusedWithTheMostThatFit) {
  System system = scene_at(4.5, 1.02, 25);
  system.start_angle = 30;
  const int most = promised(system, "in rows of rods at 30 degrees at most ");
  EXPECT_GT(most, 0.85 * system.n_rods / 1.02);
  system.n_rods = most;
  EXPECT_TRUE(static_cast<bool>(flights_of(system)));
  system.n_rods = most + 1;
  EXPECT_FALSE(static_cast<bool>(flights_of(system)));
  system = scene_at(4.5, 0.5, 25);
  system.start_angle = 30;
  system.walls = SideWalls{};
  EXPECT_FALSE(static_cast<bool>(flights_of(system)));
}

TEST(InitialFlights, RandomStartIsFreeAndIsotropic) {
  const System system = scene_at(2.5, 0.35, 60, Start::kRandom);
  const auto flights = test::good(flights_of(system));
  expect_free(system, *flights);
  double c = 0, s = 0;
  for (const Flight& flight : *flights) {
    c += flight.director.x() * flight.director.x() - flight.director.y() * flight.director.y();
    s += 2 * flight.director.x() * flight.director.y();
  }
  const double n = static_cast<double>(flights->size());
  EXPECT_LT(std::hypot(c, s) / n, 4 / std::sqrt(n));  // 0 within 4 / sqrt(N)
}

TEST(InitialFlights, WhatDoesNotFitIsRefusedWithTheLargestFraction) {
  for (const Start start : {Start::kAligned, Start::kRandom}) {
    const System system = scene_at(4.5, start == Start::kAligned ? 0.99 : 0.75, 25, start);
    const auto flights = flights_of(system);
    ASSERT_FALSE(static_cast<bool>(flights));
    const std::string telling = start == Start::kAligned ? "in rows at most " : "no room for another after ";
    EXPECT_NE(flights.error().message.find(telling), std::string::npos) << flights.error().message;
  }
}

TEST(InitialFlights, TheMostThatIsPromisedCanBePlacedAndNotOneMore) {
  for (const auto& [name, arena] : kArenaNames) {
    for (double size = 13.26; size < 34; size += 1.3) {
      System system = scene_at(4.5, 0.5, size + 1);
      system.walls = SideWalls{arena, size, 4.0, {}, 0.4 * size, 0.2 * size};
      if (system.walls->has_length()) system.walls->size = 0.6 * size;
      if (arena == Arena::kEllipse || arena == Arena::kWedge) system.walls->length = size;
      SCOPED_TRACE(testing::Message() << name << " of " << size << " mm");
      system.n_rods = 1000;
      const int most = promised(system);
      ASSERT_GT(most, 0);
      system.n_rods = most;
      const auto flights = test::good(flights_of(system));
      expect_free(system, *flights);
      system.n_rods = most + 1;
      EXPECT_EQ(promised(system), most) << "one more than is promised";
    }
  }
  System periodic = scene_at(4.5, 1.1, 25);
  const int most = promised(periodic);
  periodic.n_rods = most;
  EXPECT_TRUE(static_cast<bool>(flights_of(periodic)));
  periodic.n_rods = most + 1;
  EXPECT_EQ(promised(periodic), most);
}

}  // namespace
}  // namespace shaken
