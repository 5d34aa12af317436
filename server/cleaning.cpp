#include "server/cleaning.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <set>

#include "base/clock.h"
#include "base/text.h"
#include "run/files/directory.h"

namespace shaken::server {
namespace {

namespace fs = std::filesystem;

/// A directory on its way out has this before its id: whatever starts the run anew makes a directory of its own.
constexpr std::string_view kLeaving = ".leaving-";

/// A folder itself, not a link to one.
bool is_folder(const fs::path& path) {
  std::error_code error;
  return fs::symlink_status(path, error).type() == fs::file_type::directory;
}

/// The size of all files in a folder; links count nothing.
std::int64_t bytes_below(const fs::path& folder) {
  std::error_code error;
  std::int64_t bytes = 0;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code gone;
    if (entry->symlink_status(gone).type() != fs::file_type::regular) continue;
    const auto size = entry->file_size(gone);
    if (!gone) bytes += static_cast<std::int64_t>(size);
  }
  return bytes;
}

/// Seconds since a file in the folder was written last.
std::chrono::seconds age_of(const fs::path& folder) {
  std::error_code error;
  auto newest = fs::last_write_time(folder, error);
  if (error) return std::chrono::seconds(0);  // what cannot be looked at now is not old
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code gone;
    const auto written = fs::last_write_time(entry->path(), gone);
    if (!gone) newest = std::max(newest, written);
  }
  return std::chrono::duration_cast<std::chrono::seconds>(fs::file_time_type::clock::now() - newest);
}

/// Removes the directory of run `id`, once `agreed` says so under its lock. Returns why it stays, or nothing.
template <class Agreed>
std::string remove_run(const fs::path& runs, const std::string& id, const Agreed& agreed) {
  const run::RunDirectory directory{runs / id};
  std::error_code error;
  // To take the lock writes into its file, wherever that is.
  if (fs::is_symlink(directory.lock(), error)) return directory.lock().string() + " is a link";
  const auto lock = run::DirectoryLock::acquire(directory.lock());
  if (!lock) return lock.error().message;
  if (std::string why = agreed(); !why.empty()) return why;
  const fs::path leaving = runs / (std::string(kLeaving) + id);
  fs::remove_all(leaving, error);
  fs::rename(directory.root, leaving, error);
  if (error) return directory.root.string() + ": " + error.message();
  fs::remove_all(leaving, error);
  return error ? leaving.string() + ": " + error.message() : "";
}

bool fits(const Job& job, const CleanRequest& request, std::int64_t now) {
  const bool is_old =
      request.older.count() == 0 || now - job.finished >= std::chrono::microseconds(request.older).count();
  return has_ended(job.state) && is_old && std::count(request.states.begin(), request.states.end(), job.state) > 0;
}

/// Whether the run came to an end once, with results that were not cleaned since.
bool was_done(const std::vector<Change>& history) {
  bool done = false;
  for (const Change& change : history) {
    if (change.to == to_word(JobState::kDone)) done = true;
    if (change.cause == kCleanedOnRequest) done = false;
  }
  return done;
}

}  // namespace

std::vector<std::string> run_ids(const fs::path& runs) {
  std::vector<std::string> ids;
  std::error_code error;
  for (fs::directory_iterator entry(runs, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (is_id(name) && is_folder(entry->path())) ids.push_back(name);
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

std::vector<Cleaned> clean(Queue& queue, const fs::path& runs, const CleanRequest& request) {
  const std::int64_t now = utime_now();
  std::set<std::string> of_sweep;
  if (request.sweep) {
    for (const Job& job : queue.jobs(request.sweep)) of_sweep.insert(job.id);
  }
  std::vector<Cleaned> found;
  for (const std::string& id : run_ids(runs)) {
    if (request.only && !request.only->contains(id)) continue;
    if (request.sweep && !of_sweep.contains(id)) continue;
    Cleaned run{.id = id, .job = queue.job(id), .is_imported = false, .bytes = 0, .removed = false, .kept = {}};
    std::error_code hidden;
    run.is_imported = !run.job && fs::exists(run::RunDirectory{runs / id}.imported(), hidden);
    if (run.job ? !fits(*run.job, request, now) : request.older.count() > 0 && age_of(runs / id) < request.older)
      continue;
    const bool takes_done = std::count(request.states.begin(), request.states.end(), JobState::kDone) > 0;
    // it holds the results of when it was shorter, which an extension that came to nothing does not take along
    if (run.job && !takes_done && was_done(queue.history(id))) continue;
    run.bytes = bytes_below(runs / id);
    if (!request.dry_run && (run.job || request.unknown)) {
      run.kept = remove_run(runs, id, [&]() -> std::string {
        if (run.job) return queue.clean(id, run.job->state) ? "" : "it was asked for again a moment ago";
        if (queue.job(id)) return "it was submitted a moment ago";
        const std::vector<std::string> next = queue.starting_from(id);
        return next.empty() ? "" : "job " + next.front() + " is to start from it";
      });
      run.removed = run.kept.empty();
      spdlog::info("run {}: {}", id, run.removed ? "cleaned on request" : "not cleaned: " + run.kept);
    }
    found.push_back(std::move(run));
  }
  if (request.dry_run) return found;
  // What a daemon that was killed has left half removed.
  std::error_code error;
  for (fs::directory_iterator entry(runs, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    std::error_code stays;
    if (name.starts_with(kLeaving) && is_folder(entry->path())) fs::remove_all(entry->path(), stays);
  }
  return found;
}

}  // namespace shaken::server
