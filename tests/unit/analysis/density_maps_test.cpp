#include "analysis/density_maps.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/system.h"
#include "tests/unit/analysis/analysis_samples.h"

namespace shaken::analysis {
namespace {

constexpr double kStep = 0.1;

Grid grid_of(int columns, int rows) {
  Grid grid(columns);
  grid.rows = rows;
  return grid;
}

// The slow twin: every rod of every sample, in a box that is not square, wherever its image is.
TEST(DensityMaps, AreTheMeanNumbersInTheCells) {
  Draw draw(71);
  const Box box(20, 12);
  DensityMaps maps(box, grid_of(5, 4), kStep, 3);
  std::vector<double> expected(2 * 20);
  for (std::size_t k = 0; k < 8; ++k) {  // two maps, and two samples of a third
    std::vector<Vec3> places = random_places(draw, 50, box);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto cell = static_cast<std::size_t>(places[i].y() / 3) * 5 + static_cast<std::size_t>(places[i].x() / 4);
      if (k < 6) expected[k / 3 * 20 + cell] += 1 / 3.0 / 12 / (50 / 240.0);
      places[i] += Vec3(20.0 * static_cast<double>(i % 3), -12.0 * static_cast<double>(i % 2), 0);
    }
    maps.accumulate(static_cast<double>(k) * kStep, places);
  }
  ASSERT_EQ(maps.times().size(), 2u);
  EXPECT_NEAR(maps.times()[0], 0.1, 1e-12);
  EXPECT_NEAR(maps.times()[1], 0.4, 1e-12);
  ASSERT_EQ(maps.densities().size(), expected.size());
  double square = 0, of_mean = 0;
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_NEAR(maps.densities()[k], expected[k], 1e-9);
    square += std::pow(expected[k] - 1, 2) / 40;
    if (k < 20) of_mean += std::pow((expected[k] + expected[k + 20]) / 2 - 1, 2) / 20;
  }
  const DensitySummary all = maps.reduce(0);
  EXPECT_NEAR(all.variance.value, square, 1e-9);
  EXPECT_NEAR(all.variance_of_mean.value, of_mean, 1e-9);
  EXPECT_NEAR(all.mean[7], (expected[7] + expected[27]) / 2, 1e-9);
  EXPECT_NEAR(maps.reduce(0.25).mean[7], expected[27], 1e-9) << "the map that begins at 0.3 s";
  EXPECT_TRUE(std::isnan(maps.reduce(0.35).mean[7])) << "it has begun before";
}

// Rods in the middle of a disc only: means over cells are weighted by what of each lies within the wall.
TEST(DensityMaps, CellsCountByTheirArea) {
  Draw draw(76);
  const Region region(Box(40), SideWalls{Arena::kDisc, 38});
  DensityMaps maps(region, Grid(10), kStep, 1);
  std::vector<Vec3> places;
  while (places.size() < 3000) {
    const Vec3 place(draw.uniform(10, 30), draw.uniform(10, 30), 0);
    if (std::hypot(place.x() - 20, place.y() - 20) < 10) places.push_back(place);
  }
  maps.accumulate(0, places);
  std::vector<double> inside(100);
  for (int k = 0; k < 2000000; ++k) {
    const Vec2 place(draw.uniform(0, 40), draw.uniform(0, 40));
    if ((place - Vec2(20, 20)).norm() < 19) {
      inside[static_cast<std::size_t>(place.y() / 4) * 10 + static_cast<std::size_t>(place.x() / 4)] += 1;
    }
  }
  double weighted = 0, weight = 0, plain = 0, cells = 0;
  for (std::size_t cell = 0; cell < 100; ++cell) {
    const double density = maps.densities()[cell];
    EXPECT_EQ(std::isnan(density), inside[cell] < 0.1 * 2000000 / 100) << cell;
    if (std::isnan(density)) continue;
    weighted += inside[cell] * std::pow(density - 1, 2);
    weight += inside[cell];
    plain += std::pow(density - 1, 2);
    cells += 1;
  }
  const double variance = maps.reduce(0).variance.value;
  EXPECT_NEAR(variance, weighted / weight, 0.01 * variance);
  EXPECT_GT(std::abs(variance - plain / cells), 0.05 * variance) << "or else the weights would not matter here";
}

// Independent rods: the variance is one over the number that a cell counts; nothing stays, and nothing is remembered.
TEST(DensityMaps, OfIndependentRodsVaryAsAGasDoes) {
  Draw draw(73);
  DensityMaps maps(Box(20), Grid(10), kStep, 2);
  for (int k = 0; k < 800; ++k) maps.accumulate(k * kStep, random_places(draw, 400, Box(20)));
  const DensitySummary summary = maps.reduce(0);
  EXPECT_NEAR(summary.variance.value, 0.99 / 8, 5 * summary.variance.sem);
  EXPECT_LT(summary.variance.sem, 2e-3);
  EXPECT_LT(summary.variance_of_mean.value, 1e-3);
  EXPECT_EQ(summary.correlation.value[0], 1);
  EXPECT_NEAR(summary.lag[1], 0.2, 1e-12);
  double chi2 = 0;
  for (std::size_t k = 1; k < summary.lag.size(); ++k) {
    chi2 += std::pow(summary.correlation.value[k] / summary.correlation.sem[k], 2);
  }
  EXPECT_NEAR(chi2 / static_cast<double>(summary.lag.size() - 1), 1, 0.5);
}

// Each rod stays with probability a until the next sample: the map forgets as a^k.
TEST(DensityMaps, ForgetAsTheRodsDo) {
  Draw draw(74);
  DensityMaps maps(Box(20), Grid(10), kStep, 1);
  std::vector<Vec3> places = random_places(draw, 400, Box(20));
  constexpr double kStays = 0.9;
  for (int k = 0; k < 4000; ++k) {
    for (Vec3& place : places) {
      if (draw.uniform(0, 1) > kStays) place = Vec3(draw.uniform(0, 20), draw.uniform(0, 20), 0);
    }
    maps.accumulate(k * kStep, places);
  }
  const DensitySummary summary = maps.reduce(0);
  for (std::size_t k = 1; k < 20; ++k) {
    EXPECT_NEAR(summary.correlation.value[k], std::pow(kStays, k), 5 * summary.correlation.sem[k] + 1e-3);
    EXPECT_LT(summary.correlation.sem[k], 0.02);
  }
  EXPECT_NEAR(summary.correlation_time.value, -kStep / std::log(kStays), 5 * summary.correlation_time.sem);
  EXPECT_LT(summary.correlation_time.sem, 0.05);
}

}  // namespace
}  // namespace shaken::analysis
