#include "base/standard_streams.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>

#include "base/descriptor.h"
#include "base/failure.h"

namespace shaken {
namespace {

/// Opens /dev/null on each of the three that is closed. open(2) takes the lowest number that is free.
void open_closed() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(stream, F_GETFD) >= 0 || errno != EBADF) continue;
    const int opened = open("/dev/null", stream == STDIN_FILENO ? O_RDONLY : O_WRONLY);
    if (opened < 0 || opened == stream) continue;
    dup2(opened, stream);
    close(opened);
  }
}

bool reader_has_gone() {
  pollfd out{STDOUT_FILENO, POLLOUT, 0};
  return poll(&out, 1, 0) == 1 && (out.revents & POLLERR) != 0;
}

void check_output(int code, void* program) {
  errno = 0;
  std::cout.flush();
  const bool failed_now = std::fflush(stdout) != 0;
  const int reason = errno;  // of a write before this one it is no longer known
  if (!failed_now && std::ferror(stdout) == 0) return;
  if (reason != EPIPE && !reader_has_gone()) {
    std::fprintf(stderr, "%s: cannot write to standard output%s%s\n", static_cast<const char*>(program),
                 reason != 0 ? ": " : "", reason != 0 ? std::strerror(reason) : "");
  }
  if (code != static_cast<int>(ExitCode::kOk)) return;
  std::fflush(stderr);
  _exit(static_cast<int>(ExitCode::kFailed));  // the code of a program that has begun to end is changed in no other way
}

}  // namespace

void complain(std::string_view line) {
  std::fwrite(line.data(), 1, line.size(), stderr);
  std::fputc('\n', stderr);
}

Result<void> flush_standard_output() {
  std::cout.flush();
  if (std::fflush(stdout) == 0 && std::cout.good() && std::ferror(stdout) == 0) return {};
  return system_error("cannot write to standard output");
}

void guard_standard_streams(const char* program) {
  open_closed();
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGCHLD,
              SIG_DFL);  // whoever started us may ignore it, and then the system would not say how children end
  on_exit(check_output, const_cast<char*>(program));
}

}  // namespace shaken
