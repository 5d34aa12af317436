// Supervisor and local executor with real processes: a script that behaves as its job's label says.
#include "server/supervisor.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <limits>

#include "base/clock.h"
#include "server/local_executor.h"
#include "server/submission.h"
#include "tests/support/good.h"
#include "tests/unit/server/server_support.h"

namespace shaken::server {
namespace {

using enum JobState;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

constexpr std::chrono::milliseconds kGrace{300};

class SupervisorTest : public testing::Test {
 protected:
  ~SupervisorTest() override {
    supervisor_.shut_down();
    supervisor_.kill_all();
    EXPECT_TRUE(step_until([&] { return supervisor_.idle(); }));
  }

  SupervisorOptions options() const {
    SupervisorOptions options{directory_ / "runs", 2, {"--no-lcm"}, kGrace};
    options.counting = std::chrono::milliseconds(20);
    options.retry_pauses = {std::chrono::milliseconds(400), std::chrono::milliseconds(100)};
    options.confirm_within = std::chrono::milliseconds(200);
    options.waiting_pause = std::chrono::milliseconds(50);
    return options;
  }
  static std::string id(char digit) { return std::string(16, digit); }
  Job job(char digit) const { return *queue_.job(id(digit)); }
  std::filesystem::path directory(char digit) const { return directory_ / "runs" / id(digit); }
  void submit(char digit, const std::string& label) { queue_.submit(label, 0, std::vector{new_job(digit, label)}); }
  static bool step_until(Supervisor& supervisor, const std::function<bool()>& condition) {
    return eventually([&] {
      supervisor.step();
      return condition();
    });
  }
  bool step_until(Supervisor& supervisor, char digit, JobState state) const {
    return step_until(supervisor, [&] { return job(digit).state == state; });
  }
  bool step_until(const std::function<bool()>& condition) { return step_until(supervisor_, condition); }
  bool step_until(char digit, JobState state) { return step_until(supervisor_, digit, state); }
  /// Runs until the worker listens to signals.
  bool step_until_up(char digit) {
    return step_until([&] { return std::filesystem::exists(directory(digit) / "up"); });
  }

  ScratchFolder directory_;
  Queue queue_{directory_ / "queue.db"};
  LocalExecutor executor_{write_fake_worker(directory_.path())};
  Supervisor supervisor_{queue_, executor_, options()};
};

/// Takes every worker and says of each what `report` is.
class ToldExecutor final : public Executor {
 public:
  Result<int> start(const Launch&) override { return ++last_; }
  WorkerReport poll(int) override { return report; }
  void stop(int) override {}
  void kill(int) override {}
  int room() const override { return own_trouble.empty() ? 100 : 0; }
  std::string trouble() const override { return own_trouble; }
  std::string name(int worker) const override { return "worker " + std::to_string(worker); }

  WorkerReport report;
  std::string own_trouble;

 private:
  int last_ = 0;
};

class RefusedTest : public SupervisorTest {
 protected:
  RefusedTest() { told_.report = refusal_; }
  void step() {
    for (int i = 0; i < 5; ++i) its_supervisor_.step();
  }

  const WorkerReport refusal_{.phase = WorkerReport::Phase::kRefused, .words = "no such partition"};
  ToldExecutor told_;
  Supervisor its_supervisor_{queue_, told_, options()};
};

TEST_F(RefusedTest, WhatIsRefusedIsTriedAgainMoreAndMoreRarely) {
  SupervisorOptions patient = options();
  patient.refused_pause = std::chrono::milliseconds(20);
  Supervisor supervisor(queue_, told_, patient);
  submit('a', "done");
  Job now;
  const auto refused_again = [&] {
    const int before = now.attempt;
    return eventually([&] {
      supervisor.step();
      now = job('a');
      return now.attempt > before && now.not_before > 0;
    });
  };
  while (now.attempt < 6) {
    ASSERT_TRUE(refused_again());
    const int doublings = std::min(4, now.attempt - 1);  // on a slow machine an attempt may pass unseen
    EXPECT_EQ(now.state, kQueued);
    EXPECT_THAT(now.reason, StartsWith("could not be started: no such partition. Next attempt at "));
    const auto pause = now.not_before - queue_.history(id('a')).back().utime;
    EXPECT_GE(pause, 20'000 << doublings);
    EXPECT_LT(pause, 40'000 << doublings);
  }
  // once it is taken, the next refusal is the first
  told_.report = {};
  ASSERT_TRUE(step_until(supervisor, [&] { return job('a').state == kRunning && job('a').reason.empty(); }));
  supervisor.step();
  told_.report = refusal_;
  const int accepted = job('a').attempt;
  now.attempt = 0;
  ASSERT_TRUE(refused_again());
  EXPECT_LT(now.not_before - queue_.history(id('a')).back().utime, 40'000 << (now.attempt - accepted));
}

// Whoever has mended the options need not wait for what those before have cost.
TEST_F(RefusedTest, ARefusalHoldsForAllThatAsksForTheSameAndForNothingElse) {
  const auto submit = [&](const std::string& name, std::vector<NewJob> jobs, const std::string& settings) {
    queue_.submit(name, 0, jobs, {.settings = settings});
  };
  submit("first", {new_job('a'), new_job('b'), new_job('c')}, "wrong");
  step();
  for (const char digit : {'a', 'b'}) EXPECT_EQ(job(digit).attempt, 1) << digit;
  EXPECT_EQ(job('c').attempt, 0) << "it would be refused like those before";
  EXPECT_EQ(job('c').state, kQueued);
  EXPECT_THAT(job('c').reason, StartsWith("could not be started: no such partition. Next attempt at "));
  EXPECT_THAT(job('c').reason, EndsWith(", or at once after `shaken retry s1`"));
  EXPECT_GT(job('c').not_before, 0);

  submit("second", {new_job('d')}, "wrong");
  step();
  EXPECT_EQ(job('d').attempt, 0);
  told_.report = {};
  submit("third", {new_job('e')}, "right");
  step();
  EXPECT_EQ(job('e').state, kRunning);
  submit("first", {new_job('a'), new_job('b'), new_job('c')}, "right");
  step();
  EXPECT_EQ(job('a').state, kRunning) << "the same jobs, asked for anew with other options";
  EXPECT_EQ(job('d').state, kQueued);
  EXPECT_EQ(queue_.retry(id('e')), 0) << "nothing keeps it";
}

TEST_F(SupervisorTest, WhatWaitsForAnExecutorInTroubleSaysSo) {
  ToldExecutor executor;
  executor.own_trouble = "Slurm does not answer";
  Supervisor supervisor(queue_, executor, options());
  for (const char digit : {'a', 'c', 'd'}) submit(digit, "done");
  queue_.submit("elsewhere", 0, std::vector{new_job('b')}, {.executor = std::string(kSlurm)});
  supervisor.step();
  EXPECT_EQ(job('a').reason, "Slurm does not answer");
  EXPECT_EQ(job('b').reason, "") << "that goes to another";
  executor.own_trouble.clear();
  supervisor.step();
  EXPECT_EQ(job('a').state, kRunning);
  EXPECT_EQ(job('d').state, kQueued) << "there are two slots";
  for (const char digit : {'a', 'd'}) EXPECT_EQ(job(digit).reason, "") << digit;
}

TEST_F(RefusedTest, ARetryEndsThePauseAfterARefusal) {
  submit('a', "done");
  step();
  EXPECT_EQ(job('a').attempt, 1);
  told_.report = {};
  EXPECT_EQ(queue_.resume(id('a')), 0) << "only a retry does";
  EXPECT_EQ(queue_.retry(id('a')), 1);
  EXPECT_EQ(job('a').reason, "");
  its_supervisor_.step();
  EXPECT_EQ(job('a').state, kRunning);
}

TEST_F(SupervisorTest, AJobIsDoneByAWorkerInItsDirectory) {
  submit('a', "done");
  ASSERT_TRUE(step_until('a', kDone));
  EXPECT_EQ(read_text(directory('a') / "scene.json"), queue_.scene(id('a')));
  const std::string log = read_text(directory('a') / "worker.log");
  EXPECT_THAT(log, StartsWith("--- shakend: attempt 1, 20"));
  const std::string folder = directory('a').string();
  EXPECT_THAT(log, EndsWith("\n" + folder + "/scene.json --out " + folder + " --job-id " + id('a') +
                            " --sweep-id s1 --label done --no-lcm\n"));
}

TEST_F(SupervisorTest, AFailureCarriesTheWordsOfTheWorkerOrOfItsEnd) {
  struct Row {
    const char* label;
    const char* reason;
    int attempts;
  };
  constexpr int kAsPauses = 3;  // as many pauses and one
  // A cluster's time limit may be so short that each task is told to end as soon as it begins.
  const std::vector<Row> rows{{"fail", "exit 1: the gap is closed", 1},
                              {"progress", "exit 1: rod 3 is not finite", 1},
                              {"bad", "exit 2 (bad input)", 1},
                              {"empty", "summary.json", kAsPauses},
                              {"stops at once", "before it got any further", kAsPauses}};
  char digit = 'a';
  for (const Row& row : rows) submit(digit++, row.label);
  digit = 'a';
  for (const Row& row : rows) {
    ASSERT_TRUE(step_until(digit, kFailed)) << row.label;
    EXPECT_THAT(job(digit).reason, HasSubstr(row.reason)) << row.label;
    EXPECT_EQ(job(digit++).attempt, row.attempts) << row.label;
  }
}

// As on a network's disk, where a file may be seen some seconds after another machine wrote it, or where reading fails
// for a moment.
TEST_F(SupervisorTest, ASummaryThatIsSeenLateIsLookedForAgain) {
  ToldExecutor executor;
  executor.report = {.phase = WorkerReport::Phase::kEnded, .end = {0, 0, 77}};
  Supervisor supervisor(queue_, executor, options());
  submit('a', "done");
  for (int i = 0; i < 5; ++i) supervisor.step();
  EXPECT_EQ(job('a').state, kRunning) << "what cannot be read does not say that it is not done";
  write_text(directory('a') / "summary.json", R"({"run_id": ")" + id('a') + R"(", "exit": {"state": "done"}})");
  EXPECT_TRUE(step_until(supervisor, 'a', kDone));
  EXPECT_EQ(job('a').attempt, 1);

  // later than that it goes back into the queue, where the next worker finds that it is done
  submit('b', "done");
  EXPECT_TRUE(step_until(supervisor, [&] { return job('b').state == kQueued && job('b').attempt == 1; }));
  write_text(directory('b') / "summary.json", R"({"run_id": ")" + id('b') + R"(", "exit": {"state": "done"}})");
  EXPECT_TRUE(step_until(supervisor, 'b', kDone));
}

TEST_F(SupervisorTest, WhatCannotStartHoldsUpNoOthersHoweverMuchOfItThereIs) {
  std::filesystem::create_directories(directory_ / "runs");
  SupervisorOptions options = this->options();
  options.waiting_pause = std::chrono::seconds(60);
  Supervisor supervisor(queue_, executor_, options);
  for (char digit = 'A'; digit <= 'Z'; ++digit) {  // more than are looked at in a round
    write_text(directory(digit), "a file where the folder should be");
    submit(digit, "done");
  }
  submit('a', "done");
  EXPECT_TRUE(step_until(supervisor, 'a', kDone));
  EXPECT_EQ(job('Z').state, kQueued);
  EXPECT_THAT(job('Z').reason, HasSubstr(id('Z')));
  EXPECT_TRUE(step_until(supervisor, [&] { return supervisor.idle(); }));
}

TEST_F(SupervisorTest, WhatCannotStartIsLookedAtMoreAndMoreRarely) {
  std::filesystem::create_directories(directory_ / "runs");
  SupervisorOptions options = this->options();
  options.waiting_pause = std::chrono::milliseconds(20);
  Supervisor supervisor(queue_, executor_, options);
  write_text(directory('a'), "a file where the folder should be");
  submit('a', "done");
  std::int64_t before = 0;
  const auto next_pause = [&] {  // [us]
    std::int64_t until = before, asked = 0;
    EXPECT_TRUE(eventually([&] {
      asked = utime_now();
      supervisor.step();
      until = job('a').not_before;
      return until > before;
    }));
    before = until;
    return until - asked;
  };
  for (const int doublings : {0, 1, 2, 3, 4, 4}) EXPECT_GE(next_pause(), 20'000 << doublings);
  std::filesystem::remove(directory('a'));
  EXPECT_TRUE(step_until(supervisor, 'a', kDone));
}

TEST_F(SupervisorTest, WhatIsStoppedFurtherOnEachTimeGoesOn) {
  submit('a', "stops further on");
  EXPECT_TRUE(step_until([&] { return job('a').attempt > 5; }));
  EXPECT_NE(job('a').state, kFailed);
}

TEST_F(SupervisorTest, AWorkerThatCrashesIsTriedAgainAfterPausesAndTheOthersGoOn) {
  submit('a', "crash");
  submit('b', "done");
  submit('c', "done");
  EXPECT_TRUE(step_until('b', kDone));
  EXPECT_TRUE(step_until('c', kDone));
  ASSERT_TRUE(step_until([&] { return job('a').attempt == 1 && job('a').state == kQueued; }));
  EXPECT_EQ(job('a').reason, "worker was killed by signal 9 (SIGKILL); is tried again after 0.4 s");
  EXPECT_GT(job('a').not_before, 0);
  ASSERT_TRUE(step_until('a', kFailed));
  EXPECT_EQ(job('a').attempt, 3) << "as many pauses and one";
  EXPECT_EQ(job('a').reason, "3 times in a row, without a checkpoint between: worker was killed by signal 9 (SIGKILL)");
  std::vector<std::string> causes;
  for (const Change& change : queue_.history(id('a'))) causes.push_back(change.cause);
  EXPECT_EQ(std::count(causes.begin(), causes.end(), "worker was killed by signal 9 (SIGKILL)"), 3);
}

TEST_F(SupervisorTest, ACheckpointBetweenCrashesBeginsTheirCountAnew) {
  submit('a', "crash after checkpoint");
  ASSERT_TRUE(step_until([&] { return job('a').attempt == 5; }));
  EXPECT_NE(job('a').state, kFailed);
}

TEST_F(SupervisorTest, WithoutRoomAJobIsHeldUntilThereIs) {
  submit('a', "room");
  ASSERT_TRUE(step_until('a', kHeld));
  EXPECT_THAT(job('a').reason, StartsWith("checkpoint.bin.tmp: No space left on device. Goes on by itself once "));
  EXPECT_EQ(job('a').phase, JobPhase::kHeldForRoom);
  EXPECT_TRUE(step_until([&] { return job('a').attempt == 2; })) << "this disk has room";
}

TEST_F(SupervisorTest, NothingIsStartedOnADiskThatIsNearlyFull) {
  SupervisorOptions options = this->options();
  options.least_room = std::numeric_limits<std::int64_t>::max();
  Supervisor supervisor(queue_, executor_, options);
  std::filesystem::create_directories(directory_ / "runs");
  submit('a', "done");
  for (int i = 0; i < 5; ++i) supervisor.step();
  EXPECT_EQ(job('a').state, kQueued);
  EXPECT_EQ(job('a').attempt, 0);
  EXPECT_THAT(job('a').reason, HasSubstr("are free in "));
}

TEST_F(SupervisorTest, HoldingLetsTheWorkerStopAndReleasingGoesOn) {
  submit('a', "run");
  ASSERT_TRUE(step_until_up('a'));
  EXPECT_EQ(queue_.hold(id('a')), 1);
  EXPECT_EQ(queue_.hold(id('a')), 0);
  ASSERT_TRUE(step_until('a', kHeld));
  EXPECT_EQ(job('a').reason, "held on request");
  for (int i = 0; i < 5; ++i) supervisor_.step();
  EXPECT_EQ(job('a').state, kHeld) << "room does not release it";
  std::filesystem::remove(directory('a') / "up");
  EXPECT_EQ(queue_.resume(id('a')), 1);
  EXPECT_TRUE(step_until_up('a'));
}

TEST_F(SupervisorTest, ASceneOfAnotherRunIsNotRun) {
  SupervisorOptions options = this->options();
  options.refuse = refuse_scene;
  Supervisor supervisor(queue_, executor_, options);
  NewJob changed = new_job('a');
  changed.scene = R"({"rods": {"count": 10}, "box": {"side": 20}})";
  queue_.submit("sweep", 0, {&changed, 1});
  supervisor.step();
  EXPECT_EQ(job('a').state, kFailed);
  EXPECT_THAT(job('a').reason, HasSubstr("not the one of this id"));
  EXPECT_FALSE(std::filesystem::exists(directory('a') / "scene.json"));
}

TEST_F(SupervisorTest, NoMoreWorkersThanSlots) {
  for (const char digit : {'a', 'b', 'c'}) submit(digit, "run");
  ASSERT_TRUE(step_until_up('a'));
  ASSERT_TRUE(step_until_up('b'));
  EXPECT_EQ(queue_.counts()[kRunning], 2);
  EXPECT_EQ(job('c').state, kQueued);
  queue_.cancel(id('a'));
  EXPECT_TRUE(step_until_up('c'));
  EXPECT_EQ(job('a').state, kCancelled);
}

TEST_F(SupervisorTest, WhatKeepsAStoppingJobIsItsReason) {
  ToldExecutor executor;
  executor.report = {.phase = WorkerReport::Phase::kWaiting, .words = "waits"};
  Supervisor supervisor(queue_, executor, options());
  submit('a', "run");
  supervisor.step();
  supervisor.step();
  EXPECT_EQ(job('a').reason, "waits");
  queue_.cancel(id('a'));
  supervisor.step();
  supervisor.step();
  EXPECT_EQ(job('a').state, kStopping);
  EXPECT_EQ(job('a').reason, "waits") << "still";
  executor.report.words = "Slurm does not answer";
  supervisor.step();
  EXPECT_EQ(job('a').reason, "Slurm does not answer");
  executor.report = {.phase = WorkerReport::Phase::kRevoked, .words = "CANCELLED"};
  supervisor.step();
  EXPECT_EQ(job('a').state, kCancelled);
  EXPECT_EQ(job('a').reason, "cancelled on request");
}

TEST_F(SupervisorTest, CancelLetsTheWorkerStopByItself) {
  submit('a', "run");
  ASSERT_TRUE(step_until_up('a'));
  EXPECT_EQ(kill(job('a').pid, 0), 0);
  queue_.cancel(id('a'));
  ASSERT_TRUE(step_until('a', kCancelled));
  EXPECT_EQ(queue_.changes_since(0, 100).back().cause, "the worker has stopped at a checkpoint");
}

TEST_F(SupervisorTest, AWorkerThatFinishesAfterTheCancelIsDone) {
  submit('a', "late");
  ASSERT_TRUE(step_until_up('a'));
  queue_.cancel(id('a'));
  EXPECT_TRUE(step_until('a', kDone));
}

TEST_F(SupervisorTest, ADeafWorkerIsKilledAfterTheGrace) {
  submit('a', "deaf");
  ASSERT_TRUE(step_until_up('a'));
  const auto asked = std::chrono::steady_clock::now();
  queue_.cancel(id('a'));
  ASSERT_TRUE(step_until('a', kCancelled));
  EXPECT_GE(std::chrono::steady_clock::now() - asked, kGrace);
  EXPECT_THAT(queue_.changes_since(0, 100).back().cause, HasSubstr("SIGKILL"));
}

TEST_F(SupervisorTest, ARunGivesWayOnceItsSoftLimitIsOver) {
  SupervisorOptions one = options();
  one.slots = 1;
  Supervisor supervisor(queue_, executor_, one);
  queue_.submit("long", 0, std::vector{new_job('a', "run")}, {.soft_limit = std::chrono::milliseconds(1)});
  ASSERT_TRUE(step_until(supervisor, [&] { return std::filesystem::exists(directory('a') / "up"); }));
  for (int i = 0; i < 5; ++i) supervisor.step();
  EXPECT_EQ(job('a').state, kRunning) << "nobody waits";
  submit('b', "done");
  ASSERT_TRUE(step_until(supervisor, [&] { return job('b').state == kDone && job('a').state == kRunning; }));
  EXPECT_EQ(job('a').attempt, 2);
  EXPECT_GT(job('a').wall.count(), 0) << "the first attempt has been counted";
  supervisor.shut_down();
  ASSERT_TRUE(step_until(supervisor, [&] { return supervisor.idle(); }));
}

TEST_F(SupervisorTest, NobodyGivesWayToWhatFindsAFreeSlot) {
  queue_.submit("long", 0, std::vector{new_job('a', "run")}, {.soft_limit = std::chrono::milliseconds(1)});
  ASSERT_TRUE(step_until_up('a'));
  submit('b', "run");  // the second of two slots
  ASSERT_TRUE(step_until_up('b'));
  for (int i = 0; i < 5; ++i) supervisor_.step();
  EXPECT_EQ(job('a').state, kRunning);
  EXPECT_EQ(job('a').attempt, 1);
}

TEST_F(SupervisorTest, ARunIsTimedOutAfterAllItsAttemptsTogether) {
  queue_.submit("long", 0, std::vector{new_job('a', "run")}, {.time_limit = std::chrono::milliseconds(1500)});
  ASSERT_TRUE(step_until_up('a'));
  std::filesystem::remove(directory('a') / "up");
  kill(job('a').pid, SIGTERM);
  ASSERT_TRUE(step_until([&] { return job('a').attempt == 2; }));
  const auto first = job('a').wall;
  EXPECT_GT(first.count(), 0);
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_TRUE(step_until('a', kTimedOut));
  EXPECT_GE(first + (std::chrono::steady_clock::now() - begin) + kGrace, std::chrono::milliseconds(1500));
  EXPECT_GE(job('a').wall, std::chrono::milliseconds(1500));
  EXPECT_EQ(job('a').attempt, 2);
  EXPECT_THAT(job('a').reason, HasSubstr("its time limit"));
}

TEST_F(SupervisorTest, TimeThatIsNotWrittenDownYetCountsToo) {
  SupervisorOptions seldom = options();
  seldom.counting = std::chrono::hours(1);
  ToldExecutor executor;
  Supervisor supervisor(queue_, executor, seldom);
  queue_.submit("long", 0, std::vector{new_job('a')}, {.time_limit = std::chrono::milliseconds(100)});
  EXPECT_TRUE(step_until(supervisor, 'a', kStopping));
}

TEST_F(SupervisorTest, ADeafWorkerBeyondItsTimeLimitIsKilled) {
  submit('a', "deaf");
  ASSERT_TRUE(step_until_up('a'));
  queue_.submit("deaf", 0, std::vector{new_job('a', "deaf")}, {.time_limit = std::chrono::milliseconds(1)});
  ASSERT_TRUE(step_until('a', kTimedOut));
  EXPECT_THAT(queue_.history(id('a')).back().cause, HasSubstr("SIGKILL"));
}

TEST_F(SupervisorTest, WhatHasHadItsTimeIsNotStarted) {
  queue_.submit("late", 0, std::vector{new_job('a', "run")}, {.time_limit = std::chrono::milliseconds(1500)});
  queue_.add_wall(std::vector{std::pair(id('a'), std::chrono::milliseconds(1500))});  // before a kill of the daemon
  supervisor_.step();
  EXPECT_EQ(job('a').state, kTimedOut);
  EXPECT_EQ(job('a').attempt, 0);
}

TEST_F(SupervisorTest, AWorkerStoppedBySomebodyElseIsStartedAgain) {
  submit('a', "run");
  ASSERT_TRUE(step_until_up('a'));
  std::filesystem::remove(directory('a') / "up");
  kill(job('a').pid, SIGTERM);
  ASSERT_TRUE(step_until_up('a'));
  EXPECT_EQ(job('a').attempt, 2);
  EXPECT_THAT(read_text(directory('a') / "worker.log"), HasSubstr("attempt 2"));
}

TEST_F(SupervisorTest, ShutDownQueuesWhatRunsAndStartsNothing) {
  submit('a', "run");
  submit('b', "done");
  ASSERT_TRUE(step_until_up('a'));
  ASSERT_TRUE(step_until('b', kDone));
  supervisor_.shut_down();
  submit('c', "done");
  ASSERT_TRUE(step_until([&] { return supervisor_.idle(); }));
  EXPECT_EQ(job('a').state, kQueued);
  EXPECT_EQ(job('c').state, kQueued);
}

TEST_F(SupervisorTest, ADirectoryInUseIsWaitedForWhileOthersRun) {
  submit('a', "done");
  std::filesystem::create_directories(directory('a'));
  {
    const auto held = test::good(run::DirectoryLock::acquire(directory('a') / "lock"));
    submit('b', "done");
    ASSERT_TRUE(step_until('b', kDone));
    EXPECT_EQ(job('a').state, kQueued);
    EXPECT_EQ(job('a').attempt, 0);
    EXPECT_THAT(job('a').reason, HasSubstr("in use by process"));
  }
  EXPECT_TRUE(step_until('a', kDone));
}

TEST_F(SupervisorTest, ADiskThatRefusesLeavesTheJobQueued) {
  write_text(directory_ / "runs", "a file where the folder should be");
  submit('a', "done");
  for (int i = 0; i < 5; ++i) supervisor_.step();
  EXPECT_EQ(job('a').state, kQueued);
  std::filesystem::remove(directory_ / "runs");
  EXPECT_TRUE(step_until('a', kDone));
}

TEST_F(SupervisorTest, AProgramThatIsAwayCostsNoJob) {
  LocalExecutor away(directory_ / "away");
  SupervisorOptions options = this->options();
  options.first_pause = std::chrono::seconds(2);  // longer than 50 steps take, however slow the machine
  Supervisor supervisor(queue_, away, options);
  for (const char digit : {'a', 'b', 'c', 'd'}) submit(digit, "done");
  for (int i = 0; i < 50; ++i) supervisor.step();
  EXPECT_EQ(queue_.counts()[kQueued], 4);
  EXPECT_EQ(job('a').attempt, 1) << "the next start waits";
  EXPECT_EQ(job('b').attempt, 0);
  EXPECT_THAT(job('a').reason, HasSubstr("away cannot be run: No such file"));
  std::filesystem::copy_file(write_fake_worker(directory_.path()), directory_ / "away");
  EXPECT_TRUE(step_until(supervisor, [&] { return queue_.counts()[kDone] == 4; }));
}

class LocalExecutorTest : public testing::Test {
 protected:
  ScratchFolder directory_;
};

TEST_F(LocalExecutorTest, AWorkerInheritsNoDescriptorsAndNoBlockedSignals) {
  write_text(directory_ / "look", "#!/bin/sh\nls /proc/$$/fd\ngrep SigBlk /proc/self/status\n");
  std::filesystem::permissions(directory_ / "look", std::filesystem::perms::owner_all);
  const int leak = open("/dev/null", O_RDONLY);  // without close-on-exec
  ASSERT_GE(leak, 3);
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, &before);
  LocalExecutor executor(directory_ / "look");
  const auto pid = executor.start({directory_.path(), {}, "heading"});
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  close(leak);
  ASSERT_TRUE(pid);
  WorkerReport report;
  ASSERT_TRUE(eventually([&] { return (report = executor.poll(*pid)).phase == WorkerReport::Phase::kEnded; }));
  EXPECT_EQ(report.end.exit_code, 0);
  // 10 is the script itself, as dash opens it.
  EXPECT_EQ(read_text(directory_ / "worker.log"), "heading\n0\n1\n10\n2\nSigBlk:\t0000000000000000\n");
}

// Whoever opens a pipe waits for its other end, which may never come.
TEST_F(LocalExecutorTest, APipeInPlaceOfTheLogIsRefused) {
  ASSERT_EQ(mkfifo((directory_ / "worker.log").c_str(), 0600), 0);
  LocalExecutor executor("/bin/true");
  EXPECT_FALSE(executor.start({directory_.path(), {}, "heading"}));
  const int reader = open((directory_ / "worker.log").c_str(), O_RDONLY | O_NONBLOCK);
  const auto refused = executor.start({directory_.path(), {}, "heading"});
  close(reader);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, EndsWith("worker.log is no regular file"));
}

TEST_F(LocalExecutorTest, WhatAWorkerHasStartedEndsWithIt) {
  write_text(directory_ / "parent", "#!/bin/sh\nsleep 1000 & echo $! >\"$1\"\n");
  std::filesystem::permissions(directory_ / "parent", std::filesystem::perms::owner_all);
  LocalExecutor executor(directory_ / "parent");
  const auto pid = test::good(executor.start({directory_.path(), {directory_ / "child"}, "heading"}));
  ASSERT_TRUE(eventually([&] { return executor.poll(*pid).phase == WorkerReport::Phase::kEnded; }));
  const int child = std::stoi(read_text(directory_ / "child"));
  EXPECT_TRUE(eventually([&] {
    // Gone, or a zombie that waits for a parent to look at it.
    return kill(child, 0) != 0 ||
           read_text("/proc/" + std::to_string(child) + "/stat").find(") Z") != std::string::npos;
  }));
}

}  // namespace
}  // namespace shaken::server
