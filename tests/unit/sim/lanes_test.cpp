#include "sim/lanes/lanes.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/random_rods.h"

namespace shaken::lanes {
namespace {

/// What the lanes give and what their scalar twins do, for one width.
struct Compare {
  const float* a;
  const float* b;

  template <int W>
  SHAKEN_INLINE bool run() const {
    using F = Floats<W>;
    const F x = load<W>(a);
    const F y = load<W>(b);
    bool same = true;
    const F results[] = {larger(x, y),       smaller(x, y), not_below_zero(x),          lanes::abs(x),
                         with_sign_of(x, y), truncated(x),  lanes::sqrt(lanes::abs(x)), clamp(x, lanes::abs(y))};
    float least_x = a[0];
    for (int l = 0; l < W; ++l) {
      const float p = a[l], q = b[l];
      const float expected[] = {
          std::max(p, q),      std::min(p, q), std::max(p, 0.0F),       std::fabs(p),
          std::copysign(p, q), std::trunc(p),  std::sqrt(std::fabs(p)), std::clamp(p, -std::fabs(q), std::fabs(q))};
      for (int r = 0; r < 8; ++r) same &= results[r][l] == expected[r];
      least_x = std::min(least_x, p);
    }
    return same && least(x) == least_x;
  }
};

TEST(Lanes, DoWhatScalarsDoAtEveryWidth) {
  test::Draw draw(41);
  float a[kLanes], b[kLanes];
  const int widest = detail::machine_width;
  for (int trial = 0; trial < 1000; ++trial) {
    for (int l = 0; l < kLanes; ++l) {
      a[l] = static_cast<float>(draw.normal() * 10);
      b[l] = static_cast<float>(draw.normal() * 10);
    }
    for (const int width : {4, 8, 16}) {
      detail::machine_width = std::min(width, widest);
      EXPECT_TRUE(with_widest_vectors(Compare{a, b})) << "width " << width;
    }
  }
  detail::machine_width = widest;
}

}  // namespace
}  // namespace shaken::lanes
