#include "analysis/lags/lag_fits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "analysis/msd.h"
#include "tests/unit/analysis/walks.h"

namespace shaken::analysis {
namespace {

constexpr double kIdentity[] = {1};

/// A curve with mean law(lag) in each of 64 stretches of 125 s, at lags 0.01 s 2^(i/4).
template <class Law>
LagCurve planted(Law law, std::size_t n = 60) {
  std::vector<double> lags, independent;
  LagCurve::Stretch stretch;
  for (std::size_t i = 0; i < n; ++i) {
    lags.push_back(0.01 * std::exp2(static_cast<double>(i) / 4));
    independent.push_back(8000 / lags.back());
    stretch.rods.push_back(7);
    stretch.sums.push_back(7 * law(lags.back()));
  }
  return {lags, independent, 1, std::vector<LagCurve::Stretch>(64, stretch)};
}

// Of 8000 s the longest of these lags that fits five times is 0.01 s 2^(69/4).
TEST(Diffusion, ExponentsAndWindowsOfPowerLaws) {
  for (const double alpha : {0.4, 1.0, 1.3, 2.0}) {
    const LagCurve curve = planted([&](double t) { return 3 * std::pow(t, alpha); }, 80);
    const ShortAndLong fit = growth(curve, kIdentity);
    EXPECT_NEAR(fit.at_short.exponent.value, alpha, 1e-10);
    EXPECT_NEAR(fit.at_long.exponent.value, alpha, 1e-10);
    const double first = alpha < 1.1 ? 0 : 56.0 / 4;  // the flight does not end: the two octaves before the long lags
    EXPECT_NEAR(fit.at_short.lag_from / (0.01 * std::exp2(first)), 1, 1e-9);
    EXPECT_NEAR(fit.at_short.lag_to / (0.01 * std::exp2(first + 2)), 1, 1e-9);
    EXPECT_NEAR(fit.at_long.lag_from / (0.01 * std::exp2(65.0 / 4)), 1, 1e-9);
    EXPECT_NEAR(fit.at_long.lag_to / (0.01 * std::exp2(69.0 / 4)), 1, 1e-9);
    EXPECT_NEAR(fit.at_long.slope.sem, 0.0, 1e-9) << "all stretches alike";
    EXPECT_EQ(fit.at_long.slope.n_effective, 5) << "8000 s / 1559 s";
    const EstimateCurve local = local_exponent(curve, kIdentity);
    for (const double exponent : local.value) EXPECT_NEAR(exponent, alpha, 1e-10);
    if (alpha == 1.0) {
      EXPECT_NEAR(fit.at_long.slope.value, 3, 1e-10);
    }
  }
}

// Persistent motion whose flight ends at about tau / 0.1: wherever that lies, before, in or beyond the long lags, the
// short ones are the shorter ones. Read from the end of the flight on, "short" stood beyond "long" for any tau > 100 s.
TEST(Diffusion, ShortLagsAreShorterThanLongOnesHoweverLateTheFlightEnds) {
  for (const double tau : {0.01, 1.0, 10.0, 50.0, 100.0, 300.0, 1000.0, 1e5}) {
    const auto law = [&](double t) { return 4 * 1.7 * (t + tau * std::expm1(-t / tau)); };
    const ShortAndLong fit = growth(planted(law, 80), kIdentity);
    EXPECT_LT(fit.at_short.lag_to, fit.at_long.lag_from) << tau;
    EXPECT_NEAR(fit.at_short.lag_to / fit.at_short.lag_from, 4, 1e-9) << tau;
    EXPECT_LT(fit.at_short.slope.value, fit.at_long.slope.value) << tau;
    EXPECT_GT(fit.at_short.exponent.value, fit.at_long.exponent.value) << tau;
    if (tau >= 100) {
      EXPECT_GT(fit.at_short.exponent.value, 1.1) << "it says that the motion is not diffusive yet";
    }
  }
}

// A cage: MSD = 4 D t + a (1 - exp(-t / tau)). Short lags see the rattling, of exponent below 1; long ones D.
TEST(Diffusion, OfRodsInCages) {
  constexpr double kD = 0.02, kSize = 3.0, kTau = 0.1;
  const ShortAndLong fit =
      growth(planted([](double t) { return 4 * kD * t - kSize * std::expm1(-t / kTau); }, 80), kIdentity);
  EXPECT_NEAR(fit.at_short.lag_from, 0.01, 1e-12);
  EXPECT_LT(fit.at_short.exponent.value, 0.95);
  EXPECT_GT(fit.at_short.slope.value / 4, 100 * kD);
  EXPECT_NEAR(fit.at_long.slope.value / 4, kD, 1e-9);
}

// Persistent motion, MSD = 4 D (t - tau (1 - exp(-t / tau))): exponent about 1 + tau / t, and a line that is shifted by
// its beginning. D = MSD / 4 t would be 6 % short at 16 tau.
TEST(Diffusion, OfPersistentMotionIsThatOfTheShiftedLine) {
  constexpr double kD = 1.7, kTau = 0.05;
  const auto law = [](double t) { return 4 * kD * (t - kTau * (1 - std::exp(-t / kTau))); };
  const ShortAndLong fit = growth(planted(law), kIdentity);
  EXPECT_GT(fit.at_short.lag_from, 9 * kTau);
  EXPECT_LT(fit.at_short.lag_from, 13 * kTau);
  EXPECT_NEAR(fit.at_short.lag_to, 4 * fit.at_short.lag_from, 1e-9);
  EXPECT_NEAR(fit.at_short.slope.value / 4, kD, 1e-3 * kD);
  EXPECT_NEAR(fit.at_long.slope.value / 4, kD, 1e-6 * kD);
  EXPECT_NEAR(growth(planted(law, 34), kIdentity).at_long.slope.value / 4, kD, 1e-3 * kD);
  EXPECT_NEAR(growth(planted(law, 80), kIdentity).at_long.slope.value / 4, kD, 1e-9);
}

TEST(Diffusion, LongLagsAreTheLongestThatFiveStretchesSpan) {
  const std::vector<double> lags{1, 2, 3, 4, 5, 6, 7, 8};
  const std::vector<double> independent{40, 20, 13, 10, 8, 6.7, 5, 4.9};
  const LagCurve curve(lags, independent, 1, std::vector<LagCurve::Stretch>(64, {std::vector<double>(8, 1), lags}));
  const ShortAndLong fit = growth(curve, kIdentity);
  EXPECT_EQ(fit.at_long.lag_from, 4);
  EXPECT_EQ(fit.at_long.lag_to, 7);
  EXPECT_EQ(fit.at_long.slope.n_effective, 5);
  EXPECT_EQ(fit.at_short.lag_from, 1);
  EXPECT_EQ(fit.at_short.lag_to, 3);
  EXPECT_EQ(fit.at_short.slope.n_effective, 8) << "of 1.6 lags; six of two lags would be too few";
  const LagCurve of_one_stretch(lags, independent, 1, {{std::vector<double>(8, 1), lags}});
  EXPECT_TRUE(std::isnan(growth(of_one_stretch, kIdentity).at_long.slope.value));
}

// However its origins are cut: n stretches of one kind of noise have the error of their mean, times what n tells of
// its own scatter. A last stretch that holds next to nothing goes to its neighbour.
TEST(Diffusion, ErrorsOfFewStretchesCarryTheVarianceOfStudentsT) {
  const auto sem_of = [](double independent, std::vector<double> rods) {
    std::vector<LagCurve::Stretch> stretches;
    for (std::size_t s = 0; s < rods.size(); ++s)
      stretches.push_back({{rods[s]}, {rods[s] * (s % 2 == 0 ? 1.0 : 3.0)}});
    const LagTerm term{0, 0, 1.0};
    const LagCurve curve({1.0}, {independent}, 1, stretches);
    const auto estimate = curve.estimate(1, {&term, 1});
    EXPECT_EQ(std::isnan(estimate.n_effective), std::isnan(estimate.sem));
    return estimate.sem;
  };
  EXPECT_TRUE(std::isnan(sem_of(4.9, std::vector<double>(64, 1))));
  EXPECT_TRUE(std::isnan(sem_of(1000, std::vector<double>(4, 1))));
  EXPECT_TRUE(std::isnan(sem_of(1000, {1, 1, 1, 1, 0.01})));
  // Ten long stretches of values 1 and 3: sem^2 = 1 / 9 of independent ones, with Student's 9 / 7.
  EXPECT_NEAR(sem_of(1e6, std::vector<double>(10, 1)), std::sqrt(1.0 / 7), 1e-5);
  // 6 of one lag each: (1 / 5) (5 / 3) / (3 / 4).
  EXPECT_NEAR(sem_of(6, std::vector<double>(6, 1)), std::sqrt(1.0 / 3 / 0.75), 1e-6);
}

TEST(Diffusion, OfTooLittleIsNotKnown) {
  EXPECT_TRUE(std::isnan(growth(LagCurve(), kIdentity).at_short.slope.value));
  EXPECT_TRUE(local_exponent(LagCurve(), kIdentity).value.empty());
  const ShortAndLong of_two = growth(planted([](double t) { return t; }, 2), kIdentity);
  EXPECT_TRUE(std::isnan(of_two.at_short.slope.value));
  const ShortAndLong of_still = growth(planted([](double) { return 0.0; }), kIdentity);
  EXPECT_EQ(of_still.at_long.slope.value, 0.0);
  EXPECT_TRUE(std::isnan(of_still.at_long.exponent.value));
}

// Anisotropic walks, 2 D dt = 1 along and 0.25 across: D = 0.5 and 0.125, in the plane their mean. 400 experiments of
// 20 rods: z of the mean over the experiments below 4.5, and chi^2 / n with the reported errors (14 % itself, more at
// the few stretches of the longest lags).
TEST(Diffusion, OfRandomWalksWithItsError) {
  constexpr int kRepeats = 400;
  Draw draw(91);
  struct Known {
    double truth, sum = 0, squares = 0, chi2 = 0;
    void add(const Estimate& estimate) {
      sum += estimate.value - truth;
      squares += std::pow(estimate.value - truth, 2);
      chi2 += std::pow((estimate.value - truth) / estimate.sem, 2);
    }
  };
  Known along{0.5}, across{0.125}, plane{0.3125}, at_short{0.3125}, relative{0.3125}, exponent{1.0};
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    MeanSquareDisplacement msd(1.0, 20);
    double time = 0;
    for (const std::vector<Vec3>& frame : walks(draw, 20, 1000, 0.7, 1.0, 0.5)) msd.accumulate(time++, frame, 0.7);
    const Diffusion diffusion = msd.diffusion();
    along.add(diffusion.d_along);
    across.add(diffusion.d_across);
    plane.add(diffusion.d_long);
    at_short.add(diffusion.d_short);
    relative.add(diffusion.d_relative);
    exponent.add(diffusion.total.at_short.exponent);
    EXPECT_EQ(diffusion.total.at_short.lag_to, 4.0);
    EXPECT_EQ(diffusion.total.at_long.lag_from, 80.0);
    EXPECT_EQ(diffusion.total.at_long.lag_to, 160.0);
  }
  for (const Known& known : {along, across, plane, at_short, relative, exponent}) {
    EXPECT_LT(std::abs(known.sum) / std::sqrt(known.squares), 4.5) << known.truth;
    EXPECT_NEAR(known.chi2 / kRepeats, 1.0, 0.25) << known.truth;
  }
}

TEST(DecayTime, OfAnExponentialIsExactOnCoarseLags) {
  for (const double tau : {0.3, 1.0, 1.7, 5.9}) {
    EstimateCurve curve;
    const std::vector<double> lags{1, 2, 4, 6};
    for (const double t : lags) curve.push_back({std::exp(-t / tau), 0.01});
    const Estimate found = decay_time(lags, curve);
    EXPECT_NEAR(found.value, tau, 1e-12);
    EXPECT_NEAR(found.sem, 0.01 * tau * std::exp(1.0), 1e-12);  // slope 1 / (e tau)
  }
}

TEST(DecayTime, OfACurveThatGoesNegativeIsLinearInBetween) {
  const Estimate found = decay_time(std::vector<double>{0, 1, 2}, {{1, 0.9, -0.1}, {0, 0.02, 0.01}});
  EXPECT_NEAR(found.value, 1 + 0.9 - std::exp(-1.0), 1e-12);
  EXPECT_NEAR(found.sem, 0.02, 1e-12);
}

TEST(DecayTime, HasNoErrorWhereOneOfBothValuesHasNone) {
  constexpr double kUnknown = NAN;
  for (const auto& [before, after] : {std::pair{0.01, kUnknown}, std::pair{kUnknown, 0.01}}) {
    const Estimate found = decay_time(std::vector<double>{1, 2}, {{0.9, 0.1}, {before, after}});
    EXPECT_GT(found.value, 1);
    EXPECT_TRUE(std::isnan(found.sem));
  }
}

TEST(DecayTime, IsUnknownWhereItDoesNotFall) {
  EXPECT_TRUE(std::isnan(decay_time({}, {}).value));
  EXPECT_TRUE(std::isnan(decay_time(std::vector<double>{1, 2}, {{0.9, 0.5}, {0, 0}}).value));
  EXPECT_TRUE(std::isnan(decay_time(std::vector<double>{0, 1}, {{NAN, NAN}, {0, 0}}).value));
}

}  // namespace
}  // namespace shaken::analysis
