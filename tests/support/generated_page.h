// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

namespace shaken {

/// Holds the part of a page between the lines "<!-- MARK: begin -->" and "<!-- MARK: end -->" to `expected`. With
/// SHAKEN_UPDATE_DOCS=1 in the environment it writes that part anew instead.
inline void expect_generated(const std::string& file, const std::string& mark, const std::string& expected) {
  std::stringstream content;
  content << std::ifstream(file).rdbuf();
  std::string text = content.str();
  const std::string begin = "<!-- " + mark + ": begin -->\n";
  const std::size_t from = text.find(begin), to = text.find("<!-- " + mark + ": end -->");
  ASSERT_TRUE(from != std::string::npos && to != std::string::npos) << file << " has lost its marks " << mark;
  const std::size_t length = to - from - begin.size();
  if (std::getenv("SHAKEN_UPDATE_DOCS") != nullptr) {
    text.replace(from + begin.size(), length, expected);
    std::ofstream(file) << text;
  } else {
    EXPECT_EQ(text.substr(from + begin.size(), length), expected)
        << file << ": run this test with SHAKEN_UPDATE_DOCS=1";
  }
}

}  // namespace shaken
