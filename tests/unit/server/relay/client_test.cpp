// SPDX-License-Identifier: MIT
#include "proto/relay/client.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <array>

namespace shaken::relay {
namespace {

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
  send(flood);
  std::vector<std::string> all = turn();
  EXPECT_EQ(all.size(), limits_.turn);
  while (client_->has_more()) {
    const auto more = turn();
    EXPECT_LE(more.size(), limits_.turn);
    all.insert(all.end(), more.begin(), more.end());
  }
  ASSERT_EQ(all.size(), 100u);
  EXPECT_EQ(all.back(), "A99");
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
  send(client_greeting() + subscription(Kind::kSubscribe, "(.?){60}.{60}Q"));
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
