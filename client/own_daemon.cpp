// SPDX-License-Identifier: MIT
#include "client/own_daemon.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <chrono>
#include <csignal>
#include <string>
#include <thread>

#include "base/descriptor.h"
#include "base/failure.h"
#include "base/process.h"
#include "client/api_client.h"

namespace shaken::client {
namespace {

constexpr std::chrono::seconds kPatience{20};

bool somebody_listens(const std::filesystem::path& root) {
  try {
    ApiClient(root).get("/v1/status");
    return true;
  } catch (const Failure& failure) {
    if (failure.code != ExitCode::kNoDaemon) throw;
    return false;
  }
}

pid_t start(const std::filesystem::path& root) {
  // It keeps a log of its own. Ctrl-C is for the client, which stops the daemon in order; a client that is killed
  // leaves none behind.
  const Descriptor nowhere(open("/dev/null", O_WRONLY | O_CLOEXEC));
  const Result<pid_t> daemon = start_child({.command = {sibling_program("shakend").string(), "--root", root.string()},
                                            .output = nowhere.value(),
                                            .own_group = true,
                                            .ends_with_us = true});
  if (!daemon) throw Failure(ExitCode::kFailed, daemon.error().message);
  return *daemon;
}

void stop(pid_t pid) {
  kill(pid, SIGTERM);
  wait_for_child(pid);
}

}  // namespace

OwnDaemon::OwnDaemon(const std::filesystem::path& root) {
  if (somebody_listens(root)) return;
  pid_ = start(root);
  const auto begin = std::chrono::steady_clock::now();
  while (!somebody_listens(root)) {
    // One that ends at once may have lost a race for the root directory: then somebody else will listen.
    if (pid_ != 0 && poll_child(pid_)) pid_ = 0;
    if (std::chrono::steady_clock::now() - begin > kPatience) {
      if (pid_ != 0) stop(pid_);
      throw Failure(ExitCode::kFailed, fmt::format("shakend did not start; see {}", (root / "shakend.log").string()));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  if (pid_ != 0 && poll_child(pid_)) pid_ = 0;
}

OwnDaemon::~OwnDaemon() {
  if (pid_ != 0) stop(pid_);
}

}  // namespace shaken::client
