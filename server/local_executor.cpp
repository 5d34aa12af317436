// SPDX-License-Identifier: MIT
#include "server/local_executor.h"

#include <fcntl.h>
#include <linux/close_range.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

#include "run/files/directory.h"
#include "sim/core/check.h"

namespace shaken::server {
namespace {

/// A file descriptor that closes itself.
class Fd {
 public:
  explicit Fd(int fd) : fd_(fd) {}
  Fd(const Fd&) = delete;
  Fd& operator=(const Fd&) = delete;
  ~Fd() {
    if (fd_ >= 0) ::close(fd_);
  }
  int value() const { return fd_; }

 private:
  int fd_;
};

Error system_error(const std::string& what) { return {what + ": " + std::strerror(errno)}; }

/// The child between fork and exec: only async-signal-safe calls, for other threads may hold any lock. Reports errno
/// of a failed exec through `report`, which a successful exec closes.
[[noreturn]] void become_worker(char* const* arguments, int null, int log, int report, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(99);  // the daemon died before prctl
  setpgid(0, 0);

  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  std::signal(SIGPIPE, SIG_DFL);

  dup2(null, STDIN_FILENO);
  dup2(log, STDOUT_FILENO);
  dup2(log, STDERR_FILENO);
  close_range(3, ~0U, CLOSE_RANGE_CLOEXEC);  // sockets of cpp-httplib would leak otherwise
  execv(arguments[0], arguments);

  const int reason = errno;
  [[maybe_unused]] const ssize_t written = write(report, &reason, sizeof(reason));
  _exit(127);
}

}  // namespace

Result<int> LocalExecutor::start(const Launch& launch) {
  const std::filesystem::path log_file = run::RunDirectory{launch.directory}.log();
  const Fd log(open(log_file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600));
  if (log.value() < 0) return system_error(log_file.string());
  const std::string heading = launch.heading + "\n";
  if (write(log.value(), heading.data(), heading.size()) < 0) return system_error(log_file.string());
  const Fd null(open("/dev/null", O_RDONLY | O_CLOEXEC));
  if (null.value() < 0) return system_error("/dev/null");
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return system_error("pipe");
  const Fd report_reader(ends[0]);

  std::vector<std::string> words{program_.string()};
  words.insert(words.end(), launch.arguments.begin(), launch.arguments.end());
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  pid_t pid = -1;
  {
    const Fd report_writer(ends[1]);
    const pid_t parent = getpid();
    pid = fork();
    if (pid == 0) become_worker(arguments.data(), null.value(), log.value(), report_writer.value(), parent);
    if (pid < 0) return system_error("cannot start a worker");
  }
  int reason = 0;
  if (read(report_reader.value(), &reason, sizeof(reason)) > 0) {
    waitpid(pid, nullptr, 0);
    errno = reason;
    return system_error(program_.string() + " cannot be run");
  }
  return static_cast<int>(pid);
}

std::optional<WorkerEnd> LocalExecutor::poll(int pid) {
  siginfo_t info{};
  const int status = waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED | WNOHANG | WNOWAIT);
  SHAKEN_CHECK(status == 0, "waitid(" + std::to_string(pid) + "): " + std::strerror(errno));
  if (info.si_pid == 0) return std::nullopt;

  // Children that it has left behind; before it is reaped, for then the number of its group may be given anew.
  kill(pid);
  waitpid(pid, nullptr, 0);
  const bool exited = info.si_code == CLD_EXITED;
  return WorkerEnd{exited ? info.si_status : 0, exited ? 0 : info.si_status};
}

void LocalExecutor::stop(int pid) { ::kill(pid, SIGTERM); }

void LocalExecutor::kill(int pid) { ::kill(-pid, SIGKILL); }

}  // namespace shaken::server
