// SPDX-License-Identifier: MIT
#include "web/token.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "base/scratch_folder.h"

namespace shaken::web {
namespace {

TEST(Token, IsMadeOnceAndKept) {
  const ScratchFolder root, other;
  const auto token = read_or_make_token(root.path());
  ASSERT_TRUE(token) << token.error().message;
  EXPECT_THAT(*token, testing::MatchesRegex("[0-9a-f]+"));
  EXPECT_EQ(token->size(), 32u);
  EXPECT_EQ(*read_or_make_token(root.path()), *token);
  EXPECT_NE(*read_or_make_token(other.path()), *token);
  struct stat status {};
  ASSERT_EQ(stat((root / "web.token").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600u) << "nobody else may read it";
}

TEST(Token, AFileWithoutOneIsNotBelieved) {
  for (const char* text :
       {"", "\n", "short\n", "0123456789abcdef0123456789abcdeg\n", "0123456789abcdef0123456789abcdef0\n"}) {
    const ScratchFolder root;
    std::ofstream(root / "web.token") << text;
    const auto token = read_or_make_token(root.path());
    ASSERT_FALSE(token) << text;
    EXPECT_THAT(token.error().message, testing::HasSubstr("remove it"));
  }
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
