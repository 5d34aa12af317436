// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/contact/safe_time.h"
#include "sim/core/thread_team.h"

namespace shaken {

/// One thread's part of a loop.
struct LoopPart {
  std::vector<int> own;       ///< items of the list that the thread owns
  std::span<const int> mine;  ///< those that it visits: its own, or all if it is alone
};

/// Loops over lists without order, which several threads may share: each item has an owner, so that what belongs to it
/// stays in one thread's caches. A `Worker` is a LoopPart with whatever else a thread has and gathers in a loop.
template <class Worker>
class SharedLoops {
 public:
  /// Loops are shared if there are at least `grain` items for each thread.
  SharedLoops(int n_threads, int grain)
      : team_(n_threads), grain_(grain), workers_(static_cast<std::size_t>(n_threads)) {}

  std::vector<Worker>& workers() { return workers_; }
  const std::vector<Worker>& workers() const { return workers_; }

  /// Calls visit(worker) on each thread, worker.mine being its part of the list; on one if that is not worth it.
  template <class Visit>
  void run(const std::vector<int>& list, const std::vector<std::uint8_t>& owners, const Visit& visit) {
    if (team_.size() == 1 || static_cast<int>(list.size()) < grain_ * team_.size()) {
      for (Worker& worker : workers_) worker.mine = {};
      workers_[0].mine = list;
      visit(workers_[0]);
      return;
    }
    team_.run([&](int w) {
      Worker& worker = workers_[w];
      // without a branch, which would be mispredicted every other time
      worker.own.resize(list.size());
      std::size_t n = 0;
      for (const int item : list) {
        worker.own[n] = item;
        n += owners[item] == w;
      }
      worker.mine = std::span(worker.own).first(n);
      visit(worker);
    });
  }

 private:
  ThreadTeam team_;
  int grain_;
  std::vector<Worker> workers_;
};

/// Bounds are made for kLanes items of one group at a time. With one group in all there is nothing to sort.
template <class Group>
class Groups {
 public:
  Groups(bool several, Group group_of) : several_(several), group_of_(group_of) {}

  void sort(std::vector<int>& list) const {
    if (several_) std::stable_sort(list.begin(), list.end(), [&](int a, int b) { return group_of_(a) < group_of_(b); });
  }
  /// Calls visit(part) for parts of the sorted list that are of one group and fit into the lanes.
  template <class Visit>
  void in_lanes(std::span<const int> list, const Visit& visit) const {
    while (!list.empty()) {
      const std::size_t most = std::min<std::size_t>(kLanes, list.size());
      std::size_t n = several_ ? 1 : most;
      while (n < most && group_of_(list[n]) == group_of_(list.front())) ++n;
      visit(list.first(n));
      list = list.subspan(n);
    }
  }

 private:
  bool several_;
  Group group_of_;
};

}  // namespace shaken
