// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <thread>
#include <vector>

namespace shaken {

/// A few threads that share the loops of one tick. A tick takes microseconds, so they wait by spinning for a moment
/// before they sleep.
///
/// A loop's result must not depend on how it is shared out: that keeps runs bitwise the same on any number of threads.
class ThreadTeam {
 public:
  explicit ThreadTeam(int n_threads = 1);
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  int size() const { return static_cast<int>(threads_.size()) + 1; }

  /// Calls body(begin, end, worker) for shares of [0, n), worker in [0, size()), and returns when all are done. Loops
  /// shorter than `grain` per thread stay on the caller's, as worker 0.
  template <class Body>
  void run(int n, int grain, const Body& body) {
    if (threads_.empty() || n < 2 * grain) {
      if (n > 0) body(0, n, 0);
      return;
    }
    share_out(
        n,
        [](const void* context, int begin, int end, int worker) {
          (*static_cast<const Body*>(context))(begin, end, worker);
        },
        &body);
  }

 private:
  using Call = void (*)(const void* context, int begin, int end, int worker);

  void share_out(int n, Call call, const void* context);
  void work(int worker);
  void do_share(int worker) const;

  std::vector<std::thread> threads_;
  // the loop under way; written before round_ is raised, read after
  int n_ = 0;
  Call call_ = nullptr;
  const void* context_ = nullptr;
  bool ending_ = false;
  alignas(64) std::atomic<std::uint32_t> round_{0};  ///< raised to start a loop
  alignas(64) std::atomic<std::uint32_t> busy_{0};   ///< threads that have not finished it
};

}  // namespace shaken
