#include "analysis/angles.h"

#include <gtest/gtest.h>

#include <cstring>
#include <numeric>

#include "tests/unit/analysis/analysis_samples.h"
#include "tests/unit/analysis/state_checks.h"

namespace shaken::analysis {
namespace {

double integral(const AnglePdf& pdf) {
  return std::accumulate(pdf.density.begin(), pdf.density.end(), 0.0) * kPi / static_cast<double>(pdf.density.size());
}

/// Rods at +-10 degrees from an axis at `director`, in equal numbers.
std::vector<Vec3> two_layers(double director) {
  std::vector<Vec3> rods;
  for (int i = 0; i < 100; ++i) rods.push_back(axis(director + (i % 2 == 0 ? 1 : -1) * kPi / 18));
  return rods;
}

TEST(AngleDistribution, BinsCoverTheHalfTurn) {
  const AnglePdf pdf = AngleDistribution(4).reduce();
  ASSERT_EQ(pdf.theta.size(), 4u);
  EXPECT_DOUBLE_EQ(pdf.theta[0], -3 * kPi / 8);
  EXPECT_DOUBLE_EQ(pdf.theta[3], 3 * kPi / 8);
  EXPECT_EQ(pdf.density, std::vector<double>(4, 0.0));
  EXPECT_THROW(AngleDistribution(0), std::logic_error);
}

TEST(AngleDistribution, FindsTwoLayersWhereverTheDirectorPoints) {
  AngleDistribution angles(37);  // +-10 degrees lie well inside bins 16 and 20
  for (const double director : {-1.57, -1.0, 0.0, 0.9, 1.57}) angles.accumulate(two_layers(director));
  const AnglePdf pdf = angles.reduce();
  EXPECT_NEAR(integral(pdf), 1.0, 1e-12);
  EXPECT_NEAR(pdf.density[16], 0.5 * 37 / kPi, 1e-12);
  EXPECT_NEAR(pdf.density[20], 0.5 * 37 / kPi, 1e-12);
}

TEST(AngleDistribution, LeavesUprightRodsOut) {
  AngleDistribution angles(5);
  angles.accumulate(std::vector<Vec3>{{0, 0, 1}, axis(0.3)});
  EXPECT_NEAR(angles.reduce().density[2], 5 / kPi, 1e-12);
}

// A Gaussian of spread 0.2 about an oblique axis. Chi-square over bins that expect more than 20 counts, z = (chi^2 -
// dof) / sqrt(2 dof). Angles not taken from the director, or doubled, miss by thousands.
TEST(AngleDistribution, GaussianSpread) {
  constexpr double kSpread = 0.2, kRods = 100000;
  Draw draw(21);
  std::vector<Vec3> rods;
  for (int i = 0; i < kRods; ++i) rods.push_back(axis(1.4 + kSpread * draw.normal()));
  AngleDistribution angles(90);
  angles.accumulate(rods);
  const AnglePdf pdf = angles.reduce();
  const double width = kPi / 90;
  const auto cumulative = [&](double theta) { return 0.5 * std::erfc(-theta / kSpread / std::sqrt(2.0)); };
  double chi2 = 0, dof = 0;
  for (std::size_t i = 0; i < 90; ++i) {
    const double expected = kRods * (cumulative(pdf.theta[i] + width / 2) - cumulative(pdf.theta[i] - width / 2));
    if (expected < 20) continue;
    chi2 += std::pow(pdf.density[i] * width * kRods - expected, 2) / expected;
    dof += 1;
  }
  EXPECT_GT(dof, 30);
  EXPECT_LT(std::abs(chi2 - dof) / std::sqrt(2 * dof), 4.0);
}

TEST(AngleDistribution, CountsThatNoRunReachesAreRefused) {
  const std::vector<std::byte> bytes = state(AngleDistribution(10));
  const auto restores = [&](std::int64_t count) {
    std::vector<std::byte> other = bytes;
    std::memcpy(other.data() + other.size() - sizeof(count), &count, sizeof(count));  // that of the last bin
    AngleDistribution restored(10);
    StateReader reader(other);
    try {
      restored.restore(reader);
    } catch (const StateError&) {
      return false;
    }
    return state(restored) == other;
  };
  EXPECT_TRUE(restores(7));
  EXPECT_TRUE(restores(kMostCounted));
  EXPECT_FALSE(restores(kMostCounted + 1));
  EXPECT_FALSE(restores(-1));
  EXPECT_EQ(AngleDistribution(10).reduce().density, std::vector<double>(10, 0.0));
}

}  // namespace
}  // namespace shaken::analysis
