// SPDX-License-Identifier: MIT
#include "base/peak_memory.h"

#include <gtest/gtest.h>

#include <string>

#include "base/process.h"

namespace shaken {
namespace {

TEST(PeakMemory, IsWhatWasHeldAtMost) {
  constexpr std::size_t kMuch = 80'000'000;
  const double before = peak_memory();
  EXPECT_GT(before, 1e5);
  {
    const std::string much(kMuch, 'x');
    EXPECT_EQ(much.back(), 'x');
  }
  const double after = peak_memory();
  EXPECT_GT(after, kMuch) << "though it has been given back";
  EXPECT_EQ(run_captured({"true"}).exit_code, 0);
  EXPECT_GT(children_peak_memory(), 1e5);
  EXPECT_LT(peak_memory(), after + kMuch) << "a child holds its own";
}

}  // namespace
}  // namespace shaken
