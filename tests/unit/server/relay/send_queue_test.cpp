// SPDX-License-Identifier: MIT
#include "proto/relay/send_queue.h"

#include <gtest/gtest.h>

namespace shaken::relay {
namespace {

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

}  // namespace
}  // namespace shaken::relay
