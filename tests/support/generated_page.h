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

/// Holds the part of a file between its comments "MARK: begin" and "MARK: end" to `expected`. With SHAKEN_UPDATE_DOCS=1
/// in the environment it writes that part anew instead.
inline void expect_generated(const std::string& file, const std::string& mark, const std::string& expected) {
  const std::string text = content_of(file);
  const std::size_t begin = text.find(mark + ": begin"), end = text.find(mark + ": end");
  const std::size_t from = text.find('\n', begin), to = text.rfind('\n', end);
  ASSERT_TRUE(begin < end && end != std::string::npos) << file << " has lost its marks " << mark;
  const std::string whole = text.substr(0, from + 1) + expected + text.substr(to + 1);
  if (std::getenv("SHAKEN_UPDATE_DOCS") != nullptr) std::ofstream(file) << whole;
  EXPECT_TRUE(content_of(file) == whole) << file << ": run this test with SHAKEN_UPDATE_DOCS=1";
}

}  // namespace shaken
