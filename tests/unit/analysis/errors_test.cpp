#include <gtest/gtest.h>

#include "analysis/angles.h"
#include "analysis/errors/blocked.h"
#include "analysis/errors/jackknife.h"
#include "analysis/errors/parts.h"
#include "analysis/tilt.h"
#include "tests/unit/analysis/analysis_samples.h"
#include "tests/unit/analysis/state_checks.h"

namespace shaken::analysis {
namespace {

std::vector<std::vector<Vec3>> frames(int n) {
  Draw draw(81);
  std::vector<std::vector<Vec3>> result;
  for (int i = 0; i < n; ++i) result.push_back(random_axes(draw, 5));
  return result;
}

/// All samples from number `first` on, accumulated directly.
AngleDistribution direct(const std::vector<std::vector<Vec3>>& all, std::size_t first) {
  AngleDistribution angles(30);
  for (std::size_t i = first; i < all.size(); ++i) angles.accumulate(all[i]);
  return angles;
}

TEST(Blocked, EqualsDirectAccumulation) {
  for (const int n : {1, 10, 64, 65, 128, 129, 1000}) {
    const auto all = frames(n);
    Blocked<AngleDistribution> blocked{AngleDistribution(30)};
    for (int i = 0; i < n; ++i) blocked.accumulate(0.1 * i, all[static_cast<std::size_t>(i)]);
    EXPECT_EQ(state(blocked.all()), state(direct(all, 0))) << n;
    int stretch = 1;  // the length that 64 stretches need
    while (64 * stretch < n) stretch *= 2;
    for (const int first : {0, 1, n / 3, n / 2, n - 1}) {
      const int start = (first + stretch - 1) / stretch * stretch;  // the first stretch that begins at `first` or later
      EXPECT_EQ(state(blocked.after(0.1 * first)), state(direct(all, static_cast<std::size_t>(start))))
          << n << " " << first;
    }
    EXPECT_EQ(state(blocked.after(0.1 * n)), state(AngleDistribution(30)));
  }
}

/// Takes down the number of each sample.
struct Numbers {
  std::int64_t next = 0;
  std::vector<std::int64_t> taken;
  void start_at(std::int64_t samples) { next = samples; }
  void accumulate() { taken.push_back(next++); }
  void merge(const Numbers& other) { taken.insert(taken.end(), other.taken.begin(), other.taken.end()); }
};

TEST(Blocked, StretchesKnowHowManySamplesCameBefore) {
  Blocked<Numbers> blocked{Numbers{}};
  for (int i = 0; i < 300; ++i) blocked.accumulate(0.1 * i);
  const std::vector<std::int64_t> taken = blocked.all().taken;
  ASSERT_EQ(taken.size(), 300U);
  for (std::size_t i = 0; i < taken.size(); ++i) EXPECT_EQ(taken[i], static_cast<std::int64_t>(i));
}

TEST(Blocked, PartsAddUpToAllOfIt) {
  for (const int n : {0, 1, 5, 16, 17, 200}) {
    const auto all = frames(n);
    Blocked<AngleDistribution> blocked{AngleDistribution(30)};
    for (int i = 0; i < n; ++i) blocked.accumulate(0.1 * i, all[static_cast<std::size_t>(i)]);
    for (const double from : {0.0, 0.05 * n}) {
      AngleDistribution sum = blocked.empty();
      const std::vector<AngleDistribution> parts = blocked.parts_after(from, 16);
      for (const AngleDistribution& part : parts) sum.merge(part);
      EXPECT_EQ(state(sum), state(blocked.after(from))) << n;
      EXPECT_LE(parts.size(), 16U);
      EXPECT_GE(parts.size(), static_cast<std::size_t>(std::min(n / 2, 8))) << n;
    }
  }
}

TEST(Blocked, PassesAllArgumentsOn) {
  Blocked<TiltVelocity> blocked{TiltVelocity(4, 0.5)};
  for (int i = 0; i < 200; ++i) {
    blocked.accumulate(i, std::vector<Vec3>{axis(0, 0.1)}, std::vector<Vec3>{Vec3(i < 100 ? 5 : 1, 0, 0)});
  }
  EXPECT_DOUBLE_EQ(blocked.after(100).means().v_along[2], 1.0);
  EXPECT_DOUBLE_EQ(blocked.all().means().v_along[2], 3.0);
  EXPECT_TRUE(std::isnan(blocked.empty().means().v_along[2]));
}

struct Sums {
  double n = 0, x = 0, y = 0;
  void merge(const Sums& other) {
    n += other.n;
    x += other.x;
    y += other.y;
  }
};

// Of a mean the blocks' means are what its error and steadiness come from; of a ratio of means the error is its spread
// over repetitions.
TEST(Jackknife, OfAMeanAndOfARatio) {
  Draw draw(101);
  double spread = 0, error = 0;
  constexpr int kRepetitions = 400;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    std::vector<Sums> blocks;
    std::vector<double> x;
    for (int b = 0; b < 32; ++b) {
      x.push_back(4 + draw.normal());
      blocks.push_back({1, x.back(), 10 + draw.normal()});
    }
    const std::vector<Estimate> e = jackknife(Sums{}, blocks, [](const Sums& s) {
      return std::vector<double>{s.x / s.n, s.x / s.y};
    });
    const PartsSummary of_means = summarize_parts(x);
    EXPECT_NEAR(e[0].value, of_means.mean, 1e-12);
    EXPECT_NEAR(e[0].sem, of_means.sem, 1e-12);
    EXPECT_NEAR(e[0].n_effective, of_means.n_effective, 1e-9);
    EXPECT_EQ(e[0].steady, of_means.steady);
    spread += std::pow((e[1].value - 0.4) / e[1].sem, 2) / kRepetitions;
    error += std::pow(e[1].sem, 2) / kRepetitions;
  }
  // sigma^2 = (1 + 0.4^2) / (10^2 * 32); the mean of 400 squares is good to 7 %. Noise takes correlations that are
  // none for ones that are, which makes errors larger: by 3 % on the average of 32 parts.
  EXPECT_NEAR(spread, 1, 0.25);
  EXPECT_NEAR(error / (1.16 / 3200), 1.1, 0.2);
}

// Blocks that know of each other: of 32 block means of a series worth 32 samples the scatter alone gives errors by a
// third too small.
TEST(Jackknife, CountsBlocksThatKnowOfEachOther) {
  Draw draw(102);
  double spread = 0;
  int n = 0;
  constexpr int kRepetitions = 400;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    std::vector<Sums> blocks(32);
    const std::vector<double> series = ar1(draw, 23.0 / 25, 24 * 32);  // g = 24
    for (std::size_t i = 0; i < series.size(); ++i) blocks[i / 24].merge({1, series[i], 0});
    const Estimate e = jackknife(Sums{}, blocks, [](const Sums& s) { return std::vector<double>{s.x / s.n}; })[0];
    if (std::isnan(e.sem)) continue;  // fewer than kFewestIndependent, by chance
    spread += std::pow(e.value / e.sem, 2);
    ++n;
  }
  EXPECT_GT(n, 0.95 * kRepetitions);
  EXPECT_NEAR(spread / n, 1, 0.3);
}

// A bin that few parts of the run have met: what they say of its scatter is no error.
TEST(Jackknife, ClaimsNoErrorOfWhatFewBlocksHaveMet) {
  Draw draw(103);
  for (const std::size_t met : {9, 10}) {
    std::vector<Sums> blocks(64, Sums{0, 0, 0});
    for (std::size_t i = 0; i < met; ++i) blocks[6 * i] = {1, draw.normal(), 0};
    const Estimate e = jackknife(Sums{}, blocks, [](const Sums& s) { return std::vector<double>{s.x / s.n}; })[0];
    EXPECT_TRUE(std::isfinite(e.value));
    EXPECT_EQ(std::isnan(e.sem), met < kFewestParts) << met;
    EXPECT_EQ(std::isnan(e.n_effective), met < kFewestParts) << met;
  }
}

TEST(Jackknife, SaysSoWhereTheErrorIsUnknown) {
  const auto inverse = [](const Sums& s) { return std::vector<double>{1 / s.x}; };
  EXPECT_DOUBLE_EQ(jackknife(Sums{}, {Sums{1, 2, 0}}, inverse)[0].value, 0.5);
  EXPECT_TRUE(std::isnan(jackknife(Sums{}, {Sums{1, 2, 0}}, inverse)[0].sem));
  std::vector<Sums> blocks(20, Sums{1, 0, 0});
  blocks[0].x = 2;  // all of it
  EXPECT_TRUE(std::isnan(jackknife(Sums{}, blocks, inverse)[0].sem));
  blocks.assign(20, Sums{1, 2, 0});
  const Estimate constant = jackknife(Sums{}, blocks, inverse)[0];
  EXPECT_TRUE(std::isnan(constant.sem)) << "no spread is no error of zero";
  EXPECT_TRUE(std::isnan(constant.n_effective));
}

}  // namespace
}  // namespace shaken::analysis
