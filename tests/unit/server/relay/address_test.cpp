// SPDX-License-Identifier: MIT
#include "proto/relay/address.h"

#include <gtest/gtest.h>

namespace shaken::relay {
namespace {

TEST(RelayAddress, IsReadAndShown) {
  const auto address = parse_address("127.0.0.1:7700");
  ASSERT_TRUE(address);
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
    const auto address = parse_address(text);
    ASSERT_FALSE(address) << text;
    EXPECT_NE(address.error().message.find("127.0.0.1:7700"), std::string::npos);
  }
}

}  // namespace
}  // namespace shaken::relay
