// SPDX-License-Identifier: MIT
#include "base/keys/nearest.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <vector>

namespace shaken::keys {
namespace {

/// Straight from the definition, exponential.
std::size_t slow_distance(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty()) return std::max(a.size(), b.size());
  const auto cut = [](const std::string& s, std::size_t n) { return s.substr(0, s.size() - n); };
  std::size_t least = std::min({slow_distance(cut(a, 1), b) + 1, slow_distance(a, cut(b, 1)) + 1,
                                slow_distance(cut(a, 1), cut(b, 1)) + (a.back() == b.back() ? 0 : 1)});
  if (a.size() > 1 && b.size() > 1 && a.back() == b[b.size() - 2] && a[a.size() - 2] == b.back()) {
    least = std::min(least, slow_distance(cut(a, 2), cut(b, 2)) + 1);
  }
  return least;
}

TEST(Nearest, DistanceAgreesWithItsDefinition) {
  const auto word = rc::gen::resize(5, rc::gen::container<std::string>(rc::gen::elementOf(std::string("abc"))));
  EXPECT_TRUE(rc::check("distance", [&] {
    const std::string a = *word;
    const std::string b = *word;
    RC_ASSERT(edit_distance(a, b) == slow_distance(a, b));
  }));
}

TEST(Nearest, IsTheFirstOfThoseAtTheLeastDistance) {
  const auto word = rc::gen::resize(6, rc::gen::container<std::string>(rc::gen::elementOf(std::string("abc"))));
  EXPECT_TRUE(rc::check("nearest", [&] {
    const std::string wanted = *word;
    const auto names = *rc::gen::container<std::vector<std::string>>(rc::gen::nonEmpty(word));
    RC_PRE(!names.empty());
    const auto first = std::min_element(names.begin(), names.end(), [&](const std::string& a, const std::string& b) {
      return edit_distance(wanted, a) < edit_distance(wanted, b);
    });
    const std::string found = nearest(wanted, names);
    RC_ASSERT(found.empty() || found == *first);
  }));
}

TEST(Nearest, FindsSlipsOfThePenOnly) {
  const std::vector<std::string> names{"length", "mid_diameter", "end_diameter", "area_fraction"};
  EXPECT_EQ(nearest("lenght", names), "length");
  EXPECT_EQ(nearest("Length", names), "length");
  EXPECT_EQ(nearest("area_fracton", names), "area_fraction");
  EXPECT_EQ(nearest("diameter", names), "mid_diameter");
  EXPECT_EQ(nearest("colour", names), "");
  EXPECT_EQ(nearest("x", names), "");
  EXPECT_EQ(nearest("anything", std::vector<std::string>{}), "");
}

}  // namespace
}  // namespace shaken::keys
