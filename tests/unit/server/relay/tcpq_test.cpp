// SPDX-License-Identifier: MIT
// The bytes of LCM's tcpq, as its own client writes them.
#include "proto/relay/tcpq.h"

#include <gtest/gtest.h>

namespace shaken::relay {
namespace {

using namespace std::string_literals;

const std::string kPublish = "\0\0\0\1"s + "\0\0\0\2"s + "AB" + "\0\0\0\3"s + "xyz";
const std::string kSubscribe = "\0\0\0\2"s + "\0\0\0\3"s + "A.*";

Instruction instruction_of(std::string_view bytes) { return std::get<Instruction>(parse_instruction(bytes, {})); }

std::string refusal_of(std::string_view bytes) {
  const Parsed parsed = parse_instruction(bytes, {});
  const auto* unreadable = std::get_if<Unreadable>(&parsed);
  return unreadable == nullptr ? "" : unreadable->reason;
}

std::string word(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<char>(value >> shift & 0xff));
  return bytes;
}

TEST(Tcpq, GreetingsAreThoseOfLcm) {
  EXPECT_EQ(server_greeting(), "\x28\x76\x17\xfa\0\0\1\0"s);
  EXPECT_EQ(client_greeting(), "\x28\x76\x17\xfb\0\0\1\0"s);
}

TEST(Tcpq, AGreetingIsKnownByItsFirstWrongByte) {
  EXPECT_EQ(greeting_of(""), Greeting::kIncomplete);
  EXPECT_EQ(greeting_of("\x28\x76"), Greeting::kIncomplete);
  EXPECT_EQ(greeting_of(client_greeting() + kPublish), Greeting::kRight);
  EXPECT_EQ(greeting_of("G"), Greeting::kWrong);
  EXPECT_EQ(greeting_of(server_greeting()), Greeting::kWrong);
  EXPECT_EQ(greeting_of("\x28\x76\x17\xfb\0\0\2\0"s), Greeting::kWrong) << "another version";
}

TEST(Tcpq, InstructionsAreReadAndWritten) {
  const std::string more = kPublish + "rest";
  const Instruction published = instruction_of(more);
  EXPECT_EQ(published.kind, Kind::kPublish);
  EXPECT_EQ(published.text, "AB");
  EXPECT_EQ(published.payload, "xyz");
  EXPECT_EQ(published.size, kPublish.size());
  EXPECT_EQ(publication("AB", "xyz"), kPublish);
  const Instruction subscribed = instruction_of(kSubscribe);
  EXPECT_EQ(subscribed.kind, Kind::kSubscribe);
  EXPECT_EQ(subscribed.text, "A.*");
  EXPECT_EQ(subscribed.size, kSubscribe.size());
  EXPECT_EQ(subscription(Kind::kSubscribe, "A.*"), kSubscribe);
  EXPECT_EQ(instruction_of(subscription(Kind::kUnsubscribe, "A.*")).kind, Kind::kUnsubscribe);
  EXPECT_EQ(instruction_of(publication("AB", "")).payload, "");
}

TEST(Tcpq, EveryBeginningIsIncomplete) {
  for (const std::string& whole : {kPublish, kSubscribe}) {
    for (std::size_t n = 0; n < whole.size(); ++n) {
      EXPECT_TRUE(std::holds_alternative<Incomplete>(parse_instruction(whole.substr(0, n), {}))) << n;
    }
  }
}

TEST(Tcpq, LimitsHoldBeforeTheBytesAreThere) {
  EXPECT_NE(refusal_of(word(0)), "");
  EXPECT_NE(refusal_of(word(4)), "");
  EXPECT_NE(refusal_of(word(1) + word(0)), "") << "no channel";
  EXPECT_EQ(refusal_of(word(1) + word(63)), "");
  EXPECT_NE(refusal_of(word(1) + word(64)), "");
  EXPECT_EQ(refusal_of(word(2) + word(256)), "");
  EXPECT_NE(refusal_of(word(2) + word(257)), "");
  EXPECT_NE(refusal_of(word(3) + word(0xffffffff)), "");
  EXPECT_EQ(refusal_of(word(1) + word(1) + "A" + word(1 << 20)), "");
  EXPECT_NE(refusal_of(word(1) + word(1) + "A" + word((1 << 20) + 1)), "");
  EXPECT_NE(refusal_of(word(1) + word(1) + "A" + word(0xffffffff)), "");
  EXPECT_NE(refusal_of(publication("A\0B"s, "")), "") << "LCM's channels end with the first NUL";
}

}  // namespace
}  // namespace shaken::relay
