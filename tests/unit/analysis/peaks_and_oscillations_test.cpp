#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "analysis/angles.h"
#include "analysis/errors/blocked.h"
#include "analysis/errors/jackknife.h"
#include "analysis/oscillation.h"
#include "tests/support/effort.h"
#include "tests/unit/analysis/analysis_samples.h"

namespace shaken::analysis {
namespace {

constexpr double kDegree = kPi / 180;

/// theta_m [degrees] and dip of `samples` angles in 40 stretches of time, with errors.
struct Found {
  Estimate theta_m, dip;
};

Found found_in(const Blocked<AngleDistribution>& samples) {
  const auto numbers = [](const AngleDistribution& angles) {
    const std::optional<TwoPeaks> peaks = fit_two_peaks(angles.reduce());
    return peaks ? std::vector{peaks->theta_m / kDegree, peaks->dip} : std::vector{std::nan(""), std::nan("")};
  };
  const auto estimates = jackknife(samples.empty(), samples.parts_after(0.0, kMostParts), numbers);
  return {estimates[0], estimates[1]};
}

Found sampled(std::size_t samples, const std::function<double()>& angle, int bins = 180) {
  Blocked<AngleDistribution> stretches((AngleDistribution(bins)));
  for (int t = 0; t < 40; ++t) {
    std::vector<Vec3> rods;
    for (std::size_t i = 0; i < samples / 40; ++i) rods.push_back(axis(angle()));
    stretches.accumulate(t, rods);
  }
  return found_in(stretches);
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
      const std::optional<TwoPeaks> peaks = fit_two_peaks(pdf);
      ASSERT_TRUE(peaks) << theta_m << ' ' << width;
      EXPECT_NEAR(peaks->theta_m / kDegree, theta_m, 1e-5);
      EXPECT_NEAR(peaks->width / kDegree, width, 1e-5);
      EXPECT_NEAR(peaks->height, 2.5, 1e-5);
      EXPECT_NEAR(peaks->background, 0.1, 1e-5);
      const std::size_t middle = pdf.density.size() / 2;
      EXPECT_NEAR(peaks->dip, pdf.density[middle] / *std::max_element(pdf.density.begin(), pdf.density.end()), 0.03);
    }
  }
}

// The maximum of a mixture solves x = theta_m tanh(x theta_m / width^2): below theta_m where the peaks overlap.
double maximum_of_mixture(double theta_m, double width) {
  double x = theta_m;
  for (int step = 0; step < 1000; ++step) x = theta_m * std::tanh(x * theta_m / (width * width));
  return x;
}

TEST(TwoPeaks, MaximumOfTheCurveItself) {
  for (const double width : {4.0, 8.0}) {
    for (const double ratio : {1.25, 1.5, 2.0, 3.0}) {
      const double theta_m = ratio * width;
      AnglePdf pdf = AngleDistribution(180).reduce();
      for (std::size_t i = 0; i < pdf.theta.size(); ++i) {
        const double right = (pdf.theta[i] - theta_m * kDegree) / (width * kDegree);
        const double left = (pdf.theta[i] + theta_m * kDegree) / (width * kDegree);
        // More rods to one side: both hands are taken together.
        pdf.density[i] = 3 * std::exp(-right * right / 2) + 1 * std::exp(-left * left / 2);
      }
      const double known = maximum_of_mixture(theta_m, width);
      const double found = fit_two_peaks(pdf)->maximum / kDegree;
      EXPECT_NEAR(found, known, width * (ratio < 1.3 ? 0.045 : 0.006)) << theta_m << ' ' << width;
      if (ratio < 1.3) {
        EXPECT_LT(known, 0.9 * theta_m);
      }
    }
  }
}

// 60 experiments: the jackknife's error of the maximum is its scatter (chi^2 / n, 18 % itself, and 32 blocks' own).
TEST(TwoPeaks, MaximumHasTheErrorOfItsScatter) {
  if (!test::at_night()) GTEST_SKIP() << "statistics of a minute";
  Draw draw(124);
  constexpr int kRepeats = 60;
  const double known = maximum_of_mixture(10, 7);
  double chi2 = 0, off = 0, sem = 0;
  int n = 0;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    Blocked<AngleDistribution> samples(AngleDistribution(180));
    for (int t = 0; t < 32; ++t) {
      std::vector<Vec3> rods;
      for (int i = 0; i < 600; ++i) rods.push_back(axis(0.3 + ((i % 2 == 0 ? 10 : -10) + 7 * draw.normal()) * kDegree));
      samples.accumulate(t, rods);
    }
    const Estimate maximum =
        jackknife(samples.empty(), samples.parts_after(0.0, 64), [](const AngleDistribution& angles) {
          return std::vector{fit_two_peaks(angles.reduce())->maximum / kDegree};
        })[0];
    off += (maximum.value - known) / kRepeats;
    if (std::isnan(maximum.sem)) continue;  // by chance too few independent parts
    chi2 += std::pow((maximum.value - known) / maximum.sem, 2);
    sem += maximum.sem;
    ++n;
  }
  ASSERT_GT(n, 50);
  chi2 /= n;
  sem /= n;
  EXPECT_GT(chi2, 0.55);
  EXPECT_LT(chi2, 1.6);
  EXPECT_LT(std::abs(off), 0.5 * sem + 0.012 * 7);
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
    const auto [theta, dip] = found_in(samples);
    EXPECT_LT(std::abs(theta.value - theta_m), 4.5 * theta.sem) << theta.value << " +- " << theta.sem;
    EXPECT_GT(theta.sem, 4.0 / std::sqrt(40000.0) / 2);
    EXPECT_LT(theta.sem, 4.0 / std::sqrt(40000.0) * 3);
    EXPECT_TRUE(are_two(dip)) << dip.value << " +- " << dip.sem;
  }
}

// One broad peak, of two Gaussians that overlap (theta_m < width) or of one; and none at all: noise is not taken for a
// dip more often than two errors say. Two peaks are seen.
TEST(TwoPeaks, AreNotSeenWhereThereAreNone) {
  Draw draw(122);
  int wrong = 0;
  for (int repeat = 0; repeat < test::draws(20); ++repeat) {
    for (const std::size_t samples : {400u, 4000u, 40000u}) {
      wrong += are_two(sampled(samples, [&] { return 8 * kDegree * draw.normal(); }).dip);
      wrong += are_two(sampled(samples, [&] { return draw.uniform(-kPi, kPi); }).dip);
      wrong += are_two(
          sampled(samples, [&] { return ((draw.uniform(0, 1) < 0.5 ? 3 : -3) + 6 * draw.normal()) * kDegree; }).dip);
    }
    EXPECT_TRUE(are_two(
        sampled(40000, [&] { return ((draw.uniform(0, 1) < 0.5 ? 10 : -10) + 7 * draw.normal()) * kDegree; }).dip));
  }
  EXPECT_LE(wrong, 2) << "of 180";
  EXPECT_FALSE(fit_two_peaks(AngleDistribution(180).reduce()));
  EXPECT_FALSE(fit_two_peaks(AngleDistribution(2).reduce()));
  EXPECT_FALSE(are_two(sampled(400, [] { return 0.5; }).dip));
}

// More rods turned to one hand than to the other, so that the director lies 1 degree off the middle: the peaks are
// those of both hands together, at 8 and 12 degrees, and an odd number of bins does not matter.
TEST(TwoPeaks, OfUnequalShares) {
  const auto gaussian = [](double degrees) { return std::exp(-degrees * degrees / (2 * 5 * 5)); };
  const double at_centre = 0.6 * gaussian(8) + 0.4 * gaussian(12),
               at_peak = (0.6 * gaussian(2) + 0.4 * gaussian(2)) / 2;
  Draw draw(123);
  for (const int bins : {180, 181}) {
    const Found found = sampled(
        40000, [&] { return ((draw.uniform(0, 1) < 0.6 ? 9 : -11) + 5 * draw.normal()) * kDegree; }, bins);
    EXPECT_TRUE(are_two(found.dip)) << found.dip.value << " +- " << found.dip.sem;
    EXPECT_NEAR(found.theta_m.value, 10, 1);
    EXPECT_NEAR(found.dip.value, at_centre / at_peak, 0.05);
  }
}

struct Curve {
  std::vector<double> r, y;
};
template <class F>
Curve curve(const F& f) {
  Curve result;
  for (int i = 0; i < 120; ++i) {
    result.r.push_back(0.25 * (i + 0.5));
    result.y.push_back(f(result.r.back()));
  }
  return result;
}

TEST(FirstPeriod, OfACosine) {
  for (const double wavelength : {6.0, 9.3, 17.1}) {
    const Curve c = curve([&](double r) { return 0.3 + 0.2 * std::cos(2 * kPi * r / wavelength); });
    ASSERT_TRUE(first_period(c.r, c.y, 1.0));
    EXPECT_NEAR(*first_period(c.r, c.y, 1.0), wavelength, 0.01);
  }
}

// What a cut of G2 looks like: no pairs at contact, a ripple of the rods' own width, noise. The noise of 0.01 in y
// moves the top of a cosine of amplitude 0.1 by about a tenth of the wavelength's 2 pi-th part, 0.15 mm.
TEST(FirstPeriod, OfANoisyOneWithARippleOfTheSmoothing) {
  Draw draw(131);
  constexpr double kWavelength = 10;
  double sum = 0;
  for (int repeat = 0; repeat < 50; ++repeat) {
    const Curve c = curve([&](double r) {
      if (r < 0.9) return std::nan("");
      return 0.5 + 0.1 * std::cos(2 * kPi * r / kWavelength) + 0.3 * std::exp(-r / 3) * std::cos(2 * kPi * r) +
             0.01 * draw.normal();
    });
    const std::optional<double> found = first_period(c.r, c.y, 1.0);
    ASSERT_TRUE(found);
    EXPECT_NEAR(*found, kWavelength, 1.0);
    sum += *found / 50;
  }
  EXPECT_NEAR(sum, kWavelength, 0.15);
}

// Rods of 4.5 mm side by side, 1.15 mm apart as in a crystal, in layers of a period of 14 mm: the period is that of the
// layers, and without these there is none.
TEST(FirstPeriod, IsNotTheDistanceOfRodsSideBySide) {
  constexpr double kRodLength = 4.5;
  for (const double apart : {0.83, 1.15, 2.3, 2.9}) {  // of 2.9 mm the average leaves a fifth
    const auto ripple = [&](double r) { return 0.2 * std::exp(-r / 8) * std::cos(2 * kPi * r / apart); };
    const Curve both = curve([&](double r) { return 0.5 + 0.1 * std::cos(2 * kPi * r / 14) + ripple(r); });
    ASSERT_TRUE(first_period(both.r, both.y, kRodLength));
    EXPECT_NEAR(*first_period(both.r, both.y, kRodLength), 14, apart < 2.5 ? 0.3 : 1) << apart;
    if (apart > 2.5) continue;
    const Curve crystal = curve([&](double r) { return 0.5 + 0.3 * std::exp(-r / 20) + ripple(r); });
    EXPECT_FALSE(first_period(crystal.r, crystal.y, kRodLength)) << apart;
  }
}

TEST(FirstPeriod, OfACurveWithoutOne) {
  Draw draw(132);
  const auto none = [](const Curve& c) { return !first_period(c.r, c.y, 1.0); };
  EXPECT_TRUE(none(curve([](double r) { return std::exp(-r); })));
  EXPECT_TRUE(none(curve([](double) { return 1.0; })));
  EXPECT_TRUE(none(curve([](double) { return std::nan(""); })));
  EXPECT_TRUE(none(curve([](double r) { return std::cos(2 * kPi * r / 50); })));  // its maximum lies beyond the end
  for (int i = 0; i < 100; ++i) {
    EXPECT_TRUE(none(curve([&](double r) { return std::exp(-r / 5) + 0.02 * draw.normal(); }))) << i;
  }
  EXPECT_FALSE(first_period({}, {}, 1.0));
  EXPECT_FALSE(first_period(std::vector<double>{1}, std::vector<double>{1}, 1.0));
}

}  // namespace
}  // namespace shaken::analysis
