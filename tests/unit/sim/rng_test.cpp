// SPDX-License-Identifier: MIT
#include "sim/core/rng.h"

#include <gtest/gtest.h>

namespace shaken {
namespace {

TEST(Rng, StreamsAndIndicesAreIndependentOfOrder) {
  Rng a(7, RngStream::kVelocity, 3);
  Rng again(7, RngStream::kVelocity, 3);
  Rng other_index(7, RngStream::kVelocity, 4);
  Rng other_stream(7, RngStream::kLattice, 3);
  Rng other_seed(8, RngStream::kVelocity, 3);
  const auto first = a.bits();
  EXPECT_EQ(first, again.bits());
  EXPECT_NE(first, other_index.bits());
  EXPECT_NE(first, other_stream.bits());
  EXPECT_NE(first, other_seed.bits());
}

TEST(Rng, MomentsOfUniformAndNormal) {
  // n = 2e5 draws: standard errors 6.5e-4 (uniform mean), 2.2e-3 (normal mean), 3.2e-3 (normal variance); 5 sigma
  const int n = 200000;
  double sum = 0, normal = 0, normal2 = 0;
  for (int i = 0; i < n; ++i) {
    Rng rng(1, RngStream::kVelocity, static_cast<std::uint64_t>(i));
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
