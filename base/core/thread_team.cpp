#include "base/core/thread_team.h"

namespace shaken {
namespace {

/// Waits until `value` is no longer `old`.
void wait_for_change(const std::atomic<std::uint32_t>& value, std::uint32_t old) {
  // Spinning without the PAUSE instruction: virtual machines take it as a sign that the processor is wanted by somebody
  // else, and give it away for 50 us. Yielding comes after it, for the case that the other thread waits for this core.
  constexpr int kSpins = 3000;  // some microseconds: longer than the serial parts of most ticks
  constexpr int kYields = 200;
  for (int spin = 0; spin < kSpins + kYields; ++spin) {
    if (value.load(std::memory_order_acquire) != old) return;
    if (spin >= kSpins) std::this_thread::yield();
  }
  value.wait(old, std::memory_order_acquire);
}

}  // namespace

ThreadTeam::ThreadTeam(int n_threads) {
  for (int thread = 1; thread < n_threads; ++thread) threads_.emplace_back([this, thread] { work(thread); });
}

ThreadTeam::~ThreadTeam() {
  ending_ = true;
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void ThreadTeam::run(Call call, const void* context) {
  call_ = call;
  context_ = context;
  busy_.store(static_cast<std::uint32_t>(threads_.size()), std::memory_order_relaxed);
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
  call(context, 0);
  for (std::uint32_t left = busy_.load(std::memory_order_acquire); left != 0;
       left = busy_.load(std::memory_order_acquire)) {
    wait_for_change(busy_, left);
  }
}

void ThreadTeam::work(int thread) {
  std::uint32_t seen = 0;
  while (true) {
    wait_for_change(round_, seen);
    ++seen;
    if (ending_) return;
    call_(context_, thread);
    if (busy_.fetch_sub(1, std::memory_order_release) == 1) busy_.notify_one();
  }
}

}  // namespace shaken
