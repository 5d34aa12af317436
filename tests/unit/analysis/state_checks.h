#pragma once

#include <gtest/gtest.h>

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

}  // namespace shaken::analysis
