// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "sim/core/types.h"

namespace shaken {

/// Things to look at, by the tick at which they are due: a ring of buckets, one per tick, insert and pop in O(1)
/// (Varghese & Lauck 1987). Items are never removed: whoever pops one checks whether it is still meant.
class TimingWheel {
 public:
  /// Due ticks may lie up to `horizon()` ahead.
  static constexpr Tick kSlots = 4096;
  static constexpr Tick horizon() { return kSlots - 1; }

  void insert(Tick due, std::int32_t item) { slots_[static_cast<std::size_t>(due % kSlots)].push_back(item); }

  /// Moves the items of tick `now` into `items` (whose old content is dropped).
  void pop(Tick now, std::vector<std::int32_t>& items) {
    auto& slot = slots_[static_cast<std::size_t>(now % kSlots)];
    items.clear();
    items.swap(slot);
  }

  void clear() {
    for (auto& slot : slots_) slot.clear();
  }

 private:
  std::vector<std::vector<std::int32_t>> slots_ = std::vector<std::vector<std::int32_t>>(kSlots);
};

}  // namespace shaken
