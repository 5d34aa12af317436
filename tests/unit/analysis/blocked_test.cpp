#include "analysis/errors/blocked.h"

#include <gtest/gtest.h>

#include "analysis/angles.h"
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

}  // namespace
}  // namespace shaken::analysis
