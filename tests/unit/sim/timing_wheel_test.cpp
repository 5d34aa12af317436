// SPDX-License-Identifier: MIT
#include "sim/stepping/timing_wheel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "tests/support/random_rods.h"

namespace shaken {
namespace {

TEST(TimingWheel, BringsEachItemUpAtItsLastTickAndOnlyThen) {
  test::Draw draw(31);
  TimingWheel wheel(50);
  std::map<std::int32_t, Tick> due;  // the twin
  std::vector<std::int32_t> popped;
  Tick furthest = 0;
  for (Tick now = 0; now < 30000; ++now) {
    if (now == 10000) wheel.make_room(80);
    const int n_items = now < 10000 ? 50 : 80;
    for (int k = 0; k < 3; ++k) {
      const std::int32_t item = draw.integer(0, n_items - 1);
      if (draw.integer(0, 9) == 0) {
        wheel.remove(item);
        due.erase(item);
      } else {
        const Tick at = now + draw.integer(1, draw.integer(0, 3) ? 30 : static_cast<int>(TimingWheel::horizon()));
        wheel.set(item, at);
        due[item] = at;
        furthest = std::max(furthest, at - now);
      }
    }
    wheel.pop(now + 1, popped);
    std::sort(popped.begin(), popped.end());
    std::vector<std::int32_t> expected;
    for (const auto& [item, at] : due) {
      if (at == now + 1) expected.push_back(item);
    }
    ASSERT_EQ(popped, expected) << "tick " << now + 1;
    for (const std::int32_t item : popped) due.erase(item);
  }
  EXPECT_GT(furthest, 4000);
}

}  // namespace
}  // namespace shaken
