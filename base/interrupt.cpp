#include "base/interrupt.h"

#include <algorithm>
#include <array>
#include <csignal>
#include <ctime>

namespace shaken {
namespace {

volatile std::sig_atomic_t g_interrupted = 0;
constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};
std::array<struct sigaction, kSignals.size()> g_old;

void note_signal(int) { g_interrupted = 1; }

}  // namespace

InterruptGuard::InterruptGuard() {
  g_interrupted = 0;
  struct sigaction action {};
  action.sa_handler = note_signal;  // no SA_RESTART: sleeps must end
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &action, &g_old[i]);
}

InterruptGuard::~InterruptGuard() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &g_old[i], nullptr);
}

bool InterruptGuard::interrupted() const { return g_interrupted != 0; }

void InterruptGuard::sleep_for(std::chrono::milliseconds time) const {
  // In slices, because a signal may arrive between the test and the sleep.
  static constexpr std::chrono::milliseconds kSlice{100};
  while (time.count() > 0 && !interrupted()) {
    const auto slice = std::min(time, kSlice);
    const timespec request{0, static_cast<long>(slice.count()) * 1'000'000};
    nanosleep(&request, nullptr);
    time -= slice;
  }
}

}  // namespace shaken
