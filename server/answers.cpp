#include "server/answers.h"

#include <algorithm>

#include "base/files.h"
#include "run/files/directory.h"
#include "run/files/progress.h"

namespace shaken::server {
namespace {

/// The JSON object in a file; null if there is none to be read.
Json read_object(const std::filesystem::path& file) {
  const auto text = read_file(file);
  if (!text) return nullptr;
  // What is nested deeper than anything of ours is left out: printing it would take all of the stack.
  constexpr int kDeepest = 64;
  const auto keep = [](int depth, Json::parse_event_t, const Json&) { return depth < kDeepest; };
  Json json = Json::parse(*text, keep, false);
  return json.is_object() ? json : Json(nullptr);
}

/// Whether the worker of the present attempt has written its progress: the daemon writes scene.json before it.
bool is_of_this_attempt(const Job& job, const run::RunDirectory& directory) {
  std::error_code no_scene, no_progress;
  const auto scene = std::filesystem::last_write_time(directory.scene(), no_scene);
  const auto progress = std::filesystem::last_write_time(directory.progress(), no_progress);
  return has_worker(job.state) && !no_scene && !no_progress && progress >= scene;
}

/// Whether progress.json with the word `state` is of a job that is not done. If the run is, its end is about to be
/// seen, unless that is of the run before it was extended.
bool is_progress_of(const Job& job, const Json& state, const run::RunDirectory& directory) {
  return state != "done" || is_of_this_attempt(job, directory);
}

/// What the worker of a job that is not done has written of its progress; null where there is nothing.
Json progress_of(const Job& job, const run::RunDirectory& directory) {
  Json progress = read_object(directory.progress());
  return progress.is_object() && is_progress_of(job, progress.value("state", Json()), directory) ? progress
                                                                                                 : Json(nullptr);
}

/// The summary of run `id`; null if there is none that can be read, or if it is another run's.
Json summary_of(const std::string& id, const run::RunDirectory& directory) {
  Json summary = read_object(directory.summary());
  const auto run_id = summary.is_object() ? summary.find("run_id") : summary.end();
  return run_id != summary.end() && *run_id == id ? summary : Json(nullptr);
}

/// Whether a summary is of the end of a run. That of one that was stopped is, once the job has ended: then it has all
/// that there will be; and that of a run that came to an end and was stopped on its way to another.
bool is_final(const Json& summary, JobState state) {
  const auto exit = summary.find("exit");
  if (exit == summary.end() || !exit->is_object()) return false;
  const Json word = exit->value("state", Json());
  return word == "done" || (word == "stopped" && (has_ended(state) || exit->contains("done_before_s")));
}

double seconds(std::chrono::milliseconds time) { return std::chrono::duration<double>(time).count(); }

Json seconds_or_null(std::chrono::milliseconds limit) {
  return limit.count() > 0 ? Json(seconds(limit)) : Json(nullptr);
}

Json parameters(const Job& job) {
  Json json = Json::parse(job.parameters, nullptr, false);
  return json.is_object() ? json : Json::object();
}

/// Bytes at the end of `text` that begin a UTF-8 character without ending it.
std::size_t torn_tail(const std::string& text) {
  for (std::size_t back = 1; back <= 3 && back <= text.size(); ++back) {
    const auto byte = static_cast<unsigned char>(text[text.size() - back]);
    if (byte < 0x80) return 0;
    if (byte < 0xC0) continue;   // inside a character
    if (byte >= 0xF8) return 0;  // no UTF-8 at all
    const std::size_t length = byte >= 0xF0 ? 4 : byte >= 0xE0 ? 3 : 2;
    return length > back ? back : 0;
  }
  return 0;
}

}  // namespace

std::string reason_of(const Job& job, const std::filesystem::path& runs) {
  if (job.state != JobState::kRunning || job.reason.empty()) return job.reason;
  const run::RunDirectory directory{runs / job.id};
  if (!is_of_this_attempt(job, directory)) return job.reason;
  const auto progress = run::read_progress(directory.progress());
  if (!progress) return job.reason;
  if (progress->state == "done") return "";
  // A worker that was killed, and is to be started again, has written nothing for a while.
  constexpr std::chrono::seconds kWhile{15};
  std::error_code error;
  const auto written = std::filesystem::last_write_time(directory.progress(), error);
  const bool is_fresh = !error && written + kWhile > std::filesystem::file_time_type::clock::now();
  return is_fresh && (progress->state == "running" || progress->state == "rendering") ? "" : job.reason;
}

Json job_report(const Job& job, const std::filesystem::path& runs) {
  const run::RunDirectory directory{runs / job.id};
  const bool has_progress = job.attempt > 0 && job.state != JobState::kDone;
  return {{"id", job.id},
          {"sweep", sweep_word(job.sweep)},
          {"state", to_word(job.state)},
          {"ended", has_ended(job.state)},
          {"reason", reason_of(job, runs)},
          {"label", job.label},
          {"parameters", parameters(job)},
          {"replica", job.replica},
          {"starts_from", job.starts_from.empty() ? Json(nullptr) : Json(job.starts_from)},
          {"priority", job.priority},
          {"attempt", job.attempt},
          {"pid", job.pid},
          {"directory", directory.root.string()},
          {"created_utime", job.created},
          {"started_utime", job.started},
          {"finished_utime", job.finished},
          {"not_before_utime", job.not_before},
          {"soft_limit_s", seconds_or_null(job.soft_limit)},
          {"time_limit_s", seconds_or_null(job.time_limit)},
          {"wall_s", seconds(job.wall)},
          {"progress", has_progress ? progress_of(job, directory) : Json(nullptr)}};
}

Line line_of(std::map<std::int64_t, double> ahead, std::span<const Job> active, const std::filesystem::path& runs) {
  Line line{.ahead = std::move(ahead)};
  for (const Job& job : active) {
    if (job.state == JobState::kStopping) continue;
    const run::RunDirectory directory{runs / job.id};
    const auto progress = run::read_progress(directory.progress());
    if (!progress || !is_progress_of(job, progress->state, directory) || progress->eta < 0) continue;
    line.running_s += progress->eta;
    ++line.n_running;
  }
  return line;
}

Json sweep_report(const Sweep& sweep, std::span<const Job> begun, const SweepWork& work, const Line& line, int slots,
                  const std::filesystem::path& runs) {
  double finished = work.done;
  double longest = 0;  // wall seconds to the end of the last active job that reports one, and of the longest chain
  double sum = 0;
  int n_reporting = 0;
  double waiting = work.queued;  // work that is yet to begin
  bool any_waits = sweep.counts[JobState::kQueued] > 0, any_handed_over = false;
  for (const Job& job : begun) {
    const run::RunDirectory directory{runs / job.id};
    const auto progress = run::read_progress(directory.progress());
    const bool reports = progress && is_progress_of(job, progress->state, directory);
    const double done = reports ? job.work * std::clamp(progress->fraction(), 0.0, 1.0) : 0;
    finished += done;
    if (job.state == JobState::kQueued) waiting -= done;
    if (job.state != JobState::kRunning) continue;
    if (reports && progress->eta >= 0) {
      ++n_reporting;
      longest = std::max(longest, progress->eta);
      sum += progress->eta;
    } else {
      any_waits = true;
      waiting += job.work - done;
      if (job.pid == 0) any_handed_over = true;  // to a cluster, where it may wait; others have just begun
    }
  }
  const bool only_held = !any_waits && n_reporting == 0 && sweep.counts[JobState::kHeld] > 0;
  const bool known = !only_held && (!any_waits || (work.seconds_per_work && (n_reporting > 0 || !any_handed_over)));
  const double per_work = work.seconds_per_work.value_or(0);
  double all = sum + std::max(waiting, 0.0) * per_work;
  // where some wait that have been handed over, as many are at work as can be, and others have the places of their own
  int at_once = n_reporting;
  if (!any_handed_over) {
    at_once = std::max({line.n_running, n_reporting, slots});
    if (const auto found = line.ahead.find(sweep.id); found != line.ahead.end() && any_waits) {
      all += std::max(line.running_s - sum, 0.0) + found->second * per_work;
    }
  }
  longest = std::max(longest, work.longest_chain * per_work);
  return {{"id", sweep_word(sweep.id)},
          {"name", sweep.name},
          {"created_utime", sweep.created},
          {"n_jobs", sweep.counts.total()},
          {"n_ended", sweep.counts.of(has_ended)},
          {"counts", counts_report(sweep.counts)},
          {"at_most", sweep.at_most > 0 ? Json(sweep.at_most) : Json(nullptr)},
          {"after", sweep.after},
          {"stop_if", sweep.stop_if.empty() ? Json(nullptr) : Json(sweep.stop_if)},
          {"stopped", sweep.stopped},
          {"progress", work.all > 0 ? std::min(finished / work.all, 1.0) : 1.0},
          {"eta_s", known ? std::max(longest, all / std::max(1, at_once)) : -1.0}};
}

Json result_row(const Job& job, const std::filesystem::path& runs) {
  Json summary = summary_of(job.id, run::RunDirectory{runs / job.id});
  if (summary.is_object() && job.state != JobState::kDone && !is_final(summary, job.state)) summary = nullptr;
  return {{"job", job.id},
          {"sweep", sweep_word(job.sweep)},
          {"state", to_word(job.state)},
          {"label", job.label},
          {"parameters", parameters(job)},
          {"replica", job.replica},
          {"directory", (runs / job.id).string()},
          {"summary", std::move(summary)}};
}

Json counts_report(const JobCounts& counts) {
  Json json = Json::object();
  for (const JobStateRow& row : kJobStates) json[std::string(row.word)] = counts[row.state];
  return json;
}

std::string to_text(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n"; }

LogSlice read_slice(const std::filesystem::path& file, std::int64_t offset, std::int64_t limit) {
  const Result<std::string> part = read_part(file, offset, static_cast<std::size_t>(limit));
  std::string text = part ? *part : "";
  const std::size_t torn = torn_tail(text);
  if (torn < text.size()) text.erase(text.size() - torn);  // a tail alone is not UTF-8 and would never grow whole
  return {text, offset + static_cast<std::int64_t>(text.size())};
}

}  // namespace shaken::server
