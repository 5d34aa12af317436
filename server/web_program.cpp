#include "server/web_program.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <csignal>
#include <thread>

#include "base/process.h"

namespace shaken::server {
namespace {

using namespace std::chrono_literals;

constexpr auto kLongestWait = 60s;
constexpr auto kRunsWell = 60s;  // after so long its next end is the first again
constexpr auto kEndsWithin = 3s;

}  // namespace

void WebProgram::wait_longer() {
  pause_ = std::clamp<std::chrono::seconds>(2 * pause_, 1s, kLongestWait);
  next_start_ = Clock::now() + pause_;
}

void WebProgram::check() {
  if (is_ending_) return;
  if (pid_ != 0) {
    const std::optional<ProcessEnd> end = poll_child(pid_);
    if (!end) return;
    if (Clock::now() - started_ > kRunsWell) pause_ = 0s;
    wait_longer();
    if (end->is_success()) {
      spdlog::info("the page is served by another shaken-web; looking again in {} s", pause_.count());
    } else {
      spdlog::error("shaken-web {}; the next start is in {} s", end->text(), pause_.count());
    }
    pid_ = 0;
  }
  if (Clock::now() < next_start_) return;
  ChildSetup setup;
  setup.command = command_;
  setup.own_group = true;
  setup.ends_with_us = true;
  const Result<pid_t> started = start_child(setup);
  if (!started) {
    wait_longer();
    spdlog::error("{}; the next start is in {} s", started.error().message, pause_.count());
    return;
  }
  pid_ = *started;
  started_ = Clock::now();
}

void WebProgram::request_stop() {
  is_ending_ = true;
  if (pid_ != 0) kill(pid_, SIGTERM);
}

WebProgram::~WebProgram() {
  request_stop();
  if (pid_ == 0) return;
  const auto end = Clock::now() + kEndsWithin;
  while (!poll_child(pid_)) {
    if (Clock::now() > end) kill(pid_, SIGKILL);
    std::this_thread::sleep_for(10ms);
  }
}

}  // namespace shaken::server
