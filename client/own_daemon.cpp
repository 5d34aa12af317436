// SPDX-License-Identifier: MIT
#include "client/own_daemon.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
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

/// The child between fork and exec: only async-signal-safe calls.
[[noreturn]] void become_daemon(char* const* arguments, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);  // a client that is killed leaves no daemon behind
  if (getppid() != parent) _exit(1);
  setpgid(0, 0);  // Ctrl-C is for the client, which stops the daemon in order
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) std::signal(number, SIG_DFL);
  const int null = open("/dev/null", O_RDWR);  // it keeps a log of its own
  for (const int end : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(null, end);
  close_range(3, ~0U, CLOSE_RANGE_CLOEXEC);
  execv(arguments[0], arguments);
  _exit(127);
}

pid_t start(const std::filesystem::path& root) {
  std::vector<std::string> words{sibling_program("shakend").string(), "--root", root.string()};
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid == 0) become_daemon(arguments.data(), parent);
  if (pid < 0) throw Failure(ExitCode::kFailed, fmt::format("{}: {}", words[0], std::strerror(errno)));
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
    // One that ends at once may have lost a race for the root directory: then somebody else will listen.
    if (pid_ != 0 && waitpid(pid_, nullptr, WNOHANG) == pid_) pid_ = 0;
    if (std::chrono::steady_clock::now() - begin > kPatience) {
      if (pid_ != 0) stop(pid_);
      throw Failure(ExitCode::kFailed, fmt::format("shakend did not start; see {}", (root / "shakend.log").string()));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  if (pid_ != 0 && waitpid(pid_, nullptr, WNOHANG) == pid_) pid_ = 0;
}

OwnDaemon::~OwnDaemon() {
  if (pid_ != 0) stop(pid_);
}

}  // namespace shaken::client
