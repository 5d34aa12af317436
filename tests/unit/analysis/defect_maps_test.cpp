#include "analysis/defect_maps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "analysis/geometry/director_field.h"
#include "sim/system.h"
#include "tests/unit/analysis/analysis_samples.h"

namespace shaken::analysis {
namespace defect_maps_test {

constexpr double kBox = 60.0, kRange = 8.0, kCore = 2.0, kStep = 0.1;
constexpr int kBins = 21;
const DefectMapSums::Shape kShape{kBins, kRange, kCore};

Vec2 turned(const Vec2& a, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * a.x() - s * a.y(), s * a.x() + c * a.y()};
}

/// Rods at an instant, and the velocity of each.
struct Flow {
  std::vector<Vec3> positions, directors;
  std::vector<Vec2> velocities;

  std::vector<Vec3> after(double time) const {
    std::vector<Vec3> places = positions;
    for (std::size_t i = 0; i < places.size(); ++i) places[i].head<2>() += time * velocities[i];
    return places;
  }
};

/// What the rods have about a defect of this charge at `core`: theta = charge phi + theta_0, so that the director is
/// radial at phi = theta_0 / (1 - charge), in which frame they move by `velocity`.
Flow about_defect(Draw& draw, std::size_t n, const Region& region, const Vec2& core, double charge, double theta_0,
                  const std::function<Vec2(const Vec2&)>& velocity) {
  const double psi = theta_0 / (1 - charge);
  Flow flow;
  while (flow.positions.size() < n) {
    const Vec2 place(draw.uniform(0, kBox), draw.uniform(0, kBox));
    if (!region.contains(place)) continue;
    const Vec2 way = place - core;
    flow.positions.emplace_back(place.x(), place.y(), 0.5);
    flow.directors.push_back(axis(charge * std::atan2(way.y(), way.x()) + theta_0, 0.1 * place.x() / kBox));
    flow.velocities.push_back(turned(velocity(turned(way, -psi)), psi));
  }
  return flow;
}

/// Three samples of rods that move on, the middle one as they are.
void accumulate(DefectMaps& maps, double time, const Flow& flow, std::span<const Defect> defects,
                const Region& region) {
  for (const int k : {-1, 0, 1}) {
    maps.accumulate(time + k * kStep, k == 0 ? flow.positions : flow.after(1e3), flow.after(k * kStep), flow.directors,
                    k == 0 ? defects : std::span<const Defect>(), region);
  }
}

DefectMapSums maps_of(const Flow& flow, std::span<const Defect> defects, const Region& region) {
  DefectMaps maps(kShape);
  accumulate(maps, 1, flow, defects, region);
  return maps.sums().all();
}

/// The map of a field whose direction is found from the rods, turned by any angle: the map is the field in its own
/// frame. With the head of +1/2 taken for its tail, or one of the other signs, cosines and velocities have the wrong
/// sign.
void expect_own_frame(double charge, double allowed_angle, const std::function<Vec2(const Vec2&)>& velocity) {
  Draw draw(61);
  const Region region(kBox, SideWalls{Arena::kDisc, kBox - 1});
  for (int trial = 0; trial < 6; ++trial) {
    const Vec2 core(kBox / 2 + draw.uniform(-9, 9), kBox / 2 + draw.uniform(-9, 9));
    const double theta_0 = draw.uniform(-kPi / 2, kPi / 2), psi = theta_0 / (1 - charge);
    const Flow flow = about_defect(draw, 12000, region, core, charge, theta_0, velocity);
    const std::vector<Defect> found =
        find_defects(DirectorField(flow.positions, flow.directors, region, Grid(kBox, 0.5), 1.5));
    ASSERT_EQ(found.size(), 1u);
    ASSERT_EQ(found[0].charge, charge);
    ASSERT_LT((found[0].position - core).norm(), 0.5);
    ASSERT_NEAR(std::remainder(found[0].direction - psi, kPi / (1 - charge)), 0, allowed_angle);

    const DefectMapSums sums = maps_of(flow, found, region);
    const DefectMap map = charge > 0 ? sums.plus() : sums.minus();
    const DefectMap none = charge > 0 ? sums.minus() : sums.plus();
    EXPECT_EQ(map.defects, 1);
    EXPECT_EQ(none.defects, 0);
    EXPECT_TRUE(std::isnan(none.density[kBins * kBins / 2]));
    const std::vector<double> at = sums.centres();
    int known = 0;
    double off = 0, speed_off = 0, density = 0;
    for (std::size_t row = 0; row < kBins; ++row) {
      for (std::size_t column = 0; column < kBins; ++column) {
        const Vec2 place(at[column], at[row]);
        const std::size_t bin = row * kBins + column;
        if (std::isnan(map.density[bin])) {
          EXPECT_GT(place.norm(), kRange - kRange / kBins * std::sqrt(2.0) - 1e-9);
          EXPECT_TRUE(std::isnan(map.cos2[bin]) && std::isnan(map.v_along[bin]) && std::isnan(map.tilt2[bin]));
          continue;
        }
        density += map.density[bin];
        ++known;
        if (place.norm() < 3) continue;  // a bin sees many directions there
        const double phi = 2 * charge * std::atan2(place.y(), place.x());
        off = std::max(off, std::hypot(map.cos2[bin] - std::cos(phi), map.sin2[bin] - std::sin(phi)));
        speed_off = std::max(speed_off, (Vec2(map.v_along[bin], map.v_across[bin]) - velocity(place)).norm());
      }
    }
    EXPECT_LT(off, 0.45) << "half a bin away, at the core";
    EXPECT_LT(speed_off, 0.8);
    EXPECT_NEAR(density / known, 1, 0.1);
    EXPECT_NEAR(map.core_density, 1, 0.5);
  }
}

TEST(DefectMaps, OfPlusHaveTheTailAlongX) {
  expect_own_frame(0.5, 0.1, [](const Vec2& p) { return Vec2(-3 + 0.25 * p.x(), 0.25 * p.y()); });
}

TEST(DefectMaps, OfMinusAreThreefold) {
  expect_own_frame(-0.5, 0.1,
                   [](const Vec2& p) { return Vec2(0.05 * Vec2(p.x() * p.x() - p.y() * p.y(), -2 * p.x() * p.y())); });
}

// Rods that move from head to tail have a positive velocity along, about the core too.
TEST(DefectMaps, TheFlowThroughTheCore) {
  Draw draw(62);
  const Region region(kBox);
  const Vec2 core(25, 35);
  const double psi = 2.2;
  const Flow flow = about_defect(draw, 40000, region, core, 0.5, psi / 2, [](const Vec2&) { return Vec2(2, -1); });
  const std::vector<Defect> defects{{core, 0.5, psi}};
  const DefectMap map = maps_of(flow, defects, region).plus();
  EXPECT_NEAR(map.core_along, 2, 1e-9);
  EXPECT_NEAR(map.core_across, -1, 1e-9);
  const std::size_t middle = kBins * kBins / 2;
  EXPECT_GT(map.cos2[middle + kBins / 3], 0.9) << "radial on the tail's side";
  EXPECT_LT(map.cos2[middle - kBins / 3], -0.9) << "across before the head";
}

// The slow twin: every rod, its nearest image among nine, each bin by itself.
TEST(DefectMaps, AreTheMeansOverTheRodsOfEachBin) {
  Draw draw(63);
  const Box box(20, 17);
  constexpr std::size_t kRods = 300;
  Flow flow{random_places(draw, kRods, box), random_axes(draw, kRods), {}};
  for (std::size_t i = 0; i < kRods; ++i) flow.velocities.emplace_back(draw.normal(), draw.normal());
  std::vector<Defect> defects;
  for (const double charge : {0.5, -0.5, 0.5, -0.5, 1.0}) {
    defects.push_back({{draw.uniform(0, 20), draw.uniform(0, 17)}, charge, draw.uniform(-1, 1)});
  }
  const DefectMapSums sums = maps_of(flow, defects, box);
  const double width = 2 * kRange / kBins, of_bin = kRods / box.area() * width * width;
  for (const double charge : {0.5, -0.5}) {
    const DefectMap map = charge > 0 ? sums.plus() : sums.minus();
    EXPECT_EQ(map.defects, 2);
    double in_core = 0;
    std::vector<double> rods(kBins * kBins), cosines(rods), along(rods), tilt(rods);
    const int n_rays = charge > 0 ? 1 : 3;
    for (const Defect& defect : defects) {
      if (defect.charge != charge) continue;
      for (int ray = 0; ray < n_rays; ++ray) {
        const double psi = defect.direction + 2 * kPi / n_rays * ray;
        for (std::size_t i = 0; i < kRods; ++i) {
          for (int image = 0; image < 9; ++image) {
            const Vec2 shift((image % 3 - 1) * 20.0, (image / 3 - 1) * 17.0);
            const Vec2 way = turned(flow.positions[i].head<2>() + shift - defect.position, -psi);
            if (way.norm() >= kRange) continue;
            if (way.norm() < kCore) in_core += 1;
            const auto bin = static_cast<std::size_t>((way.y() + kRange) / width) * kBins +
                             static_cast<std::size_t>((way.x() + kRange) / width);
            const double theta = std::atan2(flow.directors[i].y(), flow.directors[i].x());
            rods[bin] += 1;
            cosines[bin] += std::cos(2 * (theta - psi));
            along[bin] += turned(flow.velocities[i], -psi).x();
            tilt[bin] += flow.directors[i].z() * flow.directors[i].z();
          }
        }
      }
    }
    for (std::size_t bin = 0; bin < rods.size(); ++bin) {
      if (std::isnan(map.density[bin])) continue;
      EXPECT_NEAR(map.density[bin], rods[bin] / (2 * n_rays * of_bin), 1e-9);
      EXPECT_EQ(std::isnan(map.cos2[bin]), rods[bin] == 0);
      if (rods[bin] == 0) continue;
      EXPECT_NEAR(map.cos2[bin], cosines[bin] / rods[bin], 1e-9);
      EXPECT_NEAR(map.v_along[bin], along[bin] / rods[bin], 1e-9);
      EXPECT_NEAR(map.tilt2[bin], tilt[bin] / rods[bin], 1e-12);
    }
    EXPECT_NEAR(map.core_density, in_core / (2 * n_rays * kRods / box.area() * kPi * kCore * kCore), 1e-9);
  }
}

// A gas has the same density wherever there is room, beside walls and behind the inner one of a ring.
TEST(DefectMaps, TheDensityIsThatOfTheRoomWithinTheWalls) {
  Draw draw(65);
  struct Place {
    SideWalls walls;
    Vec2 core;
  };
  for (const Place& place : {Place{{Arena::kDisc, 50}, {51, 33}}, Place{{Arena::kSquare, 50}, {8, 9}},
                             Place{{Arena::kAnnulus, 50, 8}, {30, 35}}, Place{{Arena::kChannel, 50}, {59, 6}}}) {
    const Region region(kBox, place.walls);
    const Flow flow = about_defect(draw, 60000, region, place.core, 0.5, 0.8, [](const Vec2&) { return Vec2(0, 0); });
    const DefectMap map = maps_of(flow, std::vector<Defect>{{place.core, 0.5, 1.6}}, region).plus();
    double rods = 0, bins = 0;
    for (const double density : map.density) {
      if (std::isnan(density)) continue;
      rods += density;
      bins += 1;
    }
    EXPECT_NEAR(rods / bins, 1, 0.06) << static_cast<int>(place.walls.arena);
    EXPECT_NEAR(map.core_density, 1, 0.15);
    EXPECT_LT(bins, 0.8 * kPi / 4 * kBins * kBins) << "none beyond the walls";
  }
}

// Behind the inner wall of a ring: 6.5 mm away, in the annulus, out of sight.
TEST(DefectMaps, WhatAWallHidesIsUnknown) {
  Draw draw(68);
  const Region ring(kBox, SideWalls{Arena::kAnnulus, 50, 8});
  const Vec2 core(30, 35), hidden(4.6, -4.6), seen(4.6, 4.6);
  ASSERT_TRUE(ring.contains(core + hidden));
  const Flow flow = about_defect(draw, 60000, ring, core, 0.5, 0, [](const Vec2&) { return Vec2(0, 0); });
  const DefectMap map = maps_of(flow, std::vector<Defect>{{core, 0.5, 0}}, ring).plus();
  const auto density_at = [&](const Vec2& way) {
    const double width = 2 * kRange / kBins;
    return map.density[static_cast<std::size_t>((way.y() + kRange) / width) * kBins +
                       static_cast<std::size_t>((way.x() + kRange) / width)];
  };
  EXPECT_TRUE(std::isnan(density_at(hidden)));
  EXPECT_GT(density_at(seen), 0.3);
}

// Of rods without any correlation too: the defects were found from those that are averaged about them.
TEST(DefectMaps, OfANoiseAreAsLargeAsItsSmoothing) {
  Draw draw(67);
  constexpr double kSmoothing = 1.5;
  DefectMaps maps({16, kRange, kSmoothing});
  for (int k = 0; k < 60; ++k) {
    const std::vector<Vec3> places = random_places(draw, 2500, kBox), axes = random_axes(draw, 2500);
    const auto found = find_defects(DirectorField(places, axes, Region(kBox), Grid(kBox, 0.5), kSmoothing));
    maps.accumulate(k * kStep, places, places, axes, lone_defects(found, 2 * kSmoothing, Region(kBox)), Region(kBox));
  }
  const DefectMap map = maps.sums().all().plus();
  EXPECT_GT(map.defects, 500);
  const auto cosine = [&](std::size_t column) { return (map.cos2[7 * 16 + column] + map.cos2[8 * 16 + column]) / 2; };
  EXPECT_GT(cosine(9), 0.1) << "1.5 mm towards the tail";
  EXPECT_LT(cosine(6), -0.1) << "1.5 mm before the head";
  EXPECT_NEAR(cosine(14), 0, 0.07) << "6.5 mm away";
}

TEST(LoneDefects, AreFarFromAllOthers) {
  const std::vector<Defect> defects{{{1, 1}, 0.5, 0}, {{59, 1}, -0.5, 0}, {{30, 30}, 0.5, 0}, {{35, 30}, 0.5, 0}};
  const auto lone_at = [&](double separation) { return lone_defects(defects, separation, Region(kBox)).size(); };
  EXPECT_EQ(lone_at(1.9), 4u);
  EXPECT_EQ(lone_at(2.1), 2u) << "two are neighbours across the border";
  EXPECT_EQ(lone_at(5.1), 0u);
  EXPECT_EQ(lone_defects(defects, 2.1, Region(kBox, SideWalls{Arena::kSquare, kBox})).size(), 4u);
}

// Displacements over two intervals, at the place and time of the sample in the middle: the first and the last sample
// have none.
TEST(DefectMaps, TakeVelocitiesAboutTheSampleInTheMiddle) {
  const std::vector<Vec3> axes{axis(0.3)};
  DefectMaps maps(kShape);
  for (int k = 0; k < 5; ++k) {
    const std::vector<Vec3> place{{10.0 + k * k, 10, 0}};  // 2 k intervals along x
    maps.accumulate(k * kStep, place, place, axes, std::vector<Defect>{{{10.0 + k * k, 10}, 0.5, 0}}, Region(kBox));
  }
  const DefectMapSums sums = maps.sums().all();
  EXPECT_EQ(sums.samples(), 3);
  EXPECT_EQ(sums.plus().defects, 3);
  EXPECT_NEAR(sums.plus().core_along, 2 * (1 + 2 + 3) / 3.0 / kStep, 1e-9);
  EXPECT_EQ(maps.sums().after(2 * kStep).samples(), 2);
}

}  // namespace defect_maps_test
}  // namespace shaken::analysis
