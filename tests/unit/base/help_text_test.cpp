// SPDX-License-Identifier: MIT
#include "base/help_text.h"

#include <gtest/gtest.h>

namespace shaken {
namespace {

TEST(WrappedHelp, LeavesWhatFits) {
  const std::string text = "Usage: shaken\n\n  -o,--out FILE   Where to write\n";
  EXPECT_EQ(wrapped_help(text), text);
}

TEST(WrappedHelp, DescriptionsGoOnBelowThemselves) {
  EXPECT_EQ(wrapped_help("  -o FILE    where the picture goes\n  -x    y\n", 25),
            "  -o FILE    where the\n             picture goes\n  -x    y\n");
}

TEST(WrappedHelp, ADescriptionFarToTheRightGetsLinesOfItsOwn) {
  EXPECT_EQ(
      wrapped_help("  shaken picture RUN RUN RUN --style layers -o x.png   three runs side by side, one headline", 60),
      "  shaken picture RUN RUN RUN --style layers -o x.png\n"
      "                              three runs side by side, one\n                              headline");
}

TEST(WrappedHelp, ProseIsBrokenAndCommandsAreNot) {
  EXPECT_EQ(wrapped_help("one two three four", 9), "one two\nthree\nfour");
  EXPECT_EQ(wrapped_help("  shaken submit scene.json", 10), "  shaken submit scene.json");
  EXPECT_EQ(wrapped_help("µµµ µµµ µµµ", 7), "µµµ µµµ\nµµµ") << "columns, not bytes";
}

}  // namespace
}  // namespace shaken
