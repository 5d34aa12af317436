#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "analysis/drift.h"
#include "analysis/rod_traces.h"
#include "tests/unit/analysis/analysis_samples.h"

namespace shaken::analysis {
namespace {

/// Rod i at (i, 2 i + time), angle 0.1 i - 1.
void sample(RodTraces& traces, double time, std::size_t n_rods) {
  std::vector<Vec3> places, directors;
  for (std::size_t i = 0; i < n_rods; ++i) {
    const auto x = static_cast<double>(i);
    places.push_back({x, 2 * x + time, 0.5});
    directors.push_back(axis(0.1 * x - 1, 0.01 * x));
  }
  traces.accumulate(time, places, directors);
}

TEST(RodTraces, KeepsRodsSpreadOverTheIndicesForTheDuration) {
  RodTraces traces(4, 0.3);
  for (int i = 7; i < 30; ++i) sample(traces, 0.1 * i, 21);
  ASSERT_EQ(traces.times().size(), 4u) << "begin and end included";
  EXPECT_DOUBLE_EQ(traces.times().front(), 0.7);
  EXPECT_DOUBLE_EQ(traces.times().back(), 1.0);
  ASSERT_EQ(traces.traces().size(), 4u);
  const double rods[] = {0, 5, 10, 15};
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(traces.traces()[k].x.at(i), rods[k]);
      EXPECT_EQ(traces.traces()[k].y.at(i), 2 * rods[k] + traces.times()[i]);
      EXPECT_NEAR(traces.traces()[k].theta.at(i), 0.1 * rods[k] - 1, 1e-12);
      EXPECT_EQ(traces.traces()[k].n_z.at(i), 0.01 * rods[k]);
    }
  }
}

TEST(RodTraces, FewAndUprightRods) {
  RodTraces traces(4, 10);
  traces.accumulate(0, std::vector<Vec3>(2, Vec3::Zero()), std::vector<Vec3>{{0, 0, 1}, {-1, 0, 0}});
  ASSERT_EQ(traces.traces().size(), 2u);
  EXPECT_TRUE(std::isnan(traces.traces()[0].theta[0]));
  EXPECT_EQ(traces.traces()[0].n_z[0], 1.0);
  EXPECT_DOUBLE_EQ(traces.traces()[1].theta[0], kPi);
  EXPECT_THROW(sample(traces, 1, 3), std::logic_error);
  RodTraces none(4, 10);
  sample(none, 0, 0);
  EXPECT_TRUE(none.traces().empty());
}

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
