// SPDX-License-Identifier: MIT
#include "base/progress_line.h"

#include <gtest/gtest.h>

#include <sstream>

namespace shaken {
namespace {

TEST(ProgressLine, IsWrittenOverOnATerminalAndWipedAtTheEnd) {
  std::ostringstream out;
  {
    ProgressLine line(out, true, 12, 0);
    line.show("a long line of text");
    EXPECT_EQ(out.str(), "\ra long lin…\x1b[K");
    line.show("too soon after the last one");
    EXPECT_EQ(out.str(), "\ra long lin…\x1b[K");
  }
  EXPECT_EQ(out.str(), "\ra long lin…\x1b[K\r\x1b[K");
}

TEST(ProgressLine, TheLastOneStaysAndIsNeverTooSoon) {
  std::ostringstream out;
  ProgressLine line(out, true, 80, 0);
  line.show("half");
  line.end_with("done");
  EXPECT_EQ(out.str(), "\rhalf\x1b[K\r\x1b[Kdone\n");
}

TEST(ProgressLine, LogsGetALineNowAndThenOrNone) {
  std::ostringstream often, never;
  ProgressLine every_nanosecond(often, false, 0, 1e-9);
  every_nanosecond.show(
      "a line that is longer than a terminal is wide, which a log does not mind at all, whatever it says");
  EXPECT_EQ(often.str(),
            "a line that is longer than a terminal is wide, which a log does not mind at all, whatever it says\n");
  ProgressLine none(never, false, 0, 0);
  none.show("half");
  EXPECT_EQ(never.str(), "");
  none.end_with("done");
  EXPECT_EQ(never.str(), "done\n");
}

}  // namespace
}  // namespace shaken
