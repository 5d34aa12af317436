#pragma once

#include <algorithm>

#include "sim/lanes/lanes.h"
#include "tests/support/random_rods.h"

namespace shaken::test {

/// Has vectors of any width that the machine has take their turn; of the widest again when this goes.
class AnyWidth {
 public:
  AnyWidth() = default;
  AnyWidth(const AnyWidth&) = delete;
  AnyWidth& operator=(const AnyWidth&) = delete;
  ~AnyWidth() { lanes::detail::machine_width = widest_; }

  void draw(Draw& draw) {
    constexpr int kWidths[] = {4, 8, 16};
    lanes::detail::machine_width = std::min(widest_, kWidths[draw.integer(0, 2)]);
  }

 private:
  int widest_ = lanes::detail::machine_width;
};

}  // namespace shaken::test
