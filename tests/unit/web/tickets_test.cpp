// SPDX-License-Identifier: MIT
#include "web/tickets.h"

#include <gtest/gtest.h>

namespace shaken::web {
namespace {

TEST(Tickets, AreForOneThingOnce) {
  Tickets tickets;
  const std::string one = tickets.give("/runs/a/files/x", {}),
                    other = tickets.give("/runs/a/picture", {{"frame", "3"}});
  EXPECT_NE(one, other);
  EXPECT_FALSE(tickets.take("0123456789abcdef0123456789abcdef"));
  EXPECT_FALSE(tickets.take(""));
  const auto meant = tickets.take(other);
  ASSERT_TRUE(meant);
  EXPECT_EQ(meant->method, "GET");
  EXPECT_EQ(meant->path, "/runs/a/picture");
  EXPECT_EQ(meant->parameter("frame"), "3");
  EXPECT_FALSE(tickets.take(other)) << "it has been used";
  EXPECT_TRUE(tickets.take(one));
}

TEST(Tickets, LastAMinute) {
  Tickets::Clock::time_point now{};
  Tickets tickets([&] { return now; });
  const std::string used = tickets.give("/runs/a/files/x", {}), late = tickets.give("/runs/a/files/y", {});
  now += std::chrono::minutes(1);
  EXPECT_TRUE(tickets.take(used));
  now += std::chrono::milliseconds(1);
  EXPECT_FALSE(tickets.take(late));
}

}  // namespace
}  // namespace shaken::web
