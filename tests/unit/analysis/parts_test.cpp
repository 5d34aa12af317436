#include "analysis/errors/parts.h"

#include <gtest/gtest.h>

#include <functional>

#include "tests/unit/analysis/analysis_samples.h"

namespace shaken::analysis {
namespace {

constexpr double kEndless = 1e9;

/// Means over `n_parts` successive parts of an autoregressive series of spread 1 and mean 0 that is worth `worth`
/// independent samples, with `trend` (of the time in [0, 1]) added.
std::vector<double> parts_worth(Draw& draw, std::size_t n_parts, double worth,
                                const std::function<double(double)>& trend = {}) {
  constexpr std::size_t kPerPart = 24;
  const auto n = static_cast<double>(n_parts * kPerPart);
  const double g = std::max(1.0, n / worth);
  const std::vector<double> series = ar1(draw, (g - 1) / (g + 1), n_parts * kPerPart);
  std::vector<double> parts(n_parts);
  for (std::size_t i = 0; i < series.size(); ++i) {
    const double added = trend ? trend(static_cast<double>(i) / n) : 0.0;
    parts[i / kPerPart] += (series[i] + added) / kPerPart;
  }
  return parts;
}

// The mean square of (mean - truth) / sem over 1000 series: 1 within 5 % by chance, four times that at worst, where
// the error itself is known; 10 parts leave it open by so much that the mean square is 1.1. The plain scatter of the
// parts, as if they were independent, gives 1.3 for 16 parts of a series worth 50 samples, 2.1 for 64 of them, and 6.5
// for 64 parts of one worth 12.
TEST(Parts, ErrorsCoverTheTruthWhateverTheCorrelation) {
  constexpr int kSeries = 1000;
  Draw draw(201);
  for (const std::size_t n_parts : {10, 16, 32, 64}) {
    for (const double worth : {kEndless, 200.0, 50.0, 20.0}) {
      if ((n_parts == 10 && worth < 200) || (n_parts == 16 && worth < 50)) continue;  // see the next test but one
      double squares = 0, n = 0, found = 0;
      for (int i = 0; i < kSeries; ++i) {
        const PartsSummary summary = summarize_parts(parts_worth(draw, n_parts, worth));
        found += summary.n_effective / kSeries;
        if (std::isnan(summary.sem)) continue;
        squares += std::pow(summary.mean / summary.sem, 2);
        n += 1;
      }
      EXPECT_GT(squares / n, 0.8) << n_parts << " parts of " << worth;
      EXPECT_LT(squares / n, 1.25) << n_parts << " parts of " << worth;
      EXPECT_GT(n, 0.7 * kSeries) << n_parts << " parts of " << worth;
      const double most = std::min(worth, static_cast<double>(n_parts));
      EXPECT_LT(found, 1.05 * most) << n_parts << " of " << worth;  // never more than there are; fewer, as parts are
      EXPECT_GT(found, 0.5 * most) << n_parts << " of " << worth;   // averages already
    }
  }
}

struct Verdicts {
  double steady = 0, drifting = 0, unknown = 0;  // shares
};

Verdicts verdicts(Draw& draw, std::size_t n_parts, double worth, const std::function<double(double)>& trend = {}) {
  constexpr int kDraws = 800;
  Verdicts shares;
  for (int i = 0; i < kDraws; ++i) {
    const std::optional<bool> steady = summarize_parts(parts_worth(draw, n_parts, worth, trend)).steady;
    (steady ? (*steady ? shares.steady : shares.drifting) : shares.unknown) += 1.0 / kDraws;
  }
  return shares;
}

TEST(Parts, AStationarySeriesIsSteady) {
  Draw draw(202);
  for (const double worth : {50.0, 200.0, 2000.0, kEndless}) {
    const Verdicts of_many = verdicts(draw, 64, worth);
    EXPECT_GT(of_many.steady, 0.97) << worth;
    EXPECT_LT(of_many.drifting, 0.02) << worth;
  }
  for (const double worth : {200.0, kEndless}) {
    EXPECT_GT(verdicts(draw, 32, worth).steady, 0.95) << worth;
    EXPECT_LT(verdicts(draw, 16, worth).drifting, 0.025) << worth;
  }
}

// What cannot be told is neither: with few independent samples hardly any series is called steady, and still not one
// in fifteen is said to drift.
TEST(Parts, FewIndependentSamplesTellNothing) {
  Draw draw(203);
  for (const std::size_t n_parts : {16, 32, 64}) {
    EXPECT_LT(verdicts(draw, n_parts, 6).steady, 0.12) << n_parts;
    EXPECT_LT(verdicts(draw, n_parts, 12).drifting, 0.06) << n_parts;
    EXPECT_GT(verdicts(draw, n_parts, 12).unknown, 0.6) << n_parts;
  }
}

// A straight drift by which the halves differ by eight errors of their difference, 2 / sqrt(worth) each; and relaxation
// by five spreads over a third of the time, and over all of it. With noise about the halves' means in place of a
// parabola the first two are found in half of the draws.
TEST(Parts, ADriftAndARelaxationAreNotSteady) {
  Draw draw(204);
  for (const std::size_t n_parts : {16, 32, 64}) {
    for (const double worth : {50.0, 100.0, 500.0}) {
      const double by = 2 * 8 * 2 / std::sqrt(worth);
      const Verdicts line = verdicts(draw, n_parts, worth, [&](double t) { return by * t; });
      EXPECT_LT(line.steady, 0.01) << n_parts << " " << worth;
      EXPECT_GT(line.drifting, 0.97) << n_parts << " " << worth;
      const Verdicts third = verdicts(draw, n_parts, worth, [](double t) { return 5 * std::exp(-t / 0.3); });
      EXPECT_LT(third.steady, 0.02) << n_parts << " " << worth;
      EXPECT_GT(third.drifting, 0.95) << n_parts << " " << worth;
      const Verdicts whole = verdicts(draw, n_parts, worth, [](double t) { return 5 * std::exp(-t); });
      EXPECT_LT(whole.steady, 0.06) << n_parts << " " << worth;
    }
  }
}

TEST(Parts, DriftIsTheDifferenceOfTheHalves) {
  const PartsSummary summary = summarize_parts(std::vector<double>{1, 3, 2, 2, 2, 5, 6, 5, 4, 5});
  EXPECT_DOUBLE_EQ(summary.mean, 3.5);
  EXPECT_DOUBLE_EQ(summary.drift.value, 3.0);
  Draw draw(205);
  double squares = 0;
  for (int i = 0; i < 2000; ++i) {
    const Estimate drift = summarize_parts(parts_worth(draw, 64, 100, [](double t) { return 1.5 * t; })).drift;
    squares += std::pow((drift.value - 0.75) / drift.sem, 2) / 2000;
  }
  EXPECT_NEAR(squares, 1.0, 0.25);
}

TEST(Parts, NothingComesFromNothing) {
  for (const std::size_t n : {0, 1, 2, 9}) {
    std::vector<double> few;
    for (std::size_t i = 0; i < n; ++i) few.push_back(static_cast<double>(i % 3));
    const PartsSummary summary = summarize_parts(few);
    EXPECT_TRUE(std::isnan(summary.sem)) << n;
    EXPECT_TRUE(std::isnan(summary.n_effective)) << n;
    EXPECT_FALSE(summary.steady) << n;
  }
  // No spread, or only that of rounding, is no error of zero.
  for (const double rounding : {0.0, 1e-16}) {
    std::vector<double> equal(20, 0.7);
    for (std::size_t i = 0; i < 20; i += 3) equal[i] += 63 * rounding;
    const PartsSummary constant = summarize_parts(equal);
    EXPECT_NEAR(constant.mean, 0.7, 1e-14);
    EXPECT_TRUE(std::isnan(constant.sem));
    EXPECT_TRUE(std::isnan(constant.n_effective));
    EXPECT_EQ(constant.drift.value, 0.0);
    EXPECT_EQ(constant.steady, std::optional(true));
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(summarize_parts(std::vector<double>(20, nan)).sem));
  EXPECT_TRUE(std::isnan(estimate_from_parts(nan, std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8, 9}).n_effective));
  EXPECT_EQ(variance_of_mean(std::vector<double>{3}), 0.0);
}

TEST(Parts, OfASeriesAreAsLongAsEachOther) {
  EXPECT_EQ(parts_of_series(std::vector<double>{1, 2, 3}), (std::vector<double>{1, 2, 3}));
  EXPECT_TRUE(parts_of_series({}).empty());
  std::vector<double> series;
  for (int i = 0; i < 1000; ++i) series.push_back(i);
  const std::vector<double> parts = parts_of_series(series);
  ASSERT_EQ(parts.size(), kMostParts);
  EXPECT_DOUBLE_EQ(parts.front(), 7.0);   // of 0 .. 14
  EXPECT_DOUBLE_EQ(parts.back(), 991.5);  // of 984 .. 999
}

}  // namespace
}  // namespace shaken::analysis
