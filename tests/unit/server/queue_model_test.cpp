// Random operations on the queue against a model of it without files, indices and transactions.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <map>
#include <memory>

#include "server/queue/queue.h"
#include "tests/unit/server/server_support.h"

namespace shaken::server {
namespace {

using enum JobState;

enum class Hold { kNone, kRequest, kRoom, kOthers, kRule };

struct ModelJob {
  JobState state = kQueued;
  JobState after_stop = kQueued;  ///< kRunning: queued behind the others, to run again
  Hold hold = Hold::kNone;
  bool waits = false;  ///< for what its sweep comes after
  int sweep = 0;       ///< that asked for it last
  int crashes = 0;
  int attempt = 0;
  int priority = 0;
  int turn = 0;
  int scene = 0;        ///< as submitted, or which it was extended to
  bool longer = false;  ///< its worker does not know of that
};

JobPhase phase_of(const ModelJob& job) {
  static const std::map<JobState, JobPhase> kEnds{{kQueued, JobPhase::kQueued},     {kRunning, JobPhase::kRunning},
                                                  {kDone, JobPhase::kDone},         {kFailed, JobPhase::kFailed},
                                                  {kTimedOut, JobPhase::kTimedOut}, {kCancelled, JobPhase::kCancelled}};
  static const std::map<Hold, JobPhase> kHolds{{Hold::kRequest, JobPhase::kHeldOnRequest},
                                               {Hold::kRoom, JobPhase::kHeldForRoom},
                                               {Hold::kOthers, JobPhase::kHeldForOthers},
                                               {Hold::kRule, JobPhase::kHeldByRule}};
  static const std::map<JobState, JobPhase> kStops{{kQueued, JobPhase::kStopToQueue},
                                                   {kRunning, JobPhase::kStopToLast},
                                                   {kCancelled, JobPhase::kStopToCancel},
                                                   {kHeld, JobPhase::kStopToHold},
                                                   {kTimedOut, JobPhase::kStopToTimeOut}};
  return job.state == kHeld       ? kHolds.at(job.hold)
         : job.state == kStopping ? kStops.at(job.after_stop)
                                  : kEnds.at(job.state);
}

/// A sweep of two jobs at most, one of which may be another's, too.
struct ModelSweep {
  std::string digits;
  int at_most = 0;
  char after = 0;  ///< a job
  bool has_results = false;
  bool has_rule = false;
  bool stopped = false;
};

enum class Operation {
  kSubmit,
  kSubmitTwo,
  kSubmitTwoOneAtOnce,
  kSubmitTwoWithRule,
  kSubmitAfter,
  kSubmitWithResults,
  kGiveWay,
  kTimeOut,
  kBegin,
  kDone,
  kFail,
  kStopped,
  kCancel,
  kExtend,
  kClean,
  kHold,
  kResume,
  kResumeSweep,
  kRetry,
  kWorkerCrashes,
  kNoRoom,
  kRoom,
  kStopAll,
  kReopen,
  kCrash
};
constexpr int kOperations = 25;
/// As many crashes in a row are forgiven.
constexpr std::array<std::chrono::milliseconds, 2> kPauses{};
constexpr std::string_view kDigits = "abcd";
/// A chain: c starts from the end of b, and d from that of c.
char start_of(char digit) { return digit == 'c' ? 'b' : digit == 'd' ? 'c' : '\0'; }

bool may_become(JobState from, JobState to) {
  if (from == kQueued) return to != kQueued && to != kStopping && to != kDone;
  if (from == kHeld) return to == kQueued || to == kCancelled;
  if (from == kRunning) return to == kStopping || to == kDone || to == kFailed || to == kQueued || to == kHeld;
  if (from == kStopping) return to != kStopping && to != kRunning;
  return to == kQueued || to == kCancelled;
}

bool has_no_result(JobState state) { return state == kFailed || state == kTimedOut || state == kCancelled; }

class Model {
 public:
  /// Whether the jobs of a submission would wait for themselves.
  bool is_circular(const std::string& digits, char after) const {
    std::string pending(1, after);
    for (std::size_t i = 0; i < pending.size(); ++i) {
      const auto job = jobs_.find(pending[i]);
      if (job == jobs_.end()) continue;
      if (digits.find(pending[i]) != std::string::npos && job->second.state != kDone) return true;
      const char prerequisite = job->second.waits ? sweeps_.at(job->second.sweep).after : 0;
      const bool has_begun = job->second.attempt > 0 || job->second.state == kDone;
      const char start = has_begun ? '\0' : start_of(pending[i]);
      if (start != 0 && digits.find(start) != std::string::npos && !is_done(start)) return true;
      for (const char next : {prerequisite, start}) {
        if (next != 0 && pending.find(next) == std::string::npos) pending += next;
      }
    }
    return false;
  }
  bool is_done(char digit) const { return jobs_.contains(digit) && jobs_.at(digit).state == kDone; }
  bool waits_for_start(char digit) const {
    const char start = start_of(digit);
    return start != 0 && jobs_.at(digit).attempt == 0 && jobs_.contains(start) && !is_done(start);
  }
  void submit(const ModelSweep& asked, int priority) {
    const bool same = !sweeps_.empty() && sweeps_.rbegin()->second.digits == asked.digits;
    const int sweep = static_cast<int>(sweeps_.size()) + (same ? 0 : 1);
    for (const char digit : asked.digits) {
      const auto [entry, is_new] = jobs_.try_emplace(digit);
      ModelJob& job = entry->second;
      if (is_new) job.turn = ++time_;
      if (is_new && asked.has_results) job.state = kDone;
      job.priority = is_new ? priority : std::max(job.priority, priority);
      job.sweep = sweep;
      const bool is_stopping = job.state == kStopping;
      if (has_no_result(job.state) || (is_stopping && job.after_stop == kCancelled)) {
        job.scene = 0;
        job.longer = job.longer || is_stopping;
      } else if (job.state != kDone) {
        extend(digit, 0);
      }
      const bool held = job.state == kHeld && job.hold != Hold::kRoom;
      if (has_no_result(job.state) || held) become(digit, kQueued);
      // One that is to stop behind the others, stops.
      if (job.after_stop != kRunning) job.after_stop = kQueued;
    }
    sweeps_[sweep] = asked;
    for (const char digit : asked.digits) {
      ModelJob& job = jobs_[digit];
      job.waits = asked.after != 0 && (job.state == kQueued || job.state == kHeld);
    }
    settle_waits();
  }
  /// Whether that is another scene than the job had.
  bool extend(char digit, int scene) {
    ModelJob& job = jobs_.at(digit);
    if (job.scene == scene) return false;
    job.scene = scene;
    job.longer = job.longer || job.state == kRunning || job.state == kStopping;
    ++time_;
    return true;
  }
  void finish(char digit, JobState end) {
    if (end == kDone && jobs_.at(digit).longer) return stop(digit);
    become(digit, end);
  }
  /// Whether nothing comes of what a job waits for, as things are.
  bool waits_in_vain(char digit) const {
    const ModelJob& job = jobs_.at(digit);
    const auto sweep = sweeps_.find(job.sweep);
    const bool after = job.waits && sweep != sweeps_.end() && sweep->second.after != 0 &&
                       has_no_result(jobs_.at(sweep->second.after).state);
    if (after || !waits_for_start(digit)) return after;
    const ModelJob& start = jobs_.at(start_of(digit));
    return has_no_result(start.state) || start.hold == Hold::kOthers;
  }
  /// Those that wait for others are held while nothing comes of that, and wait no more for what is done.
  void settle_waits() {
    for (auto& [digit, job] : jobs_) {  // in the order of the chain
      const auto sweep = sweeps_.find(job.sweep);
      if (sweep != sweeps_.end() && sweep->second.after != 0 && is_done(sweep->second.after)) job.waits = false;
      const bool is_held = job.hold == Hold::kOthers;
      if ((job.state == kQueued || is_held) && waits_in_vain(digit) != is_held) {
        ++time_;
        job.state = is_held ? kQueued : kHeld;
        job.hold = is_held ? Hold::kNone : Hold::kOthers;
      }
    }
  }
  void judge(char ended) {
    for (auto& [number, sweep] : sweeps_) {
      if (!sweep.has_rule || sweep.stopped || sweep.digits.find(ended) == std::string::npos) continue;
      for (const char digit : sweep.digits) sweep.stopped = sweep.stopped || jobs_.at(digit).state == kFailed;
      if (!sweep.stopped) continue;
      for (const char digit : sweep.digits) {
        const ModelJob& job = jobs_.at(digit);
        if (job.state == kQueued && job.sweep == number) become(digit, kHeld, Hold::kRule);
      }
    }
  }
  void become(char digit, JobState state, Hold hold = Hold::kNone) {
    ModelJob& job = jobs_.at(digit);
    job.state = state;
    job.after_stop = kQueued;
    job.hold = hold;
    job.crashes = 0;
    ++time_;  // a line of the journal
    if (state == kDone || state == kFailed || state == kTimedOut) judge(digit);
    if (state != kHeld) settle_waits();
  }
  void stop(char digit) {
    const ModelJob& job = jobs_.at(digit);
    const bool is_last = job.state == kStopping && job.after_stop == kRunning;
    become(digit, job.state != kStopping || is_last ? kQueued : job.after_stop,
           job.after_stop == kHeld ? Hold::kRequest : Hold::kNone);
    if (is_last) jobs_.at(digit).turn = time_;
  }
  void ask_to_stop(char digit, JobState after_stop) {
    ModelJob& job = jobs_.at(digit);
    if (job.state == kRunning) ++time_;
    job.state = kStopping;
    job.after_stop = after_stop;
  }
  void cancel(char digit) {
    const JobState state = jobs_.at(digit).state;
    if (state == kQueued || state == kHeld) become(digit, kCancelled);
    if (state == kRunning || state == kStopping) ask_to_stop(digit, kCancelled);
  }
  void hold(char digit) {
    ModelJob& job = jobs_.at(digit);
    if (job.state == kQueued) become(digit, kHeld, Hold::kRequest);
    if (job.state == kHeld) job.hold = Hold::kRequest;
    settle_waits();
    const bool is_ending = job.after_stop == kCancelled || job.after_stop == kTimedOut;
    if (job.state == kRunning || (job.state == kStopping && !is_ending)) ask_to_stop(digit, kHeld);
  }
  void release(char digit, bool retry) {
    ModelJob& job = jobs_.at(digit);
    if (job.state == kHeld || (retry && has_no_result(job.state))) {
      if (job.hold == Hold::kOthers) job.waits = false;
      become(digit, kQueued);
    }
    if (job.state == kStopping && job.after_stop == kHeld) job.after_stop = kQueued;
    if (retry && job.state == kQueued) job.crashes = 0;
    settle_waits();
  }
  void release_sweep(int number) {
    for (const char digit : sweeps_.at(number).digits) release(digit, false);
    ModelSweep& sweep = sweeps_.at(number);
    if (sweep.stopped) sweep.has_rule = sweep.stopped = false;
  }
  void crash(char digit) {
    const ModelJob& job = jobs_.at(digit);
    if (job.state == kStopping) return stop(digit);
    const int crashes = job.crashes + 1;
    const bool is_too_often = crashes > static_cast<int>(kPauses.size());
    become(digit, is_too_often ? kFailed : kQueued);
    if (!is_too_often) jobs_.at(digit).crashes = crashes;
  }
  void find_no_room(char digit) {
    if (jobs_.at(digit).state == kStopping) return stop(digit);
    become(digit, kHeld, Hold::kRoom);
  }
  bool is_full(int number) const {
    const ModelSweep& sweep = sweeps_.at(number);
    const auto runs = std::count_if(jobs_.begin(), jobs_.end(), [&](const auto& entry) {
      return entry.second.sweep == number && (entry.second.state == kRunning || entry.second.state == kStopping);
    });
    return sweep.at_most > 0 && runs >= sweep.at_most;
  }
  bool waits_for_its_turn(char digit) const {
    const ModelJob& job = jobs_.at(digit);
    return job.state == kQueued && !job.waits && !waits_for_start(digit);
  }
  bool begins(char digit) const { return waits_for_its_turn(digit) && !is_full(jobs_.at(digit).sweep); }
  bool gives_way(char digit) const {
    const ModelJob& job = jobs_.at(digit);
    const auto n_stopping =
        std::count_if(jobs_.begin(), jobs_.end(), [](const auto& other) { return other.second.state == kStopping; });
    return job.state == kRunning &&
           n_stopping < std::count_if(
                            jobs_.begin(), jobs_.end(),
                            [&](const auto& other) {
                              return waits_for_its_turn(other.first) && other.second.priority >= job.priority &&
                                     (other.second.sweep == job.sweep || !is_full(other.second.sweep));
                            });
  }
  bool active(char digit) const {
    const auto job = jobs_.find(digit);
    return job != jobs_.end() && (job->second.state == kRunning || job->second.state == kStopping);
  }
  /// The order in which queued jobs start.
  std::string order() const {
    std::vector<std::pair<std::pair<int, int>, char>> waiting;
    for (const auto& [digit, job] : jobs_) {
      if (begins(digit)) waiting.push_back({{-job.priority, job.turn}, digit});
    }
    std::sort(waiting.begin(), waiting.end());
    std::string digits;
    for (const auto& entry : waiting) digits += entry.second;
    return digits;
  }

  std::map<char, ModelJob> jobs_;
  std::map<int, ModelSweep> sweeps_;
  int time_ = 0;
};

void apply(Operation operation, char digit, int priority, std::unique_ptr<Queue>& queue, Model& model,
           const std::filesystem::path& file) {
  const std::string id(16, digit);
  const bool known = model.jobs_.contains(digit);
  switch (operation) {
    case Operation::kSubmit:
    case Operation::kSubmitTwo:
    case Operation::kSubmitTwoOneAtOnce:
    case Operation::kSubmitTwoWithRule:
    case Operation::kSubmitAfter:
    case Operation::kSubmitWithResults: {
      ModelSweep sweep;
      sweep.digits = std::string(1, digit);
      sweep.has_results = operation == Operation::kSubmitWithResults;
      const char other = kDigits[(kDigits.find(digit) + 1) % kDigits.size()];
      if (operation != Operation::kSubmit && operation != Operation::kSubmitAfter && !sweep.has_results)
        sweep.digits += other;
      if (operation == Operation::kSubmitTwoOneAtOnce) sweep.at_most = 1;
      sweep.has_rule = operation == Operation::kSubmitTwoWithRule;
      if (operation == Operation::kSubmitAfter && model.jobs_.contains(other)) sweep.after = other;
      Terms terms{.at_most = sweep.at_most};
      if (sweep.after != 0) terms.after = {std::string(16, sweep.after)};
      if (sweep.has_rule) terms.stop_if = *StopRule::parse("failed>0");
      std::vector<NewJob> jobs;
      for (const char each : sweep.digits) {
        jobs.push_back(new_job(each));
        if (const char start = start_of(each); start != 0) jobs.back().starts_from = std::string(16, start);
        if (sweep.has_results) jobs.back().has_results = true;
      }
      bool refused = false;
      try {
        queue->submit("sweep", priority, jobs, terms);
      } catch (const Conflict&) {
        refused = true;
      }
      RC_ASSERT(refused == (sweep.after != 0 && model.is_circular(sweep.digits, sweep.after)));
      if (!refused) model.submit(sweep, priority);
      return;
    }
    case Operation::kGiveWay:
      if (!known) return;
      RC_ASSERT(queue->preempt(id) == model.gives_way(digit));
      if (model.gives_way(digit)) model.ask_to_stop(digit, kRunning);
      return;
    case Operation::kTimeOut:
      if (!known || model.jobs_[digit].state != kRunning) return;
      queue->time_out(id);
      model.ask_to_stop(digit, kTimedOut);
      return;
    case Operation::kBegin: {
      const auto attempt = begin(*queue, id);
      const bool begins = known && model.begins(digit);
      RC_ASSERT(attempt.has_value() == begins);
      if (!begins) return;
      model.jobs_[digit].state = kRunning;
      model.jobs_[digit].longer = false;
      ++model.time_;
      RC_ASSERT(*attempt == ++model.jobs_[digit].attempt);
      return;
    }
    case Operation::kDone:
    case Operation::kFail: {
      if (!model.active(digit)) return;
      const JobState end = operation == Operation::kDone ? kDone : kFailed;
      queue->ended(id, end == kDone ? JobEvent::kWorkerDone : JobEvent::kWorkerFailed);
      model.finish(digit, end);
      return;
    }
    case Operation::kStopped:
      if (!model.active(digit)) return;
      queue->ended(id, JobEvent::kWorkerStopped, "stopped");
      model.stop(digit);
      return;
    case Operation::kCancel:
      queue->cancel(id);
      if (known) model.cancel(digit);
      return;
    case Operation::kExtend: {
      const std::pair scene{id, "scene " + std::to_string(1 + priority) + " of " + id};
      const bool changes = known && model.extend(digit, 1 + priority);
      RC_ASSERT(queue->extend(std::span(&scene, 1)) == (changes ? 1 : 0));
      if (changes && model.jobs_[digit].state == kDone) model.become(digit, kQueued);
      return;
    }
    case Operation::kClean: {
      const bool has_ended = known && (model.jobs_[digit].state == kDone || has_no_result(model.jobs_[digit].state));
      RC_ASSERT(queue->clean(id, known ? model.jobs_[digit].state : kDone) == has_ended);
      if (has_ended) {
        model.jobs_[digit].attempt = 0;
        model.become(digit, kCancelled);
      }
      return;
    }
    case Operation::kHold:
      queue->hold(id);
      if (known) model.hold(digit);
      return;
    case Operation::kResume:
    case Operation::kRetry:
      operation == Operation::kRetry ? queue->retry(id) : queue->resume(id);
      if (known) model.release(digit, operation == Operation::kRetry);
      return;
    case Operation::kResumeSweep:
      if (!known) return;
      queue->resume(std::int64_t{model.jobs_[digit].sweep});
      model.release_sweep(model.jobs_[digit].sweep);
      return;
    case Operation::kWorkerCrashes:
      if (!model.active(digit)) return;
      queue->crashed(id, "crash", false, kPauses);
      model.crash(digit);
      return;
    case Operation::kNoRoom:
      if (!model.active(digit)) return;
      queue->no_room(id, "no room", 1000 * priority, std::chrono::milliseconds(0));
      model.find_no_room(digit);
      return;
    case Operation::kRoom:
      queue->release_for_room(1'000'000);
      for (auto& [each, job] : model.jobs_) {
        if (job.state == kHeld && job.hold == Hold::kRoom) model.become(each, kQueued);
      }
      model.settle_waits();
      return;
    case Operation::kStopAll:
      queue->stop_all();
      for (auto& [each, job] : model.jobs_) {
        if (job.state == kRunning) model.ask_to_stop(each, kQueued);
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
        if (job.state == kRunning || job.state == kStopping) model.stop(each);
      }
      return;
  }
}

/// Once everything is tried again, and everything that may start is done, every job is done or held with a reason.
void expect_an_end(Queue& queue) {
  constexpr int kRounds = 2 * static_cast<int>(kDigits.size());
  for (int round = 0; round < kRounds; ++round) {
    for (const Job& job : queue.active()) queue.ended(job.id, JobEvent::kWorkerStopped, "stopped");
    for (const Job& job : queue.jobs(std::nullopt)) {
      queue.retry(job.id);
      begin(queue, job.id);
    }
    for (const Job& job : queue.active()) queue.ended(job.id, JobEvent::kWorkerDone);
  }
  for (const Job& job : queue.jobs(std::nullopt)) {
    RC_ASSERT(job.state == kDone || (job.state == kHeld && !job.reason.empty()));
  }
}

using History = std::vector<std::tuple<Operation, char, int>>;  ///< what, to which job, with which priority

/// Whether the queue is as the model says after each operation, and its journal leads to that.
void compare(const History& history) {
  const ScratchFolder directory;
  const auto file = directory / "queue.db";
  auto queue = std::make_unique<Queue>(file);
  Model model;
  for (const auto& [operation, digit, priority] : history) {
    apply(operation, digit, priority, queue, model, file);

    std::map<std::string, std::pair<JobPhase, int>> stored;
    for (const Job& job : queue->jobs(std::nullopt)) stored[job.id] = {job.phase, job.attempt};
    std::map<std::string, std::pair<JobPhase, int>> expected;
    for (const auto& [each, job] : model.jobs_) expected[std::string(16, each)] = {phase_of(job), job.attempt};
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
      // one that is extended stays what it is
      RC_ASSERT(change.from == change.to || may_become(*job_state(change.from), *job_state(change.to)));
    }
    replayed[change.job] = *job_state(change.to);
  }
  for (const Job& job : queue->jobs(std::nullopt)) RC_ASSERT(replayed.at(job.id) == job.state);
  expect_an_end(*queue);
}

/// In memory, where there is a folder for that: hundreds of queues, none of which is to outlast a loss of power.
class QueueModelTest : public testing::Test {
 protected:
  QueueModelTest() {
    if (access("/dev/shm", W_OK) == 0) setenv("TMPDIR", "/dev/shm", 1);
  }
  ~QueueModelTest() override { before_.empty() ? unsetenv("TMPDIR") : setenv("TMPDIR", before_.c_str(), 1); }

 private:
  std::string before_ = std::getenv("TMPDIR") != nullptr ? std::getenv("TMPDIR") : "";
};

TEST_F(QueueModelTest, EveryHistoryEndsAsTheModelSays) {
  EXPECT_TRUE(rc::check("queue", [] {
    const auto steps = *rc::gen::container<std::vector<std::tuple<int, int, int>>>(
        rc::gen::tuple(rc::gen::inRange(0, kOperations), rc::gen::inRange(0, static_cast<int>(kDigits.size())),
                       rc::gen::inRange(0, 3)));
    History history;
    for (const auto& [operation, digit, priority] : steps) {
      history.emplace_back(static_cast<Operation>(operation), kDigits[static_cast<std::size_t>(digit)], priority);
    }
    compare(history);
  }));
}

// Random histories seldom do something rare to a job that has come to a rare place.
TEST_F(QueueModelTest, EveryOperationInEveryPhaseDoesWhatTheModelSays) {
  using enum Operation;
  const std::vector<std::vector<std::pair<Operation, char>>> ways{
      {{kSubmit, 'a'}},
      {{kSubmit, 'a'}, {kHold, 'a'}},
      {{kSubmit, 'a'}, {kBegin, 'a'}, {kNoRoom, 'a'}},
      {{kSubmit, 'b'}, {kSubmitAfter, 'a'}, {kCancel, 'b'}},
      // the second stage of a chain: waiting, held for the first, cancelled, held while the first is done and cleaned
      {{kSubmitTwo, 'b'}, {kSubmit, 'c'}},
      {{kSubmitTwo, 'b'}, {kCancel, 'b'}, {kResume, 'c'}},
      {{kSubmitTwo, 'b'}, {kCancel, 'c'}, {kBegin, 'b'}, {Operation::kDone, 'b'}, {kRetry, 'c'}},
      {{kSubmitTwo, 'b'}, {kHold, 'c'}, {kBegin, 'b'}, {Operation::kDone, 'b'}, {kClean, 'b'}, {kResume, 'c'}},
      {{kSubmitTwoWithRule, 'a'}, {kBegin, 'b'}, {kFail, 'b'}},
      {{kSubmit, 'a'}, {kBegin, 'a'}},
      {{kSubmit, 'a'}, {kBegin, 'a'}, {kStopAll, 'a'}},
      {{kSubmit, 'a'}, {kBegin, 'a'}, {kSubmit, 'b'}, {kGiveWay, 'a'}},
      {{kSubmit, 'a'}, {kBegin, 'a'}, {kCancel, 'a'}},
      // asked for again, when its worker may have done what it was asked for before
      {{kSubmit, 'a'}, {kBegin, 'a'}, {kCancel, 'a'}, {kSubmit, 'a'}},
      {{kSubmit, 'a'}, {kBegin, 'a'}, {kHold, 'a'}},
      {{kSubmit, 'a'}, {kBegin, 'a'}, {kTimeOut, 'a'}},
      {{kSubmit, 'a'}, {kBegin, 'a'}, {Operation::kDone, 'a'}},
      {{kSubmit, 'a'}, {kBegin, 'a'}, {kFail, 'a'}},
      {{kSubmit, 'a'}, {kBegin, 'a'}, {kTimeOut, 'a'}, {kStopped, 'a'}},
      {{kSubmit, 'a'}, {kCancel, 'a'}},
      // running, with no crash forgiven any more
      {{kSubmit, 'a'}, {kBegin, 'a'}, {kWorkerCrashes, 'a'}, {kBegin, 'a'}, {kWorkerCrashes, 'a'}, {kBegin, 'a'}}};
  for (std::size_t phase = 0; phase < ways.size(); ++phase) {
    History history;
    for (const auto& [operation, digit] : ways[phase]) history.emplace_back(operation, digit, 1);
    for (int last = 0; last < kOperations; ++last) {
      History whole = history;
      whole.emplace_back(static_cast<Operation>(last), std::get<char>(history.back()), 1);
      EXPECT_NO_THROW(compare(whole)) << "operation " << last << " in phase " << phase;
    }
  }
}

}  // namespace
}  // namespace shaken::server
