// SPDX-License-Identifier: MIT
#include "analysis/two_peaks.h"

#include <gtest/gtest.h>

#include <functional>

#include "analysis/blocked.h"
#include "analysis/jackknife.h"
#include "tests/unit/analysis/samples.h"

namespace shaken::analysis {
namespace {

constexpr double kDegree = kPi / 180;

AnglePdf histogram(std::size_t samples, const std::function<double()>& angle, int bins = 180) {
  std::vector<Vec3> rods;
  for (std::size_t i = 0; i < samples; ++i) rods.push_back(axis(angle()));
  AngleDistribution angles(bins);
  angles.accumulate(rods);
  return angles.reduce();
}

// Points of the curve itself are fitted exactly, whatever the shares.
TEST(TwoPeaks, OfTheCurveItself) {
  for (const double theta_m : {6.0, 10.0, 30.0}) {
    for (const double width : {2.0, 5.0}) {
      AnglePdf pdf = AngleDistribution(180).reduce();
      for (std::size_t i = 0; i < pdf.theta.size(); ++i) {
        const double right = (pdf.theta[i] - theta_m * kDegree) / (width * kDegree);
        const double left = (pdf.theta[i] + theta_m * kDegree) / (width * kDegree);
        pdf.density[i] = 2.5 * (std::exp(-right * right / 2) + std::exp(-left * left / 2)) + 0.1;
      }
      const std::optional<TwoPeaks> peaks = find_two_peaks(pdf);
      ASSERT_TRUE(peaks) << theta_m << ' ' << width;
      EXPECT_NEAR(peaks->theta_m / kDegree, theta_m, 1e-5);
      EXPECT_NEAR(peaks->width / kDegree, width, 1e-5);
      EXPECT_NEAR(peaks->height, 2.5, 1e-5);
      EXPECT_NEAR(peaks->background, 0.1, 1e-5);
      const double x = theta_m / width;
      EXPECT_NEAR(peaks->dip, (5 * std::exp(-x * x / 2) + 0.1) / (2.5 * (1 + std::exp(-2 * x * x)) + 0.1), 1e-5);
    }
  }
}

// Sampled mixtures in 40 stretches: theta_m within 4.5 of the error that the stretches tell, and that error near the
// Gaussian's own width / sqrt(n) where the peaks do not overlap.
TEST(TwoPeaks, OfSampledMixtures) {
  Draw draw(121);
  for (const double theta_m : {8.0, 10.0, 15.0}) {
    Blocked<AngleDistribution> samples(AngleDistribution(180));
    for (int t = 0; t < 40; ++t) {
      std::vector<Vec3> rods;
      for (int i = 0; i < 1000; ++i) {
        rods.push_back(axis(0.3 + ((i % 2 == 0 ? theta_m : -theta_m) + 4.0 * draw.normal()) * kDegree));
      }
      samples.accumulate(t, rods);
    }
    const auto theta = [](const AngleDistribution& angles) {
      const std::optional<TwoPeaks> peaks = find_two_peaks(angles.reduce());
      return std::vector<double>{peaks ? peaks->theta_m / kDegree : std::nan("")};
    };
    const Estimate result = jackknife(samples.empty(), samples.parts_after(0.0, 16), theta)[0];
    EXPECT_LT(std::abs(result.value - theta_m), 4.5 * result.sem) << result.value << " +- " << result.sem;
    EXPECT_GT(result.sem, 4.0 / std::sqrt(40000.0) / 2);
    EXPECT_LT(result.sem, 4.0 / std::sqrt(40000.0) * 3);
  }
}

// One broad peak, of two Gaussians that overlap (theta_m < width) or of one; and none at all. Many draws: noise must
// not be taken for a dip.
TEST(TwoPeaks, AreNotSeenWhereThereAreNone) {
  Draw draw(122);
  for (int repeat = 0; repeat < 20; ++repeat) {
    for (const std::size_t samples : {300u, 3000u, 30000u}) {
      EXPECT_FALSE(find_two_peaks(histogram(samples, [&] { return 8 * kDegree * draw.normal(); })));
      EXPECT_FALSE(find_two_peaks(histogram(samples, [&] { return draw.uniform(-kPi, kPi); })));
      EXPECT_FALSE(find_two_peaks(
          histogram(samples, [&] { return ((draw.uniform(0, 1) < 0.5 ? 3 : -3) + 6 * draw.normal()) * kDegree; })));
    }
  }
  EXPECT_FALSE(find_two_peaks(AngleDistribution(180).reduce()));
  EXPECT_FALSE(find_two_peaks(AngleDistribution(2).reduce()));
  EXPECT_FALSE(find_two_peaks(histogram(100, [] { return 0.5; })));
}

}  // namespace
}  // namespace shaken::analysis
