// SPDX-License-Identifier: MIT
// Random operations on the queue against a model that is a few lines long.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <map>
#include <memory>

#include "server/queue.h"
#include "tests/unit/server/support.h"

namespace shaken::server {
namespace {

using enum JobState;

struct ModelJob {
  JobState state = kQueued;
  bool cancel_asked = false;
  int attempt = 0;
  int priority = 0;
  int arrival = 0;
};

enum class Operation { kSubmit, kBegin, kDone, kFail, kStopped, kCancel, kStopAll, kReopen, kCrash };
constexpr int kOperations = 9;
constexpr std::string_view kDigits = "abcde";

class Model {
 public:
  void submit(char digit, int priority) {
    const auto [entry, is_new] = jobs_.try_emplace(digit);
    ModelJob& job = entry->second;
    if (is_new) job.arrival = static_cast<int>(jobs_.size());
    job.priority = is_new ? priority : std::max(job.priority, priority);
    if (job.state == kFailed || job.state == kCancelled) job.state = kQueued;
    job.cancel_asked = false;
  }
  void stop(ModelJob& job) {
    job.state = job.cancel_asked ? kCancelled : kQueued;
    job.cancel_asked = false;
  }
  void cancel(ModelJob& job) {
    if (job.state == kQueued) job.state = kCancelled;
    if (job.state == kRunning || job.state == kStopping) {
      job.state = kStopping;
      job.cancel_asked = true;
    }
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
      model.jobs_[digit].state = end;
      model.jobs_[digit].cancel_asked = false;
      return;
    }
    case Operation::kStopped:
      if (!model.active(digit)) return;
      queue->stopped(id, "stopped");
      model.stop(model.jobs_[digit]);
      return;
    case Operation::kCancel:
      queue->cancel_job(id);
      if (known) model.cancel(model.jobs_[digit]);
      return;
    case Operation::kStopAll:
      queue->stop_all();
      for (auto& [each, job] : model.jobs_) {
        if (job.state == kRunning) job.state = kStopping;
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
