#include "web/run_reader.h"

#include <cstddef>
#include <utility>

#include "base/process.h"
#include "run/files/content_hash.h"
#include "run/files/directory.h"

namespace shaken::web {
namespace {

namespace fs = std::filesystem;

/// After which a bad file is tried again: the machine may only have been busy.
constexpr std::chrono::seconds kMemory{60};
constexpr std::size_t kMostBad = 1000;
/// The longest answer [bytes].
constexpr std::size_t kMostAnswer = std::size_t{512} << 20;
constexpr int kSignalled = 128;  // and what is above it

std::string stamp_of(const fs::path& file) {
  std::error_code error;
  const auto size = fs::file_size(file, error);
  const auto written = fs::last_write_time(file, error).time_since_epoch().count();
  return std::to_string(size) + " " + std::to_string(written);
}

std::string damaged(const fs::path& file, const std::string& how) {
  return file.string() + " cannot be read: it " + how +
         ", as damaged files do. Put a copy of it back; or remove summary.json beside it and submit the scene again, "
         "which makes the run's files anew";
}

}  // namespace

Result<std::string> RunReader::ask(const std::string& run, const std::vector<std::string>& question) {
  const run::RunDirectory directory{runs_ / run};
  const fs::path file = question.front() == "curves" ? directory.observables() : directory.recorded();
  {
    std::unique_lock lock(mutex_);
    if (!free_.wait_for(lock, limit_, [&] { return !busy_.contains(run); })) {
      return Error{"run " + run + " is being read: try again"};
    }
    busy_.insert(run);
  }
  Result<std::string> answer = read(run, file, question);
  const std::lock_guard lock(mutex_);
  busy_.erase(run);
  free_.notify_all();
  return answer;
}

Result<std::string> RunReader::read(const std::string& run, const fs::path& file,
                                    const std::vector<std::string>& question) {
  const std::string stamp = stamp_of(file);
  {
    const std::lock_guard lock(mutex_);
    const auto bad = bad_.find(file);
    if (bad != bad_.end() && bad->second.stamp == stamp && Clock::now() < bad->second.until) {
      return Error{bad->second.why};
    }
  }
  if (auto whole = run::check_content(file); !whole) return whole.error();
  std::vector<std::string> command{sibling_program("shaken-web").string(), "read", (runs_ / run).string()};
  command.insert(command.end(), question.begin(), question.end());
  Captured captured = run_captured(command, CaptureLimits{.time = limit_, .output = kMostAnswer, .stop = stop_});
  if (captured.exit_code == 0) return std::move(captured.output);
  if (stop_ && stop_()) return Error{"the page's program is ending"};
  if (!captured.cut_short && captured.exit_code <= kSignalled) return Error{captured.output};
  const std::string why = damaged(
      file, captured.cut_short ? "kept its reader for over " + std::to_string(limit_.count() / 1000) + " s"
                               : "ended its reader (signal " + std::to_string(captured.exit_code - kSignalled) + ")");
  const std::lock_guard lock(mutex_);
  if (bad_.size() >= kMostBad) bad_.clear();
  bad_[file] = {stamp, why, Clock::now() + kMemory};
  return Error{why};
}

}  // namespace shaken::web
