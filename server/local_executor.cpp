#include "server/local_executor.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "base/descriptor.h"
#include "base/process.h"
#include "run/files/directory.h"

namespace shaken::server {

Result<int> LocalExecutor::start(const Launch& launch) {
  const std::filesystem::path log_file = run::RunDirectory{launch.directory}.log();
  // O_NONBLOCK: a pipe of that name, which nobody reads, would keep the daemon for ever
  const Descriptor log(open(log_file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NONBLOCK, 0600));
  if (!log) return system_error(log_file.string());
  struct stat about {};
  if (fstat(log.value(), &about) != 0) return system_error(log_file.string());
  if (!S_ISREG(about.st_mode)) return Error{log_file.string() + " is no regular file"};
  const std::string heading = launch.heading + "\n";
  if (write(log.value(), heading.data(), heading.size()) < 0) return system_error(log_file.string());
  ChildSetup setup;
  setup.command = {program_.string()};
  setup.command.insert(setup.command.end(), launch.arguments.begin(), launch.arguments.end());
  setup.output = log.value();
  setup.own_group = true;
  setup.ends_with_us = true;
  return start_child(setup);
}

WorkerReport LocalExecutor::poll(int pid) {
  siginfo_t info{};
  const int status = waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED | WNOHANG | WNOWAIT);
  if (status != 0) return {.phase = WorkerReport::Phase::kLost, .words = system_error("its worker is lost").message};
  if (info.si_pid == 0) return {};

  // Children that it has left behind; before it is reaped, for then the number of its group may be given anew.
  kill(pid);
  waitpid(pid, nullptr, 0);
  const bool exited = info.si_code == CLD_EXITED;
  return {.phase = WorkerReport::Phase::kEnded, .end = {exited ? info.si_status : 0, exited ? 0 : info.si_status, pid}};
}

void LocalExecutor::stop(int pid) { ::kill(pid, SIGTERM); }

void LocalExecutor::kill(int pid) { ::kill(-pid, SIGKILL); }

}  // namespace shaken::server
