#pragma once

#include <atomic>
#include <thread>
#include <vector>

namespace shaken {

/// A few threads that do the loops of one tick together. A tick takes microseconds, so they wait by spinning for a
/// moment before they sleep.
class ThreadTeam {
 public:
  explicit ThreadTeam(int n_threads = 1);
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  int size() const { return static_cast<int>(threads_.size()) + 1; }

  /// Calls body(thread) once on each thread, thread in [0, size()), 0 being the caller's, and returns when all are
  /// done.
  template <class Body>
  void run(const Body& body) {
    run([](const void* context, int thread) { (*static_cast<const Body*>(context))(thread); }, &body);
  }

 private:
  using Call = void (*)(const void* context, int thread);

  void run(Call call, const void* context);
  void work(int thread);

  std::vector<std::thread> threads_;
  // the call under way; written before round_ is raised, read after
  Call call_ = nullptr;
  const void* context_ = nullptr;
  bool ending_ = false;
  alignas(64) std::atomic<std::uint32_t> round_{0};  ///< raised to start a call
  alignas(64) std::atomic<std::uint32_t> busy_{0};   ///< threads that have not finished it
};

}  // namespace shaken
