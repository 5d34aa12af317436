#include "sim/schedule/timing_wheel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "tests/support/random_rods.h"

namespace shaken {
namespace {

/// Who owns an item may change while it is not in.
TEST(TimingWheel, BringsEachItemUpAtItsLastTickAndOnlyThenToItsOwner) {
  constexpr int kOwners = 3;
  test::Draw draw(31);
  TimingWheel wheel(50, kOwners);
  std::map<std::int32_t, int> owners;
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
        if (!due.contains(item)) owners[item] = draw.integer(0, kOwners - 1);
        wheel.set(item, at, owners[item]);
        due[item] = at;
        furthest = std::max(furthest, at - now);
      }
    }
    popped.clear();
    for (int owner = 0; owner < kOwners; ++owner) {
      const std::size_t first = popped.size();
      wheel.pop(now + 1, popped, owner);
      for (std::size_t k = first; k < popped.size(); ++k) EXPECT_EQ(owners[popped[k]], owner);
    }
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
