#include "analysis/time_series.h"

#include <gtest/gtest.h>

#include <functional>
#include <numeric>

#include "analysis/errors/bounded_series.h"
#include "tests/unit/analysis/analysis_samples.h"

namespace shaken::analysis {
namespace {

std::vector<double> equal_times(std::size_t n, double interval = 1.0) {
  std::vector<double> times(n);
  for (std::size_t i = 0; i < n; ++i) times[i] = static_cast<double>(i) * interval;
  return times;
}

/// The definition, written down plainly.
double slow_inefficiency(const std::vector<double>& x) {
  const auto n = static_cast<double>(x.size());
  const double mean = std::accumulate(x.begin(), x.end(), 0.0) / n;
  const auto covariance = [&](std::size_t lag) {
    double sum = 0;
    for (std::size_t i = 0; i + lag < x.size(); ++i) sum += (x[i] - mean) * (x[i + lag] - mean);
    return sum / n;
  };
  double g = 1;
  for (std::size_t lag = 1; lag < x.size(); ++lag) {
    g += 2 * covariance(lag) / covariance(0);
    if (static_cast<double>(lag) >= 5 * g) break;
  }
  return std::max(g, 1.0);
}

/// Relative standard error of g summed over a window of 5 g (Madras & Sokal, J. Stat. Phys. 50, 109 (1988), eq. 2.21).
double relative_error_of_g(double g, double n) { return std::sqrt(2 * (2 * 5 * g + 1) / n); }

TEST(StatisticalInefficiency, EqualsItsDefinition) {
  Draw draw(11);
  for (const double a : {-0.5, 0.0, 0.5, 0.9, 0.99}) {
    const std::vector<double> x = ar1(draw, a, 2500);
    EXPECT_NEAR(statistical_inefficiency(x), slow_inefficiency(x), 1e-9) << a;
  }
}

// Known answers g = (1 + a) / (1 - a). z uses Madras & Sokal's error of the windowed sum. tau itself in place of
// g = 1 + 2 tau, or a sum without the factor 2, misses by more than 10 z. The longest series spends its budget and is
// averaged in pairs on the way: forgetting to scale back halves g, 25 z away.
TEST(StatisticalInefficiency, OfAutoregressiveSeries) {
  struct Case {
    double a;
    std::size_t n;
  };
  Draw draw(12);
  for (const Case& c : {Case{0.5, 200000}, Case{0.9, 200000}, Case{0.9, 1000000}}) {
    const double g = (1 + c.a) / (1 - c.a);
    const double measured = statistical_inefficiency(ar1(draw, c.a, c.n));
    EXPECT_LT(std::abs(measured / g - 1) / relative_error_of_g(g, static_cast<double>(c.n)), 4.0)
        << c.a << " " << measured;
  }
}

// White noise (70 % of the variance) on a slow part (a = 0.95, g = 39): g = 0.7 + 0.3 * 39 = 12.4, less the 4 % that
// lie beyond the window of 62 lags; 1.6 % statistical error. The budget is spent on the way, and pairs lose a third of
// the variance: leaving that out gives 1.5 g.
TEST(StatisticalInefficiency, AllowsForTheVarianceThatAveragingTakes) {
  Draw draw(10);
  std::vector<double> x = ar1(draw, 0.95, 1000000);
  for (double& value : x) value = std::sqrt(0.3) * value + std::sqrt(0.7) * draw.normal();
  EXPECT_NEAR(statistical_inefficiency(x), 12.4, 1.3);
}

TEST(StatisticalInefficiency, IsOneWhereThereIsNothingToCorrelate) {
  for (const std::size_t n : {0, 1, 2, 3, 4, 1000})
    EXPECT_EQ(statistical_inefficiency(std::vector<double>(n, 0.1)), 1.0) << n;
  std::vector<double> alternating;
  for (int i = 0; i < 100; ++i) alternating.push_back(i % 2);
  EXPECT_EQ(statistical_inefficiency(alternating), 1.0);
}

// The quoted error must cover: over 300 independent series, (mean - truth) / sem has mean square 1 within 8 % by
// chance, allowed three times. By the autocorrelation sum alone it is 2 where a series is worth 20 samples, and 1.4 at
// 50; std / sqrt(n) would give 19 to 200.
TEST(Summary, ErrorBarsCoverTheTruth) {
  constexpr int kRepeats = 300;
  Draw draw(15);
  for (const double worth : {20.0, 50.0, 210.0}) {
    const double g = 2000 / worth;
    double sum = 0, n = 0;
    for (int i = 0; i < kRepeats; ++i) {
      const std::vector<double> x = ar1(draw, (g - 1) / (g + 1), 2000);
      const SteadySummary summary = summarize_series(equal_times(x.size()), x, 0.0);
      if (std::isnan(summary.sem)) continue;
      sum += std::pow(summary.mean / summary.sem, 2);
      n += 1;
    }
    EXPECT_GT(n, 0.9 * kRepeats) << worth;
    EXPECT_NEAR(sum / n, 1.0, 0.25) << worth;
  }
}

// The same with a slow part (a quarter of the variance, worth 40 samples) below fast noise: what one correlation of
// neighbours does not show.
TEST(Summary, ErrorBarsCoverTheTruthWithTwoTimes) {
  constexpr int kRepeats = 300;
  Draw draw(20);
  double sum = 0;
  for (int i = 0; i < kRepeats; ++i) {
    std::vector<double> x = ar1(draw, 49.0 / 51, 2000);
    for (double& value : x) value = 0.5 * value + std::sqrt(0.75) * draw.normal();
    const SteadySummary summary = summarize_series(equal_times(x.size()), x, 0.0);
    sum += std::pow(summary.mean / summary.sem, 2) / kRepeats;
  }
  EXPECT_NEAR(sum, 1.0, 0.3);
}

TEST(Summary, OfGivenSteadyStart) {
  const std::vector<double> values{9, 9, 1, 2, 3, 4};
  const SteadySummary summary = summarize_series(equal_times(6, 0.5), values, 1.0);
  EXPECT_EQ(summary.t_steady, 1.0);
  EXPECT_DOUBLE_EQ(summary.mean, 2.5);
  EXPECT_DOUBLE_EQ(summary.std, std::sqrt(5.0 / 3));
  EXPECT_TRUE(std::isnan(summary.sem)) << "four samples have no error";
  EXPECT_FALSE(summary.steady);
  // A start that rounding puts just above the sample meant.
  EXPECT_EQ(summarize_series(equal_times(6, 0.5), values, 1.0 + 1e-12).mean, summary.mean);
}

TEST(Summary, TauIsInTheUnitOfTheTimes) {
  Draw draw(16);
  const std::vector<double> x = ar1(draw, 0.9, 50000);
  const SteadySummary summary = summarize_series(equal_times(x.size(), 0.01), x, 0.0);
  EXPECT_NEAR(summary.tau, 0.01 * (statistical_inefficiency(x) - 1) / 2, 1e-12);
  EXPECT_DOUBLE_EQ(summary.sem, summary.std / std::sqrt(summary.n_effective));
  EXPECT_LE(summary.n_effective, 50000 / statistical_inefficiency(x) * (1 + 1e-9));
  EXPECT_NEAR(summary.n_effective, 50000 / 19.0, 0.4 * 50000 / 19);
}

// An ordered start that falls within few samples to a state that fluctuates slowly: it costs next to no effective
// samples to keep it, but it is no sample of that state.
TEST(SteadyIndex, IsNotBeforeTheSeriesHasComeBackFromItsStart) {
  for (const int seed : {21, 22, 23, 24}) {
    Draw draw(static_cast<std::uint64_t>(seed));
    std::vector<double> x = ar1(draw, 0.97, 4000);
    for (double& value : x) value = 0.3 + 0.05 * value;
    for (std::size_t i = 0; i < 40; ++i) x[i] = 1.0 - 0.015 * static_cast<double>(i);  // 1 to 0.4
    const std::size_t begin = steady_index(x);
    EXPECT_GE(begin, 40u) << seed;
    EXPECT_LT(begin, 1500u) << seed;
  }
}

TEST(Summary, ShortAndConstantSeries) {
  EXPECT_EQ(summarize_series({}, {}).n_effective, 0.0);
  EXPECT_EQ(summarize_series({}, {}, 3.0).t_steady, 3.0);
  const SteadySummary beyond = summarize_series(equal_times(5), std::vector<double>(5, 1.0), 9.0);
  EXPECT_EQ(beyond.n_effective, 0.0);
  EXPECT_EQ(beyond.t_steady, 9.0);
  for (const std::size_t n : {1, 2, 3, 4, 5, 100, 10000}) {
    const SteadySummary summary = summarize_series(equal_times(n), std::vector<double>(n, 0.1));
    EXPECT_EQ(summary.mean, 0.1) << n;
    EXPECT_EQ(summary.std, 0.0) << n;
    EXPECT_TRUE(std::isnan(summary.sem)) << n << ": no spread is no error of zero";
    EXPECT_EQ(summary.tau, 0.0) << n;
    EXPECT_EQ(summary.t_steady, 0.0) << n;
    EXPECT_EQ(summary.n_effective, static_cast<double>(n)) << n;
    EXPECT_EQ(summary.steady, n >= 100 ? std::optional(true) : std::nullopt)
        << n << ": what does not change is steady, if it was looked at often enough";
  }
}

// 3 exp(-t / 100) on noise of spread 0.1: at t = 340 the transient has come down to the spread, at t = 700 to a
// thirtieth of it. The mean of the whole series is off by 0.06, tens of standard errors.
TEST(SteadyState, IsFoundAfterATransient) {
  Draw draw(17);
  for (const double a : {0.0, 0.5, 0.9}) {
    std::vector<double> x = ar1(draw, a, 5000);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = 0.1 * x[i] + 3 * std::exp(-static_cast<double>(i) / 100);
    const SteadySummary summary = summarize_series(equal_times(x.size()), x);
    EXPECT_GT(summary.t_steady, 200) << a;
    EXPECT_LT(summary.t_steady, 900) << a;
    EXPECT_LT(std::abs(summary.mean), 4 * summary.sem + 0.002) << a;
  }
}

TEST(SteadyState, OfALongSeriesIsFoundOnItsGroups) {
  Draw draw(18);
  std::vector<double> x = ar1(draw, 0.5, 100000);
  for (std::size_t i = 0; i < 30000; ++i) x[i] += 5;  // a step: the steady state begins at sample 30000
  const auto t0 = static_cast<double>(steady_index(x));
  EXPECT_NEAR(t0, 30000, 500);
}

TEST(SteadyState, StationarySeriesLosesLittle) {
  Draw draw(19);
  double lost = 0;
  for (int i = 0; i < 20; ++i) lost += static_cast<double>(steady_index(ar1(draw, 0.5, 4000))) / 4000;
  EXPECT_LT(lost / 20, 0.2);
}

TEST(SteadyState, ConstantTailAfterATransient) {
  std::vector<double> x(1000, 0.7);
  for (std::size_t i = 0; i < 100; ++i) x[i] = 0.007 * static_cast<double>(i);
  EXPECT_NEAR(static_cast<double>(steady_index(x)), 100, 2);
  EXPECT_NEAR(summarize_series(equal_times(1000), x).mean, 0.7, 1e-4);
}

TEST(SteadyState, ADriftIsWorthFewSamples) {
  const SteadySummary summary = summarize_series(equal_times(10000), equal_times(10000));
  EXPECT_LT(summary.n_effective, 20);
  EXPECT_EQ(summary.t_steady, 7500) << "the last quarter comes nearest";
  EXPECT_EQ(summary.steady, false);
}

/// Share of `repeats` series that are called steady, with the search for t0, and how many of these have it late.
double steady_share(Draw& draw, double worth, int repeats, const std::function<double(double)>& trend) {
  constexpr std::size_t kSamples = 2000;
  const double g = std::max(1.0, kSamples / worth);
  double steady = 0;
  for (int i = 0; i < repeats; ++i) {
    std::vector<double> x = ar1(draw, (g - 1) / (g + 1), kSamples);
    for (std::size_t k = 0; k < x.size(); ++k) x[k] += trend(static_cast<double>(k) / kSamples);
    if (summarize_series(equal_times(x.size()), x).steady == true) steady += 1.0 / repeats;
  }
  return steady;
}

// Ornstein-Uhlenbeck series with the start looked for: 200 draws each, so 95 % is 3 standard errors below 98 %. The sum
// over lags in the search (in place of parts) finds a late t0 in 4 % of those worth 100.
TEST(SteadyState, AStationarySeriesIsSteady) {
  Draw draw(21);
  for (const double worth : {100.0, 200.0, 2000.0}) {
    EXPECT_GT(steady_share(draw, worth, 200, [](double) { return 0.0; }), 0.95) << worth;
    // A transient of twenty spreads that is over after a tenth does not count against it.
    EXPECT_GT(steady_share(draw, worth, 200, [](double t) { return 20 * std::exp(-t / 0.02); }), 0.93) << worth;
  }
}

// Straight drifts by six spreads, and relaxations that the run ends in the midst of; and what is too short to tell.
TEST(SteadyState, ADriftAndARelaxationAreNotSteady) {
  Draw draw(22);
  for (const double worth : {100.0, 400.0, 2000.0}) {
    EXPECT_LT(steady_share(draw, worth, 100, [](double t) { return -6 * t; }), 0.04) << worth;
    EXPECT_LT(steady_share(draw, worth, 100, [](double t) { return 10 * std::exp(-t / 0.5); }), 0.06) << worth;
    EXPECT_LT(steady_share(draw, worth, 100, [](double t) { return 10 * std::exp(-t); }), 0.06) << worth;
  }
  EXPECT_LT(steady_share(draw, 12, 200, [](double) { return 0.0; }), 0.05);
  EXPECT_EQ(steady_share(draw, 1, 100, [](double) { return 0.0; }), 0.0);
}

TEST(SteadyState, DriftHasItsError) {
  Draw draw(23);
  double squares = 0;
  for (int i = 0; i < 300; ++i) {
    const std::vector<double> x = ar1(draw, 0.9, 2000);
    const Estimate drift = summarize_series(equal_times(x.size()), x, 0.0).drift;
    squares += std::pow(drift.value / drift.sem, 2) / 300;
  }
  EXPECT_NEAR(squares, 1.0, 0.25);
}

// Up to seven samples as they are; then, with room for eight, ever wider means.
TEST(BoundedSeries, AveragesPairsWhenItIsFull) {
  BoundedSeries<2> series(8);
  for (int i = 0; i < 7; ++i) series.accumulate(i, {10.0 * i, 1.0});
  EXPECT_EQ(series.times(), (std::vector<double>{0, 1, 2, 3, 4, 5, 6}));
  for (int i = 7; i < 1000; ++i) series.accumulate(i, {10.0 * i, 1.0});
  ASSERT_EQ(series.times().size(), 7U);  // of 128 samples each: 999 / 128 = 7.8
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_DOUBLE_EQ(series.times()[i], 128.0 * static_cast<double>(i) + 63.5);
    EXPECT_DOUBLE_EQ(series.column(0)[i], 10 * series.times()[i]);
    EXPECT_DOUBLE_EQ(series.column(1)[i], 1);
  }
  EXPECT_THROW(series.accumulate(999, {0, 0}), std::logic_error);
}

}  // namespace
}  // namespace shaken::analysis
