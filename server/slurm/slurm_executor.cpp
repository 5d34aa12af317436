#include "server/slurm/slurm_executor.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <random>
#include <system_error>

#include "base/files.h"
#include "base/slurm_conf.h"
#include "base/text.h"
#include "scene/sweeps/slurm_settings.h"

namespace shaken::server::slurm {
namespace {

using std::chrono::milliseconds;
using Phase = WorkerReport::Phase;
using Stage = SentBatch::Stage;
using Kind = SlurmCall::Kind;

/// Workers that one round takes: each costs the daemon some writes to the disk.
constexpr int kPerRound = 50;
/// Tasks that one scancel names.
constexpr std::size_t kMostCancelled = 500;
/// After something has changed that the next list is to show.
constexpr milliseconds kSoon{500};
constexpr std::string_view kNamePrefix = "shaken-";
/// Ahead of the end of a task's time its runs are told to write a checkpoint.
constexpr double kAhead = 60;

/// 16 hex digits, as an id has (is_id).
std::string new_token() {
  std::random_device random;
  return fmt::format("{:08x}{:08x}", random(), random());
}

/// Whether Slurm has refused an array for its size, or for how many tasks a user may have: "Invalid job array
/// specification", "Job array index too large", "Job violates accounting/QOS policy (job submit limit, ...)".
bool is_about_size(std::string_view words) {
  std::string text(words);
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text.find("array") != text.npos || text.find("submit") != text.npos;
}

}  // namespace

SlurmExecutor::SlurmExecutor(SlurmOptions options) : options_(std::move(options)), call_(options_.longest_pause) {}

int SlurmExecutor::n_waiting() const {
  std::ptrdiff_t n = 0;
  for (const auto& [token, batch] : batches_) {
    if (batch.stage() == Stage::kRefused) continue;
    n += std::count_if(batch.tasks().begin(), batch.tasks().end(),
                       [](const ArrayTask& task) { return task.stage() == QueuedTask::Stage::kWaiting; });
  }
  return static_cast<int>(n);
}

int SlurmExecutor::room() const {
  const bool any_unsent = std::ranges::any_of(batches_, [](const auto& entry) {
    return entry.second.stage() == Stage::kClosed || entry.second.stage() == Stage::kUnsure;
  });
  if (!call_.trouble().empty() || !refilling_ || any_unsent) return 0;
  if (n_waiting() < options_.max_pending) return budget_;
  int places = 0;
  for (const auto& [token, batch] : batches_) places += batch.stage() == Stage::kOpen ? batch.n_free_places() : 0;
  return std::min(budget_, places);
}

Result<int> SlurmExecutor::start(const Launch& launch) {
  auto entry =
      std::ranges::find_if(batches_, [&](const auto& each) { return each.second.fits(launch.settings, most_tasks_); });
  if (entry == batches_.end()) {
    const int asked = scene::slurm_settings(launch.settings).runs_per_task;
    const std::string token = new_token();
    entry =
        batches_
            .try_emplace(token, options_.folder / token, launch.settings, asked > 0 ? asked : options_.runs_per_task)
            .first;
  }
  --budget_;
  handles_[++last_handle_] = {entry->first, entry->second.add(launch)};
  return last_handle_;
}

std::string SlurmExecutor::name(int worker) const {
  const auto entry = handles_.find(worker);
  return entry == handles_.end() ? std::string() : fmt::format("{}/{}", entry->second.batch, entry->second.run);
}

std::optional<int> SlurmExecutor::adopt(const std::string& name) {
  const std::string token = name.substr(0, name.find('/'));
  const int number = token.size() < name.size() ? number_in<int>(name.substr(token.size() + 1)).value_or(-1) : -1;
  if (!is_id(token) || number < 0) return std::nullopt;
  auto batch = batches_.find(token);
  if (batch == batches_.end()) {
    auto written = SentBatch::written(options_.folder / token);
    if (!written) return std::nullopt;
    batch = batches_.emplace(token, *std::move(written)).first;
  }
  if (!batch->second.adopt(number)) return std::nullopt;
  handles_[++last_handle_] = {token, number};
  return last_handle_;
}

WorkerReport SlurmExecutor::poll(int worker) {
  const Handle& handle = handles_.at(worker);
  SentBatch& batch = batches_.at(handle.batch);
  WorkerReport report = batch.state_of(handle.run, options_.report_delay);
  if (report.phase != Phase::kWaiting && report.phase != Phase::kWorking) {
    batch.set_collected(handle.run);
    handles_.erase(worker);
    return report;
  }
  const bool is_to_stop = report.phase == Phase::kWaiting && batch.is_stop_asked(handle.run);
  if (is_to_stop && batch.stage() == Stage::kOut && !call_.trouble().empty()) {
    report.words =
        fmt::format("stops once Slurm answers, which has it as job {}: {}", batch.job_of(handle.run), call_.trouble());
  } else if (batch.may_be_out() && !call_.silence().empty()) {
    report.words += (report.words.empty() ? "" : "; ") + call_.silence();
  }
  return report;
}

void SlurmExecutor::step() {
  if (!looked_for_unknown_) remove_unknown();
  write_stops();  // once for all that the last round has stopped
  budget_ = kPerRound;
  const int waiting = n_waiting();
  if (waiting >= options_.max_pending) refilling_ = false;
  if (waiting <= options_.max_pending / 2) refilling_ = true;
  for (auto& [token, batch] : batches_) batch.close(options_.worker, options_.task);
  remove_finished();
  const auto now = Clock::now();
  if (now >= read_after_) {
    read_reports();
    read_after_ = now + options_.poll;
  }
  if (const auto answer = call_.poll()) handle_answer(*answer);
  if (call_.is_busy() || call_.is_pausing()) return;
  if (cancel_tasks() || submit_next()) return;
  if (now >= list_after_) list_tasks();
}

void SlurmExecutor::write_stops() {
  const auto now = Clock::now();
  if (now < write_stops_after_) return;
  for (auto& [token, batch] : batches_) {
    const Result<void> written = batch.write_stops();
    if (written || write_stops_after_ > now) continue;  // it is told once in a round: it is the same for the others
    spdlog::error("{}", printable(written.error().message));
    write_stops_after_ = now + options_.poll;
  }
}

void SlurmExecutor::read_reports() {
  for (auto& [token, batch] : batches_) batch.read_reports(!call_.trouble().empty(), options_.report_delay);
}

std::vector<std::string> SlurmExecutor::sbatch_command(const std::string& token, const SentBatch& batch) const {
  const scene::SlurmSettings settings = scene::slurm_settings(batch.settings());
  std::vector<std::string> words{"sbatch",
                                 "--parsable",
                                 "--requeue",
                                 "--open-mode=append",
                                 "--nodes=1",
                                 "--ntasks=1",
                                 fmt::format("--cpus-per-task={}", options_.threads),
                                 fmt::format("--job-name={}{}", kNamePrefix, token),
                                 fmt::format("--array=0-{}", batch.tasks().size() - 1),
                                 "--chdir=" + batch.folder().root.string(),
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
  words.push_back(batch.folder().script().string());
  return words;
}

bool SlurmExecutor::cancel_tasks() {
  for (const bool if_waits : {false, true}) {
    std::vector<std::string> words{"scancel"};
    if (if_waits) words.emplace_back("--state=PENDING");
    const std::size_t most = words.size() + kMostCancelled, none = words.size();
    first_cancel_ = false;
    for (auto& [token, batch] : batches_) {
      if (batch.stage() != Stage::kOut) continue;
      for (std::size_t number = 0; number < batch.tasks().size() && words.size() < most; ++number) {
        ArrayTask& task = batch.tasks()[number];
        if (!task.is_to_cancel(if_waits)) continue;
        words.push_back(fmt::format("{}_{}", batch.job(), number));
        if (task.set_cancelled()) first_cancel_ = true;
      }
    }
    if (words.size() == none) continue;
    call_.start(Kind::kCancel, words, options_.folder);
    return true;
  }
  return false;
}

bool SlurmExecutor::submit_next() {
  const auto next = std::ranges::find_if(batches_, [](const auto& entry) {
    return entry.second.stage() == Stage::kClosed && !entry.second.has_unwritten_stops();
  });
  if (next == batches_.end()) return false;
  submitted_ = next->first;
  next->second.set_unsure("");
  call_.start(Kind::kSubmit, sbatch_command(next->first, next->second), next->second.folder().root);
  return true;
}

void SlurmExecutor::list_tasks() {
  const bool anything = std::ranges::any_of(batches_, [](const auto& entry) { return entry.second.may_be_out(); });
  if (!anything && call_.trouble().empty()) return;
  list_after_ = Clock::now() + options_.poll;
  call_.start(Kind::kList, squeue_command(), options_.folder);
}

void SlurmExecutor::handle_answer(const SlurmCall::Answer& answer) {
  switch (answer.kind) {
    case Kind::kCancel:
      // that a task has ended meanwhile is an error to scancel; the next list tells what came of it
      if (!answer.is_fine()) spdlog::debug("scancel: {}", answer.in_one_line());
      if (first_cancel_) list_after_ = std::min(list_after_, Clock::now() + kSoon);
      break;
    case Kind::kSubmit:
      handle_submitted(answer);
      break;
    case Kind::kList:
      if (!answer.is_fine()) {
        call_.set_failed("squeue: " + answer.in_one_line() + printable(" (" + slurm_conf_text() + ")"), options_.poll);
        call_.set_silent();
        list_after_ = {};  // when the pause is over
        break;
      }
      call_.set_fine();
      read_reports();  // of what the list calls over
      update_tasks(parse_squeue(answer.said.output));
      break;
  }
}

void SlurmExecutor::handle_submitted(const SlurmCall::Answer& answer) {
  SentBatch& batch = batches_.at(submitted_);
  const std::size_t n_tasks = batch.tasks().size();
  const std::string job = answer.is_fine() ? parse_sbatch(answer.said.output) : std::string();
  if (job.empty()) {
    const std::string why = answer.in_one_line();
    batch.set_unsure(why);
    if (n_tasks > 1 && is_about_size(why)) {
      most_tasks_ = std::min(most_tasks_, n_tasks / 2);
      spdlog::warn("Slurm refuses an array of {} tasks: the next have at most {}", n_tasks, most_tasks_);
    }
    // A refusal comes at once, and the next list makes sure of it. What takes longer may be in Slurm's hands still.
    call_.set_failed("sbatch: " + why, answer.came_at_once ? std::min(kSoon, options_.poll) : options_.poll);
    list_after_ = {};  // when the pause is over
    if (!answer.reached_slurm) batch.set_refused();
    return;
  }
  batch.set_out(job);
  spdlog::info("Slurm job {}: {} runs in {} tasks, batch {}", job, batch.n_runs(), n_tasks, submitted_);
  if (const auto written = write_file_atomically(batch.folder().job(), job); !written) {
    spdlog::warn("{}", printable(written.error().message));  // it is found by its name
  }
}

void SlurmExecutor::update_tasks(const std::vector<QueuedTask>& listed) {
  std::map<std::string, std::vector<const QueuedTask*>> by_token;
  for (const QueuedTask& task : listed) {
    if (task.name.starts_with(kNamePrefix)) by_token[task.name.substr(kNamePrefix.size())].push_back(&task);
  }
  for (auto& [token, batch] : batches_) batch.update_tasks(by_token[token]);
}

void SlurmExecutor::remove_finished() {
  std::erase_if(batches_, [](const auto& entry) {
    if (!entry.second.is_finished()) return false;
    std::error_code ignored;
    std::filesystem::remove_all(entry.second.folder().root, ignored);
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
    if (is_id(name) && !batches_.contains(name)) unknown.push_back(entry->path());
  }
  for (const std::filesystem::path& folder : unknown) std::filesystem::remove_all(folder, error);
}

}  // namespace shaken::server::slurm
