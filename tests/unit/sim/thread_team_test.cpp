#include "base/core/thread_team.h"

#include <gtest/gtest.h>

#include <numeric>

namespace shaken {
namespace {

TEST(ThreadTeam, CallsEachThreadOnce) {
  for (const int n_threads : {1, 2, 3, 4}) {
    ThreadTeam team(n_threads);
    EXPECT_EQ(team.size(), n_threads);
    for (int round = 0; round < 300; ++round) {
      std::vector<int> calls(n_threads, 0);
      std::vector<std::thread::id> threads(n_threads);
      team.run([&](int thread) {
        ++calls.at(thread);
        threads.at(thread) = std::this_thread::get_id();
      });
      EXPECT_EQ(calls, std::vector<int>(n_threads, 1));
      EXPECT_EQ(threads[0], std::this_thread::get_id());
    }
  }
}

TEST(ThreadTeam, WhatACallWritesIsSeenByTheNext) {
  ThreadTeam team(4);
  std::vector<std::int64_t> values(1000);
  std::iota(values.begin(), values.end(), 0);
  for (int round = 0; round < 200; ++round) {
    std::vector<std::int64_t> next(values.size());
    team.run([&](int thread) {
      for (std::size_t k = thread; k < values.size(); k += 4) next[k] = values[values.size() - 1 - k] + 1;
    });
    values = next;
  }
  for (std::size_t k = 0; k < values.size(); ++k) EXPECT_EQ(values[k], static_cast<std::int64_t>(k) + 200);
}

TEST(ThreadTeam, SleepersWakeUp) {
  ThreadTeam team(2);
  std::atomic<int> calls{0};
  for (int round = 0; round < 3; ++round) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // far longer than anyone spins
    team.run([&](int) { ++calls; });
  }
  EXPECT_EQ(calls, 6);
}

}  // namespace
}  // namespace shaken
