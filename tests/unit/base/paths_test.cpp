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
  EXPECT_EQ(none.error().message, "no root directory: set --root, SHAKEN_ROOT, or HOME to an absolute path");
  setenv("HOME", "/h", 1);
  EXPECT_EQ(*data_root(), "/h/.local/share/shaken");
  setenv("XDG_DATA_HOME", "/x", 1);
  EXPECT_EQ(*data_root(), "/x/shaken");
  setenv("SHAKEN_ROOT", "/s", 1);
  EXPECT_EQ(*data_root(), "/s");
  EXPECT_EQ(*data_root("/g"), "/g");
  EXPECT_EQ(*data_root("g"), std::filesystem::current_path() / "g");
}

// It would be another root in every folder.
TEST(DataRoot, ARelativePathInTheEnvironmentIsIgnored) {
  unsetenv("SHAKEN_ROOT");
  setenv("XDG_DATA_HOME", "rel", 1);
  setenv("HOME", "/h", 1);
  EXPECT_EQ(*data_root(), "/h/.local/share/shaken");
  setenv("HOME", "rel", 1);
  EXPECT_FALSE(data_root());
}

// Verbs that open a run's folder got its name through JSON, with U+FFFD in the place of such a byte.
TEST(DataRoot, ANameThatJsonCannotHaveIsRefused) {
  for (const char* name : {"/tmp/r\xff", "/tmp/a\nb"}) {
    const auto root = data_root(name);
    ASSERT_FALSE(root);
    EXPECT_NE(root.error().message.find("UTF-8 without control characters, not /tmp/"), std::string::npos)
        << root.error().message;
  }
  EXPECT_EQ(*data_root("/tmp/\u03bc \u00e4"), "/tmp/\u03bc \u00e4");
}

}  // namespace
}  // namespace shaken
