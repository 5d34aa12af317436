#include "server/slurm/slurm_call.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "base/text.h"

namespace shaken::server::slurm {
namespace {

using std::chrono::seconds;

constexpr seconds kSubmitLimit{300};
constexpr seconds kLimit{60};
/// How long Slurm takes at most to refuse something.
constexpr seconds kAtOnce{2};
constexpr int kCannotBeRun = 127;

}  // namespace

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
