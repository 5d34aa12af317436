// SPDX-License-Identifier: MIT
#include "run/movie_process.h"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <string>
#include <thread>

namespace shaken::run {
namespace {

constexpr int kCannotExecute = 127;

/// The exit status of `child`; ends it first if `stop` becomes true.
int wait_for(pid_t child, const std::atomic<bool>& stop) {
  constexpr std::chrono::milliseconds kPause{20};
  bool asked = false;
  for (;;) {
    int status = 0;
    const pid_t ended = waitpid(child, &status, WNOHANG);
    if (ended == child) return status;
    if (ended < 0 && errno != EINTR) return -1;
    if (stop && !asked) {
      kill(child, SIGTERM);
      asked = true;
    }
    std::this_thread::sleep_for(kPause);
  }
}

}  // namespace

std::optional<Error> render_movie(const std::filesystem::path& directory, const std::atomic<bool>& stop) {
  std::error_code reason;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", reason);
  if (reason) return Error{"cannot find the folder of this program: " + reason.message()};
  const std::string program = (self.parent_path() / "shaken-render").string();
  if (!std::filesystem::exists(program)) return Error{program + " is missing"};
  std::string verb = "movie";
  std::string folder = directory.string();
  std::string name = "shaken-render";
  char* const arguments[] = {name.data(), verb.data(), folder.data(), nullptr};

  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0) return Error{std::string("cannot start ") + program + ": " + std::strerror(errno)};
  if (child == 0) {
    // Only calls that are safe after fork: no movie must go on without its worker.
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() == parent) execv(program.c_str(), arguments);
    _exit(kCannotExecute);
  }
  const int status = wait_for(child, stop);
  if (stop) return Error{"stopped while drawing"};
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return std::nullopt;
  const std::string how = WIFSIGNALED(status) ? "was ended by signal " + std::to_string(WTERMSIG(status))
                                              : "failed with exit code " + std::to_string(WEXITSTATUS(status));
  return Error{program + " " + how};
}

}  // namespace shaken::run
