// The executor with stand-ins for Slurm's programs, which do as files beside them say. The real Slurm: tests/cluster.
#include "server/slurm/slurm_executor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <thread>

#include "base/process.h"
#include "base/slurm_conf.h"
#include "server/slurm/batch.h"
#include "server/slurm/slurm_call.h"
#include "server/slurm/squeue.h"
#include "tests/support/good.h"
#include "tests/unit/server/server_support.h"

namespace shaken::server::slurm {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::StartsWith;
using Phase = WorkerReport::Phase;

class SlurmExecutorTest : public testing::Test {
 protected:
  SlurmExecutorTest() {
    const char* path = std::getenv("PATH");
    path_ = path != nullptr ? path : "";
    const std::string here = directory_.path().string();
    // each writes down how it was called; the answer of sbatch and the list of squeue are files
    for (const char* name : {"sbatch", "squeue", "scancel"}) {
      const auto file = directory_ / name;
      write_text(file, "#!/bin/sh\nfor word in \"$@\"; do printf '<%s>' \"$word\"; done >> '" + here + "/" + name +
                           ".calls'\necho >> '" + here + "/" + name + ".calls'\n[ ! -e '" + here +
                           "/down' ] || { echo 'Unable to contact slurm controller' >&2; exit 1; }\ncat '" + here +
                           "/" + name + ".says' 2>/dev/null || true\n[ ! -e '" + here + "/" + name + ".fails' ]\n");
      std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    }
    setenv("PATH", (here + ":" + path_).c_str(), 1);
    says("sbatch", "sbatch: a warning\n7\n");
  }
  ~SlurmExecutorTest() override { setenv("PATH", path_.c_str(), 1); }

  SlurmOptions options() const {
    SlurmOptions options;
    options.folder = directory_ / "slurm";
    options.worker = "/bin/worker";
    options.task = "/bin/it's a task";
    options.max_pending = 2;
    options.runs_per_task = 2;
    options.options = {"--qos=low"};
    options.poll = milliseconds(20);
    options.longest_pause = milliseconds(160);
    options.report_delay = milliseconds(0);
    return options;
  }
  void says(const std::string& program, const std::string& text) { write_text(directory_ / (program + ".says"), text); }
  /// A call counts when its line is whole: the program may be writing.
  std::vector<std::string> calls(const std::string& program) const {
    std::vector<std::string> lines;
    std::istringstream text(read_text(directory_ / (program + ".calls")));
    for (std::string line; std::getline(text, line) && !text.eof();) lines.push_back(line);
    return lines;
  }
  bool step_until(SlurmExecutor& executor, const std::function<bool()>& condition) {
    return eventually([&] {
      executor.step();
      return condition();
    });
  }
  /// Steps until that is what the executor says of a worker.
  bool step_until_says(SlurmExecutor& executor, int worker, const std::string& words) {
    return step_until(executor, [&] { return executor.poll(worker).words == words; });
  }
  /// Steps until a worker has ended, and says how.
  WorkerReport end_of(SlurmExecutor& executor, int worker) {
    WorkerReport end;
    EXPECT_TRUE(step_until(executor, [&] {
      end = executor.poll(worker);
      return end.phase != Phase::kWaiting && end.phase != Phase::kWorking;
    }));
    return end;
  }
  /// What squeue is to say of tasks of the batch that worker `one` is in, "STATE|reason" each.
  void list(const SlurmExecutor& executor, int one, const std::vector<std::string>& tasks) {
    const std::string token = executor.name(one).substr(0, 16);
    std::string text;
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      const auto bar = tasks[i].find('|');
      text +=
          "7|" + std::to_string(i) + "|" + tasks[i].substr(0, bar) + "|shaken-" + token + tasks[i].substr(bar) + "\n";
    }
    says("squeue", text);
  }
  BatchFolder folder(const SlurmExecutor& executor, int one) const {
    return {directory_ / "slurm" / executor.name(one).substr(0, 16)};
  }
  Launch launch(const std::string& settings = "") const { return {directory_ / "runs", {}, "heading", settings}; }
  std::vector<int> start(SlurmExecutor& executor, int n, const std::string& settings = "") {
    executor.step();
    std::vector<int> workers;
    for (int i = 0; i < n; ++i) workers.push_back(executor.start(launch(settings)).value());
    return workers;
  }

  ScratchFolder directory_;
  std::string path_;
};

TEST_F(SlurmExecutorTest, WorkersGoOutPackedAsOneArray) {
  SlurmExecutor executor(options());
  const auto workers = start(executor, 3, R"({"partition": "short", "time_s": 90, "options": ["--nice=3"]})");
  ASSERT_TRUE(step_until(executor, [&] { return calls("sbatch").size() == 1; }));
  const std::string call = calls("sbatch").front();
  EXPECT_THAT(call, HasSubstr("<--array=0-1>"));
  EXPECT_THAT(call, HasSubstr("<--partition=short>"));
  EXPECT_LT(call.find("<--qos=low>"), call.find("<--partition=short>")) << "sbatch takes the later of two";
  EXPECT_THAT(call, HasSubstr("<--time=2>")) << "whole minutes";
  EXPECT_THAT(call, HasSubstr("<--signal=B:USR1@22>"));
  EXPECT_THAT(call, HasSubstr("<--nice=3>"));
  EXPECT_LT(call.find("<--qos=low>"), call.find("<--nice=3>"));
  EXPECT_EQ(read_batch(folder(executor, workers[0]))->tasks.size(), 2);
  EXPECT_THAT(read_text(folder(executor, workers[0]).script()), HasSubstr("exec '/bin/it'\\''s a task' /"));
  list(executor, workers[0], {"PENDING|Priority", "PENDING|Priority"});
  ASSERT_TRUE(step_until_says(executor, workers[0], "waits as Slurm job 7_0 (Priority)"));
  EXPECT_EQ(executor.poll(workers[2]).words, "waits as Slurm job 7_1 (Priority)");
}

// What a program of Slurm says is kept in memory.
TEST(Command, OneThatSaysTooMuchIsEnded) {
  for (const char* says : {"yes", "head -c 50000000 /dev/zero"}) {
    auto command = Command::start({"sh", "-c", says}, "/", std::chrono::hours(1)).value();
    std::optional<Captured> end;
    ASSERT_TRUE(eventually([&] { return (end = command.poll()).has_value(); }, std::chrono::seconds(60))) << says;
    EXPECT_NE(end->exit_code, 0) << says;
    EXPECT_EQ(end->output, "has said more than 32 MiB");
  }
}

TEST_F(SlurmExecutorTest, WhatWaitsInSlurmIsBounded) {
  SlurmOptions of_four = options();
  of_four.max_pending = 4;
  SlurmExecutor executor(of_four);
  executor.step();
  std::vector<int> workers;
  while (executor.room() > 0) workers.push_back(executor.start(launch()).value());
  EXPECT_EQ(workers.size(), 8) << "four tasks of two";
  std::vector<std::string> tasks(4, "PENDING|Priority");
  for (const std::size_t n_running : {0, 1, 2}) {  // there is room again once half of them run
    if (n_running > 0) tasks[n_running - 1] = "RUNNING|None";
    list(executor, workers[0], tasks);
    const std::size_t before = calls("squeue").size();
    ASSERT_TRUE(step_until(executor, [&] { return calls("squeue").size() > before + 2; }));
    EXPECT_EQ(executor.room() > 0, n_running == 2) << n_running;
  }
}

TEST_F(SlurmExecutorTest, TheEndOfAWorkerIsWhatItsTaskSays) {
  SlurmExecutor executor(options());
  const auto workers = start(executor, 2);
  ASSERT_TRUE(step_until(executor, [&] { return calls("sbatch").size() == 1; }));
  list(executor, workers[0], {"RUNNING|None"});
  TaskReport report{.slurm_job = "7", .host = "n0", .restarts = 0, .begun = {0, 1}, .ends = {}};
  report.ends[0] = {0, 0, 55};
  const BatchFolder files = folder(executor, workers[0]);
  ASSERT_TRUE(write_report(files.report(0), report));
  const WorkerReport end = end_of(executor, workers[0]);
  EXPECT_EQ(end.end.pid, 55);
  EXPECT_EQ(executor.poll(workers[1]).phase, Phase::kWorking);

  list(executor, workers[1], {"OUT_OF_MEMORY|None"});
  const WorkerReport lost = end_of(executor, workers[1]);
  EXPECT_EQ(lost.phase, Phase::kLost);
  EXPECT_EQ(lost.words, "Slurm job 7_0 has ended: OUT_OF_MEMORY");
  EXPECT_TRUE(step_until(executor, [&] { return !std::filesystem::exists(files.root); }));
}

TEST_F(SlurmExecutorTest, ANodeThatFailsIsNoFaultOfItsWorkers) {
  SlurmExecutor executor(options());
  const auto workers = start(executor, 1);
  list(executor, workers[0], {"NODE_FAIL|None"});
  const WorkerReport end = end_of(executor, workers[0]);
  EXPECT_EQ(end.phase, Phase::kRevoked);
}

TEST_F(SlurmExecutorTest, WhatSlurmRefusesIsToldOnceItIsKnownNotToBeThere) {
  write_text(directory_ / "sbatch.fails", "");
  says("sbatch", "sbatch: error: invalid partition specified: shrot\n");
  SlurmExecutor executor(options());
  const auto workers = start(executor, 1);
  const WorkerReport end = end_of(executor, workers[0]);
  EXPECT_EQ(end.phase, Phase::kRefused);
  EXPECT_THAT(end.words, HasSubstr("invalid partition"));
  EXPECT_GE(calls("squeue").size(), 1);
  EXPECT_TRUE(step_until(executor, [&] { return executor.room() > 0; })) << "others may be handed over";
}

TEST_F(SlurmExecutorTest, ArraysGetSmallerWhereSlurmRefusesTheirSize) {
  write_text(directory_ / "sbatch.fails", "");
  says("sbatch", "sbatch: error: Batch job submission failed: Invalid job array specification\n");
  SlurmOptions many = options();
  many.max_pending = 100;
  many.runs_per_task = 1;
  SlurmExecutor executor(many);
  const auto largest_of_the_next = [&](std::size_t calls_before) {
    if (!eventually([&] {
          executor.step();
          return executor.room() > 0;
        })) {
      return std::string("no room");
    }
    const auto workers = start(executor, 5);
    const bool refused = step_until(executor, [&] {
      return std::all_of(workers.begin(), workers.end(), [&](int one) {
        return executor.name(one).empty() || executor.poll(one).phase == Phase::kRefused;
      });
    });
    if (!refused) return std::string("not refused");
    std::string largest;  // they may be handed over at the same time
    const std::vector<std::string> all = calls("sbatch");
    for (std::size_t k = calls_before; k < all.size(); ++k) {
      const auto begin = all[k].find("<--array=");
      largest = std::max(largest, all[k].substr(begin, all[k].find('>', begin) - begin + 1));
    }
    return largest;
  };
  EXPECT_EQ(largest_of_the_next(0), "<--array=0-4>");
  const std::size_t so_far = calls("sbatch").size();
  EXPECT_EQ(largest_of_the_next(so_far), "<--array=0-1>");
}

// Until it is told, its jobs count as handed over.
TEST_F(SlurmExecutorTest, ARefusalThatComesAtOnceIsToldSoon) {
  write_text(directory_ / "sbatch.fails", "");
  SlurmOptions rarely = options();
  rarely.poll = std::chrono::hours(1);
  SlurmExecutor executor(rarely);
  const auto workers = start(executor, 1);
  EXPECT_TRUE(step_until(executor, [&] { return executor.poll(workers[0]).phase == Phase::kRefused; }));
}

TEST_F(SlurmExecutorTest, WhatWasHandedOverThoughSbatchDidNotSaySoIsFoundByItsName) {
  write_text(directory_ / "sbatch.fails", "");
  says("sbatch", "sbatch: error: Socket timed out\n");
  SlurmExecutor executor(options());
  const auto workers = start(executor, 1);
  list(executor, workers[0], {"PENDING|Priority"});
  ASSERT_TRUE(step_until_says(executor, workers[0], "waits as Slurm job 7_0 (Priority)"));
  EXPECT_EQ(calls("sbatch").size(), 1);
}

TEST_F(SlurmExecutorTest, ASlurmThatDoesNotAnswerIsAskedMoreAndMoreRarelyAndLosesNothing) {
  SlurmExecutor executor(options());
  const auto workers = start(executor, 1);
  list(executor, workers[0], {"RUNNING|None"});
  ASSERT_TRUE(step_until(executor, [&] { return calls("squeue").size() > 1; }));
  write_text(directory_ / "down", "");
  const std::size_t before = calls("squeue").size();
  const auto end = std::chrono::steady_clock::now() + milliseconds(900);
  while (std::chrono::steady_clock::now() < end) {
    executor.step();
    std::this_thread::sleep_for(milliseconds(2));
  }
  // 20, 40, 80, 160, 160, ... ms, not one every 20 ms
  EXPECT_LE(calls("squeue").size() - before, 10);
  EXPECT_EQ(executor.room(), 0);
  EXPECT_THAT(executor.trouble(), HasSubstr("does not answer: squeue: Unable to contact slurm controller (SLURM_CONF"));
  EXPECT_EQ(executor.poll(workers[0]).phase, Phase::kWaiting) << "for its turn: nothing has ended";
  std::filesystem::remove(directory_ / "down");
  EXPECT_TRUE(step_until(executor, [&] { return executor.room() > 0; }));
  EXPECT_EQ(executor.trouble(), "");
}

TEST_F(SlurmExecutorTest, AnotherExecutorFindsTheWorkersByTheirNames) {
  std::string name;
  {
    SlurmExecutor executor(options());
    const auto workers = start(executor, 2);
    name = executor.name(workers[1]);
    list(executor, workers[0], {"RUNNING|None"});
    ASSERT_TRUE(step_until_says(executor, workers[0], "waits for its turn in Slurm job 7_0"));
  }
  for (const bool has_said_its_id : {true, false}) {
    if (!has_said_its_id) std::filesystem::remove(directory_ / "slurm" / name.substr(0, 16) / "job");
    SlurmExecutor executor(options());
    EXPECT_FALSE(executor.adopt("0123456789abcdef/0")) << "never written";
    EXPECT_FALSE(executor.adopt("../../etc/0"));
    EXPECT_FALSE(executor.adopt(name.substr(0, 17) + "9"));
    const auto worker = test::good(executor.adopt(name));
    EXPECT_EQ(executor.name(*worker), name);
    ASSERT_TRUE(step_until_says(executor, *worker, "waits for its turn in Slurm job 7_0"));
    EXPECT_EQ(calls("sbatch").size(), 1);
  }
}

TEST_F(SlurmExecutorTest, StoppingOneOfATaskThatRunsLeavesTheOthersAlone) {
  SlurmExecutor executor(options());
  const auto workers = start(executor, 2);
  list(executor, workers[0], {"RUNNING|None"});
  ASSERT_TRUE(step_until_says(executor, workers[0], "waits for its turn in Slurm job 7_0"));
  executor.stop(workers[1]);
  executor.step();
  EXPECT_EQ(read_stop(folder(executor, workers[0]).stop(0)), std::set{1});
  // It is cancelled in case that it waits by now, unless a list that came meanwhile has shown it running.
  const std::size_t lists = calls("squeue").size();
  ASSERT_TRUE(step_until(executor, [&] { return !calls("scancel").empty() || calls("squeue").size() > lists + 2; }));
  for (const std::string& call : calls("scancel")) EXPECT_EQ(call, "<--state=PENDING><7_0>");
  executor.stop(workers[0]);
  ASSERT_TRUE(step_until(executor, [&] { return !calls("scancel").empty() && calls("scancel").back() == "<7_0>"; }));
}

TEST_F(SlurmExecutorTest, ATaskThatGoesOnIsNotAskedToEndAgainAndAgain) {
  SlurmExecutor executor(options());
  const auto workers = start(executor, 2);
  list(executor, workers[0], {"RUNNING|None"});
  ASSERT_TRUE(step_until(executor, [&] { return calls("squeue").size() > 1; }));
  executor.stop(workers[1]);
  const std::size_t lists = calls("squeue").size();
  ASSERT_TRUE(step_until(executor, [&] { return calls("squeue").size() > lists + 5; }));
  EXPECT_LE(calls("scancel").size(), 1);  // none where a list that is under way says first that the task has begun
}

TEST_F(SlurmExecutorTest, WithoutItsProgramsNothingIsHandedOver) {
  for (const char* name : {"sbatch", "squeue", "scancel"}) std::filesystem::remove(directory_ / name);
  setenv("PATH", directory_.path().c_str(), 1);
  SlurmExecutor executor(options());
  const auto workers = start(executor, 1);
  const WorkerReport end = end_of(executor, workers[0]);
  EXPECT_EQ(end.phase, Phase::kRefused);
  EXPECT_THAT(end.words, HasSubstr("sbatch"));
  EXPECT_EQ(executor.room(), 0);
}

TEST_F(SlurmExecutorTest, AReportThatIsSeenLateStillCounts) {
  SlurmOptions patient = options();
  patient.report_delay = std::chrono::hours(1);
  SlurmExecutor executor(patient);
  const auto workers = start(executor, 1);
  list(executor, workers[0], {"COMPLETED|None"});
  ASSERT_TRUE(step_until_says(executor, workers[0],
                              "Slurm job 7_0 has ended: COMPLETED; how the run ended is not to be read yet"));
  TaskReport report{.slurm_job = "7", .host = "n0", .restarts = 0, .begun = {0}, .ends = {}};
  report.ends[0] = {0, 0, 55};
  ASSERT_TRUE(write_report(folder(executor, workers[0]).report(0), report));
  EXPECT_TRUE(step_until(executor, [&] { return executor.poll(workers[0]).phase == Phase::kEnded; }));
}

TEST_F(SlurmExecutorTest, WhatAFormerDaemonHasStoppedStaysSo) {
  std::string name;
  BatchFolder files;
  {
    SlurmExecutor executor(options());
    const auto workers = start(executor, 2);
    name = executor.name(workers[1]);
    files = folder(executor, workers[0]);
    ASSERT_TRUE(step_until(executor, [&] { return calls("sbatch").size() == 1; }));
    executor.stop(workers[0]);
    executor.step();
  }
  SlurmExecutor executor(options());
  const auto worker = test::good(executor.adopt(name));
  executor.stop(*worker);
  executor.step();
  EXPECT_EQ(read_stop(files.stop(0)), (std::set{0, 1}));
}

TEST_F(SlurmExecutorTest, WhatARoundHasStoppedIsWrittenOnce) {
  SlurmExecutor executor(options());
  const auto workers = start(executor, 4);
  ASSERT_TRUE(step_until(executor, [&] { return calls("sbatch").size() == 1; }));
  const BatchFolder files = folder(executor, workers[0]);
  for (const int worker : workers) executor.stop(worker);
  EXPECT_FALSE(std::filesystem::exists(files.stop(0))) << "not yet: the next may be of the same task";
  executor.step();
  EXPECT_EQ(read_stop(files.stop(0)), (std::set{0, 1}));
  EXPECT_EQ(read_stop(files.stop(1)), (std::set{0, 1}));
  std::filesystem::remove(files.stop(0));
  executor.step();
  EXPECT_FALSE(std::filesystem::exists(files.stop(0))) << "nothing new is to be said";
}

TEST_F(SlurmExecutorTest, NothingIsHandedOverBeforeItsStopsAreWritten) {
  SlurmExecutor executor(options());
  const auto workers = start(executor, 2);
  const BatchFolder files = folder(executor, workers[0]);
  executor.stop(workers[0]);
  std::filesystem::create_directories(files.stop(0) / "in the way");
  const auto end = std::chrono::steady_clock::now() + milliseconds(200);
  while (std::chrono::steady_clock::now() < end) executor.step();
  EXPECT_TRUE(calls("sbatch").empty());
  std::filesystem::remove_all(files.stop(0));
  ASSERT_TRUE(step_until(executor, [&] { return calls("sbatch").size() == 1; }));
  EXPECT_EQ(read_stop(files.stop(0)), std::set{0});
}

TEST_F(SlurmExecutorTest, WhatIsToStopSaysThatSlurmDoesNotAnswer) {
  SlurmExecutor executor(options());
  const auto workers = start(executor, 2);
  list(executor, workers[0], {"PENDING|Priority"});
  ASSERT_TRUE(step_until_says(executor, workers[0], "waits as Slurm job 7_0 (Priority)"));
  for (const char* name : {"sbatch", "squeue", "scancel"}) {
    std::filesystem::rename(directory_ / name, directory_ / (std::string(name) + ".away"));
  }
  setenv("PATH", directory_.path().c_str(), 1);
  executor.stop(workers[0]);
  ASSERT_TRUE(step_until(executor, [&] {
    return executor.poll(workers[0]).words.starts_with("stops once Slurm answers, which has it as job 7_0: squeue");
  }));
  EXPECT_THAT(executor.poll(workers[1]).words,
              StartsWith("waits as Slurm job 7_0 (Priority); Slurm does not answer: squeue"))
      << "nobody has stopped that one";
  for (const char* name : {"sbatch", "squeue", "scancel"}) {
    std::filesystem::rename(directory_ / (std::string(name) + ".away"), directory_ / name);
  }
  setenv("PATH", (directory_.path().string() + ":" + path_).c_str(), 1);
  EXPECT_TRUE(step_until_says(executor, workers[0], "waits as Slurm job 7_0 (Priority)"));
}

TEST_F(SlurmExecutorTest, WhatIsStoppedBeforeItIsHandedOverHasEnded) {
  SlurmExecutor executor(options());
  const auto workers = start(executor, 1);
  executor.stop(workers[0]);
  const WorkerReport end = executor.poll(workers[0]);
  EXPECT_EQ(end.phase, Phase::kEnded);
  EXPECT_EQ(end.end.exit_code, 99);
}

using Stage = QueuedTask::Stage;

TEST(Squeue, TasksAreReadAndAnythingElseIsPassedOver) {
  const auto tasks = parse_squeue(
      "slurm_load_jobs: warning\n"
      "12|3|PENDING|shaken-ab|Resources\n"
      "12|4|RUNNING|shaken-ab|None\n"
      "13|N/A|RUNNING|a job of another kind|None\n"
      "14|99999999999999|RUNNING|x|None\n"
      "12|5|NODE_FAIL|shaken-ab|Nodes required | for job are DOWN");
  ASSERT_EQ(tasks.size(), 3);
  EXPECT_EQ(tasks[0].job, "12");
  EXPECT_EQ(tasks[0].task, 3);
  EXPECT_EQ(tasks[0].name, "shaken-ab");
  EXPECT_EQ(tasks[0].reason, "Resources");
  EXPECT_EQ(tasks[0].stage, Stage::kWaiting);
  EXPECT_EQ(tasks[1].stage, Stage::kWorking);
  EXPECT_EQ(tasks[2].stage, Stage::kOver);
  EXPECT_EQ(tasks[2].state, "NODE_FAIL");
}

TEST(Squeue, AStateThatNobodyKnowsIsNoEnd) {
  EXPECT_EQ(parse_squeue("1|0|REQUEUE_HOLD|a|b").at(0).stage, Stage::kWaiting);
  EXPECT_EQ(parse_squeue("1|0|COMPLETING|a|b").at(0).stage, Stage::kWorking);
}

TEST(Sbatch, TheIdIsFoundAmongWarnings) {
  EXPECT_EQ(parse_sbatch("123\n"), "123");
  EXPECT_EQ(parse_sbatch("sbatch: warning: 3 cores are few\n124;east\n"), "124");
  EXPECT_EQ(parse_sbatch("sbatch: error: Batch job submission failed: Invalid partition"), "");
  EXPECT_EQ(parse_sbatch(""), "");
}

TEST(BatchFiles, WhatIsWrittenIsRead) {
  const ScratchFolder directory;
  const BatchFolder folder{directory.path()};
  const Batch batch{"/a program/worker", {{{"/runs/a", {"one", "two words\n'"}, "heading"}}, {{"/runs/b", {}, ""}}}};
  ASSERT_TRUE(write_batch(folder, batch));
  const auto read = test::good(read_batch(folder));
  EXPECT_EQ(read->worker, batch.worker);
  ASSERT_EQ(read->tasks.size(), 2);
  EXPECT_EQ(read->tasks[0][0].directory, "/runs/a");
  EXPECT_EQ(read->tasks[0][0].arguments, batch.tasks[0][0].arguments);
  EXPECT_EQ(read->tasks[0][0].heading, "heading");

  TaskReport report{.slurm_job = "7", .host = "n0", .restarts = 2, .begun = {0, 3}, .ends = {}};
  report.ends[3] = {1, 9, 77};
  ASSERT_TRUE(write_report(folder.report(1), report));
  const auto told = test::good(read_report(folder.report(1)));
  EXPECT_EQ(told->slurm_job, "7");
  EXPECT_EQ(told->restarts, 2);
  EXPECT_EQ(told->begun, report.begun);
  EXPECT_EQ(told->ends.at(3).exit_code, 1);
  EXPECT_EQ(told->ends.at(3).signal, 9);
  EXPECT_EQ(told->ends.at(3).pid, 77);

  ASSERT_TRUE(write_stop(folder.stop(1), {2, 5}, Lasting::kYes));
  EXPECT_EQ(read_stop(folder.stop(1)), (std::set{2, 5}));
  ASSERT_TRUE(write_stop(folder.stop(1), {2, 5, 7}, Lasting::kNo));
  EXPECT_EQ(read_stop(folder.stop(1)), (std::set{2, 5, 7}));
  EXPECT_TRUE(read_stop(folder.stop(2)).empty());
}

// The program that Slurm starts, with workers that end by themselves, and signals that come while the first is at work.
TEST(TaskProgram, DoesItsRunsOneAfterTheOtherUntilItsTimeIsOver) {
  struct Case {
    std::vector<std::string> labels;
    int signal, exit_code;
    std::vector<int> ends;  ///< exit codes of the workers of which it says how they ended
  };
  for (const Case& of : {Case{{"done", "fail"}, 0, 0, {0, 1}}, Case{{"run", "done"}, SIGUSR1, 0, {99}},
                         Case{{"stops at once", "done"}, SIGTERM, 143, {}}}) {
    const ScratchFolder directory;
    const BatchFolder folder{directory.path()};
    Batch batch{write_fake_worker(directory.path()), {}};
    std::vector<Launch>& runs = batch.tasks.emplace_back();
    for (const std::string& label : of.labels) {
      std::filesystem::create_directory(directory / label);
      runs.push_back({directory / label,
                      {"scene", "--out", directory / label, "--job-id", "1", "--sweep-id", "s1", "--label", label},
                      "heading"});
    }
    ASSERT_TRUE(write_batch(folder, batch));
    setenv("SLURM_ARRAY_TASK_ID", "0", 1);
    const pid_t task = start_child({.command = {SHAKEN_TASK, directory.path()}}).value();
    if (of.signal != 0) {
      const bool listens = of.labels[0] == "run";
      ASSERT_TRUE(
          eventually([&] { return std::filesystem::exists(listens ? directory / "run/up" : folder.report(0)); }));
      if (!listens) std::this_thread::sleep_for(milliseconds(500));  // Slurm's word comes after the worker's end
      kill(task, of.signal);
    }
    EXPECT_EQ(wait_for_child(task).exit_code, of.exit_code) << of.labels[0];
    const auto report = test::good(read_report(folder.report(0)));
    std::vector<int> ends;
    for (const auto& [place, end] : report->ends) ends.push_back(end.exit_code);
    EXPECT_EQ(ends, of.ends) << of.labels[0];
  }
  unsetenv("SLURM_ARRAY_TASK_ID");
}

TEST(ForgetFilters, NothingHidesTasksAndTheRestStays) {
  setenv("SQUEUE_PARTITION", "short", 1);
  setenv("SBATCH_CLUSTERS", "other", 1);
  setenv("SBATCH_ACCOUNT", "physics", 1);
  const std::vector<const char*> others{"SINFO_PARTITION", "SLURM_TIME_FORMAT", "SBATCH_WAIT", "SBATCH_TEST_ONLY"};
  for (const char* name : others) setenv(name, "1", 1);
  forget_slurm_filters();
  for (const char* name : others) EXPECT_EQ(std::getenv(name), nullptr) << name;
  EXPECT_EQ(std::getenv("SQUEUE_PARTITION"), nullptr);
  EXPECT_EQ(std::getenv("SBATCH_CLUSTERS"), nullptr);
  EXPECT_STREQ(std::getenv("SBATCH_ACCOUNT"), "physics");
  unsetenv("SBATCH_ACCOUNT");
}

TEST(BatchFiles, WhatIsNoneIsRefusedWithItsName) {
  const ScratchFolder directory;
  const BatchFolder folder{directory.path()};
  EXPECT_FALSE(read_batch(folder));
  for (const char* text : {"", "{", "[]", R"({"worker": 3, "tasks": []})", R"({"worker": "w", "tasks": [[3]]})"}) {
    write_text(folder.plan(), text);
    EXPECT_THAT(test::refusal(read_batch(folder)), testing::HasSubstr("batch.json")) << text;
  }
}

}  // namespace
}  // namespace shaken::server::slurm
