// SPDX-License-Identifier: MIT
// Random operations on the queue against a model that is a few lines long.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <array>
#include <chrono>
#include <map>
#include <memory>

#include "server/queue.h"
#include "tests/unit/server/support.h"

namespace shaken::server {
namespace {

using enum JobState;

struct ModelJob {
  JobState state = kQueued;
  JobState after_stop = kQueued;
  bool waits_for_room = false;
  int crashes = 0;
  int attempt = 0;
  int priority = 0;
  int arrival = 0;
};

enum class Operation {
  kSubmit,
  kBegin,
  kDone,
  kFail,
  kStopped,
  kCancel,
  kHold,
  kResume,
  kRetry,
  kWorkerCrashes,
  kNoRoom,
  kRoom,
  kStopAll,
  kReopen,
  kCrash
};
constexpr int kOperations = 15;
/// As many crashes in a row are forgiven.
constexpr std::array<std::chrono::milliseconds, 2> kPauses{};
constexpr std::string_view kDigits = "abcde";

class Model {
 public:
  void submit(char digit, int priority) {
    const auto [entry, is_new] = jobs_.try_emplace(digit);
    ModelJob& job = entry->second;
    if (is_new) job.arrival = static_cast<int>(jobs_.size());
    job.priority = is_new ? priority : std::max(job.priority, priority);
    const bool held = job.state == kHeld && !job.waits_for_room;
    if (job.state == kFailed || job.state == kCancelled || held) become(job, kQueued);
    job.after_stop = kQueued;
  }
  static void become(ModelJob& job, JobState state) {
    job.state = state;
    job.after_stop = kQueued;
    job.waits_for_room = false;
    job.crashes = 0;
  }
  static void stop(ModelJob& job) { become(job, job.state == kStopping ? job.after_stop : kQueued); }
  static void ask_to_stop(ModelJob& job, JobState after_stop) {
    job.state = kStopping;
    job.after_stop = after_stop;
  }
  static void cancel(ModelJob& job) {
    if (job.state == kQueued || job.state == kHeld) become(job, kCancelled);
    if (job.state == kRunning || job.state == kStopping) ask_to_stop(job, kCancelled);
  }
  static void hold(ModelJob& job) {
    if (job.state == kQueued || job.state == kHeld) become(job, kHeld);
    const bool is_cancelled = job.state == kStopping && job.after_stop == kCancelled;
    if (job.state == kRunning || (job.state == kStopping && !is_cancelled)) ask_to_stop(job, kHeld);
  }
  static void release(ModelJob& job, bool retry) {
    if (job.state == kHeld || (retry && (job.state == kFailed || job.state == kCancelled))) become(job, kQueued);
    if (job.state == kStopping && job.after_stop == kHeld) job.after_stop = kQueued;
    if (retry && job.state == kQueued) job.crashes = 0;
  }
  static void crash(ModelJob& job) {
    if (job.state == kStopping) return stop(job);
    const int crashes = job.crashes + 1;
    const bool is_too_often = crashes > static_cast<int>(kPauses.size());
    become(job, is_too_often ? kFailed : kQueued);
    if (!is_too_often) job.crashes = crashes;
  }
  static void find_no_room(ModelJob& job) {
    if (job.state == kStopping) return stop(job);
    become(job, kHeld);
    job.waits_for_room = true;
  }
  bool active(char digit) const {
    const auto job = jobs_.find(digit);
    return job != jobs_.end() && (job->second.state == kRunning || job->second.state == kStopping);
  }
  /// The order in which queued jobs start.
  std::string order() const {
    std::vector<std::pair<std::pair<int, int>, char>> waiting;
    for (const auto& [digit, job] : jobs_) {
      if (job.state == kQueued) waiting.push_back({{-job.priority, job.arrival}, digit});
    }
    std::sort(waiting.begin(), waiting.end());
    std::string digits;
    for (const auto& entry : waiting) digits += entry.second;
    return digits;
  }

  std::map<char, ModelJob> jobs_;
};

void apply(Operation operation, char digit, int priority, std::unique_ptr<Queue>& queue, Model& model,
           const std::filesystem::path& file) {
  const std::string id(16, digit);
  const bool known = model.jobs_.contains(digit);
  switch (operation) {
    case Operation::kSubmit:
      queue->submit("sweep", priority, std::vector{new_job(digit)});
      model.submit(digit, priority);
      return;
    case Operation::kBegin: {
      const auto attempt = queue->begin(id);
      const bool begins = known && model.jobs_[digit].state == kQueued;
      RC_ASSERT(attempt.has_value() == begins);
      if (!begins) return;
      model.jobs_[digit].state = kRunning;
      RC_ASSERT(*attempt == ++model.jobs_[digit].attempt);
      return;
    }
    case Operation::kDone:
    case Operation::kFail: {
      if (!model.active(digit)) return;
      const JobState end = operation == Operation::kDone ? kDone : kFailed;
      queue->finish(id, end, "");
      Model::become(model.jobs_[digit], end);
      return;
    }
    case Operation::kStopped:
      if (!model.active(digit)) return;
      queue->stopped(id, "stopped");
      model.stop(model.jobs_[digit]);
      return;
    case Operation::kCancel:
      queue->cancel(id);
      if (known) model.cancel(model.jobs_[digit]);
      return;
    case Operation::kHold:
      queue->hold(id);
      if (known) Model::hold(model.jobs_[digit]);
      return;
    case Operation::kResume:
    case Operation::kRetry:
      queue->release(id, operation == Operation::kRetry);
      if (known) Model::release(model.jobs_[digit], operation == Operation::kRetry);
      return;
    case Operation::kWorkerCrashes:
      if (!model.active(digit)) return;
      queue->crashed(id, "crash", false, kPauses);
      Model::crash(model.jobs_[digit]);
      return;
    case Operation::kNoRoom:
      if (!model.active(digit)) return;
      queue->no_room(id, "no room", 1000 * priority, std::chrono::milliseconds(0));
      Model::find_no_room(model.jobs_[digit]);
      return;
    case Operation::kRoom:
      queue->there_is_room(1'000'000);
      for (auto& [each, job] : model.jobs_) {
        if (job.state == kHeld && job.waits_for_room) Model::become(job, kQueued);
      }
      return;
    case Operation::kStopAll:
      queue->stop_all();
      for (auto& [each, job] : model.jobs_) {
        if (job.state == kRunning) Model::ask_to_stop(job, kQueued);
      }
      return;
    case Operation::kReopen:
      queue.reset();
      queue = std::make_unique<Queue>(file);
      return;
    case Operation::kCrash:
      queue.reset();
      queue = std::make_unique<Queue>(file);
      queue->recover();
      for (auto& [each, job] : model.jobs_) {
        if (job.state == kRunning || job.state == kStopping) model.stop(job);
      }
      return;
  }
}

TEST(QueueModelTest, EveryHistoryEndsAsTheModelSays) {
  EXPECT_TRUE(rc::check("queue", [] {
    const auto history = *rc::gen::container<std::vector<std::tuple<int, int, int>>>(
        rc::gen::tuple(rc::gen::inRange(0, kOperations), rc::gen::inRange(0, static_cast<int>(kDigits.size())),
                       rc::gen::inRange(0, 3)));
    const TempDirectory directory;
    const auto file = directory / "queue.db";
    auto queue = std::make_unique<Queue>(file);
    Model model;
    for (const auto& [operation, digit, priority] : history) {
      apply(static_cast<Operation>(operation), kDigits[static_cast<std::size_t>(digit)], priority, queue, model, file);

      std::map<std::string, std::pair<JobState, int>> stored;
      for (const Job& job : queue->jobs(std::nullopt)) stored[job.id] = {job.state, job.attempt};
      std::map<std::string, std::pair<JobState, int>> expected;
      for (const auto& [each, job] : model.jobs_) expected[std::string(16, each)] = {job.state, job.attempt};
      RC_ASSERT(stored == expected);
      std::string order;
      for (const Job& job : queue->next(100)) order += job.id.front();
      RC_ASSERT(order == model.order());
    }
    // The journal, read from the start, leads to the same states and knows no forbidden step.
    std::map<std::string, JobState> replayed;
    for (const Change& change : queue->changes_since(0, 1'000'000)) {
      if (!change.from.empty()) {
        RC_ASSERT(replayed.at(change.job) == *job_state(change.from));
        RC_ASSERT(may_become(*job_state(change.from), *job_state(change.to)));
      }
      replayed[change.job] = *job_state(change.to);
    }
    for (const Job& job : queue->jobs(std::nullopt)) RC_ASSERT(replayed.at(job.id) == job.state);
  }));
}

}  // namespace
}  // namespace shaken::server
