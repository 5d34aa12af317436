// SPDX-License-Identifier: MIT
#include "scene/keys/log_scale.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>

namespace shaken::scene {
namespace {

// Held to the last bit: every machine and compiler has the same values, so that a sweep has the same runs.
TEST(LogScale, TheBitsAreTheSameEverywhere) { EXPECT_EQ(between_on_log_scale(0.3, 70, 0.37), 0x1.20b94d21d30f9p+1); }

TEST(LogScale, IsExactToRounding) {
  EXPECT_TRUE(rc::check("as libm has it", [] {
    const double from = std::pow(10.0, *rc::gen::inRange(-700, 700) / 100.0),
                 ratio = 1 + *rc::gen::inRange(0, 100'000'000) / 10.0;
    const double share = *rc::gen::inRange(0, 1000) / 1000.0;
    const double expected = from * std::pow(ratio, share);
    RC_ASSERT(std::abs(between_on_log_scale(from, from * ratio, share) - expected) < 1e-14 * expected);
  }));
}

}  // namespace
}  // namespace shaken::scene
