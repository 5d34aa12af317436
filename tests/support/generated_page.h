// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

namespace shaken {

inline std::string content_of(const std::string& file) {
  std::stringstream content;
  content << std::ifstream(file).rdbuf();
  return content.str();
}

/// Holds the part of a page between the lines "<!-- MARK: begin -->" and "<!-- MARK: end -->" to `expected`. With
/// SHAKEN_UPDATE_DOCS=1 in the environment it writes that part anew instead.
inline void expect_generated(const std::string& file, const std::string& mark, const std::string& expected) {
  const std::string text = content_of(file), begin = "<!-- " + mark + ": begin -->\n";
  const std::size_t from = text.find(begin), to = text.find("<!-- " + mark + ": end -->");
  ASSERT_TRUE(from != std::string::npos && to != std::string::npos) << file << " has lost its marks " << mark;
  const std::string whole = text.substr(0, from + begin.size()) + expected + text.substr(to);
  if (std::getenv("SHAKEN_UPDATE_DOCS") != nullptr) std::ofstream(file) << whole;
  EXPECT_TRUE(content_of(file) == whole) << file << ": run this test with SHAKEN_UPDATE_DOCS=1";
}

}  // namespace shaken
