// Errors of G2(r) and of the cuts through its map, through the adapters that a run uses.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <utility>

#include "run/measure/measurements.h"

namespace shaken::run {
namespace pair_errors_test {

constexpr double kDt = 1e-3;
constexpr int kSamples = 320, kRuns = 60;

scene::RunPlan plan() {
  scene::RunPlan p;
  p.system.dt = kDt;
  p.system.box_side = 20;
  p.steady = 0.0;
  p.g2 = scene::MeasureG2{kDt, 20};
  p.pairs = scene::MeasurePairs{kDt, 11, 0};
  return p;
}

/// Rods anywhere and any way about a director that G2 has to know, independent from sample to sample.
Snapshot gas(Tick tick, std::mt19937_64& rng) {
  std::uniform_real_distribution<double> place(0, 20);
  std::normal_distribution<double> angle(0, 0.5);
  Snapshot s;
  s.tick = tick;
  s.time = static_cast<double>(tick) * kDt;
  s.box = 20;
  for (int i = 0; i < 60; ++i) {
    const double theta = angle(rng);
    s.position.emplace_back(place(rng), place(rng), 0.6);
    s.director.emplace_back(std::cos(theta), std::sin(theta), 0);
    s.velocity.emplace_back(0, 0, 0);
    s.angular_velocity.emplace_back(0, 0, 0);
    s.image.push_back({0, 0});
  }
  return s;
}

TEST(PairErrors, AreTheScatterOfIndependentRuns) {
  // <cos 2 (theta_i - theta_j)> of two independent Gaussian angles of variance 1/4 is exp(-4 x 1/4)
  const double g2 = std::exp(-1.0);
  std::vector<std::pair<std::string, double>> known{{"/g2/g2", g2},
                                                    {"/g2/g", 1.0},
                                                    {"/pairs/cut/g2_along", g2},
                                                    {"/pairs/cut/g2_across", g2},
                                                    {"/pairs/cut/g_along", 1.0},
                                                    {"/pairs/cut/g_across", 1.0}};
  std::map<std::string, double> chi2, n;
  for (int run = 0; run < kRuns; ++run) {
    std::mt19937_64 rng(static_cast<std::uint64_t>(run) + 1);
    Measurements measurements(plan());
    for (Tick tick = 0; tick < kSamples; ++tick) measurements.sample(gas(tick, rng));
    const Reduction reduction = measurements.reduce(kSamples * kDt);
    for (const auto& [path, expected] : known) {
      const auto &values = reduction.arrays.at(path), &errors = reduction.arrays.at(path + "_sem");
      ASSERT_EQ(values.size(), errors.size()) << path;
      // the smallest rings hold too few pairs for a Gaussian error
      for (std::size_t k = values.size() / 4; k < values.size(); ++k) {
        chi2[path] += std::pow((values[k] - expected) / errors[k], 2);
        n[path] += 1;
      }
    }
  }
  // Noise is taken for correlation now and then, which makes errors a tenth too large.
  for (const auto& [path, sum] : chi2) {
    EXPECT_GT(sum / n[path], 0.7) << path;
    EXPECT_LT(sum / n[path], 1.3) << path;
  }
}

}  // namespace pair_errors_test
}  // namespace shaken::run
