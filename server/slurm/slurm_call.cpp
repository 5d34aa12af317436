#include "server/slurm/slurm_call.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstddef>

#include "base/text.h"

namespace shaken::server::slurm {
namespace {

using std::chrono::seconds;

constexpr seconds kSubmitLimit{300};
constexpr seconds kLimit{60};
/// How long Slurm takes at most to refuse something.
constexpr seconds kAtOnce{2};
constexpr int kCannotBeRun = 127;

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

std::string SlurmCall::Answer::in_one_line() const {
  std::string text = said.output;
  std::replace(text.begin(), text.end(), '\n', ' ');
  text.erase(text.find_last_not_of(' ') + 1);
  if (text.empty()) text = fmt::format("exit {}", said.exit_code);
  constexpr std::size_t kMost = 500;
  return printable(fitted(text, kMost));
}

void SlurmCall::start(Kind kind, const std::vector<std::string>& words, const std::filesystem::path& folder) {
  kind_ = kind;
  started_ = Clock::now();
  auto command = Command::start(words, folder, kind == Kind::kSubmit ? kSubmitLimit : kLimit);
  if (command) {
    command_.emplace(std::move(*command));
  } else {
    not_started_ = {kind, {kCannotBeRun, command.error().message}, true, false};
  }
}

std::optional<SlurmCall::Answer> SlurmCall::poll() {
  if (not_started_) return std::exchange(not_started_, std::nullopt);
  const auto said = command_ ? command_->poll() : std::nullopt;
  if (!said) return std::nullopt;
  command_.reset();
  return Answer{kind_, *said, Clock::now() < started_ + kAtOnce};
}

void SlurmCall::set_failed(const std::string& why, std::chrono::milliseconds first_pause) {
  pause_ = std::clamp(2 * pause_, first_pause, std::max(first_pause, longest_pause_));
  next_call_ = Clock::now() + pause_;
  if (trouble_ != why) spdlog::warn("Slurm: {}", why);
  trouble_ = why;
}

void SlurmCall::set_fine() {
  if (!trouble_.empty()) spdlog::info("Slurm answers");
  trouble_.clear();
  silence_.clear();
  pause_ = {};
}

}  // namespace shaken::server::slurm
