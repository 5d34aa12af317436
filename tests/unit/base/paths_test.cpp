// SPDX-License-Identifier: MIT
#include "base/paths.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace shaken {
namespace {

TEST(DataRoot, WhatIsGivenDecidesElseTheFirstVariableThatIsSet) {
  for (const char* name : {"SHAKEN_ROOT", "XDG_DATA_HOME", "HOME"}) unsetenv(name);
  const auto none = data_root();
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().message, "no root directory: set --root, SHAKEN_ROOT or HOME");
  setenv("HOME", "/h", 1);
  EXPECT_EQ(*data_root(), "/h/.local/share/shaken");
  setenv("XDG_DATA_HOME", "/x", 1);
  EXPECT_EQ(*data_root(), "/x/shaken");
  setenv("SHAKEN_ROOT", "/s", 1);
  EXPECT_EQ(*data_root(), "/s");
  EXPECT_EQ(*data_root("/g"), "/g");
  EXPECT_EQ(*data_root("g"), std::filesystem::current_path() / "g");
}

}  // namespace
}  // namespace shaken
