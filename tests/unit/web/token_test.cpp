// SPDX-License-Identifier: MIT
#include "web/token.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace shaken::web {
namespace {

TEST(Token, IsAnotherOneEachTime) {
  const auto one = make_token(), other = make_token();
  ASSERT_TRUE(one && other);
  EXPECT_THAT(*one, testing::MatchesRegex("[0-9a-f]+"));
  EXPECT_EQ(one->size(), 32u);
  EXPECT_NE(*one, *other);
}

TEST(Token, OnlyTheWholeOneFits) {
  const std::string token(32, 'a');
  EXPECT_TRUE(is_token(token, token));
  EXPECT_FALSE(is_token(std::string(31, 'a'), token));
  EXPECT_FALSE(is_token(std::string(33, 'a'), token));
  EXPECT_FALSE(is_token("", token));
  for (std::size_t i = 0; i < token.size(); ++i) {
    std::string other = token;
    other[i] = 'b';
    EXPECT_FALSE(is_token(other, token)) << i;
  }
}

}  // namespace
}  // namespace shaken::web
