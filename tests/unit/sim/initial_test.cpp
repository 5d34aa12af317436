// SPDX-License-Identifier: MIT
#include "sim/initial.h"

#include <gtest/gtest.h>

#include "sim/contact/bead_contacts.h"
#include "sim/neighbors/neighbor_list.h"
#include "sim/world.h"

namespace shaken {
namespace {

Scene scene_at(double length, double area_fraction, double side, Start start = Start::kAligned) {
  Scene scene;
  scene.rod.length = length;
  scene.rod.n_beads = beads_for_pitch(length, scene.rod.end_diameter, 0.3);
  scene.box_side = side;
  scene.start = start;
  scene.n_rods = static_cast<int>(std::round(area_fraction * side * side / make_species(scene.rod).area));
  return scene;
}

/// Every pair, no neighbour list: nothing touches, nothing sticks into a plate.
Result<std::vector<Flight>> flights_of(const Scene& scene) {
  const World world = empty_world(scene);
  return initial_flights(scene, world.species, world.kinds);
}

void expect_free(const Scene& scene, const std::vector<Flight>& flights) {
  const Species species = make_species(scene.rod);
  ASSERT_EQ(static_cast<int>(flights.size()), scene.n_rods);
  std::vector<BeadContact> contacts;
  for (std::size_t i = 0; i < flights.size(); ++i) {
    for (int b = 0; b < species.n_beads(); ++b) {
      const double z = flights[i].position.z() + species.bead_offset[b] * flights[i].director.z();
      EXPECT_GT(z - species.bead_radius[b], 2 * scene.amplitude);
      EXPECT_LT(z + species.bead_radius[b], 2 * scene.amplitude + scene.gap);
    }
    for (std::size_t j = i + 1; j < flights.size(); ++j) {
      find_bead_contacts(species, flights[i].director, species, flights[j].director,
                         nearest_image(flights[i].position, flights[j].position, scene.box_side), contacts);
    }
  }
  EXPECT_TRUE(contacts.empty()) << contacts.size() << " overlaps";
}

TEST(InitialFlights, AlignedReaches085ForAllLengths) {
  for (const double length : {2.5, 3.0, 3.5, 4.0, 4.5}) {
    for (const double fraction : {0.45, 0.70, 0.85}) {
      const Scene scene = scene_at(length, fraction, 41.865);
      SCOPED_TRACE(testing::Message() << "l = " << length << ", area fraction " << fraction);
      const auto flights = flights_of(scene);
      ASSERT_TRUE(static_cast<bool>(flights)) << flights.error().message;
      expect_free(scene, *flights);
      for (const Flight& flight : *flights) EXPECT_EQ(flight.director.y(), 0.0);
    }
  }
}

TEST(InitialFlights, FullSizeOfThePaper) {
  const Scene scene = scene_at(4.5, 0.85, 83.73);
  const auto flights = flights_of(scene);
  ASSERT_TRUE(static_cast<bool>(flights)) << flights.error().message;
  EXPECT_NEAR(flights->size(), 2400, 50);
}

TEST(InitialFlights, RandomStartIsFreeAndIsotropic) {
  const Scene scene = scene_at(2.5, 0.35, 60, Start::kRandom);
  const auto flights = flights_of(scene);
  ASSERT_TRUE(static_cast<bool>(flights)) << flights.error().message;
  expect_free(scene, *flights);
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
    const Scene scene = scene_at(4.5, start == Start::kAligned ? 0.99 : 0.75, 25, start);
    const auto flights = flights_of(scene);
    ASSERT_FALSE(static_cast<bool>(flights));
    const std::string telling = start == Start::kAligned ? "in rows at most " : "no room for another after ";
    EXPECT_NE(flights.error().message.find(telling), std::string::npos) << flights.error().message;
  }
}

/// The number that a refusal says can be placed.
int promised(const Scene& scene) {
  const auto flights = flights_of(scene);
  if (flights) return -1;
  const std::string& message = flights.error().message;
  const std::string before = "in rows at most ";
  const std::size_t at = message.find(before);
  return at == std::string::npos ? -1 : std::stoi(message.substr(at + before.size()));
}

TEST(InitialFlights, TheMostThatIsPromisedCanBePlacedAndNotOneMore) {
  for (const Arena arena : {Arena::kDisc, Arena::kSquare, Arena::kAnnulus}) {
    for (double size = 13.26; size < 34; size += 1.3) {
      Scene scene = scene_at(4.5, 0.5, size + 1);
      scene.walls = SideWalls{arena, size, 4.0, {}};
      SCOPED_TRACE(testing::Message() << "arena " << static_cast<int>(arena) << " of " << size << " mm");
      scene.n_rods = 1000;
      const int most = promised(scene);
      ASSERT_GT(most, 0);
      scene.n_rods = most;
      const auto flights = flights_of(scene);
      ASSERT_TRUE(static_cast<bool>(flights)) << flights.error().message;
      expect_free(scene, *flights);
      scene.n_rods = most + 1;
      EXPECT_EQ(promised(scene), most) << "one more than is promised";
    }
  }
  Scene periodic = scene_at(4.5, 1.1, 25);
  const int most = promised(periodic);
  periodic.n_rods = most;
  EXPECT_TRUE(static_cast<bool>(flights_of(periodic)));
  periodic.n_rods = most + 1;
  EXPECT_EQ(promised(periodic), most);
}

TEST(InitialFlights, DependOnTheSeedAlone) {
  Scene scene = scene_at(4.5, 0.6, 25);
  const Species species = make_species(scene.rod);
  const auto first = flights_of(scene);
  const auto again = flights_of(scene);
  scene.seed = 2;
  const auto other = flights_of(scene);
  EXPECT_EQ((*first)[5].velocity, (*again)[5].velocity);
  EXPECT_NE((*first)[5].velocity, (*other)[5].velocity);
}

}  // namespace
}  // namespace shaken
