// SPDX-License-Identifier: MIT
#include "client/watch/graphics.h"

#include <gtest/gtest.h>

#include <map>

namespace shaken::client {
namespace {

Graphics best_after(std::initializer_list<const char*> answers) {
  TerminalAnswers heard;
  for (const char* answer : answers) heard.note(answer);
  return heard.best();
}

TEST(Graphics, Names) {
  EXPECT_EQ(graphics_named("auto"), Graphics::kAuto);
  EXPECT_EQ(graphics_named("blocks"), Graphics::kBlocks);
  EXPECT_EQ(graphics_named("sixel"), Graphics::kSixel);
  EXPECT_EQ(graphics_named("kitty"), Graphics::kKitty);
  for (const char* name : {"", "Sixel", "auto|blocks", "iterm"}) EXPECT_EQ(graphics_named(name), std::nullopt) << name;
}

TEST(Graphics, AreThoseThatTheTerminalNames) {
  constexpr const char* kOk = "\x1b_Gi=31;OK\x1b\\";
  EXPECT_EQ(best_after({}), Graphics::kBlocks) << "nothing has been answered";
  EXPECT_EQ(best_after({kOk}), Graphics::kBlocks) << "not all has been answered";
  EXPECT_EQ(best_after({kOk, "\x1b[?62c"}), Graphics::kKitty) << "kitty";
  EXPECT_EQ(best_after({"\x1b[?62;4;22c"}), Graphics::kSixel) << "foot";
  EXPECT_EQ(best_after({"\x1b[?63;1;2;4c"}), Graphics::kSixel) << "the last of them";
  EXPECT_EQ(best_after({kOk, "\x1b[?65;4;6;18;22c"}), Graphics::kKitty) << "WezTerm has both";
  EXPECT_EQ(best_after({"\x1b_Gi=31;ENOTSUPPORTED:no\x1b\\", "\x1b[?6c"}), Graphics::kBlocks);
}

TEST(Graphics, AnswersWithoutSixelsAreNotMistaken) {
  EXPECT_EQ(best_after({"\x1b[?1;2c"}), Graphics::kBlocks) << "VT100";
  EXPECT_EQ(best_after({"\x1b[?6c"}), Graphics::kBlocks) << "the console of Linux";
  EXPECT_EQ(best_after({"\x1b[?4;6c"}), Graphics::kBlocks) << "a VT132: the first is the kind of terminal";
  EXPECT_EQ(best_after({"\x1b[?62;14;24;41c"}), Graphics::kBlocks) << "4 is a digit of others";
  EXPECT_EQ(best_after({"\x1b[?62;4;x4c", "\x1b[?c", "\x1b[?;;c"}), Graphics::kBlocks) << "no numbers";
  EXPECT_EQ(best_after({"\x1b[?62;99999999999;4c"}), Graphics::kBlocks) << "no number that there is";
}

TEST(Graphics, TheWindowsSizeGivesThatOfACharacter) {
  TerminalAnswers answers;
  for (const char* other : {"\x1b[8;40;120t", "\x1b[4;600t", "\x1b[4;;t", "\x1b[4;6x;800t", "\x1b[6;20;10t"}) {
    answers.note(other);
    EXPECT_EQ(answers.window, std::nullopt) << other;
  }
  answers.note("\x1b[4;805;1209t");
  ASSERT_EQ(answers.window, (PixelSize{1209, 805}));
  EXPECT_EQ(cell_size(*answers.window, 120, 40), (PixelSize{10, 20}));
  EXPECT_EQ(cell_size({0, 0}, 120, 40), std::nullopt);
  EXPECT_EQ(cell_size({1200, 800}, 0, 0), std::nullopt);
  EXPECT_EQ(cell_size({120, 40}, 120, 40), std::nullopt) << "some put characters where pixels belong";
  EXPECT_EQ(cell_size({2000000000, 2000000000}, 120, 40), std::nullopt) << "too large to be drawn";
  EXPECT_EQ(cell_size({-1200, -800}, 120, 40), std::nullopt);
}

TEST(Graphics, MultiplexersAreKnownByTheirVariables) {
  const auto is_one = [](std::map<std::string, std::string> variables) {
    return is_in_multiplexer([&](const char* name) -> const char* {
      const auto place = variables.find(name);
      return place == variables.end() ? nullptr : place->second.c_str();
    });
  };
  EXPECT_TRUE(is_one({{"TERM", "xterm-256color"}, {"TMUX", "/tmp/tmux-1000/default,1,0"}}));
  EXPECT_TRUE(is_one({{"TERM", "xterm-256color"}, {"STY", "1.pts-0.host"}}));
  EXPECT_TRUE(is_one({{"TERM", "tmux-256color"}})) << "by ssh, out of tmux";
  EXPECT_TRUE(is_one({{"TERM", "screen.xterm-256color"}}));
  EXPECT_FALSE(is_one({{"TERM", "xterm-kitty"}, {"TMUX", ""}}));
  EXPECT_FALSE(is_one({}));
}

}  // namespace
}  // namespace shaken::client
