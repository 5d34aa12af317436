#include "server/slurm/command.h"

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstddef>

namespace shaken::server::slurm {
namespace {

constexpr int kTimeIsOver = 124;  // as timeout(1) has it
constexpr int kSaidTooMuch = 1;
/// The most that is read of what a program says [bytes]; squeue has some 100 bytes for a job.
constexpr std::size_t kMostOutput = std::size_t{32} << 20;

std::size_t size_of(const Descriptor& file) {
  struct stat status {};
  return fstat(file.value(), &status) == 0 ? static_cast<std::size_t>(status.st_size) : 0;
}

std::string content(const Descriptor& file) {
  std::string text(size_of(file), '\0');
  const ssize_t n = pread(file.value(), text.data(), text.size(), 0);
  text.resize(n < 0 ? 0 : static_cast<std::size_t>(n));
  return text;
}

}  // namespace

Result<Command> Command::start(const std::vector<std::string>& words, const std::filesystem::path& folder,
                               std::chrono::milliseconds limit) {
  Descriptor output(memfd_create("output", MFD_CLOEXEC));  // never full, unlike a pipe
  if (!output) return system_error("memfd_create");
  const Result<pid_t> child =
      start_child({.command = words, .folder = folder, .output = output.value(), .own_group = true});
  if (!child) return child.error();
  return Command(*child, std::move(output), Clock::now() + limit);
}

std::optional<Captured> Command::poll() {
  const bool says_too_much = size_of(output_) > kMostOutput;
  if (const auto ended = poll_child(child_); ended && !says_too_much) {
    return Captured{ended->shell_code(), content(output_)};
  } else if (!ended && !says_too_much && Clock::now() < end_) {
    return std::nullopt;
  } else if (!ended) {
    kill(-child_, SIGKILL);
    wait_for_child(child_);
  }
  if (says_too_much) return Captured{kSaidTooMuch, "has said more than 32 MiB"};
  return Captured{kTimeIsOver, content(output_) + "has not answered in time"};
}

}  // namespace shaken::server::slurm
