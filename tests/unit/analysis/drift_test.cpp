#include "analysis/drift.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace shaken::analysis {
namespace {

// Rods that move at random about a common motion of (3, -1) mm/s, with a vibration of 10 Hz on top of it.
struct DriftingRods {
  Drift drift;
  std::vector<Vec3> start, now;

  explicit DriftingRods(int n_samples) {
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 50; ++i) start.emplace_back(normal(random), normal(random), normal(random));
    for (int k = 0; k < n_samples; ++k) {
      const double time = 5 + 0.02 * k;
      now = start;
      for (Vec3& place : now) {
        place += time * Vec3(3, -1, 0) + Vec3(0, 0.3 * std::sin(20 * kPi * time), 0);
        place += 0.1 * Vec3(normal(random), normal(random), normal(random));
      }
      drift.accumulate(time, now);
    }
  }
};

TEST(Drift, IsTheMeanVelocityOfAllRods) {
  const DriftingRods rods(1001);  // 200 vibrations
  const Vec2 velocity = rods.drift.statistics().all().reduce();
  EXPECT_NEAR(velocity.x(), 3, 0.01);
  EXPECT_NEAR(velocity.y(), -1, 0.01);
  // slow twin: from the first sample to the last
  Vec2 last = Vec2::Zero();
  for (std::size_t i = 0; i < rods.now.size(); ++i) last += rods.now[i].head<2>() / 50;
  EXPECT_NEAR(rods.drift.x().back() - rods.drift.x().front(), velocity.x() * 20, 1e-9);
  EXPECT_NEAR(rods.drift.y().back() - rods.drift.y().front(), velocity.y() * 20, 1e-9);
  EXPECT_EQ(rods.drift.x().front(), 0);
  EXPECT_EQ(rods.drift.times().size(), 1001u);
}

TEST(Drift, OfASingleSampleHasNoVelocity) {
  const DriftingRods rods(1);
  EXPECT_TRUE(std::isnan(rods.drift.statistics().all().reduce().x()));
  EXPECT_EQ(rods.drift.x(), std::vector<double>{0});
}

}  // namespace
}  // namespace shaken::analysis
