// SPDX-License-Identifier: MIT
#include "client/console.h"

#include <gtest/gtest.h>

#include <sstream>

namespace shaken::client {
namespace {

TEST(Agrees, AsksUntilTheAnswerIsClear) {
  std::ostringstream out;
  std::istringstream answers("perhaps\nn\n\ny\n");
  const Console console{.out = out, .err = out, .in = &answers};
  EXPECT_FALSE(console.agrees("Go on?", true));
  EXPECT_EQ(out.str(), "Go on? [Y/n] Go on? [Y/n] ");
  EXPECT_TRUE(console.agrees("Go on?", true)) << "an empty answer";
  EXPECT_TRUE(console.agrees("Go on?", false));
  EXPECT_FALSE(console.agrees("Go on?", false)) << "no answer at all";
}

TEST(Painted, ColoursOnlyWhereWanted) {
  std::ostringstream out;
  Console console{.out = out, .err = out};
  EXPECT_EQ(console.painted(Colour::kRed, "x"), "x");
  console.colour = true;
  EXPECT_EQ(console.painted(Colour::kRed, "x"), "\x1b[31mx\x1b[0m");
  EXPECT_EQ(console.painted(Colour::kPlain, "x"), "x");
}

}  // namespace
}  // namespace shaken::client
