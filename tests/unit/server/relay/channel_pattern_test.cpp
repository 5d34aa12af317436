// SPDX-License-Identifier: MIT
#include "proto/relay/channel_pattern.h"

#include <glib.h>
#include <gtest/gtest.h>

#include <optional>

namespace shaken::relay {
namespace {

std::optional<bool> matches(const std::string& pattern, const std::string& channel) {
  const auto compiled = ChannelPattern::compile(pattern);
  if (!compiled) return std::nullopt;
  return compiled->matches(channel);
}

/// What LCM itself does with the two (lcm.c).
bool lcm_matches(const std::string& pattern, const std::string& channel) {
  GRegex* regex = g_regex_new(("^" + pattern + "$").c_str(), GRegexCompileFlags{}, GRegexMatchFlags{}, nullptr);
  const bool is_match = regex != nullptr && g_regex_match(regex, channel.c_str(), GRegexMatchFlags{}, nullptr) != 0;
  if (regex != nullptr) g_regex_unref(regex);
  return is_match;
}

TEST(ChannelPattern, FitsWholeChannelsAsLcmHasIt) {
  EXPECT_EQ(matches("SHAKEN_FRAME", "SHAKEN_FRAME"), true);
  EXPECT_EQ(matches("SHAKEN_FRAME", "SHAKEN_FRAME_STATIC"), false);
  EXPECT_EQ(matches("FRAME", "SHAKEN_FRAME"), false);
  EXPECT_EQ(matches(".*", "SHAKEN_JOB"), true);
  for (const char* pattern :
       {"SHAKEN_.*", "SHAKEN_FRAME|SHAKEN_JOB", "(SHAKEN_FRAME|SHAKEN_JOB)", "[A-Z_]+", "", ".", "SHAKEN_(JOB|STATUS)",
        "A{2,3}", "[A-Z]+", "\\d*", "SHAKEN_JOB.?", "^SHAKEN_JOB$", "a)(b", "é+"}) {
    for (const char* channel : {"SHAKEN_FRAME", "SHAKEN_FRAME_STATIC", "SHAKEN_JOB", "XSHAKEN_JOB", "AA", "AAAA", "",
                                "B", "éé", "SHAKEN_STATUS"}) {
      EXPECT_EQ(matches(pattern, channel).value_or(false), lcm_matches(pattern, channel)) << pattern << " " << channel;
    }
  }
}

TEST(ChannelPattern, WhatCannotBeUsedIsRefused) {
  for (const char* pattern : {"(", "[", "a)(b", "(a)\\1", "(?=a)b", "\\pX", "(((a{50}){50}){50})", "\xff"}) {
    const auto compiled = ChannelPattern::compile(pattern);
    ASSERT_FALSE(compiled) << pattern;
    EXPECT_NE(compiled.error().message, "");
  }
}

TEST(ChannelPattern, NoPatternTakesLong) {
  // PCRE takes some 2^60 steps for the first of these, or gives up.
  const std::string channel = std::string(62, 'a') + "b";
  for (const char* pattern : {"(a+)+", "(a|aa)+", "(a*)*", "(.*)(.*)(.*)(.*)(.*)(.*)c", "(a?){30}a{30}c"}) {
    EXPECT_EQ(matches(pattern, channel), false) << pattern;
  }
}

}  // namespace
}  // namespace shaken::relay
