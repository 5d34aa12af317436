// SPDX-License-Identifier: MIT
#include "sim/initial.h"

#include <gtest/gtest.h>

#include <tuple>

#include "base/core/sincos.h"
#include "sim/balance.h"
#include "sim/contact/bead_contacts.h"
#include "sim/neighbors/neighbor_list.h"
#include "sim/simulation.h"
#include "sim/world.h"

namespace shaken {
namespace {

System scene_at(double length, double area_fraction, double side, Start start = Start::kAligned) {
  System system;
  system.rod.length = length;
  system.rod.n_beads = beads_for_pitch(length, system.rod.end_diameter, 0.3);
  system.box_side = side;
  system.start = start;
  system.n_rods = static_cast<int>(std::round(area_fraction * side * side / make_species(system.rod).area));
  return system;
}

/// Every pair, no neighbour list: nothing touches, nothing sticks into a plate.
Result<std::vector<Flight>> flights_of(const System& system) {
  const World world = empty_world(system);
  return initial_flights(system, world.species, world.shape_of_rod);
}

void expect_free(const System& system, const std::vector<Flight>& flights) {
  const Species species = make_species(system.rod);
  ASSERT_EQ(static_cast<int>(flights.size()), system.n_rods);
  std::vector<BeadContact> contacts;
  for (std::size_t i = 0; i < flights.size(); ++i) {
    for (int b = 0; b < species.n_beads(); ++b) {
      const double z = flights[i].position.z() + species.bead_offset[b] * flights[i].director.z();
      EXPECT_GT(z - species.bead_radius[b], 2 * system.amplitude);
      EXPECT_LT(z + species.bead_radius[b], 2 * system.amplitude + system.gap);
    }
    for (std::size_t j = i + 1; j < flights.size(); ++j) {
      find_bead_contacts(species, flights[i].director, species, flights[j].director,
                         nearest_image(flights[i].position, flights[j].position, system.box()), contacts);
    }
  }
  EXPECT_TRUE(contacts.empty()) << contacts.size() << " overlaps";
}

TEST(InitialFlights, AlignedReaches085ForAllLengths) {
  for (const double length : {2.5, 3.0, 3.5, 4.0, 4.5}) {
    for (const double fraction : {0.45, 0.70, 0.85}) {
      const System system = scene_at(length, fraction, 41.865);
      SCOPED_TRACE(testing::Message() << "l = " << length << ", area fraction " << fraction);
      const auto flights = flights_of(system);
      ASSERT_TRUE(static_cast<bool>(flights)) << flights.error().message;
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
      const auto flights = flights_of(system);
      ASSERT_TRUE(static_cast<bool>(flights)) << flights.error().message;
      expect_free(system, *flights);
      Vec2 reached = Vec2::Zero();
      for (const Flight& flight : *flights) reached = reached.cwiseMax(flight.position.head<2>());
      EXPECT_GT(reached.x(), 0.75 * system.box().x());
      EXPECT_GT(reached.y(), 0.85 * system.box().y());
    }
  }
}

TEST(InitialFlights, FullSizeOfThePaper) {
  const System system = scene_at(4.5, 0.85, 83.73);
  const auto flights = flights_of(system);
  ASSERT_TRUE(static_cast<bool>(flights)) << flights.error().message;
  EXPECT_NEAR(flights->size(), 2400, 50);
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
      const auto flights = flights_of(system);
      ASSERT_TRUE(static_cast<bool>(flights)) << flights.error().message;
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
  const World world = empty_world(system);
  const auto flights = initial_flights(system, world.species, world.shape_of_rod);
  ASSERT_TRUE(static_cast<bool>(flights)) << flights.error().message;  // which itself looks for overlaps
  int n_back = 0;
  for (const Flight& flight : *flights) n_back += flight.director.x() < 0;
  EXPECT_GT(n_back, 10) << "polar rods point either way";
}

TEST(InitialFlights, AtAnAngleAreRefusedWithTheMostThatFit) {
  System system = scene_at(4.5, 1.02, 25);
  system.start_angle = 30;
  const auto flights = flights_of(system);
  ASSERT_FALSE(static_cast<bool>(flights));
  const std::string before = "in rows of rods at 30 degrees at most ";
  const std::size_t at = flights.error().message.find(before);
  ASSERT_NE(at, std::string::npos) << flights.error().message;
  const int most = std::stoi(flights.error().message.substr(at + before.size()));
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
  const auto flights = flights_of(system);
  ASSERT_TRUE(static_cast<bool>(flights)) << flights.error().message;
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

/// The number that a refusal says can be placed.
int promised(const System& system) {
  const auto flights = flights_of(system);
  if (flights) return -1;
  const std::string& message = flights.error().message;
  const std::string before = "in rows at most ";
  const std::size_t at = message.find(before);
  return at == std::string::npos ? -1 : std::stoi(message.substr(at + before.size()));
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
      const auto flights = flights_of(system);
      ASSERT_TRUE(static_cast<bool>(flights)) << flights.error().message;
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

TEST(InitialFlights, DependOnTheSeedAlone) {
  System system = scene_at(4.5, 0.6, 25);
  const Species species = make_species(system.rod);
  const auto first = flights_of(system);
  const auto again = flights_of(system);
  system.seed = 2;
  const auto other = flights_of(system);
  EXPECT_EQ((*first)[5].velocity, (*again)[5].velocity);
  EXPECT_NE((*first)[5].velocity, (*other)[5].velocity);
}

/// Rods of two species that have been shaken for `periods` vibrations of the plates.
Simulation shaken_for(double periods) {
  System system = scene_at(2.5, 0.4, 16);
  system.rod.n_beads = 7;
  system.added[0] = AddedRods{system.rod, 9};
  system.added[0]->rod.end_diameter = 0.5;
  Simulation simulation = std::move(Simulation::start(system)).value();
  const double ticks = periods / (system.frequency * system.dt);
  EXPECT_FALSE(simulation.advance_to(static_cast<Tick>(std::llround(ticks))));
  return simulation;
}

TEST(MakeWorld, FromAnotherKeepsWhereRodsAreAndHowTheyMove) {
  const Simulation before = shaken_for(10);
  System system = before.world().system;
  system.amplitude *= 1.5;
  system.dt *= 0.5;
  const auto made = make_world(system, before.world());
  ASSERT_TRUE(made) << made.error().message;
  const World& world = *made;
  EXPECT_EQ(world.tick, 0);
  EXPECT_EQ(world.shape_of_rod, before.world().shape_of_rod);
  const Snapshot then = before.snapshot();
  const Snapshot now = snapshot(world);
  for (std::size_t i = 0; i < now.n_rods(); ++i) {
    Vec3 moved = now.position[i] - then.position[i];
    for (const int x : {0, 1}) moved[x] -= system.box_side * std::round(moved[x] / system.box_side);
    // the base, which begins at the top of its travel, has risen by twice what the amplitude has grown
    EXPECT_NEAR((moved - Vec3(0, 0, 2 * (system.amplitude - before.world().system.amplitude))).norm(), 0, 1e-9);
    EXPECT_NEAR((now.velocity[i] - then.velocity[i]).norm(), 0, 1e-9);
    EXPECT_NEAR((now.director[i] - then.director[i]).norm(), 0, 1e-12);
    EXPECT_NEAR((now.angular_velocity[i] - then.angular_velocity[i]).norm(), 0, 1e-9);
  }
  const Content left = content(before.world());
  const double lifted = content(world).energy - left.energy;
  EXPECT_GT(lifted, 0);
  EXPECT_EQ(world.start.energy, content(world).energy) << "its budget begins with what it has";
}

TEST(MakeWorld, FromAnotherUnderTheSameConditionsGoesOnAsThatDoes) {
  Simulation one = shaken_for(10);
  Simulation other = std::move(Simulation::start(one.world().system, one.world())).value();
  const Tick ticks = 100;
  const std::int64_t hits_before = one.world().counters.impulses_rod_base;
  ASSERT_FALSE(one.advance_to(one.tick() + ticks));
  ASSERT_FALSE(other.advance_to(ticks));
  EXPECT_GT(one.world().counters.impulses_rod_base, hits_before) << "something happens meanwhile";
  EXPECT_EQ(other.world().counters.impulses_rod_base, one.world().counters.impulses_rod_base - hits_before);
  const Snapshot a = one.snapshot(), b = other.snapshot();
  for (std::size_t i = 0; i < a.n_rods(); ++i) {
    EXPECT_NEAR((a.director[i] - b.director[i]).norm(), 0, 1e-6) << i;
    EXPECT_NEAR(a.position[i].z(), b.position[i].z(), 1e-6) << i;
  }
}

TEST(MakeWorld, FromAnotherKeepsTheSpeciesOfEachRodWhateverTheSeed) {
  const Simulation before = shaken_for(1);
  System system = before.world().system;
  system.seed += 1;
  const World world = std::move(make_world(system, before.world())).value();
  EXPECT_NE(world.shape_of_rod, before.world().shape_of_rod);
  const auto heights = [](const World& of, std::uint8_t species) {
    std::vector<double> all;
    const Snapshot rods = snapshot(of);
    for (std::size_t i = 0; i < of.rods.size(); ++i) {
      if (of.shape_of_rod[i] == species) all.push_back(rods.position[i].z());
    }
    return all;
  };
  for (const std::uint8_t species : {0, 1}) {
    const auto now = heights(world, species), then = heights(before.world(), species);
    ASSERT_EQ(now.size(), then.size());
    for (std::size_t k = 0; k < now.size(); ++k) EXPECT_NEAR(now[k], then[k], 1e-9);
  }
}

TEST(MakeWorld, ReplicasFromOneStateGoTheirOwnWays) {
  System system = scene_at(2.5, 0.4, 16);
  Simulation alike = std::move(Simulation::start(system)).value();
  ASSERT_FALSE(alike.advance_to(12500));
  std::vector<Simulation> replicas;
  for (const std::uint64_t seed : {system.seed, system.seed + 1, system.seed + 2}) {
    system.seed = seed;
    replicas.push_back(std::move(Simulation::start(system, alike.world())).value());
    EXPECT_NEAR(replicas.back().world().start.energy / replicas.front().world().start.energy, 1, 1e-5);
    EXPECT_FALSE(replicas.back().advance_to(125000));  // half a second
  }
  const auto mean_angle = [&](std::size_t one, std::size_t other) {
    const Snapshot a = replicas[one].snapshot(), b = replicas[other].snapshot();
    double sum = 0;
    for (std::size_t i = 0; i < a.n_rods(); ++i)
      sum += std::asin(std::min(1.0, a.director[i].cross(b.director[i]).norm()));
    return sum / static_cast<double>(a.n_rods());
  };
  for (const auto& [one, other] : {std::pair<std::size_t, std::size_t>{0, 1}, {0, 2}, {1, 2}}) {
    EXPECT_GT(mean_angle(one, other), 0.1) << one << " and " << other;
  }
}

TEST(MakeWorld, FromAnotherThatDoesNotFitIsRefused) {
  const auto refusal = [](const World& left, const System& system) {
    const auto world = make_world(system, left);
    return world ? std::string() : world.error().message;
  };
  const Simulation before = shaken_for(2);
  System system = before.world().system;
  system.gap += 0.1;
  system.rod.length += 0.1;
  system.lid = false;
  EXPECT_EQ(refusal(before.world(), system),
            "not the same as where the rods come from: the rods, the plates that are there")
      << "another gap would do";
  system = before.world().system;
  system.walls = SideWalls{};
  EXPECT_EQ(refusal(before.world(), system), "not the same as where the rods come from: the walls");
  const Simulation half = shaken_for(2.25);
  EXPECT_EQ(refusal(half.world(), half.world().system),
            "its plates are in the middle of a vibration at 0.011252 s and would jump; the nearest whole one is at "
            "0.01 s");
}

// 200 and 300 Hz come together after each 10 ms. Of plates that only the second moves, its periods alone count.
TEST(OffTheBeat, CountsEveryVibrationThatIsThere) {
  System system;
  system.dt = 5e-6;  // 1,000 ticks of the first
  system.frequency = 200;
  EXPECT_EQ(off_the_beat(system, 1000), 0);
  system.second = SecondVibration{0.01, 300, 20};
  EXPECT_NEAR(std::abs(off_the_beat(system, 1000)), 5.0 / 3000, 1e-12);
  EXPECT_NEAR(off_the_beat(system, 2000), 0, 1e-12);
  EXPECT_EQ(nearest_beat(system, 1000), "both vibrations, of 200 and 300 Hz, must be whole ones there");
  system.amplitude = 0;
  system.second->frequency = 500;
  EXPECT_NEAR(off_the_beat(system, 400), 0, 1e-12);
  EXPECT_NEAR(off_the_beat(system, 500), 5e-4, 1e-12);
}

// A lid that is lower at the start of the next run might be in rods.
TEST(StartMismatch, IsOfLidsThatMoveInOtherWays) {
  System system;
  system.lid_motion = LidMotion{0.02, 30};
  System other = system;
  EXPECT_EQ(start_mismatch(system, other), "");
  other.lid_motion->phase = 40;
  EXPECT_EQ(start_mismatch(system, other), "how the lid moves");
  other = system;
  other.amplitude *= 2;
  EXPECT_EQ(start_mismatch(system, other), "how the lid moves");
  other.lid_motion.reset();
  EXPECT_EQ(start_mismatch(system, other), "how the lid moves");
  System plain, stronger;
  stronger.amplitude *= 2;
  EXPECT_EQ(start_mismatch(plain, stronger), "") << "a lid that moves with the base keeps its height over it";
}

}  // namespace
}  // namespace shaken
