// SPDX-License-Identifier: MIT
#include "client/own_daemon.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <string>
#include <thread>

#include "client/failure.h"
#include "client/process.h"
#include "client/session.h"

namespace shaken::client {
namespace {

constexpr std::chrono::seconds kPatience{20};

bool somebody_listens(const std::filesystem::path& root) {
  try {
    Session(root).get("/v1/status");
    return true;
  } catch (const Failure& failure) {
    if (failure.code != ExitCode::kNoDaemon) throw;
    return false;
  }
}

pid_t start(const std::filesystem::path& root) {
  const std::string program = sibling_program("shakend").string();
  const std::string root_text = root.string();
  std::vector<std::string> words{program, "--root", root_text};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int end : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {  // it keeps a log of its own
    posix_spawn_file_actions_addopen(&actions, end, "/dev/null", O_RDWR, 0);
  }
  // A process group of its own: Ctrl-C is for us, and we stop it in order.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t defaults;
  sigemptyset(&defaults);
  for (const int signal : {SIGINT, SIGTERM, SIGPIPE}) sigaddset(&defaults, signal);
  posix_spawnattr_setsigdefault(&attributes, &defaults);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
  pid_t pid = 0;
  const int failure = posix_spawnp(&pid, arguments[0], &actions, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  if (failure != 0) throw Failure(ExitCode::kFailed, fmt::format("{}: {}", program, std::strerror(failure)));
  return pid;
}

void stop(pid_t pid) {
  kill(pid, SIGTERM);
  while (waitpid(pid, nullptr, 0) < 0 && errno == EINTR) {
  }
}

}  // namespace

OwnDaemon::OwnDaemon(const std::filesystem::path& root) {
  if (somebody_listens(root)) return;
  pid_ = start(root);
  const auto begin = std::chrono::steady_clock::now();
  while (!somebody_listens(root)) {
    int status = 0;
    const bool ended = waitpid(pid_, &status, WNOHANG) == pid_;
    if (ended || std::chrono::steady_clock::now() - begin > kPatience) {
      if (!ended) stop(pid_);
      throw Failure(ExitCode::kFailed, fmt::format("shakend did not start; see {}", (root / "shakend.log").string()));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

OwnDaemon::~OwnDaemon() {
  if (pid_ != 0) stop(pid_);
}

}  // namespace shaken::client
