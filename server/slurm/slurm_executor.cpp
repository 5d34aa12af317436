// SPDX-License-Identifier: MIT
#include "server/slurm/slurm_executor.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <random>
#include <system_error>

#include "base/failure.h"
#include "base/files.h"
#include "base/slurm_conf.h"
#include "base/text.h"

namespace shaken::server::slurm {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Phase = WorkerReport::Phase;
using QueueStage = QueuedTask::Stage;

/// Workers that one round takes: each costs the daemon some writes to the disk.
constexpr int kPerRound = 50;
/// Tasks that one scancel names.
constexpr std::size_t kMostCancelled = 500;
constexpr seconds kSubmitLimit{300};
constexpr seconds kLimit{60};
/// How long Slurm takes at most to refuse something.
constexpr seconds kAtOnce{2};
/// After something has changed that the next list is to show.
constexpr milliseconds kSoon{500};
constexpr std::string_view kNamePrefix = "shaken-";
/// Ahead of the end of a task's time its runs are told to write a checkpoint.
constexpr double kAhead = 60;

std::string new_token() {
  std::random_device random;
  return fmt::format("{:08x}{:08x}", random(), random());
}

/// The words of a program that failed, on one line.
std::string in_one_line(const Captured& answer) {
  std::string text = answer.output;
  std::replace(text.begin(), text.end(), '\n', ' ');
  text.erase(text.find_last_not_of(' ') + 1);
  if (text.empty()) text = fmt::format("exit {}", answer.exit_code);
  constexpr std::size_t kMost = 500;
  return printable(fitted(text, kMost));
}

/// Whether Slurm has refused an array for its size, or for how many tasks a user may have: "Invalid job array
/// specification", "Job array index too large", "Job violates accounting/QOS policy (job submit limit, ...)".
bool is_about_size(std::string_view words) {
  std::string text(words);
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text.find("array") != text.npos || text.find("submit") != text.npos;
}

bool is_token(std::string_view word) {
  return word.size() == 16 && word.find_first_not_of("0123456789abcdef") == word.npos;
}

}  // namespace

SlurmExecutor::SlurmExecutor(SlurmOptions options) : options_(std::move(options)) {}

int SlurmExecutor::n_waiting() const {
  std::size_t n = 0;
  for (const auto& [token, batch] : batches_) {
    if (batch.stage == Stage::kRefused) continue;
    n += static_cast<std::size_t>(std::count_if(batch.tasks.begin(), batch.tasks.end(),
                                                [](const Task& task) { return task.stage == QueueStage::kWaiting; }));
  }
  return static_cast<int>(n);
}

int SlurmExecutor::n_unsent() const {
  return static_cast<int>(std::count_if(batches_.begin(), batches_.end(), [](const auto& entry) {
    return entry.second.stage == Stage::kClosed || entry.second.stage == Stage::kUnsure;
  }));
}

int SlurmExecutor::room() const {
  if (!trouble_.empty() || !refilling_ || n_unsent() > 0) return 0;
  if (n_waiting() < options_.max_pending) return budget_;
  int places = 0;  // in tasks that are not full yet
  for (const auto& [token, batch] : batches_) {
    const auto most = batch.tasks.size() * static_cast<std::size_t>(batch.runs_per_task);
    if (batch.stage == Stage::kOpen) places += static_cast<int>(most - batch.runs.size());
  }
  return std::min(budget_, places);
}

SlurmExecutor::Sent& SlurmExecutor::open_batch(const std::string& settings, std::string& token) {
  for (auto& [open_token, batch] : batches_) {
    const bool fits = batch.stage == Stage::kOpen && batch.settings == settings &&
                      batch.runs.size() < most_tasks_ * static_cast<std::size_t>(batch.runs_per_task);
    if (!fits) continue;
    token = open_token;
    return batch;
  }
  token = new_token();
  Sent& batch = batches_[token];
  batch.folder.root = options_.folder / token;
  batch.settings = settings;
  const int asked = scene::slurm_settings(settings).runs_per_task;
  batch.runs_per_task = asked > 0 ? asked : options_.runs_per_task;
  return batch;
}

Result<int> SlurmExecutor::start(const Launch& launch) {
  std::string token;
  Sent& batch = open_batch(launch.settings, token);
  batch.runs.push_back({.launch = launch});
  batch.grown = true;
  const int run = static_cast<int>(batch.runs.size()) - 1;
  if (task_of(batch, run) == static_cast<int>(batch.tasks.size())) batch.tasks.emplace_back();
  --budget_;
  handles_[++last_handle_] = {token, run};
  return last_handle_;
}

std::string SlurmExecutor::name(int worker) const {
  const auto entry = handles_.find(worker);
  return entry == handles_.end() ? std::string() : fmt::format("{}/{}", entry->second.batch, entry->second.run);
}

std::optional<int> SlurmExecutor::adopt(const std::string& name) {
  const std::string token = name.substr(0, name.find('/'));
  int number = -1;
  if (token.size() < name.size()) std::from_chars(name.data() + token.size() + 1, name.data() + name.size(), number);
  if (!is_token(token) || number < 0) return std::nullopt;
  if (!batches_.contains(token)) {
    const BatchFolder folder{options_.folder / token};
    const Result<Batch> plan = read_batch(folder);
    if (!plan || plan->tasks.empty()) return std::nullopt;
    Sent& batch = batches_[token];
    batch.folder = folder;
    batch.runs_per_task = static_cast<int>(plan->tasks.front().size());
    batch.adopted = true;
    batch.tasks.resize(plan->tasks.size());
    for (const std::vector<Launch>& task : plan->tasks) {
      for (std::size_t i = 0; i < task.size(); ++i) batch.runs.push_back({.told = true});  // but for those adopted
    }
    const Result<std::string> job = read_file(folder.job());
    if (job) batch.job = *job;
    batch.stage = job ? Stage::kOut : Stage::kUnsure;
    batch.error = "the daemon ended while it was handed over to Slurm";
    for (std::size_t task = 0; task < batch.tasks.size(); ++task) read_report_of(batch, static_cast<int>(task));
  }
  Sent& batch = batches_.at(token);
  if (number >= static_cast<int>(batch.runs.size())) return std::nullopt;
  batch.runs[static_cast<std::size_t>(number)].told = false;
  handles_[++last_handle_] = {token, number};
  return last_handle_;
}

WorkerReport SlurmExecutor::state_of(const Sent& batch, const Run& run, int task) const {
  if (run.end) return {.phase = Phase::kEnded, .end = *run.end};
  const Task& in = batch.tasks[static_cast<std::size_t>(task)];
  switch (batch.stage) {
    case Stage::kOpen:
    case Stage::kClosed:
      return {.phase = Phase::kWaiting, .words = "is about to be handed over to Slurm"};
    case Stage::kUnsure:
      return {.phase = Phase::kWaiting,
              .words = "is being handed over to Slurm" + (batch.error.empty() ? "" : ": " + batch.error)};
    case Stage::kRefused:
      return {.phase = batch.adopted || run.stop_asked ? Phase::kTaken : Phase::kRefused, .words = batch.error};
    case Stage::kOut:
      break;
  }
  const std::string of = fmt::format("Slurm job {}_{}", batch.job, task);
  if (in.is_over()) {
    const bool no_fault = in.was_cancelled || run.stop_asked || (!run.begun && in.reported) ||
                          in.words == "NODE_FAIL" || in.words == "PREEMPTED" || in.words == "BOOT_FAIL";
    if (!no_fault && Clock::now() < in.over_since + options_.report_delay) {
      return {.phase = run.begun ? Phase::kWorking : Phase::kWaiting,
              .words = fmt::format("{} has ended: {}; how the run ended is not to be read yet", of, in.words)};
    }
    return {.phase = no_fault ? Phase::kTaken : Phase::kLost, .words = fmt::format("{} has ended: {}", of, in.words)};
  }
  if (in.stage == QueueStage::kWaiting) {
    return {.phase = Phase::kWaiting,
            .words = in.words.empty() ? "waits as " + of : fmt::format("waits as {} ({})", of, in.words)};
  }
  if (run.begun) return {.phase = Phase::kWorking};
  return {.phase = Phase::kWaiting, .words = "waits for its turn in " + of};
}

WorkerReport SlurmExecutor::poll(int worker) {
  const Handle& handle = handles_.at(worker);
  Sent& batch = batches_.at(handle.batch);
  Run& run = batch.runs[static_cast<std::size_t>(handle.run)];
  WorkerReport report = state_of(batch, run, task_of(batch, handle.run));
  if (report.phase == Phase::kWaiting || report.phase == Phase::kWorking) {
    if (report.phase == Phase::kWaiting && batch.stage == Stage::kOut && run.stop_asked && !trouble_.empty()) {
      report.words = fmt::format("stops once Slurm answers, which has it as job {}_{}: {}", batch.job,
                                 task_of(batch, handle.run), trouble_);
    } else if ((batch.stage == Stage::kOut || batch.stage == Stage::kUnsure) && !silence_.empty()) {
      report.words += (report.words.empty() ? "" : "; ") + silence_;
    }
    return report;
  }
  run.told = true;
  handles_.erase(worker);
  return report;
}

void SlurmExecutor::stop(int worker) {
  const Handle& handle = handles_.at(worker);
  Sent& batch = batches_.at(handle.batch);
  Run& run = batch.runs[static_cast<std::size_t>(handle.run)];
  run.stop_asked = true;
  const int number = task_of(batch, handle.run);
  unsaid_stops_.emplace(handle.batch, number);
  if (batch.stage == Stage::kOpen || batch.stage == Stage::kClosed) {
    run.end = WorkerEnd{.exit_code = static_cast<int>(ExitCode::kStopped)};  // its task reads that file first
    return;
  }
  Task& task = batch.tasks[static_cast<std::size_t>(number)];
  bool is_last = true;
  for (int other = number * batch.runs_per_task;
       other < std::min((number + 1) * batch.runs_per_task, static_cast<int>(batch.runs.size())); ++other) {
    const Run& beside = batch.runs[static_cast<std::size_t>(other)];
    is_last = is_last && (beside.told || beside.end || beside.stop_asked);
  }
  // others of a task that waits lose nothing by going back into the queue
  task.cancel = true;
  task.if_waits = !is_last;
}

void SlurmExecutor::kill(int worker) {
  const Handle& handle = handles_.at(worker);
  Sent& batch = batches_.at(handle.batch);
  Task& task = batch.tasks[static_cast<std::size_t>(task_of(batch, handle.run))];
  task.cancel = true;
  task.if_waits = false;
}

bool SlurmExecutor::has_unsaid_stops(const std::string& token) const {
  const auto first = unsaid_stops_.lower_bound({token, 0});
  return first != unsaid_stops_.end() && first->first == token;
}

void SlurmExecutor::write_stops() {
  const auto now = Clock::now();
  if (unsaid_stops_.empty() || now < write_stops_after_) return;
  std::erase_if(unsaid_stops_, [&](const auto& unsaid) {
    const auto entry = batches_.find(unsaid.first);
    if (entry == batches_.end()) return true;
    const Sent& batch = entry->second;
    const int task = unsaid.second;
    const std::filesystem::path file = batch.folder.stop(task);
    std::set<int> places = read_stop(file);  // also of those that a former daemon has stopped
    for (int place = 0; place < batch.runs_per_task; ++place) {
      const auto run = static_cast<std::size_t>(task * batch.runs_per_task + place);
      if (run < batch.runs.size() && batch.runs[run].stop_asked) places.insert(place);
    }
    // A run that Slurm has is asked again by the next daemon, should this file get lost with the power: that need not
    // wait for the disk. One that is not handed over yet has ended with the asking, and nobody asks again.
    const bool is_out = batch.stage == Stage::kOut || batch.stage == Stage::kUnsure;
    Result<void> written = make_folder(batch.folder.root);
    if (written) written = write_stop(file, places, is_out ? Lasting::kNo : Lasting::kYes);
    if (!written && write_stops_after_ <= now) {  // the first of the round; it is the same for the others
      spdlog::error("{}", printable(written.error().message));
      write_stops_after_ = now + options_.poll;
    }
    return static_cast<bool>(written);
  });
}

void SlurmExecutor::step() {
  if (!looked_for_unknown_) remove_unknown();
  write_stops();  // once for all that the last round has stopped
  budget_ = kPerRound;
  const int waiting = n_waiting();
  if (waiting >= options_.max_pending) refilling_ = false;
  if (waiting <= options_.max_pending / 2) refilling_ = true;
  close_batches();
  remove_finished();
  const auto now = Clock::now();
  if (now >= read_after_) {
    read_reports();
    read_after_ = now + options_.poll;
  }
  if (command_) {
    const auto answer = command_->poll();
    if (!answer) return;
    command_.reset();
    take_answer(*answer);
  }
  if (now < ask_after_) return;
  if (cancel_tasks() || submit_next()) return;
  if (now >= list_after_) list_tasks();
}

void SlurmExecutor::close_batches() {
  for (auto& [token, batch] : batches_) {
    if (batch.stage != Stage::kOpen || std::exchange(batch.grown, false)) continue;
    Batch plan{options_.worker, std::vector<std::vector<Launch>>(batch.tasks.size())};
    for (std::size_t run = 0; run < batch.runs.size(); ++run) {
      auto& task = plan.tasks[static_cast<std::size_t>(task_of(batch, static_cast<int>(run)))];
      task.push_back(std::exchange(batch.runs[run].launch, {}));
    }
    const std::string script = fmt::format("#!/bin/sh\nexec {} {}\n", shell_word(options_.task.string()),
                                           shell_word(batch.folder.root.string()));
    Result<void> written = make_folder(batch.folder.root);
    if (written) written = write_batch(batch.folder, plan);
    if (written) written = write_file_atomically(batch.folder.script(), script);
    batch.stage = written ? Stage::kClosed : Stage::kRefused;
    if (!written) batch.error = written.error().message;
  }
}

std::vector<std::string> SlurmExecutor::sbatch_command(const std::string& token, const Sent& batch) const {
  const scene::SlurmSettings settings = scene::slurm_settings(batch.settings);
  std::vector<std::string> words{"sbatch",
                                 "--parsable",
                                 "--requeue",
                                 "--open-mode=append",
                                 "--nodes=1",
                                 "--ntasks=1",
                                 fmt::format("--cpus-per-task={}", options_.threads),
                                 fmt::format("--job-name={}{}", kNamePrefix, token),
                                 fmt::format("--array=0-{}", batch.tasks.size() - 1),
                                 "--chdir=" + batch.folder.root.string(),
                                 "--output=%a.log"};
  // The later one wins: first what is for all, then what this sweep says.
  words.insert(words.end(), options_.options.begin(), options_.options.end());
  if (!settings.partition.empty()) words.push_back("--partition=" + settings.partition);
  if (!settings.account.empty()) words.push_back("--account=" + settings.account);
  if (!settings.memory.empty()) words.push_back("--mem=" + settings.memory);
  double ahead = kAhead;
  if (settings.time > 0) {
    words.push_back(fmt::format("--time={:.0f}", std::ceil(settings.time / 60)));
    ahead = std::min(ahead, settings.time / 4);
  }
  words.push_back(fmt::format("--signal=B:USR1@{:.0f}", ahead));
  words.insert(words.end(), settings.options.begin(), settings.options.end());
  words.push_back(batch.folder.script().string());
  return words;
}

void SlurmExecutor::ask(Asked what, const std::vector<std::string>& words, const std::filesystem::path& folder,
                        milliseconds limit) {
  asked_ = what;
  asked_at_ = Clock::now();
  auto command = Command::start(words, folder, limit);
  if (command) {
    command_.emplace(std::move(*command));
    return;
  }
  take_answer({127, command.error().message});
  if (what == Asked::kSubmit) batches_.at(submitted_).stage = Stage::kRefused;  // nothing can have reached Slurm
}

bool SlurmExecutor::cancel_tasks() {
  std::vector<std::string> always;
  std::vector<std::string> if_waits;
  for (auto& [token, batch] : batches_) {
    if (batch.stage != Stage::kOut) continue;
    for (std::size_t number = 0; number < batch.tasks.size(); ++number) {
      const Task& task = batch.tasks[number];
      if (!task.cancel || task.cancelled || task.times_over > 0) continue;
      (task.if_waits ? if_waits : always).push_back(fmt::format("{}_{}", batch.job, number));
    }
  }
  std::vector<std::string>& chosen = always.empty() ? if_waits : always;
  if (chosen.empty()) return false;
  if (chosen.size() > kMostCancelled) chosen.resize(kMostCancelled);
  first_cancel_ = false;
  for (auto& [token, batch] : batches_) {
    for (std::size_t number = 0; number < batch.tasks.size(); ++number) {
      Task& task = batch.tasks[number];
      const bool sent =
          batch.stage == Stage::kOut && task.cancel &&
          std::find(chosen.begin(), chosen.end(), fmt::format("{}_{}", batch.job, number)) != chosen.end();
      if (!sent) continue;
      first_cancel_ = first_cancel_ || !task.was_cancelled;
      task.cancelled = task.was_cancelled = true;
    }
  }
  std::vector<std::string> words{"scancel"};
  if (&chosen == &if_waits) words.emplace_back("--state=PENDING");
  words.insert(words.end(), chosen.begin(), chosen.end());
  ask(Asked::kCancel, words, options_.folder, kLimit);
  return true;
}

bool SlurmExecutor::submit_next() {
  const auto next = std::find_if(batches_.begin(), batches_.end(), [&](const auto& entry) {
    return entry.second.stage == Stage::kClosed && !has_unsaid_stops(entry.first);
  });
  if (next == batches_.end()) return false;
  submitted_ = next->first;
  next->second.stage = Stage::kUnsure;
  ask(Asked::kSubmit, sbatch_command(next->first, next->second), next->second.folder.root, kSubmitLimit);
  return true;
}

void SlurmExecutor::list_tasks() {
  const bool anything = std::any_of(batches_.begin(), batches_.end(), [](const auto& entry) {
    return entry.second.stage == Stage::kOut || entry.second.stage == Stage::kUnsure;
  });
  if (!anything && trouble_.empty()) return;
  list_after_ = Clock::now() + options_.poll;
  ask(Asked::kList, squeue_command(), options_.folder, kLimit);
}

void SlurmExecutor::failed(const std::string& why, milliseconds first_pause) {
  pause_ = std::clamp(2 * pause_, first_pause, std::max(first_pause, options_.longest_pause));
  ask_after_ = Clock::now() + pause_;
  list_after_ = ask_after_;
  if (trouble_ != why) spdlog::warn("Slurm: {}", why);
  trouble_ = why;
}

void SlurmExecutor::take_answer(const Captured& answer) {
  const bool fine = answer.exit_code == 0;
  switch (asked_) {
    case Asked::kCancel:
      // that a task has ended meanwhile is an error to scancel; the next list tells what came of it
      if (!fine) spdlog::debug("scancel: {}", in_one_line(answer));
      if (first_cancel_) list_after_ = std::min(list_after_, Clock::now() + kSoon);
      break;
    case Asked::kSubmit: {
      Sent& batch = batches_.at(submitted_);
      const std::string job = fine ? parse_sbatch(answer.output) : std::string();
      if (job.empty()) {
        batch.error = in_one_line(answer);
        // A refusal comes at once, and the next list makes sure of it. What takes longer may be in Slurm's hands still.
        const bool at_once = Clock::now() < asked_at_ + kAtOnce;
        if (batch.tasks.size() > 1 && is_about_size(batch.error)) {
          most_tasks_ = std::min(most_tasks_, batch.tasks.size() / 2);
          spdlog::warn("Slurm refuses an array of {} tasks: the next have at most {}", batch.tasks.size(), most_tasks_);
        }
        failed("sbatch: " + batch.error, at_once ? std::min(kSoon, options_.poll) : options_.poll);
        break;
      }
      batch.job = job;
      batch.stage = Stage::kOut;
      spdlog::info("Slurm job {}: {} runs in {} tasks, batch {}", job, batch.runs.size(), batch.tasks.size(),
                   submitted_);
      if (const auto written = write_file_atomically(batch.folder.job(), job); !written) {
        spdlog::warn("{}", printable(written.error().message));  // it is found by its name
      }
      break;
    }
    case Asked::kList:
      if (!fine) {
        failed("squeue: " + in_one_line(answer) + printable(" (" + slurm_conf_text() + ")"), options_.poll);
        silence_ = "Slurm does not answer: " + trouble_;
        break;
      }
      if (!trouble_.empty()) spdlog::info("Slurm answers");
      trouble_.clear();
      silence_.clear();
      pause_ = milliseconds(0);
      read_reports();  // of what the list calls over
      take_list(parse_squeue(answer.output));
      break;
  }
}

void SlurmExecutor::take_list(const std::vector<QueuedTask>& listed) {
  std::map<std::string, std::vector<const QueuedTask*>> by_token;
  for (const QueuedTask& task : listed) {
    if (!task.name.starts_with(kNamePrefix)) continue;
    const std::string token = task.name.substr(kNamePrefix.size());
    if (batches_.contains(token)) by_token[token].push_back(&task);
  }
  for (auto& [token, batch] : batches_) {
    if (batch.stage != Stage::kOut && batch.stage != Stage::kUnsure) continue;
    const std::vector<const QueuedTask*>& found = by_token[token];
    const bool has_begun =
        std::any_of(batch.tasks.begin(), batch.tasks.end(), [](const Task& t) { return t.reported; });
    if (batch.stage == Stage::kUnsure) {
      batch.stage = found.empty() && !has_begun ? Stage::kRefused : Stage::kOut;
      if (!found.empty()) batch.job = found.front()->job;
      if (batch.stage == Stage::kRefused) {
        std::error_code ignored;
        std::filesystem::remove_all(batch.folder.root, ignored);  // should it come after all, it finds nothing to do
      }
    }
    if (batch.stage != Stage::kOut) continue;
    std::vector<const QueuedTask*> of_task(batch.tasks.size(), nullptr);
    for (const QueuedTask* task : found) {
      if (task->job == batch.job && task->task < static_cast<int>(of_task.size())) {
        of_task[static_cast<std::size_t>(task->task)] = task;
      }
    }
    for (std::size_t number = 0; number < batch.tasks.size(); ++number) {
      Task& task = batch.tasks[number];
      const QueuedTask* now = of_task[number];
      task.cancelled = false;
      if (now == nullptr || now->stage == QueueStage::kOver) {
        if (task.times_over == 0) task.over_since = Clock::now();
        task.stage = QueueStage::kOver;
        task.words = now != nullptr ? now->state : "Slurm does not know it any more";
        ++task.times_over;
      } else {
        task.stage = now->stage;
        task.words = now->stage == QueueStage::kWaiting ? now->reason : "";
        task.times_over = 0;
        if (task.if_waits && now->stage == QueueStage::kWorking) task.cancel = false;  // its file of stops tells it
      }
    }
  }
}

void SlurmExecutor::read_report_of(Sent& batch, int number) {
  const Result<TaskReport> report = read_report(batch.folder.report(number));
  if (!report) return;
  Task& task = batch.tasks[static_cast<std::size_t>(number)];
  task.reported = true;
  const auto run_at = [&](int place) -> Run* {
    const auto run = static_cast<std::size_t>(number * batch.runs_per_task + place);
    return place >= 0 && place < batch.runs_per_task && run < batch.runs.size() ? &batch.runs[run] : nullptr;
  };
  for (const int place : report->begun) {
    if (Run* run = run_at(place)) run->begun = true;
  }
  for (const auto& [place, end] : report->ends) {
    if (Run* run = run_at(place)) run->end = end;
  }
}

void SlurmExecutor::read_reports() {
  for (auto& [token, batch] : batches_) {
    if (batch.stage != Stage::kOut && batch.stage != Stage::kUnsure) continue;
    for (std::size_t number = 0; number < batch.tasks.size(); ++number) {
      const Task& task = batch.tasks[number];
      const bool may_have_begun = task.stage != QueueStage::kWaiting || !trouble_.empty();
      const bool may_come = !task.is_over() || Clock::now() < task.over_since + options_.report_delay;
      if (may_have_begun && may_come) read_report_of(batch, static_cast<int>(number));
    }
  }
}

void SlurmExecutor::remove_finished() {
  std::erase_if(batches_, [](const auto& entry) {
    const Sent& batch = entry.second;
    if (batch.runs.empty() ||
        !std::all_of(batch.runs.begin(), batch.runs.end(), [](const Run& run) { return run.told; })) {
      return false;
    }
    const bool tasks_over =
        std::all_of(batch.tasks.begin(), batch.tasks.end(), [](const Task& t) { return t.is_over(); });
    if (batch.stage == Stage::kUnsure || (batch.stage == Stage::kOut && !tasks_over)) return false;
    std::error_code ignored;
    std::filesystem::remove_all(batch.folder.root, ignored);
    return true;
  });
}

void SlurmExecutor::remove_unknown() {
  looked_for_unknown_ = true;
  std::error_code error;
  std::vector<std::filesystem::path> unknown;
  for (std::filesystem::directory_iterator entry(options_.folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (is_token(name) && !batches_.contains(name)) unknown.push_back(entry->path());
  }
  for (const std::filesystem::path& folder : unknown) std::filesystem::remove_all(folder, error);
}

}  // namespace shaken::server::slurm
