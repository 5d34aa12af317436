#include "sim/start/compression.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>
#include <utility>

#include "sim/balance.h"
#include "sim/checkpoint.h"
#include "sim/simulation.h"
#include "sim/start/director_patterns.h"
#include "sim/start/initial.h"
#include "tests/support/free_rods.h"
#include "tests/support/good.h"

namespace shaken {
namespace {

System scene_at(double length, double area_fraction, double side, std::uint64_t seed = 1) {
  return test::scene_at(length, area_fraction, side, Start::kCompressed, seed);
}

/// S^2 from the directions in the plane.
double order_squared(const World& world) {
  double c = 0, s = 0;
  for (const Flight& rod : world.rods) {
    const Vec2 along = rod.director.head<2>().normalized();
    c += along.x() * along.x() - along.y() * along.y();
    s += 2 * along.x() * along.y();
  }
  const double n = static_cast<double>(world.rods.size());
  return (c * c + s * s) / (n * n);
}

// Rods that lie at random have <S^2> = 1 / N. Rods this dense lie side by side with some of their neighbours: N is
// then the number of such groups, about four rods each.
TEST(Compression, ReachesArea085FreeOfOverlapsAndAsDisorderedAsGroupsOfAFewRods) {
  for (const double length : {2.5, 3.5, 4.5}) {
    double sum = 0;
    int n_rods = 0;
    constexpr int kSeeds = 6;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      SCOPED_TRACE(testing::Message() << "l = " << length << ", seed " << seed);
      const auto world = test::good(make_compressed_world(scene_at(length, 0.85, 20, seed)));
      test::expect_free(*world);
      sum += order_squared(*world);
      n_rods = static_cast<int>(world->rods.size());
    }
    std::printf("l = %.1f mm: <S^2> N = %.1f\n", length, sum / kSeeds * n_rods);
    EXPECT_LT(sum / kSeeds * n_rods, 16) << "groups of a few rods";
    EXPECT_LT(std::sqrt(sum / kSeeds), 0.35);
  }
}

/// Mean of cos 2 delta of the rods whose places `is_counted`, delta being the angle to the director of their place.
template <class IsCounted>
double order_along(const World& world, const DirectorAt& directors, const IsCounted& is_counted) {
  double sum = 0, n = 0;
  for (const Flight& rod : world.rods) {
    const Vec2 place = rod.position.head<2>();
    if (!is_counted(place)) continue;
    const double cosine = rod.director.head<2>().normalized().dot(directors(place));
    sum += 2 * cosine * cosine - 1;
    n += 1;
  }
  return sum / n;
}

// Within a domain the order is that of a nematic: its rods, but for those within a rod length of a seam.
TEST(Compression, KeepsToTheDirectorsOfDomains) {
  for (const double fraction : {0.6, 0.85}) {
    for (const double aspect : {1.0, 0.5}) {
      for (const std::uint64_t seed : {1, 2}) {
        SCOPED_TRACE(testing::Message() << "area fraction " << fraction << ", aspect " << aspect << ", seed " << seed);
        System system = scene_at(2.5, fraction, 30 / std::sqrt(aspect), seed);
        system.box_aspect = aspect;
        system.n_rods = static_cast<int>(system.n_rods * aspect);
        system.start = Start::kPolydomain;
        const auto world = test::good(make_compressed_world(system));
        test::expect_free(*world);
        const DirectorAt directors = start_pattern(system);
        const auto is_inside = [&](const Vec2& place) {
          for (const Vec2& step : {Vec2(1, 0), Vec2(0, 1), Vec2(-1, 0), Vec2(0, -1)}) {
            if (directors(place + system.rod.length * step) != directors(place)) return false;
          }
          return true;
        };
        EXPECT_GT(order_along(*world, directors, is_inside), 0.98);
        EXPECT_LT(std::sqrt(order_squared(*world)), 0.35) << "domains point all ways";
      }
    }
  }
}

TEST(Compression, KeepsToTheDirectorsRoundAPairOfDefects) {
  for (const double angle : {0.0, 90.0}) {
    for (const std::uint64_t seed : {1, 2}) {
      System system = scene_at(3.5, 0.75, 33, seed);
      system.start = Start::kDefectPair;
      system.start_separation = 14;
      system.start_angle = angle;
      const auto world = test::good(make_compressed_world(system));
      test::expect_free(*world);
      EXPECT_GT(order_along(*world, start_pattern(system), [](const Vec2&) { return true; }), 0.95);
    }
  }
}

TEST(Compression, DependsOnTheSeedAlone) {
  const auto hash_of = [](const System& system) { return std::move(Simulation::start(system)).value().state_hash(); };
  for (const Start start : {Start::kCompressed, Start::kPolydomain, Start::kDefectPair}) {
    System system = scene_at(4.5, 0.7, 15);
    system.start = start;
    system.start_separation = 7.5;
    const std::uint64_t one = hash_of(system);
    EXPECT_EQ(hash_of(system), one);
    system.stepper = StepperKind::kReference;
    EXPECT_EQ(hash_of(system), one);
    system.seed = 2;
    EXPECT_NE(hash_of(system), one);
  }
}

TEST(Compression, VelocitiesAreThoseOfAnyStart) {
  System system = scene_at(2.5, 0.4, 30);
  const auto compressed = test::good(make_compressed_world(system));
  double v2 = 0, w2 = 0;
  const double n = static_cast<double>(compressed->rods.size());
  for (const Flight& rod : compressed->rods) {
    v2 += rod.velocity.squaredNorm() / (3 * n);
    w2 += rod.precession.squaredNorm() / (2 * n);
    EXPECT_NEAR(rod.precession.dot(rod.director), 0, 1e-9);
    EXPECT_EQ(rod.spin, 0);
  }
  EXPECT_NEAR(std::sqrt(v2), 20, 4 * 20 / std::sqrt(6 * n));
  EXPECT_NEAR(std::sqrt(w2), 5, 4 * 5 / std::sqrt(4 * n));
}

TEST(Compression, TakesSeveralSpeciesNarrowAndHighGapsAndScenesInThePlane) {
  System mixture = scene_at(3.5, 0.4, 20);
  mixture.rod.profile = Profile::kPolar;
  mixture.added = {AddedRods{{.length = 2.5, .n_beads = 9}, 30}, AddedRods{{.length = 0.8, .n_beads = 1}, 60}};
  System narrow = scene_at(3.5, 0.6, 15);
  narrow.gap = 0.801;
  System high = scene_at(3.5, 0.7, 15);
  high.gap = 20;
  high.lid = false;
  System planar = scene_at(3.5, 0.7, 15);
  planar.base = planar.lid = false;
  planar.gravity = 0;
  planar.amplitude = 0;
  System domains = mixture;
  domains.start = Start::kPolydomain;
  System defects = planar;
  defects.start = Start::kDefectPair;
  defects.start_separation = 7.5;
  for (const System& system : {mixture, narrow, high, planar, domains, defects}) {
    SCOPED_TRACE(testing::Message() << "a gap of " << system.gap << ", planar: " << system.is_planar());
    const auto world = test::good(make_compressed_world(system));
    test::expect_free(*world);
    for (const Flight& rod : world->rods) {
      EXPECT_NEAR(rod.position.z(), 2 * system.amplitude + 0.5 * system.gap, 0.4) << "in the middle of the gap";
      if (system.is_planar()) {
        EXPECT_EQ(rod.position.z(), world->rods[0].position.z());
        EXPECT_EQ(rod.director.z(), 0);
        EXPECT_EQ(rod.velocity.z(), 0);
      }
    }
  }
}

// In rows each site has room for the largest of all kinds: half long and half short rods reach 0.64, and with spheres
// in place of the short ones 0.3.
TEST(Compression, PacksMixturesAsDenselyAsOneKind) {
  System mixture = scene_at(4.5, 0.425, 25);
  for (const RodShape& other : {RodShape{.length = 2.5, .n_beads = 9}, RodShape{.length = 0.8, .n_beads = 1}}) {
    SCOPED_TRACE(testing::Message() << "with rods of " << other.length << " mm");
    mixture.added[0] = AddedRods{other, static_cast<int>(std::round(0.425 * 625 / make_species(other).area))};
    const auto world = test::good(make_compressed_world(mixture));
    test::expect_free(*world);
    System rows = mixture;
    rows.start = Start::kAligned;
    EXPECT_THAT(test::refusal(make_world(rows)),
                testing::HasSubstr("rods.start \"compressed\" packs mixtures more densely"));
  }
}

TEST(Compression, WhatItCannotDoItSays) {
  System system = scene_at(3.5, 0.5, 20);
  system.walls = SideWalls{Arena::kDisc, 19, 4, {}};
  EXPECT_EQ(make_compressed_world(system).error().message,
            "rods can be compressed in a periodic box only, without walls");
  // discs in a plane jam at random at 0.84, and in no order beyond 0.907
  System discs = scene_at(3.5, 0.5, 8);
  discs.rod = {.length = 0.8, .mid_diameter = 0.8, .end_diameter = 0.8, .n_beads = 1};
  discs.base = discs.lid = false;
  discs.gravity = discs.amplitude = 0;
  discs.n_rods = static_cast<int>(0.95 * 64 / make_species(discs.rod).area);
  EXPECT_THAT(test::refusal(make_compressed_world(discs)), testing::HasSubstr("the rods jammed at area fraction 0."));
}

TEST(Compression, IsGivenUpWhenAsked) {
  int n_asked = 0;
  const auto stopped = make_compressed_world(scene_at(3.5, 0.85, 20), [&] { return ++n_asked < 10; });
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().message, "stopped");
  EXPECT_EQ(n_asked, 10);
}

/// Rods that have been shaken for a tenth of a second.
Simulation shaken_at(double area_fraction, const System& base) {
  System system = base;
  system.n_rods = static_cast<int>(std::round(area_fraction * system.box().area() / make_species(system.rod).area));
  Simulation simulation = std::move(Simulation::start(system)).value();
  EXPECT_FALSE(simulation.advance_to(std::llround(0.1 / system.dt)));
  return simulation;
}

/// Mean of |n . n'|, and root mean square of how far centres have moved in units of the box.
std::pair<double, double> likeness(const Snapshot& then, const Snapshot& now) {
  double along = 0, moved = 0;
  for (std::size_t i = 0; i < then.n_rods(); ++i) {
    along += std::abs(then.director[i].dot(now.director[i]));
    for (int axis = 0; axis < 2; ++axis) {
      const double part = now.position[i][axis] / now.box[axis] - then.position[i][axis] / then.box[axis];
      moved += std::pow(part - std::round(part), 2);
    }
  }
  const auto n = static_cast<double>(then.n_rods());
  return {along / n, std::sqrt(moved / n)};
}

// A packing that changes: the same rods in a box of another side, with another gap, or both.
TEST(Resized, KeepsTheRodsWhereTheyAreInUnitsOfTheBox) {
  System base = scene_at(3.5, 0, 16);
  base.start = Start::kAligned;
  base.box_aspect = 1.5;
  for (const auto& [from, to, gap] :
       {std::tuple{0.6, 0.75, 1.2}, {0.6, 0.6, 1.0}, {0.6, 0.5, 1.4}, {0.75, 0.85, 1.0}, {0.85, 0.6, 1.2}}) {
    SCOPED_TRACE(testing::Message() << from << " to " << to << ", gap " << gap);
    const Simulation before = shaken_at(from, base);
    System system = before.world().system;
    system.box_side *= std::sqrt(from / to);
    system.gap = gap;
    const auto world = test::good(make_resized_world(system, before.world()));
    EXPECT_EQ(world->system, system);
    EXPECT_EQ(world->tick, 0);
    test::expect_free(*world);
    const auto [along, moved] = likeness(before.snapshot(), snapshot(*world));
    EXPECT_GT(along, 0.95);
    EXPECT_LT(moved, 0.06) << "a millimetre";
    EXPECT_EQ(world->start.energy, content(*world).energy);
    EXPECT_EQ(state_hash(*make_resized_world(system, before.world())), state_hash(*world));
    Simulation after = std::move(Simulation::start(system, before.world())).value();
    EXPECT_EQ(after.state_hash(), state_hash(*world));
    EXPECT_FALSE(after.advance_to(2500));
  }
}

TEST(Resized, IsRefusedWhereItCannotBe) {
  System base = scene_at(3.5, 0, 16);
  base.start = Start::kAligned;
  const Simulation before = shaken_at(0.6, base);
  const auto refusal = [&](const System& system, const GoOn& go_on = {}) {
    const auto world = make_resized_world(system, before.world(), go_on);
    return world ? std::string() : world.error().message;
  };
  System system = before.world().system;
  system.n_rods += 1;
  system.box_aspect = 2;
  EXPECT_EQ(refusal(system), "not the same as where the rods come from: their number, the shape of the box");
  system = before.world().system;
  system.box_side *= std::sqrt(0.6 / 1.6);
  const std::string jam = refusal(system);
  EXPECT_TRUE(jam.starts_with("the rods jammed at area fraction 1.")) << jam;
  EXPECT_EQ(refusal(system, [] { return false; }), "stopped");
}

}  // namespace
}  // namespace shaken
