// SPDX-License-Identifier: MIT
#include "study/scheduling.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "base/failure.h"
#include "base/text.h"
#include "study/cost.h"

namespace shaken::study {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// Between two lines of progress in a log, where there is no terminal to redraw [s].
constexpr double kQuiet = 60;

/// A daemon that goes away more often than that has a reason.
constexpr int kMostRestarts = 3;

}  // namespace

bool is_agreed_to(const Selection& selection, const fs::path& runs_folder, int cores, bool yes,
                  client::Console& console) {
  // A glance at each sweep: hours or minutes is the question.
  const client::EstimateOptions glance{.cpu = 0.2, .most_probes = 2, .levels = false};
  std::vector<NamedSweep> rest;
  for (const NamedSweep& sweep : selection.sweeps) {
    if (!sweep.needed) continue;
    NamedSweep left{.name = sweep.name, .needed = true, .sweep = rest_of(sweep.sweep, runs_folder)};
    if (!left.sweep.points.empty()) rest.push_back(std::move(left));
  }
  if (rest.empty()) return true;
  const StudyCost study = probed_cost(rest, glance, cores, console);
  const std::string where = study.cores > 0 ? fmt::format("{} cores", study.cores) : "a core for each task";
  const Cost& all = study.all;
  console.err << fmt::format("{} runs to be done{}: about {}, {} on {}, and {} in {}\n", all.n_runs,
                             study.slurm ? fmt::format(" in {} tasks", all.estimate.n_tasks) : "",
                             client::cpu_text(3600 * all.estimate.core_hours), duration_text(all.estimate.all()), where,
                             bytes_text(all.disk), runs_folder.string());
  for (const std::string& remark : remarks_on(study)) console.err << remark << "\n";
  return yes || console.in == nullptr || console.agrees("Go on?", true);
}

Schedule::Schedule(const Selection& selection, fs::path root, client::Console& console)
    : selection_(selection), root_(std::move(root)), console_(console) {
  daemon_.emplace(root_);
  if (daemon_->started_here()) {
    console_.err << fmt::format("shakend started for {}; it stops with this command\n", root_.string());
  }
  session_.emplace(root_);
}

void Schedule::submit() {
  const Json jobs = session_->get("/v1/status").at("jobs");
  if (const int n = jobs.value("queued", 0) + jobs.value("running", 0); n > 0) {
    console_.err << fmt::format(
        "{} jobs were queued here before, perhaps by an earlier `shaken figures`; they go first. `shaken status` lists "
        "them, `shaken cancel SWEEP` takes them out\n",
        n);
  }
  for (const NamedSweep& sweep : selection_.sweeps) {
    if (!sweep.needed) continue;
    const Json answer = session_->post(
        "/v1/sweeps", {{"text", sweep.input.text}, {"file", sweep.input.file}, {"settings", Json::array()}});
    queued_.push_back({&sweep, client::find_target(*session_, answer.at("sweep").at("id").get<std::string>())});
  }
}

bool Schedule::wait(const InterruptGuard& guard, const std::function<bool(const PaperFigure&)>& draw) {
  std::vector<const PaperFigure*> left = selection_.figures;
  bool complete = true;
  ProgressLine progress(console_.err, console_.err_is_terminal, console_.width, kQuiet);
  for (;;) {
    for (auto figure = left.begin(); figure != left.end();) {
      if (guard.interrupted()) return false;
      if (can_be_drawn(**figure)) {
        complete &= draw(**figure);
        figure = left.erase(figure);
      } else {
        ++figure;
      }
    }
    if (left.empty()) {
      show_progress(progress, /*is_last=*/true);
      return all_done() && complete;
    }
    tell_reasons(progress);
    show_progress(progress);
    guard.sleep_for(std::chrono::milliseconds(500));
    if (guard.interrupted()) return false;
    refresh_all();
  }
}

void Schedule::let_others_finish(const InterruptGuard& guard) {
  if (!daemon_->started_here()) return;
  bool told = false;
  while (!guard.interrupted()) {
    const Json jobs = session_->get("/v1/status").at("jobs");
    const int n = jobs.value("queued", 0) + jobs.value("running", 0) + jobs.value("stopping", 0);
    if (n == 0) return;
    if (!told) {
      console_.err << fmt::format(
          "waiting for {} jobs that others have queued here (Ctrl-C: they stop, and can go on)\n", n);
    }
    told = true;
    guard.sleep_for(std::chrono::seconds(2));
  }
}

bool Schedule::has_ended(const Queued& queued) {
  const std::vector<Json> jobs = client::jobs_of(queued.target);
  return std::all_of(jobs.begin(), jobs.end(),
                     [](const Json& job) { return client::is_final(client::text_of(job, "state")); });
}

bool Schedule::can_be_drawn(const PaperFigure& figure) const {
  return std::all_of(queued_.begin(), queued_.end(), [&](const Queued& queued) {
    const bool needed = std::find(figure.sets.begin(), figure.sets.end(), queued.sweep->name) != figure.sets.end();
    return !needed || has_ended(queued);
  });
}

void Schedule::refresh_all() {
  try {
    for (Queued& queued : queued_) {
      if (!has_ended(queued)) client::refresh(*session_, queued.target);
    }
  } catch (const Failure& failure) {
    if (failure.code != ExitCode::kNoDaemon || ++n_restarts_ > kMostRestarts) throw;
    console_.err << "the daemon has gone; starting one\n";
    daemon_.emplace(root_);
  }
}

bool Schedule::all_done() const {
  bool done = true;
  for (const Queued& queued : queued_) {
    for (const Json& job : client::jobs_of(queued.target)) {
      if (client::text_of(job, "state") == "done") continue;
      done = false;
      console_.err << fmt::format("{} {} {}: {} {}\n", queued.sweep->name, client::short_id(client::text_of(job, "id")),
                                  client::text_of(job, "label"), client::text_of(job, "state"),
                                  client::text_of(job, "reason"));
    }
  }
  return done;
}

void Schedule::tell_reasons(ProgressLine& progress) {
  std::map<std::string, Json> jobs;  // sweeps may share runs
  for (const Queued& queued : queued_) {
    for (Json& job : client::jobs_of(queued.target)) jobs.try_emplace(client::text_of(job, "id"), std::move(job));
  }
  std::vector<Json> all;
  all.reserve(jobs.size());
  for (auto& [id, job] : jobs) all.push_back(std::move(job));
  for (const std::string& line : reasons_.news(all)) progress.end_with(line);
}

void Schedule::show_progress(ProgressLine& progress, bool is_last) {
  double done = 0, all = 0, eta = -1;
  int n_ended = 0, n_jobs = 0;
  for (const auto& [sweep, target] : queued_) {
    const std::vector<Json> jobs = client::jobs_of(target);
    const auto& points = sweep->sweep.points;
    // what a run costs goes about with its rods and its time
    for (std::size_t k = 0; k < std::min(jobs.size(), points.size()); ++k) {
      const double cost = points[k].plan.system.n_all_rods() * points[k].plan.total_time();
      const bool ended = client::is_final(client::text_of(jobs[k], "state"));
      all += cost;
      done += cost * (ended ? 1.0 : client::job_fraction(jobs[k]));
      n_ended += ended;
      ++n_jobs;
    }
  }
  const double elapsed = std::chrono::duration<double>(Clock::now() - begin_).count();
  if (!first_done_) first_done_ = done;
  if (elapsed > 5 && done > *first_done_) eta = (all - done) * elapsed / (done - *first_done_);
  const double fraction = all > 0 ? done / all : 1;
  const std::string text = progress_text(fraction, fmt::format("{}/{} runs", n_ended, n_jobs), eta);
  if (!is_last) {
    progress.show(text);
  } else if (!console_.err_is_terminal) {
    progress.end_with(text);  // a log would otherwise end with how far it was a minute ago
  }
}

}  // namespace shaken::study
