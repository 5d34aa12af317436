#include "base/core/rng.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "base/core/natural_log.h"

namespace shaken {
namespace {

TEST(Rng, StreamsAndIndicesAreIndependentOfOrder) {
  Rng a(7, RngStream::kVelocity, 0, 3);
  Rng again(7, RngStream::kVelocity, 0, 3);
  Rng other_index(7, RngStream::kVelocity, 0, 4);
  Rng other_stream(7, RngStream::kLattice, 0, 3);
  Rng other_seed(8, RngStream::kVelocity, 0, 3);
  Rng other_tick(7, RngStream::kVelocity, 1, 3);
  const auto first = a.bits();
  EXPECT_EQ(first, again.bits());
  EXPECT_NE(first, other_index.bits());
  EXPECT_NE(first, other_stream.bits());
  EXPECT_NE(first, other_seed.bits());
  EXPECT_NE(first, other_tick.bits());
}

// Replicas have neighbouring seeds: what one draws at a tick must not be what another draws at the next one.
TEST(Rng, NoTwoKeysNearEachOtherDrawTheSame) {
  std::set<std::uint64_t> drawn;
  int n = 0;
  for (std::uint64_t seed = 0; seed < 16; ++seed) {
    for (const RngStream stream : {RngStream::kNoise, RngStream::kContacts}) {
      for (Tick tick = 0; tick < 64; ++tick) {
        for (std::uint64_t index = 0; index < 16; ++index) {
          drawn.insert(Rng(seed, stream, tick, index).bits());
          ++n;
        }
      }
    }
  }
  EXPECT_EQ(drawn.size(), static_cast<std::size_t>(n));
}

TEST(NaturalLog, AgreesWithLongDouble) {
  double worst = 0;
  for (std::uint64_t k = 0; k < 200000; ++k) {
    Rng rng(1, RngStream::kVelocity, 0, k);
    const double x = k % 2 ? rng.uniform() + 0x1p-53 : std::ldexp(1 + rng.uniform(), static_cast<int>(k % 100) - 50);
    const auto exact = static_cast<double>(std::log(static_cast<long double>(x)));
    worst = std::max(worst, std::abs(natural_log(x) - exact) / std::max(std::abs(exact), 1e-300));
  }
  EXPECT_LT(worst, 5e-16);
  EXPECT_EQ(natural_log(1.0), 0.0);
}

TEST(Rng, MomentsOfUniformAndNormal) {
  // n = 2e5 draws: standard errors 6.5e-4 (uniform mean), 2.2e-3 (normal mean), 3.2e-3 (normal variance); 5 sigma
  const int n = 200000;
  double sum = 0, normal = 0, normal2 = 0;
  for (int i = 0; i < n; ++i) {
    Rng rng(1, RngStream::kVelocity, 0, static_cast<std::uint64_t>(i));
    const double u = rng.uniform();
    EXPECT_GE(u, 0.0);
    EXPECT_LT(u, 1.0);
    sum += u;
    const double z = rng.normal();
    normal += z;
    normal2 += z * z;
  }
  EXPECT_NEAR(sum / n, 0.5, 5 * 6.5e-4);
  EXPECT_NEAR(normal / n, 0.0, 5 * 2.2e-3);
  EXPECT_NEAR(normal2 / n, 1.0, 5 * 3.2e-3);
}

}  // namespace
}  // namespace shaken
