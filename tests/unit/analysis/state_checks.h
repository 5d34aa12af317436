#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "base/core/state_io.h"
#include "tests/support/effort.h"

namespace shaken::analysis {

template <class Accumulator>
std::vector<std::byte> state(const Accumulator& accumulator) {
  StateWriter writer;
  accumulator.save(writer);
  return writer.bytes();
}

/// As a run does that stops and goes on: `accumulator` into bytes, and back into a new one without samples.
template <class Accumulator>
void stop_and_go_on(Accumulator& accumulator, const std::type_identity_t<Accumulator>& empty) {
  const std::vector<std::byte> bytes = state(accumulator);
  accumulator = empty;
  StateReader reader(bytes);
  accumulator.restore(reader);
  reader.end();
}

/// Restoring from a state cut off anywhere throws and leaves the object as it was. Sanitizers see every seventh length,
/// which is cut at each byte of a number in turn.
template <class Accumulator>
void expect_every_truncation_found(Accumulator& accumulator) {
  const std::vector<std::byte> bytes = state(accumulator);
  for (std::size_t size = 0; size < bytes.size(); size += test::kSanitized ? 7 : 1) {
    StateReader reader{std::span(bytes).first(size)};
    ASSERT_THROW(accumulator.restore(reader), StateError) << size << " of " << bytes.size();
  }
  EXPECT_EQ(state(accumulator), bytes);
}

/// Numbers of two states are the same, but for the rounding of sums in another order.
inline void expect_same_sums(const std::vector<std::byte>& a, const std::vector<std::byte>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t at = a.size() % 8; at < a.size(); at += 8) {
    if (std::equal(&a[at], &a[at] + 8, &b[at])) continue;
    double x = 0, y = 0;
    std::memcpy(&x, &a[at], 8);
    std::memcpy(&y, &b[at], 8);
    EXPECT_TRUE(std::isnormal(x) && std::isnormal(y)) << "counts, at byte " << at;
    EXPECT_NEAR(x, y, 1e-12 * std::max(1.0, std::abs(y))) << "at byte " << at;
  }
}

}  // namespace shaken::analysis
