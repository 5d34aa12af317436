#include "base/interrupt.h"

#include <algorithm>
#include <csignal>
#include <ctime>

namespace shaken {
namespace {

volatile std::sig_atomic_t g_interrupted = 0;
struct sigaction g_old_int;
struct sigaction g_old_term;
struct sigaction g_old_hup;

void note_signal(int) { g_interrupted = 1; }

}  // namespace

InterruptGuard::InterruptGuard() {
  g_interrupted = 0;
  struct sigaction action {};
  action.sa_handler = note_signal;  // no SA_RESTART: sleeps must end
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, &g_old_int);
  sigaction(SIGTERM, &action, &g_old_term);
  sigaction(SIGHUP, &action, &g_old_hup);
}

InterruptGuard::~InterruptGuard() {
  sigaction(SIGINT, &g_old_int, nullptr);
  sigaction(SIGTERM, &g_old_term, nullptr);
  sigaction(SIGHUP, &g_old_hup, nullptr);
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
