#include "web/run_reader.h"

#include <sys/resource.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/files.h"
#include "base/process.h"
#include "base/text.h"
#include "run/files/content_hash.h"
#include "run/files/directory.h"
#include "web/json_reply.h"
#include "web/packed_frame.h"
#include "web/recorded_run.h"

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

// The process that reads.

namespace {

std::string line_of(const Json& json) { return text_of(json) + "\n"; }

/// A damaged file may make a reader ask for much memory, or end in a core dump: neither is to hurt the machine.
void be_expendable() {
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
  [[maybe_unused]] const auto done = write_file("/proc/self/oom_score_adj", "1000");
}

Result<std::string> curves(const RecordedRun& run, std::span<const std::string> wanted) {
  const auto curves = SHAKEN_TRY(run.curves());
  Json names = Json::array(), chosen = Json::object();
  for (const auto& [name, values] : curves) {
    names.push_back({{"name", name}, {"points", values.size()}});
    if (std::find(wanted.begin(), wanted.end(), name) != wanted.end()) chosen[name] = values;  // NaN becomes null
  }
  return line_of({{"names", names}, {"curves", chosen}});
}

/// Places of a curve that is drawn while a run is at work.
constexpr std::size_t kMostOrders = 300;
/// Frames of the path of one rod.
constexpr std::size_t kLongestPath = 60;

Result<std::string> frames(const RecordedRun& run) {
  const auto frames = SHAKEN_TRY(run.frames());
  if (frames.n == 0) return line_of({{"n", 0}, {"reason", frames.reason}});
  return line_of({{"n", frames.n}, {"first_s", frames.first}, {"last_s", frames.last}});
}

Result<std::string> order(const RecordedRun& run) {
  const auto order = SHAKEN_TRY(run.order(kMostOrders));
  return line_of({{"time_s", order.times}, {"order", order.orders}});
}

/// Frame "7", or the "last".
Result<std::size_t> index_in(const RecordedRun& run, const std::string& word) {
  if (word == "last") {
    const auto frames = SHAKEN_TRY(run.frames());
    if (frames.n == 0) return Error{frames.reason};
    return frames.n - 1;
  }
  if (const auto index = number_in<std::size_t>(word)) return *index;
  return Error{word + " is no number of a frame"};
}

Result<std::string> frame(const RecordedRun& run, const std::string& word) {
  const std::size_t index = SHAKEN_TRY(index_in(run, word));
  return packed(SHAKEN_TRY(run.frame(index)));
}

/// The path of rod `rod`, up to frame `word`.
Result<std::string> path(const RecordedRun& run, const std::string& rod, const std::string& word) {
  const auto last = SHAKEN_TRY(index_in(run, word));
  const auto which = number_in<std::size_t>(rod);
  if (!which) return Error{rod + " is no number of a rod"};
  const auto path = SHAKEN_TRY(run.path(*which, last >= kLongestPath ? last + 1 - kLongestPath : 0, last));
  return line_of({{"time_s", path.times}, {"x_mm", path.x}, {"y_mm", path.y}, {"n_z", path.n_z}});
}

Result<std::string> answer(const RecordedRun& run, const std::vector<std::string>& question) {
  const std::string& what = question.front();
  if (what == "curves") return curves(run, std::span(question).subspan(1));
  if (what == "frames" && question.size() == 1) return frames(run);
  if (what == "order" && question.size() == 1) return order(run);
  if (what == "frame" && question.size() == 2) return frame(run, question[1]);
  if (what == "path" && question.size() == 3) return path(run, question[1], question[2]);
  return Error{"there is no question " + what};
}

}  // namespace

int read_run_command(int argc, char** argv) {
  if (argc < 4) {
    std::fputs("shaken-web read DIR QUESTION... is asked by shaken-web itself\n", stdout);
    return 2;
  }
  be_expendable();
  Result<std::string> answered = Error{""};
  try {
    const run::RunDirectory directory{argv[2]};
    run::assume_whole(directory.trajectory());
    run::assume_whole(directory.observables());
    answered = answer(RecordedRun(directory.root), {argv + 3, argv + argc});
  } catch (const std::exception& problem) {  // no memory for what a damaged file asks for
    answered = Error{problem.what()};
  }
  const std::string& text = answered ? *answered : answered.error().message;
  const bool is_written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  return answered && is_written ? 0 : 1;
}

}  // namespace shaken::web
