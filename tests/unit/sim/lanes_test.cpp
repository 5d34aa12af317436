#include "sim/lanes/lanes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <limits>

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

/// The same to the bit, of values where instructions for the larger of two and comparisons may differ.
struct CompareBits {
  const float* a;
  const float* b;

  template <int W>
  SHAKEN_INLINE bool run() const {
    using F = Floats<W>;
    const F x = load<W>(a), y = load<W>(b), most = larger(x, y), least_of_two = smaller(x, y);
    bool same = true;
    std::uint32_t below = 0, not_above = 0;
    for (unsigned l = 0; l < W; ++l) {
      const float p = a[l], q = b[l];
      const auto bits = [](float of) { return std::bit_cast<std::uint32_t>(of); };
      same &= bits(most[l]) == bits(p > q ? p : q) && bits(least_of_two[l]) == bits(p < q ? p : q);
      below |= (p < 0 ? 1U : 0U) << l;
      not_above |= (p > 0 ? 0U : 1U) << l;
    }
    return same && below_zero(x) == below && not_above_zero(x) == not_above;
  }
};

TEST(Lanes, DoWhatScalarsDoAtEveryWidth) {
  test::Draw draw(41);
  constexpr float kSpecial[] = {std::numeric_limits<float>::quiet_NaN(), 0.0F, -0.0F, 1.0F, -1.0F, 1e-40F};
  float a[kLanes], b[kLanes], special[kLanes], other[kLanes];
  const int widest = detail::machine_width;
  for (int trial = 0; trial < 1000; ++trial) {
    for (int l = 0; l < kLanes; ++l) {
      a[l] = static_cast<float>(draw.normal() * 10);
      b[l] = static_cast<float>(draw.normal() * 10);
      special[l] = kSpecial[draw.integer(0, 5)];
      other[l] = kSpecial[draw.integer(0, 5)];
    }
    for (const int width : {4, 8, 16}) {
      detail::machine_width = std::min(width, widest);
      EXPECT_TRUE(with_widest_vectors(Compare{a, b})) << "width " << width;
      EXPECT_TRUE(with_widest_vectors(CompareBits{special, other})) << "width " << width;
    }
  }
  detail::machine_width = widest;
}

}  // namespace
}  // namespace shaken::lanes
