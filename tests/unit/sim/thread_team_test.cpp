// SPDX-License-Identifier: MIT
#include "sim/core/thread_team.h"

#include <gtest/gtest.h>

#include <numeric>

namespace shaken {
namespace {

TEST(ThreadTeam, VisitsEachItemOnceWhateverTheNumberOfThreads) {
  for (const int n_threads : {1, 2, 3, 4}) {
    ThreadTeam team(n_threads);
    EXPECT_EQ(team.size(), n_threads);
    for (int round = 0; round < 300; ++round) {
      const int n = round % 50;
      std::vector<int> visits(n, 0), workers(n, -1);
      team.run(n, 1, [&](int begin, int end, int worker) {
        for (int k = begin; k < end; ++k) {
          ++visits[k];
          workers[k] = worker;
        }
      });
      EXPECT_EQ(visits, std::vector<int>(n, 1));
      for (const int worker : workers) EXPECT_TRUE(worker >= 0 && worker < n_threads);
    }
  }
}

TEST(ThreadTeam, WhatALoopWritesIsSeenByTheNext) {
  ThreadTeam team(4);
  std::vector<std::int64_t> values(1000);
  std::iota(values.begin(), values.end(), 0);
  for (int round = 0; round < 200; ++round) {
    std::vector<std::int64_t> next(values.size());
    team.run(static_cast<int>(values.size()), 1, [&](int begin, int end, int) {
      for (int k = begin; k < end; ++k) next[k] = values[values.size() - 1 - k] + 1;
    });
    values = next;
  }
  for (std::size_t k = 0; k < values.size(); ++k) EXPECT_EQ(values[k], static_cast<std::int64_t>(k) + 200);
}

TEST(ThreadTeam, ShortLoopsStayWithTheCaller) {
  ThreadTeam team(4);
  int calls = 0;
  team.run(7, 4, [&](int begin, int end, int worker) {
    ++calls;
    EXPECT_EQ(begin, 0);
    EXPECT_EQ(end, 7);
    EXPECT_EQ(worker, 0);
  });
  EXPECT_EQ(calls, 1);
  team.run(0, 1, [&](int, int, int) { ++calls; });
  EXPECT_EQ(calls, 1);
}

}  // namespace
}  // namespace shaken
