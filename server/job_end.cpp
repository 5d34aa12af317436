#include "server/job_end.h"

#include <spdlog/spdlog.h>

#include <csignal>
#include <sstream>

#include "base/failure.h"
#include "base/files.h"
#include "run/files/done.h"
#include "run/files/progress.h"

namespace shaken::server {
namespace {

constexpr auto kFailedCode = static_cast<int>(ExitCode::kFailed);
constexpr auto kBadInputCode = static_cast<int>(ExitCode::kBadInput);
constexpr auto kNoRoomCode = static_cast<int>(ExitCode::kNoRoom);
constexpr auto kStoppedOnRequest = static_cast<int>(ExitCode::kStopped);

/// A line of the worker's log, "2026-11-28T13:06:32.775 error no room", without its time and level.
std::string without_time(const std::string& line) {
  const std::size_t time = line.find(' '), level = line.find(' ', time + 1);
  const bool has_time = time != std::string::npos && time > 10 && line[4] == '-' && line[10] == 'T';
  if (!has_time || level == std::string::npos) return line;
  const std::string word = line.substr(time + 1, level - time - 1);
  return spdlog::level::from_str(word) == spdlog::level::off ? line : line.substr(level + 1);
}

/// The last line of the worker with anything on it, of the last 4 KiB; empty if the log cannot be read.
std::string last_line(const std::filesystem::path& file) {
  constexpr int kTail = 4096;
  const Result<std::string> part = read_part(file, -kTail, kTail);
  if (!part) return {};
  std::istringstream tail(*part);
  std::string line;
  std::string last;
  while (std::getline(tail, line)) {
    if (line.starts_with(kHeading))
      last.clear();
    else if (line.find_first_not_of(" \t\r") != std::string::npos)
      last = line;
  }
  return without_time(last);
}

/// What worker `pid` said of its failure.
std::string explanation(int pid, const run::RunDirectory& directory) {
  const auto progress = run::read_progress(directory.progress());
  if (progress && progress->pid == pid && !progress->message.empty()) return progress->message;
  return last_line(directory.log());
}

std::string signal_name(int signal) {
  const char* name = sigabbrev_np(signal);
  return "signal " + std::to_string(signal) + (name != nullptr ? " (SIG" + std::string(name) + ")" : "");
}

}  // namespace

JobEnd judge(const WorkerEnd& end, bool stop_asked, const std::string& id, const run::RunDirectory& directory) {
  using enum JobEnd::Outcome;
  if (end.signal == SIGTERM || (end.signal == SIGKILL && stop_asked)) {
    return {kStopped, "the worker was stopped by " + signal_name(end.signal)};
  }
  if (end.signal != 0) return {kCrashed, "worker was killed by " + signal_name(end.signal)};
  if (end.exit_code == 0) {
    if (run::is_done(directory, id)) return {kDone, ""};
    return {kUnconfirmed, "exit 0, but " + directory.summary().string() + " does not say that it is done"};
  }
  if (end.exit_code == kStoppedOnRequest) return {kStopped, "the worker has stopped at a checkpoint"};
  const std::string why = explanation(end.pid, directory);
  if (end.exit_code == kNoRoomCode) return {kNoRoom, why.empty() ? "no room" : why};
  std::string reason = "exit " + std::to_string(end.exit_code) + (end.exit_code == kBadInputCode ? " (bad input)" : "");
  if (!why.empty()) reason += ": " + why;
  const bool it_said_so = end.exit_code == kFailedCode || end.exit_code == kBadInputCode;
  return {it_said_so ? kFailed : kCrashed, reason};
}

}  // namespace shaken::server
