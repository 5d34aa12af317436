#include "server/slurm/sent_batch.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "base/failure.h"
#include "base/files.h"
#include "base/text.h"

namespace shaken::server::slurm {

using Phase = WorkerReport::Phase;

SentBatch::SentBatch(std::filesystem::path folder, std::string settings, int runs_per_task)
    : folder_{std::move(folder)}, settings_(std::move(settings)), runs_per_task_(runs_per_task) {}

std::optional<SentBatch> SentBatch::written(const std::filesystem::path& folder) {
  const Result<Batch> plan = read_batch({folder});
  if (!plan || plan->tasks.empty()) return std::nullopt;
  SentBatch batch(folder, "", static_cast<int>(plan->tasks.front().size()));
  batch.adopted_ = true;
  batch.tasks_.resize(plan->tasks.size());
  for (const std::vector<Launch>& task : plan->tasks) {
    for (std::size_t i = 0; i < task.size(); ++i) batch.runs_.push_back({.collected = true});
  }
  batch.set_unsure("the daemon ended while it was handed over to Slurm");
  if (const Result<std::string> job = read_file(batch.folder_.job())) batch.set_out(*job);
  for (std::size_t task = 0; task < batch.tasks_.size(); ++task) batch.read_report_of(static_cast<int>(task));
  return batch;
}

bool SentBatch::fits(const std::string& settings, std::size_t most_tasks) const {
  return stage_ == Stage::kOpen && settings_ == settings &&
         n_runs() < most_tasks * static_cast<std::size_t>(runs_per_task_);
}

int SentBatch::add(const Launch& launch) {
  runs_.push_back({.launch = launch});
  grown_ = true;
  const int run = static_cast<int>(runs_.size()) - 1;
  if (number_of(run) == static_cast<int>(tasks_.size())) tasks_.emplace_back();
  return run;
}

bool SentBatch::adopt(int run) {
  if (run >= static_cast<int>(runs_.size())) return false;
  runs_[static_cast<std::size_t>(run)].collected = false;
  return true;
}

std::string SentBatch::job_of(int run) const { return fmt::format("{}_{}", job_, number_of(run)); }

WorkerReport SentBatch::state_of(int number, std::chrono::milliseconds report_delay) const {
  const Run& run = runs_[static_cast<std::size_t>(number)];
  if (run.end) return {.phase = Phase::kEnded, .end = *run.end};
  switch (stage_) {
    case Stage::kOpen:
    case Stage::kClosed:
      return {.phase = Phase::kWaiting, .words = "is about to be handed over to Slurm"};
    case Stage::kUnsure:
      return {.phase = Phase::kWaiting,
              .words = "is being handed over to Slurm" + (error_.empty() ? "" : ": " + error_)};
    case Stage::kRefused:
      return {.phase = adopted_ || run.stop_asked ? Phase::kRevoked : Phase::kRefused, .words = error_};
    case Stage::kOut:
      break;
  }
  const ArrayTask& task = task_of(number);
  const std::string job = "Slurm job " + job_of(number);
  if (task.is_over()) {
    const bool no_fault = task.was_revoked() || run.stop_asked || (!run.begun && task.has_reported());
    std::string words = fmt::format("{} has ended: {}", job, task.words());
    if (no_fault) return {.phase = Phase::kRevoked, .words = std::move(words)};
    if (task.is_over_for(report_delay)) return {.phase = Phase::kLost, .words = std::move(words)};
    return {.phase = run.begun ? Phase::kWorking : Phase::kWaiting,
            .words = words + "; how the run ended is not to be read yet"};
  }
  if (task.stage() == QueuedTask::Stage::kWaiting) {
    return {.phase = Phase::kWaiting,
            .words = "waits as " + job + (task.words().empty() ? "" : fmt::format(" ({})", task.words()))};
  }
  if (run.begun) return {.phase = Phase::kWorking};
  return {.phase = Phase::kWaiting, .words = "waits for its turn in " + job};
}

SentBatch::Run* SentBatch::run_at(int task, int place) {
  const auto run = static_cast<std::size_t>(task * runs_per_task_ + place);
  return place >= 0 && place < runs_per_task_ && run < runs_.size() ? &runs_[run] : nullptr;
}

void SentBatch::stop(int number) {
  Run& run = runs_[static_cast<std::size_t>(number)];
  run.stop_asked = true;
  const int task = number_of(number);
  unwritten_stops_.insert(task);
  if (stage_ == Stage::kOpen || stage_ == Stage::kClosed) {
    run.end = WorkerEnd{.exit_code = static_cast<int>(ExitCode::kStopped)};  // its task reads that file first
    return;
  }
  bool is_last = true;
  for (int place = 0; place < runs_per_task_; ++place) {
    const Run* beside = run_at(task, place);
    is_last = is_last && (beside == nullptr || beside->collected || beside->end || beside->stop_asked);
  }
  task_of(number).cancel(!is_last);  // others of a task that waits lose nothing by going back into the queue
}

Result<void> SentBatch::write_stops() {
  Result<void> all;
  std::erase_if(unwritten_stops_, [&](int task) {
    const std::filesystem::path file = folder_.stop(task);
    std::set<int> places = read_stop(file);  // also of those that a former daemon has stopped
    for (int place = 0; place < runs_per_task_; ++place) {
      if (const Run* run = run_at(task, place); run != nullptr && run->stop_asked) places.insert(place);
    }
    // A run that Slurm has is asked again by the next daemon, should this file get lost with the power: that need not
    // wait for the disk. One that is not handed over yet has ended with the asking, and nobody asks again.
    Result<void> written = make_folder(folder_.root);
    if (written) written = write_stop(file, places, may_be_out() ? Lasting::kNo : Lasting::kYes);
    if (!written) all = written;
    return static_cast<bool>(written);
  });
  return all;
}

void SentBatch::close(const std::filesystem::path& worker, const std::filesystem::path& task) {
  if (stage_ != Stage::kOpen || std::exchange(grown_, false)) return;
  Batch plan{worker, std::vector<std::vector<Launch>>(tasks_.size())};
  for (std::size_t run = 0; run < runs_.size(); ++run) {
    plan.tasks[static_cast<std::size_t>(number_of(static_cast<int>(run)))].push_back(
        std::exchange(runs_[run].launch, {}));
  }
  const std::string script =
      fmt::format("#!/bin/sh\nexec {} {}\n", shell_word(task.string()), shell_word(folder_.root.string()));
  Result<void> written = make_folder(folder_.root);
  if (written) written = write_batch(folder_, plan);
  if (written) written = write_file_atomically(folder_.script(), script);
  stage_ = written ? Stage::kClosed : Stage::kRefused;
  if (!written) error_ = written.error().message;
}

void SentBatch::set_unsure(const std::string& why) {
  stage_ = Stage::kUnsure;
  error_ = why;
}

void SentBatch::set_out(const std::string& job) {
  stage_ = Stage::kOut;
  job_ = job;
}

void SentBatch::update_tasks(const std::vector<const QueuedTask*>& listed) {
  if (stage_ == Stage::kUnsure) {
    const bool has_begun = std::ranges::any_of(tasks_, [](const ArrayTask& task) { return task.has_reported(); });
    if (listed.empty() && !has_begun) {
      stage_ = Stage::kRefused;
      std::error_code ignored;
      std::filesystem::remove_all(folder_.root, ignored);  // should it come after all, it finds nothing to do
    } else {
      set_out(listed.empty() ? job_ : listed.front()->job);
    }
  }
  if (stage_ != Stage::kOut) return;
  std::vector<const QueuedTask*> of_task(tasks_.size(), nullptr);
  for (const QueuedTask* task : listed) {
    if (task->job == job_ && task->task < static_cast<int>(of_task.size())) {
      of_task[static_cast<std::size_t>(task->task)] = task;
    }
  }
  for (std::size_t number = 0; number < tasks_.size(); ++number) tasks_[number].update(of_task[number]);
}

void SentBatch::read_report_of(int number) {
  const Result<TaskReport> report = read_report(folder_.report(number));
  if (!report) return;
  tasks_[static_cast<std::size_t>(number)].set_reported();
  for (const int place : report->begun) {
    if (Run* run = run_at(number, place)) run->begun = true;
  }
  for (const auto& [place, end] : report->ends) {
    if (Run* run = run_at(number, place)) run->end = end;
  }
}

void SentBatch::read_reports(bool of_all, std::chrono::milliseconds report_delay) {
  if (!may_be_out()) return;
  for (std::size_t number = 0; number < tasks_.size(); ++number) {
    const ArrayTask& task = tasks_[number];
    const bool may_have_begun = task.stage() != QueuedTask::Stage::kWaiting || of_all;
    if (may_have_begun && !task.is_over_for(report_delay)) read_report_of(static_cast<int>(number));
  }
}

bool SentBatch::is_finished() const {
  if (runs_.empty() || !std::ranges::all_of(runs_, [](const Run& run) { return run.collected; })) return false;
  if (stage_ != Stage::kOut) return stage_ != Stage::kUnsure;
  return std::ranges::all_of(tasks_, [](const ArrayTask& task) { return task.is_over(); });
}

}  // namespace shaken::server::slurm
