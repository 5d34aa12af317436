#include "base/process.h"

#include <fcntl.h>
#include <linux/close_range.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

#include "base/descriptor.h"
#include "base/failure.h"
#include "base/standard_streams.h"

namespace shaken {
namespace {

constexpr int kParentHasGone = 1;
constexpr int kCannotRun = 127;
/// The end of a child of which the system does not know: as if it had been killed.
constexpr ProcessEnd kLost{0, SIGKILL};

std::vector<char*> argument_vector(const std::vector<std::string>& command) {
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  return arguments;
}

/// The child between fork and exec: only async-signal-safe calls, for other threads may hold any lock. Reports errno of
/// what failed through `report`, which a successful exec closes.
[[noreturn]] void become_child(const ChildSetup& setup, char* const* arguments, int null, int report, pid_t parent) {
  if (setup.ends_with_us) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent) _exit(kParentHasGone);  // it ended before prctl
  }
  if (setup.own_group) setpgid(0, 0);

  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  std::signal(SIGPIPE, SIG_DFL);  // we ignore them; others are not written for that
  std::signal(SIGXFSZ, SIG_DFL);

  dup2(setup.input >= 0 ? setup.input : null, STDIN_FILENO);
  if (setup.output >= 0) {
    dup2(setup.output, STDOUT_FILENO);
    dup2(setup.output, STDERR_FILENO);
  }
  close_range(3, ~0U, CLOSE_RANGE_CLOEXEC);  // sockets of cpp-httplib would leak otherwise
  if (setup.folder.empty() || chdir(setup.folder.c_str()) == 0) execvp(arguments[0], arguments);

  const int reason = errno;
  [[maybe_unused]] const ssize_t written = write(report, &reason, sizeof(reason));
  _exit(kCannotRun);
}

ProcessEnd end_of(int status) {
  return WIFEXITED(status) ? ProcessEnd{WEXITSTATUS(status), 0} : ProcessEnd{0, WTERMSIG(status)};
}

/// Keeps what comes out of `output` until its writers are gone. False where they went beyond the limits before.
bool keep_output(int output, const CaptureLimits* limits, std::string& kept) {
  constexpr int kRoundMs = 100;
  const auto begin = std::chrono::steady_clock::now();
  char buffer[1 << 16];
  for (;;) {
    if (limits != nullptr) {
      if (std::chrono::steady_clock::now() - begin > limits->time || kept.size() > limits->output) return false;
      if (limits->stop && limits->stop()) return false;
      pollfd readable{output, POLLIN, 0};
      if (poll(&readable, 1, kRoundMs) == 0) continue;
    }
    const ssize_t n = read(output, buffer, sizeof buffer);
    if (n > 0) kept.append(buffer, static_cast<std::size_t>(n));
    if (n == 0 || (n < 0 && errno != EINTR)) return true;
  }
}

Captured capture(ChildSetup setup, const CaptureLimits* limits) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return {kCannotRun, std::strerror(errno)};
  const Descriptor reader(ends[0]);
  const Result<pid_t> child = [&] {
    const Descriptor writer(ends[1]);
    setup.output = writer.value();
    return start_child(setup);
  }();
  if (!child) return {kCannotRun, child.error().message};
  Captured captured;
  captured.cut_short = !keep_output(reader.value(), limits, captured.output);
  if (captured.cut_short) kill(-*child, SIGKILL);
  captured.exit_code = wait_for_child(*child).shell_code();
  return captured;
}

}  // namespace

std::filesystem::path sibling_program(const std::string& name) {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  return error ? std::filesystem::path(name) : self.parent_path() / name;
}

void go_on_as_wide_build([[maybe_unused]] char** argv) {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma") || !__builtin_cpu_supports("bmi") ||
      !__builtin_cpu_supports("bmi2")) {
    return;
  }
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) execv((self.string() + "-wide").c_str(), argv);  // of which there is no wide build
#endif
}

std::string ProcessEnd::text() const {
  return signal != 0 ? "was ended by signal " + std::to_string(signal)
                     : "failed with exit code " + std::to_string(exit_code);
}

Result<pid_t> start_child(const ChildSetup& setup) {
  const auto arguments = argument_vector(setup.command);
  const Descriptor null(open("/dev/null", O_RDONLY | O_CLOEXEC));
  if (!null) return system_error("/dev/null");
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return system_error("pipe");
  const Descriptor report_reader(ends[0]);

  pid_t child = -1;
  {
    const Descriptor report_writer(ends[1]);
    const pid_t parent = getpid();
    child = fork();
    if (child == 0) become_child(setup, arguments.data(), null.value(), report_writer.value(), parent);
    if (child < 0) return system_error("cannot start " + setup.command[0]);
  }
  int reason = 0;
  ssize_t n = 0;
  do n = read(report_reader.value(), &reason, sizeof(reason));
  while (n < 0 && errno == EINTR);
  if (n > 0) {
    wait_for_child(child);
    errno = reason;
    return system_error(setup.command[0] + " cannot be run");
  }
  return child;
}

ProcessEnd wait_for_child(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return kLost;
  }
  return end_of(status);
}

std::optional<ProcessEnd> poll_child(pid_t child) {
  int status = 0;
  const pid_t ended = waitpid(child, &status, WNOHANG);
  if (ended == child) return end_of(status);
  return ended == 0 || errno == EINTR ? std::nullopt : std::optional(kLost);
}

Captured run_captured(const std::vector<std::string>& command, const std::filesystem::path& folder) {
  return capture({.command = command, .folder = folder, .ends_with_us = true}, nullptr);
}

Captured run_with_input(const std::vector<std::string>& command, std::string_view input) {
  // a file, not a pipe: nobody has to write while the other reads
  const Descriptor file(memfd_create("input", MFD_CLOEXEC));
  if (!file) return {kCannotRun, std::strerror(errno)};
  while (!input.empty()) {
    const ssize_t n = write(file.value(), input.data(), input.size());
    if (n < 0 && errno != EINTR) return {kCannotRun, std::strerror(errno)};
    if (n > 0) input.remove_prefix(static_cast<std::size_t>(n));
  }
  lseek(file.value(), 0, SEEK_SET);
  return capture({.command = command, .input = file.value(), .ends_with_us = true}, nullptr);
}

Captured run_captured(const std::vector<std::string>& command, const CaptureLimits& limits) {
  return capture({.command = command, .own_group = true, .ends_with_us = true}, &limits);
}

void become(const std::vector<std::string>& command) {
  done_or_fail(flush_standard_output());
  std::signal(SIGPIPE, SIG_DFL);
  std::signal(SIGXFSZ, SIG_DFL);
  const auto arguments = argument_vector(command);
  execvp(arguments[0], arguments.data());
  throw Failure(ExitCode::kFailed, system_error(command[0] + " cannot be run").message);
}

}  // namespace shaken
