#pragma once

#include <algorithm>
#include <atomic>
#include <span>
#include <vector>

#include "base/core/thread_team.h"
#include "base/core/types.h"
#include "sim/bounds/safe_time.h"

namespace shaken {

/// Threads that share the loops of a tick. Each has a `Share`: its own rods and pairs, so that what belongs to them
/// stays in one thread's caches, and whatever it gathers.
template <class Share>
class SharedLoops {
 public:
  explicit SharedLoops(int n_threads) : team_(n_threads), shares_(static_cast<std::size_t>(n_threads)) {}

  std::vector<Share>& shares() { return shares_; }
  const std::vector<Share>& shares() const { return shares_; }

  /// Whether loops are shared from now on; if not, the caller's thread does everyone's work.
  void set_shared(bool shared) { shared_ = shared && team_.size() > 1; }

  /// Calls visit(share) for each share, each on its own thread if loops are shared. Returns when all are done.
  template <class Visit>
  void run(const Visit& visit) {
    if (shared_) {
      team_.run([&](int k) { visit(shares_[static_cast<std::size_t>(k)]); });
    } else {
      for (Share& share : shares_) visit(share);
    }
  }

  /// Sets the mark to `now`. True for one of the threads that do so at the same time, and for that one only if the mark
  /// was not `now` before.
  bool claim(Tick& mark, Tick now) const {
    if (!shared_) {
      if (mark == now) return false;
      mark = now;
      return true;
    }
    const std::atomic_ref<Tick> shared(mark);
    return shared.load(std::memory_order_relaxed) != now && shared.exchange(now, std::memory_order_relaxed) != now;
  }

 private:
  ThreadTeam team_;
  std::vector<Share> shares_;
  bool shared_ = false;
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
  void in_lanes(std::span<const int> list, const Visit& visit, std::size_t n_lanes = kLanes) const {
    while (!list.empty()) {
      const std::size_t most = std::min(n_lanes, list.size());
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
