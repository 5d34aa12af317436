#include <glib.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <array>
#include <optional>

#include "proto/relay/address.h"
#include "proto/relay/client.h"
#include "proto/relay/tcpq.h"
#include "tests/support/good.h"

namespace shaken::relay {
namespace {

TEST(RelayAddress, IsReadAndShown) {
  const auto address = test::good(parse_address("127.0.0.1:7700"));
  EXPECT_TRUE(address->is_loopback());
  EXPECT_EQ(address->port, 7700);
  EXPECT_EQ(address->text(), "127.0.0.1:7700");
  EXPECT_EQ(address->url(), "tcpq://127.0.0.1:7700");
}

TEST(RelayAddress, OfOtherMachinesIsNoLoopback) {
  EXPECT_FALSE(parse_address("192.168.1.2:7700")->is_loopback());
  EXPECT_FALSE(parse_address("0.0.0.0:7700")->is_loopback());
  EXPECT_EQ(parse_address("0.0.0.0:7700")->url(), "tcpq://127.0.0.1:7700") << "where a program beside it finds it";
  EXPECT_TRUE(parse_address("127.9.9.9:0")->is_loopback());
}

TEST(RelayAddress, RefusesWhatTcpqCannotReach) {
  for (const char* text : {"", "7700", "127.0.0.1", "127.0.0.1:", "127.0.0.1:70000", "127.0.0.1:-1", "127.0.0.1:7700x",
                           "desk:7700", "localhost:7700", "[::1]:7700", "127.1:7700", "tcpq://127.0.0.1:7700"}) {
    EXPECT_THAT(test::refusal(parse_address(text)), testing::HasSubstr("127.0.0.1:7700")) << text;
  }
}

// The bytes of LCM's tcpq, as its own client writes them.

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

SendQueue::Message message(const std::string& text) { return std::make_shared<const std::string>(text); }

std::string rest_of(SendQueue& queue) {
  std::string text;
  while (!queue.empty()) {
    text += std::string(queue.next()) + ",";
    queue.sent(queue.next().size());
  }
  return text;
}

TEST(SendQueue, KeepsTheNewestOfTooMany) {
  SendQueue queue(2, 1000);
  for (const char* text : {"a", "b", "c", "d"}) queue.push(message(text));
  EXPECT_EQ(queue.dropped(), 2);
  EXPECT_EQ(rest_of(queue), "c,d,");
}

TEST(SendQueue, KeepsTheNewestOfTooManyBytes) {
  SendQueue queue(100, 8);
  for (const char* text : {"aaaa", "bbb", "ccc"}) queue.push(message(text));
  EXPECT_EQ(queue.dropped(), 1);
  EXPECT_EQ(rest_of(queue), "bbb,ccc,");
  queue.push(message("nine long"));
  EXPECT_TRUE(queue.empty()) << "what would never fit";
  queue.push(message("dddddddd"));
  EXPECT_EQ(rest_of(queue), "dddddddd,") << "the count of bytes has not suffered";
}

TEST(SendQueue, WhatIsOnItsWayStaysWhole) {
  SendQueue queue(1, 8);
  queue.push(message("begun"));
  queue.sent(2);
  queue.push(message("b"));
  queue.push(message("c"));
  EXPECT_EQ(queue.next(), "gun");
  EXPECT_EQ(queue.dropped(), 1);
  queue.push(message("much more"));
  EXPECT_EQ(rest_of(queue), "gun,");
  EXPECT_EQ(queue.dropped(), 3);
}

class ClientTest : public testing::Test {
 protected:
  ClientTest() {
    std::array<int, 2> ends{};
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends.data()), 0);
    program_ = Descriptor(ends[0]);
    client_ = std::make_unique<Client>(Descriptor(ends[1]), limits_, Client::Clock::now());
  }
  void send(const std::string& bytes) const {
    EXPECT_EQ(::send(program_.value(), bytes.data(), bytes.size(), 0), std::ssize(bytes));
  }
  /// One turn; what it has published.
  std::vector<std::string> turn() {
    std::vector<std::string> channels;
    client_->receive([&](std::string_view channel, std::string_view) { channels.emplace_back(channel); },
                     Client::Clock::now());
    return channels;
  }

  Limits limits_;
  Descriptor program_;
  std::unique_ptr<Client> client_;
};

// Each message may have to be matched with the patterns of all others.
TEST_F(ClientTest, AFloodIsObeyedInTurns) {
  std::string flood = client_greeting();
  for (int k = 0; k < 100; ++k) flood += publication("A" + std::to_string(k), "");
  send(flood.substr(0, flood.size() - 1));
  std::vector<std::string> all = turn();
  EXPECT_EQ(all.size(), limits_.turn);
  while (client_->has_more()) {
    const auto more = turn();
    EXPECT_LE(more.size(), limits_.turn);
    all.insert(all.end(), more.begin(), more.end());
  }
  EXPECT_EQ(all.size(), 99u);
  send(flood.substr(flood.size() - 1));
  EXPECT_EQ(turn(), std::vector<std::string>{"A99"});
  client_->check_times(Client::Clock::now() + std::chrono::hours(1));
  EXPECT_FALSE(client_->has_ended()) << "nothing is left half said";
}

TEST_F(ClientTest, HalfAMessageAfterAFloodIsStillNoticed) {
  std::string flood = client_greeting();
  for (int k = 0; k < 20; ++k) flood += publication("A", "");
  send(flood + publication("A", "payload").substr(0, 10));
  do turn();
  while (client_->has_more());
  client_->check_times(Client::Clock::now() + std::chrono::hours(1));
  EXPECT_THAT(client_->refusal(), testing::HasSubstr("half a message"));
}

TEST_F(ClientTest, SubscriptionsThatTakeLongToMatchAreRefused) {
  limits_.program = ChannelPattern::compile("A").value().size();
  send(client_greeting() + subscription(Kind::kSubscribe, "A"));
  turn();
  EXPECT_EQ(client_->refusal(), "") << "as long as may be";
  limits_ = {};
  send(subscription(Kind::kSubscribe, "(.?){60}.{60}Q"));
  turn();
  EXPECT_THAT(client_->refusal(), testing::HasSubstr("take too long"));
}

TEST_F(ClientTest, ManySubscriptionsThatTakeLongToMatchAreRefused) {
  send(client_greeting());
  for (int k = 0; k < 32; ++k) send(subscription(Kind::kSubscribe, "([a-z]?){20}Q" + std::to_string(k)));
  do turn();
  while (client_->has_more());
  EXPECT_THAT(client_->refusal(), testing::HasSubstr("take too long"));
}

TEST_F(ClientTest, UsualSubscriptionsAreAllTaken) {
  send(client_greeting());
  for (int k = 0; k < 31; ++k) send(subscription(Kind::kSubscribe, "SHAKEN_FRAME_STATIC_" + std::to_string(k)));
  send(subscription(Kind::kSubscribe, ".*"));
  do turn();
  while (client_->has_more());
  EXPECT_EQ(client_->refusal(), "");
  EXPECT_TRUE(client_->wants("ANY"));
}

}  // namespace
}  // namespace shaken::relay
