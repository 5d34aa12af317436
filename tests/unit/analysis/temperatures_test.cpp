#include "analysis/temperatures.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/analysis/analysis_samples.h"

namespace shaken::analysis {
namespace {

constexpr RodInertia kBrass{.mass = 12, .across = 18, .along = 0.7};

double of(const Temperatures& temperatures, Freedom freedom) { return temperatures[static_cast<std::size_t>(freedom)]; }

struct Rods {
  std::vector<Vec3> directors, velocities, angular_velocities;
  std::vector<RodInertia> inertias{kBrass};
  Temperatures temperatures() const {
    return granular_temperatures(directors, velocities, angular_velocities, inertias);
  }
};

// By hand: two rods along x and y, and one upright.
TEST(Temperatures, OfAFewRodsByHand) {
  Rods rods{{Vec3(1, 0, 0), Vec3(0, 1, 0)}, {Vec3(1, 2, 3), Vec3(-1, 4, 9)}, {Vec3(1, 2, 3), Vec3(4, 5, 6)}};
  Temperatures found = rods.temperatures();  // velocities less their mean: +-(1, -1, -3)
  EXPECT_NEAR(of(found, Freedom::kHorizontal), 12 * (2 + 2) / 2.0, 1e-12);
  EXPECT_NEAR(of(found, Freedom::kVertical), 12 * (9 + 9), 1e-12);
  EXPECT_NEAR(of(found, Freedom::kAlong), 12 * (1 + 1), 1e-12);
  EXPECT_NEAR(of(found, Freedom::kAcross), 12 * (1 + 1), 1e-12);
  EXPECT_NEAR(of(found, Freedom::kTurning), 18 * (9 + 36) / 2.0, 1e-12);
  EXPECT_NEAR(of(found, Freedom::kTipping), 18 * (4 + 16) / 2.0, 1e-12);
  EXPECT_NEAR(of(found, Freedom::kSpinning), 0.7 * (1 + 25) / 2.0, 1e-12);
  EXPECT_NEAR(of(found, Freedom::kRotation), (18 * (13 + 52) + 0.7 * 26) / 2 / 3, 1e-12);
  // An upright rod with the mean velocity: it counts where no direction in the plane is needed.
  rods.directors.push_back(Vec3(0, 0, -1));
  rods.velocities.push_back(Vec3(0, 3, 6));
  rods.angular_velocities.push_back(Vec3(1, 1, 2));
  found = rods.temperatures();
  EXPECT_NEAR(of(found, Freedom::kVertical), 12 * 18 / 2.0, 1e-12);
  EXPECT_NEAR(of(found, Freedom::kAlong), 12 * 1.5 * (1 + 1) / 2.0, 1e-12);
  EXPECT_NEAR(of(found, Freedom::kTurning), 18 * (9 + 36) / 2.0, 1e-12);
  EXPECT_NEAR(of(found, Freedom::kSpinning), 0.7 * (1 + 25 + 4) / 3.0, 1e-12);
  EXPECT_NEAR(of(found, Freedom::kRotation), (18 * (13 + 52 + 2) + 0.7 * 30) / 3 / 3, 1e-12);
}

// Three rods at 5, 0 and 13 mm/s in the plane, and all of them twice as fast in a second sample.
TEST(Temperatures, SpeedsAreThoseOfInstantsInThePlane) {
  TemperatureStatistics statistics;
  EXPECT_TRUE(std::isnan(statistics.speeds().rms));
  const std::vector<Vec3> velocities{{3, -4, 100}, {0, 0, -7}, {5, 12, 1}};
  statistics.accumulate({}, velocities);
  EXPECT_DOUBLE_EQ(statistics.speeds().mean, 6);
  EXPECT_DOUBLE_EQ(statistics.speeds().rms, std::sqrt((25 + 169) / 3.0));
  std::vector<Vec3> faster = velocities;
  for (Vec3& velocity : faster) velocity *= 2;
  statistics.accumulate({}, faster);
  EXPECT_DOUBLE_EQ(statistics.speeds().mean, 9);
  EXPECT_DOUBLE_EQ(statistics.speeds().rms, std::sqrt((25 + 169) / 3.0 * 5 / 2));
}

// Slow twin: the energy of all motion relative to the centre of mass is half the sum of the temperatures of its
// freedoms.
void expect_sum_of_energy(Rods rods, Draw& draw) {
  const std::size_t kRods = rods.directors.size();
  const auto inertia_of = [&](std::size_t i) { return rods.inertias.size() == 1 ? kBrass : rods.inertias[i]; };
  for (std::size_t i = 0; i < kRods; ++i) {
    rods.velocities.push_back(Vec3(draw.normal(), draw.normal(), draw.normal()));
    rods.angular_velocities.push_back(Vec3(draw.normal(), draw.normal(), draw.normal()));
  }
  Vec3 mean = Vec3::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < kRods; ++i) {
    mean += inertia_of(i).mass * rods.velocities[i];
    mass += inertia_of(i).mass;
  }
  mean /= mass;
  double translation = 0, rotation = 0;
  for (std::size_t i = 0; i < kRods; ++i) {
    const auto [m, across, along] = inertia_of(i);
    translation += m * (rods.velocities[i] - mean).squaredNorm() / 2;
    const Vec3& n = rods.directors[i];
    const Mat3 inertia = across * (Mat3::Identity() - n * n.transpose()) + along * n * n.transpose();
    rotation += rods.angular_velocities[i].dot(inertia * rods.angular_velocities[i]) / 2;
  }
  const Temperatures found = rods.temperatures();
  EXPECT_NEAR((2 * of(found, Freedom::kHorizontal) + of(found, Freedom::kVertical)) / 2,
              translation / (static_cast<double>(kRods) - 1), 1e-12 * translation);
  EXPECT_NEAR(of(found, Freedom::kAlong) + of(found, Freedom::kAcross), 2 * of(found, Freedom::kHorizontal), 1e-11);
  EXPECT_NEAR(of(found, Freedom::kTurning) + of(found, Freedom::kTipping) + of(found, Freedom::kSpinning),
              2 * rotation / static_cast<double>(kRods), 1e-12 * rotation);
  EXPECT_NEAR(3 * of(found, Freedom::kRotation), 2 * rotation / static_cast<double>(kRods), 1e-12 * rotation);
}

TEST(Temperatures, AddUpToTheEnergy) {
  Draw draw(302);
  Rods rods{random_axes(draw, 30), {}, {}};
  expect_sum_of_energy(rods, draw);
  rods.inertias.clear();
  for (int i = 0; i < 30; ++i)
    rods.inertias.push_back({draw.uniform(2, 20), draw.uniform(5, 30), draw.uniform(0.2, 2)});
  expect_sum_of_energy(rods, draw);
}

// In equilibrium all freedoms of light and heavy rods have the same temperature, however few the rods.
TEST(Temperatures, OfRodsThatDifferAreUnbiased) {
  constexpr int kRepeats = 40000;
  constexpr double kTemperature = 3;
  Draw draw(304);
  TemperatureStatistics statistics;
  for (int i = 0; i < kRepeats; ++i) {
    Rods rods{{axis(0.3), axis(2), axis(-1, 0.5)}, {}, {}, {{2, 5, 0.1}, {10, 15, 0.6}, {30, 60, 2}}};
    // those of a closed system at rest: the velocity of the centre of mass is taken off
    Vec3 momentum = Vec3::Zero();
    for (const RodInertia& rod : rods.inertias) {
      const auto normal = [&] { return Vec3(draw.normal(), draw.normal(), draw.normal()); };
      rods.velocities.push_back(std::sqrt(kTemperature / rod.mass) * normal());
      momentum += rod.mass * rods.velocities.back();
      const Vec3& n = rods.directors[rods.angular_velocities.size()];
      const Vec3 w = std::sqrt(kTemperature / rod.across) * normal();
      rods.angular_velocities.push_back(w - w.dot(n) * n + std::sqrt(kTemperature / rod.along) * draw.normal() * n);
    }
    for (Vec3& v : rods.velocities) v -= momentum / 42;
    statistics.accumulate(rods.temperatures(), rods.velocities);
  }
  const Temperatures found = statistics.reduce();
  for (const Freedom freedom : {Freedom::kHorizontal, Freedom::kVertical, Freedom::kTurning, Freedom::kTipping,
                                Freedom::kSpinning, Freedom::kRotation}) {
    EXPECT_NEAR(of(found, freedom), kTemperature, 4.5 * kTemperature * std::sqrt(1.0 / kRepeats))
        << static_cast<int>(freedom);
  }
}

// What the mean takes of the fluctuations of few rods is made up for.
TEST(Temperatures, OfFewRodsAreUnbiased) {
  constexpr int kRepeats = 40000;
  Draw draw(303);
  TemperatureStatistics statistics;
  for (int i = 0; i < kRepeats; ++i) {
    Rods rods{{axis(0.3), axis(2), axis(-1, 0.5)}, {}, std::vector<Vec3>(3, Vec3::Zero())};
    for (int k = 0; k < 3; ++k) rods.velocities.push_back(Vec3(draw.normal(), draw.normal(), draw.normal()));
    statistics.accumulate(rods.temperatures(), rods.velocities);
  }
  const Temperatures found = statistics.reduce();
  for (const Freedom freedom : {Freedom::kHorizontal, Freedom::kVertical, Freedom::kAlong, Freedom::kAcross}) {
    EXPECT_NEAR(of(found, freedom), kBrass.mass, 4.5 * kBrass.mass / std::sqrt(kRepeats));
  }
}

TEST(Temperatures, OfASingleRodAreOfRotation) {
  const Rods rods{{axis(1)}, {Vec3(1, 2, 3)}, {Vec3(0, 0, 2)}};
  const Temperatures found = rods.temperatures();
  EXPECT_TRUE(std::isnan(of(found, Freedom::kHorizontal)));
  EXPECT_TRUE(std::isnan(of(found, Freedom::kAlong)));
  EXPECT_NEAR(of(found, Freedom::kTurning), 18 * 4, 1e-12);
  EXPECT_THROW(granular_temperatures(rods.directors, {}, rods.angular_velocities, std::span(&kBrass, 1)),
               std::logic_error);
}

TEST(TemperatureSeries, KeepsEachByItself) {
  TemperatureSeries series;
  series.accumulate(1, {0, 1, 2, 3, 4, 5, 6, 7});
  series.accumulate(2, {10, 11, 12, 13, 14, 15, 16, 17});
  EXPECT_EQ(series.times(), (std::vector<double>{1, 2}));
  EXPECT_EQ(series.of(Freedom::kTurning), (std::vector<double>{4, 14}));
  EXPECT_EQ(series.of(Freedom::kRotation), (std::vector<double>{7, 17}));
}

TEST(TemperatureStatistics, AreMeans) {
  TemperatureStatistics two;
  two.accumulate({1, 2, 3, 4, 5, 6, 7, 8}, std::vector{Vec3(3, 4, 5)});
  two.accumulate({3, 4, 5, 6, 7, 8, 9, 10}, std::vector{Vec3(1, 0, 9)});
  EXPECT_EQ(two.reduce(), (Temperatures{2, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(two.speeds().mean, 3);
  EXPECT_TRUE(std::isnan(TemperatureStatistics().reduce()[0]));
}

}  // namespace
}  // namespace shaken::analysis
