#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <shaken/job_t.hpp>
#include <sstream>
#include <thread>

#include "base/text.h"
#include "client/live/json.h"
#include "client/waiting.h"
#include "proto/bus.h"
#include "tests/support/good.h"
#include "tests/unit/client/fake_daemon.h"
#include "tests/unit/client/run_client.h"

namespace shaken::client {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// Verbs against a daemon whose answers are laid down (docs/protocol.md).
class Verbs : public ::testing::Test {
 protected:
  Outcome run(std::vector<std::string> arguments, int width = 0) {
    arguments.insert(arguments.end(), {"--root", root_.path().string()});
    return run_client(arguments, width);
  }
  /// Runs a verb that waits, and presses Ctrl-C once it has asked the daemon `n_requests` times.
  Outcome run_interrupted(const std::vector<std::string>& arguments, std::size_t n_requests) {
    std::thread finger([&] {
      while (daemon_.requests().size() < n_requests) std::this_thread::sleep_for(std::chrono::milliseconds(5));
      kill(getpid(), SIGINT);
    });
    Outcome outcome = run(arguments);
    finger.join();
    return outcome;
  }

  static Json job(const std::string& id, const std::string& state) {
    return {{"id", id},
            {"sweep", "s1"},
            {"state", state},
            {"ended", state == "done" || state == "failed" || state == "cancelled" || state == "timed out"},
            {"reason", state == "failed" ? "2 rods overlap by 0.3 mm" : ""},
            {"label", "rods.length=2.5"},
            {"parameters", {{"rods.length", 2.5}}},
            {"replica", 1},
            {"attempt", 1},
            {"pid", 0},
            {"directory", "/data/runs/" + id},
            {"created_utime", 2000},
            {"started_utime", 0},
            {"finished_utime", 0},
            {"progress", nullptr}};
  }
  static Json sweep(const std::vector<Json>& jobs) {
    Json counts{{"queued", 0}, {"running", 0},   {"stopping", 0}, {"done", 0},
                {"failed", 0}, {"timed out", 0}, {"cancelled", 0}};
    std::size_t n_ended = 0;
    for (const Json& each : jobs) {
      Json& n = counts[each.at("state").get<std::string>()];
      n = n.get<int>() + 1;
      n_ended += each.at("ended").get<bool>();
    }
    return {{"sweep",
             {{"id", "s1"},
              {"name", "phases"},
              {"created_utime", 1000},
              {"n_jobs", jobs.size()},
              {"n_ended", n_ended},
              {"counts", counts},
              {"progress", 0.5},
              {"eta_s", 90.0}}},
            {"jobs", jobs}};
  }
  static std::string text(const Json& json) { return json.dump(); }

  ScratchFolder root_;
  FakeDaemon daemon_{root_.path()};
};

TEST_F(Verbs, StatusListsSweeps) {
  daemon_.on("GET /v1/status",
             R"({"version": "0.1.0", "api": 1, "pid": 77, "root": "/r", "host": "desk", "uptime_s": 65.0,
    "slots": 2, "lcm": {"url": "udpm://x", "ok": false, "message": "no route"}, "jobs": {}})");
  const Json one = sweep({job("1f0c000000000000", "running"), job("2a0c000000000000", "failed")}).at("sweep");
  daemon_.on("GET /v1/sweeps", text({{"sweeps", {one}}}));
  const Outcome outcome = run({"status"});
  EXPECT_EQ(outcome.code, ExitCode::kOk) << outcome.err;
  EXPECT_THAT(outcome.out,
              HasSubstr("shakend 0.1.0 on desk, pid 77, up 1 min 05 s; 2 slots; live state off: no route"));
  EXPECT_THAT(outcome.out, HasSubstr("1 running, 1 failed"));
  EXPECT_THAT(outcome.out, HasSubstr("1 min 30 s ("));
  EXPECT_THAT(outcome.out, Not(HasSubstr("\x1b")));
  const Outcome json = run({"status", "--json"});
  EXPECT_EQ(Json::parse(json.out).at("sweeps").at(0), one);
}

TEST_F(Verbs, ALongNameDoesNotMoveAllSweepsApart) {
  daemon_.on("GET /v1/status", R"({"version": "0.1.0", "lcm": {"ok": true, "url": "udpm://x"}})");
  Json one = sweep({job("1f0c000000000000", "done")}).at("sweep");
  one["name"] = std::string(120, 'n');
  daemon_.on("GET /v1/sweeps", text({{"sweeps", {one}}}));
  const Outcome outcome = run({"status"});
  EXPECT_THAT(outcome.out, HasSubstr(" " + std::string(39, 'n') + "… "));
  EXPECT_THAT(outcome.out, Not(HasSubstr(std::string(40, 'n'))));
}

TEST_F(Verbs, StatusOfASweepAndItsFailures) {
  daemon_.on("GET /v1/sweeps/phases",
             text(sweep({job("1f0c000000000000", "done"), job("2a0c000000000000", "failed")})));
  EXPECT_THAT(shown(run({"status", "phases"})),
              AllOf(HasSubstr("sweep s1 (phases): 1 done, 1 failed"), HasSubstr("1f0c0000  done")));
  const Outcome failed = run({"status", "phases", "--failed"});
  EXPECT_THAT(failed.out, HasSubstr("2 rods overlap by 0.3 mm"));
  EXPECT_THAT(failed.out, HasSubstr("/data/runs/2a0c000000000000/worker.log"));
  EXPECT_THAT(failed.out, Not(HasSubstr("1f0c")));
}

TEST_F(Verbs, StatusShowsTheMeanOrderOfWhatIsDone) {
  Json done = job("1f0c000000000000", "done"), damaged = job("2a0c000000000000", "done");
  for (Json* each : {&done, &damaged}) {
    const std::filesystem::path folder = root_ / each->at("id").get<std::string>();
    std::filesystem::create_directory(folder);
    (*each)["directory"] = folder.string();
    std::ofstream(folder / "summary.json") << (each == &done ? R"({"order": {"mean": 0.625}})" : R"({"order": 3})");
  }
  daemon_.on("GET /v1/sweeps/s1", text(sweep({done, damaged, job("3b0c000000000000", "done")})));
  const Outcome outcome = run({"status", "s1"});
  EXPECT_THAT(outcome.out, HasSubstr("1f0c0000  done   100 %  0.625 "));
  EXPECT_THAT(outcome.out, HasSubstr("2a0c0000  done   100 %      - "));
}

// The marks and words of `shaken results`: a mean of no steady state is not shown as one.
TEST_F(Verbs, StatusMarksWhatIsNotKnownToBeSteady) {
  std::vector<Json> jobs;
  for (const auto& [id, steady] :
       {std::pair{"1f0c000000000000", "true"}, {"2a0c000000000000", "false"}, {"3b0c000000000000", "null"}}) {
    jobs.push_back(job(id, "done"));
    const std::filesystem::path folder = root_ / id;
    std::filesystem::create_directory(folder);
    jobs.back()["directory"] = folder.string();
    std::ofstream(folder / "summary.json") << R"({"order": {"mean": 0.625}, "steady": )" << steady << "}";
    daemon_.on(std::string("GET /v1/jobs/") + id, text({{"job", jobs.back()}}));
  }
  daemon_.on("GET /v1/sweeps/s1", text(sweep(jobs)));
  const Outcome outcome = run({"status", "s1"});
  EXPECT_THAT(outcome.out, HasSubstr("1f0c0000  done   100 %   0.625 "));
  EXPECT_THAT(outcome.out, HasSubstr("2a0c0000  done   100 %  ~0.625 "));
  EXPECT_THAT(outcome.out, HasSubstr("3b0c0000  done   100 %  ?0.625 "));
  EXPECT_THAT(outcome.out, HasSubstr("\n~ still relaxing: "));
  EXPECT_THAT(outcome.out, HasSubstr("\n? not known to be steady: "));
}

TEST_F(Verbs, AnswersOfAnotherShapeAreNamedAsSuch) {
  daemon_.on("GET /v1/status", "{}");
  daemon_.on("GET /v1/sweeps", R"({"sweeps": 7})");
  EXPECT_THAT(test::said_with(ExitCode::kFailed, run({"status"})), HasSubstr("another version"));
}

TEST_F(Verbs, SubmitSendsTheFileWithAllThatIsAskedAndShowsThePoints) {
  const std::string file = (root_.path() / "scene.json").string();
  std::ofstream(file) << R"({"box": {"side": 30}})";
  Json answer = sweep({job("1f0c000000000000", "queued"), job("2a0c000000000000", "done")});
  answer["jobs"][1]["created_utime"] = 500;
  answer["counts"] = {{"new", 1}, {"requeued", 0}, {"done", 1}};
  daemon_.on("POST /v1/sweeps", {{201, text(answer)}});
  EXPECT_THAT(shown(run({"submit",       file,        "-s",           "rods.length=2.5,3.5",
                         "--replicas",   "2",         "--name",       "phases",
                         "--priority",   "10",        "--soft-limit", "10min",
                         "--time-limit", "1.5 d",     "--at-once",    "4",
                         "--after",      "s3",        "--after",      "1f0c",
                         "--stop-if",    "failed>10%"})),
              AllOf(HasSubstr("sweep s1 (phases): 2 points: 1 new, 1 done\n"), HasSubstr("1f0c0000  new"),
                    HasSubstr("2a0c0000  done")));
  const Json asked{{"text", R"({"box": {"side": 30}})"},
                   {"file", file},
                   {"settings", {"rods.length=2.5,3.5"}},
                   {"replicas", 2},
                   {"name", "phases"},
                   {"priority", 10},
                   {"soft_limit_s", 600.0},
                   {"time_limit_s", 129600.0},
                   {"at_most", 4},
                   {"after", {"s3", "1f0c"}},
                   {"stop_if", "failed>10%"}};
  const Json sent = Json::parse(daemon_.requests().back().body);
  for (const auto& [key, value] : asked.items()) EXPECT_EQ(sent.at(key), value) << key;
  EXPECT_EQ(run({"submit", file}).code, ExitCode::kOk);
  EXPECT_FALSE(Json::parse(daemon_.requests().back().body).contains("priority"));
  for (const char* time : {"soon", "0", "-3min", "5 mm", "1e999", "nan"}) {
    EXPECT_THAT(test::said_with(ExitCode::kBadInput, run({"submit", file, "--time-limit", time})),
                HasSubstr("--time-limit"))
        << time;
  }
}

TEST_F(Verbs, StatusAndHistoryShowTerms) {
  Json limited = job("1f0c000000000000", "timed out");
  limited["soft_limit_s"] = 600.0;
  limited["time_limit_s"] = 7200.0;
  limited["wall_s"] = 7201.0;
  Json answer = sweep({limited});
  answer["sweep"].update(
      {{"at_most", 4}, {"after", {"s3", "1f0c\u001b"}}, {"stop_if", "failed>10%"}, {"stopped", true}});
  daemon_.on("GET /v1/sweeps/s1", text(answer));
  daemon_.on("GET /v1/jobs/1f0c", text({{"job", limited}}));
  daemon_.on("GET /v1/jobs/1f0c000000000000/history", R"({"changes": []})");
  const std::string of_sweep = run({"status", "s1"}).out;
  EXPECT_THAT(of_sweep, HasSubstr("\nat most 4 at once; after s3, 1f0c\\u001b; stopped if failed>10%\n"));
  EXPECT_THAT(of_sweep, HasSubstr("1 timed out"));
  EXPECT_THAT(of_sweep, HasSubstr("took 2 h 00 min"));
  EXPECT_THAT(run({"status", "1f0c"}).out,
              AllOf(HasSubstr("gives way after 10 min 00 s; 2 h 00 min of 2 h 00 min used"),
                    ContainsRegex("point +rods.length=2.5\n"), Not(HasSubstr("rods  "))));
  limited["progress"] = {{"sim_time_s", 1.0}, {"sim_time_total_s", 4.0}, {"n_rods", 271}};
  daemon_.on("GET /v1/jobs/1f0c", text({{"job", limited}}));
  EXPECT_THAT(run({"status", "1f0c"}).out, ContainsRegex("rods +271\n"));
  EXPECT_THAT(run({"history", "1f0c"}).out, HasSubstr("gives way after 10 min 00 s"));
  EXPECT_THAT(run({"status", "s1", "--failed"}).out, HasSubstr("1f0c000000000000"));
  EXPECT_EQ(run({"wait", "s1"}).err, "1f0c0000 timed out (rods.length=2.5)\n") << "it has ended";
}

constexpr const char* kToClean = R"({"runs": [
    {"id": "1f0c000000000000", "known": true, "state": "failed", "label": "rods.length=2.5", "sweep": "s1", "bytes": 3000},
    {"id": "2a0c000000000000", "known": false, "state": null, "label": "", "sweep": null, "bytes": 500}], "bytes": 3000})";

TEST_F(Verbs, CleanShowsWhatWouldGo) {
  daemon_.on("POST /v1/clean", kToClean);
  const Outcome outcome =
      run({"clean", "--dry-run", "--state", "failed, timed out", "--older", "30d", "--sweep", "s1"});
  EXPECT_EQ(outcome.code, ExitCode::kOk) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("1f0c0000  failed"));
  EXPECT_THAT(outcome.out, HasSubstr("2a0c0000  unknown"));
  EXPECT_THAT(outcome.out, HasSubstr("3 kB in all\n1 unknown to the queue"));
  ASSERT_EQ(daemon_.requests().size(), 1u);
  EXPECT_EQ(Json::parse(daemon_.requests().back().body),
            Json({{"states", {"failed", "timed out"}}, {"sweep", "s1"}, {"older_s", 2592000.0}, {"dry_run", true}}));
}

TEST_F(Verbs, CleanAsksWhoeverIsThere) {
  daemon_.on("POST /v1/clean", kToClean);
  for (const bool agrees : {false, true}) {
    std::ostringstream out;
    std::ostringstream err;
    std::istringstream in(agrees ? "y\n" : "\n");
    Console console{.out = out, .err = err, .in = &in};
    const ExitCode code = run_program({"clean", "--root", root_.path().string()}, console);
    EXPECT_THAT(err.str(), HasSubstr("Remove 1 run, 3 kB? [y/N] "));
    EXPECT_EQ(code, ExitCode::kFailed) << "not agreed, or kept by the daemon without a word";
    EXPECT_EQ(Json::parse(daemon_.requests().back().body).contains("only"), agrees);
  }
}

TEST_F(Verbs, CleanRemovesOnlyWhatWasShown) {
  daemon_.on(
      "POST /v1/clean",
      {{200, kToClean},
       {200, R"({"runs": [{"id": "1f0c000000000000", "known": true, "removed": true, "kept": ""}], "bytes": 3000})"},
       {200, kToClean},
       {200, R"({"runs": [{"id": "1f0c000000000000", "known": true, "removed": false, "kept": "in use"}],
                        "bytes": 0})"}});
  const Outcome unasked = run({"clean"});
  EXPECT_EQ(unasked.code, ExitCode::kBadInput) << "nobody is there who could agree";
  EXPECT_TRUE(daemon_.requests().empty());
  EXPECT_THAT(shown(run({"clean", "--yes"})), HasSubstr("1 removed, 3 kB\n"));
  EXPECT_EQ(Json::parse(daemon_.requests().back().body), Json({{"only", {"1f0c000000000000"}}}));
  EXPECT_EQ(test::said_with(ExitCode::kFailed, run({"clean", "--yes"})), "1f0c0000 stays: in use\n");
}

TEST_F(Verbs, SubmitOfABadSceneNeverReachesTheDaemon) {
  const std::string file = (root_.path() / "scene.json").string();
  std::ofstream(file) << R"({"box": {"sied": 30}})";
  EXPECT_THAT(test::said_with(ExitCode::kBadInput, run({"submit", file})), HasSubstr("sied"));
  EXPECT_TRUE(daemon_.requests().empty());
}

TEST_F(Verbs, SubmitDryRunQueuesNothing) {
  const std::string file = (root_.path() / "scene.json").string();
  std::ofstream(file) << R"({"box": {"side": 30}})";
  daemon_.on("POST /v1/sweeps", "{}");
  EXPECT_THAT(
      shown(run({"submit", file, "--dry-run", "--no-probe", "-s", "rods.count=100,200,300", "--name", "sizes"})),
      AllOf(HasSubstr("sizes: 3 points, nothing queued"), HasSubstr("  300  ")));
  ASSERT_EQ(daemon_.requests().size(), 1u);
  EXPECT_EQ(Json::parse(daemon_.requests()[0].body)["dry_run"], true) << "whether it would be taken is asked";

  daemon_.on("POST /v1/sweeps", {{400, R"({"error": "at_most: 0 is less than 1"})"}});
  const Outcome refused = run({"submit", file, "--dry-run", "--no-probe", "--at-once", "0"});
  EXPECT_EQ(refused.code, ExitCode::kBadInput);
  EXPECT_EQ(refused.out, "");
}

TEST_F(Verbs, WaitEndsWhenAllAreDone) {
  daemon_.on("GET /v1/sweeps/s1", {{200, text(sweep({job("1f0c000000000000", "running")}))},
                                   {200, text(sweep({job("1f0c000000000000", "running")}))},
                                   {200, text(sweep({job("1f0c000000000000", "done")}))}});
  EXPECT_EQ(run({"wait", "s1"}).code, ExitCode::kOk);
  EXPECT_EQ(daemon_.requests().size(), 3u);
}

TEST_F(Verbs, WaitFailsWithTheReasonIfAJobFailed) {
  daemon_.on("GET /v1/sweeps/s1", text(sweep({job("1f0c000000000000", "done"), job("2a0c000000000000", "failed")})));
  EXPECT_THAT(test::said_with(ExitCode::kFailed, run({"wait", "s1"})), HasSubstr("2a0c0000 failed: 2 rods overlap"));
}

TEST_F(Verbs, WaitSaysWhatKeepsJobsWaiting) {
  Json queued = job("1f0c000000000000", "queued");
  queued["reason"] = "could not be started: sbatch: error: invalid partition";
  daemon_.on("GET /v1/sweeps/s1", text(sweep({queued})));
  const Outcome outcome = run({"wait", "s1", "--timeout", "5"});
  EXPECT_THAT(outcome.err, StartsWith("1 job queued: could not be started: sbatch: error: invalid partition\n"));
}

TEST_F(Verbs, WaitGivesUpAfterTheTimeout) {
  daemon_.on("GET /v1/sweeps/s1", text(sweep({job("1f0c000000000000", "running")})));
  EXPECT_THAT(test::said_with(ExitCode::kFailed, run({"wait", "s1", "--timeout", "0.2"})),
              HasSubstr("time is up: 1 of 1 jobs"));
}

TEST_F(Verbs, CtrlCIsExitCode130) {
  daemon_.on("GET /v1/sweeps/s1", text(sweep({job("1f0c000000000000", "running")})));
  daemon_.on("GET /v1/jobs/1f0c", text({{"job", job("1f0c000000000000", "running")}}));
  daemon_.on("GET /v1/jobs/1f0c000000000000/log?offset=0",
             R"({"text": "", "offset": 0, "state": "running", "ended": false})");
  daemon_.on("GET /v1/status", R"({"lcm": {"url": "", "ok": false, "message": "no multicast route"}})");
  EXPECT_EQ(run_interrupted({"wait", "s1"}, 3).code, ExitCode::kInterrupted);
  EXPECT_EQ(run_interrupted({"logs", "1f0c", "-f"}, daemon_.requests().size() + 4).code, ExitCode::kInterrupted);
  EXPECT_EQ(run_interrupted({"watch", "s1"}, daemon_.requests().size() + 4).code, ExitCode::kInterrupted);
}

TEST_F(Verbs, WaitForNothingSaysSo) {
  for (const char* state : {"queued", "running", "stopping"}) {
    daemon_.on(std::string("GET /v1/jobs?state=") + state, R"({"jobs": []})");
  }
  EXPECT_EQ(test::said_with(ExitCode::kOk, run({"wait"})), "no job is queued or running\n");
}

TEST_F(Verbs, WaitLeavesOutWhatAFailedJobDoesNotHave) {
  Json failed = job("2a0c000000000000", "cancelled");
  failed["label"] = "";
  daemon_.on("GET /v1/sweeps/s1", text(sweep({failed})));
  EXPECT_EQ(run({"wait", "s1"}).err, "2a0c0000 cancelled\n");
}

TEST_F(Verbs, WaitWithoutAnIdTakesWhatIsUnfinished) {
  daemon_.on("GET /v1/jobs?state=queued", R"({"jobs": []})");
  daemon_.on("GET /v1/jobs?state=running", text({{"jobs", {job("1f0c000000000000", "running")}}}));
  daemon_.on("GET /v1/jobs?state=stopping", R"({"jobs": []})");
  daemon_.on("GET /v1/jobs/1f0c000000000000", text({{"job", job("1f0c000000000000", "done")}}));
  EXPECT_EQ(run({"wait"}).code, ExitCode::kOk);
}

TEST_F(Verbs, CancelLooksEverythingUpBeforeItStopsAnything) {
  daemon_.on("GET /v1/sweeps/s1", text(sweep({job("1f0c000000000000", "running")})));
  daemon_.on("POST /v1/sweeps/s1/cancel", {{200, R"({"cancelled": 3})"}, {200, R"({"cancelled": 0})"}});
  EXPECT_EQ(run({"cancel", "s1", "nothing"}).code, ExitCode::kBadInput);
  for (const auto& request : daemon_.requests()) EXPECT_THAT(request.line, Not(HasSubstr("POST")));
  EXPECT_THAT(run({"cancel", "s1"}).out, HasSubstr("3 jobs cancelled"));
  EXPECT_THAT(shown(run({"cancel", "s1"})), HasSubstr("nothing to be cancelled"));
}

TEST_F(Verbs, JobsAreHeldAndPutFirst) {
  daemon_.on("GET /v1/sweeps/s1", text(sweep({job("1f0c000000000000", "running")})));
  daemon_.on("POST /v1/sweeps/s1/hold", R"({"held": 1})");
  daemon_.on("POST /v1/sweeps/s1/priority", R"({"changed": 2})");
  EXPECT_THAT(run({"hold", "s1"}).out, HasSubstr("1 job held"));
  EXPECT_THAT(test::said_with(ExitCode::kBadInput, run({"hold", "n1", "s1", "n2"})),
              AllOf(HasSubstr("is called 'n1'"), HasSubstr("is called 'n2'"), Not(HasSubstr("'s1'"))));
  EXPECT_THAT(run({"priority", "7", "s1"}).out, HasSubstr("2 jobs changed"));
  EXPECT_EQ(daemon_.requests().back().body, R"({"priority":7})");
  EXPECT_EQ(run({"priority", "much", "s1"}).code, ExitCode::kBadInput);
}

TEST_F(Verbs, HistoryTellsEveryChange) {
  daemon_.on("GET /v1/jobs/1f0c", text({{"job", job("1f0c000000000000", "failed")}}));
  daemon_.on(
      "GET /v1/jobs/1f0c000000000000/history",
      R"({"changes": [{"utime": 1700000000000000, "from": "", "to": "queued", "attempt": 0, "cause": "submitted"},
                             {"utime": 1700000001000000, "from": "running", "to": "failed", "attempt": 1,
                              "cause": "the gap is closed"}]})");
  const std::string out = run({"history", "1f0c"}).out;
  EXPECT_THAT(out, HasSubstr("WHEN"));
  EXPECT_THAT(out, HasSubstr("failed"));
  EXPECT_THAT(out, HasSubstr("the gap is closed"));
}

TEST_F(Verbs, LogsComeInPiecesAndFollowEndsWithTheJob) {
  daemon_.on("GET /v1/jobs/1f0c", text({{"job", job("1f0c000000000000", "running")}}));
  daemon_.on("GET /v1/jobs/1f0c000000000000/log?offset=0",
             R"({"text": "one\n", "offset": 4, "state": "running", "ended": false})");
  daemon_.on("GET /v1/jobs/1f0c000000000000/log?offset=4",
             {{200, R"({"text": "", "offset": 4, "state": "running", "ended": false})"},
              {200, R"({"text": "two\n", "offset": 8, "state": "failed", "ended": true})"}});
  daemon_.on("GET /v1/jobs/1f0c000000000000/log?offset=8",
             R"({"text": "", "offset": 8, "state": "failed", "ended": true})");
  const Outcome outcome = run({"logs", "1f0c", "-f"});
  EXPECT_EQ(outcome.out, "one\ntwo\n");
  EXPECT_EQ(outcome.code, ExitCode::kFailed);
}

// What they say is held by python/tests/test_tables.py; here: every option gets there, from the daemon and the runs.
TEST_F(Verbs, ResultsAreThoseOfPython) {
  Json rows = Json::array();
  std::vector<Json> jobs;
  for (const int k : {0, 1}) {
    const std::string id = "1f0c00000000000" + std::to_string(k);
    rows.push_back({{"job", id},
                    {"sweep", "s1"},
                    {"state", "done"},
                    {"label", "x"},
                    {"parameters", {{"rods.length", 4.5}}},
                    {"replica", k + 1},
                    {"summary",
                     {{"order", {{"mean", 0.94961 - 0.5 * k}, {"sem", 0.01}, {"steady", k == 1}}},
                      {"steady", k == 1},
                      {"measured", {{"theta_m_deg", {{"value", 8.5}, {"sem", 0.25}, {"steady", nullptr}}}}}}}});
    jobs.push_back(job(id, "done"));
    const std::filesystem::path folder = root_.path() / "runs" / id;
    jobs.back()["directory"] = folder.string();
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "scene.json") << R"({"rods": {"count": 10}, "box": {"gap": )" << (k == 0 ? 1.2 : 1.4)
                                         << "}}";
  }
  daemon_.on("GET /v1/sweeps", text({{"sweeps", {sweep({}).at("sweep")}}}));
  daemon_.on("GET /v1/sweeps/s1", text(sweep(jobs)));
  daemon_.on("GET /v1/results?sweep=s1", text({{"rows", rows}}));

  const Outcome table = run({"results", "--columns", "order.mean,theta_m_deg,order.steady"});
  EXPECT_EQ(table.code, ExitCode::kOk) << table.err;
  EXPECT_EQ(table.out,
            "order.mean  measured.theta_m_deg.value  order.steady\n"
            "   ~0.9496                        ~8.5  false\n"
            "    0.4496                         8.5  true\n"
            "~ still relaxing: no steady state yet, run it longer (-s time.measure=...)\n");
  EXPECT_EQ(run({"results", "s1", "--csv", "--columns", "job", "--where", "box.gap>1300um", "-w", "order.mean<2"}).out,
            "job\n1f0c000000000001\n");
  EXPECT_EQ(run({"results", "s1", "-a", "--csv", "--columns", "rods.length,n_done"}).out,
            "rods.length,n_done\n4.5,2\n");
  EXPECT_EQ(Json::parse(run({"results", "s1", "--json"}).out).at("rows"), rows);
  EXPECT_THAT(
      test::said_with(ExitCode::kBadInput, run({"results", "s1", "--where", "order.mean>", "--where", "(state=done"})),
      HasSubstr("this ( is never closed"));
}

TEST_F(Verbs, WatchWithoutAnIdShowsEverythingThatRuns) {
  const auto named = [](Json sweep, const char* id) {
    sweep["sweep"]["id"] = id;
    for (Json& job : sweep["jobs"]) job["sweep"] = id;
    return sweep;
  };
  const Json one = named(sweep({job("1f0c000000000000", "running")}), "s1");
  const Json two = named(sweep({job("2a0c000000000000", "done")}), "s2");
  const Json three = named(sweep({job("3b0c000000000000", "queued")}), "s3");
  Json none = Json::array({one.at("sweep"), two.at("sweep"), three.at("sweep")});
  daemon_.on("GET /v1/sweeps", text({{"sweeps", none}}));
  daemon_.on("GET /v1/sweeps/s1",
             {{200, text(one)}, {200, text(named(sweep({job("1f0c000000000000", "done")}), "s1"))}});
  daemon_.on("GET /v1/sweeps/s2", text(two));
  daemon_.on("GET /v1/sweeps/s3",
             {{200, text(three)}, {200, text(named(sweep({job("3b0c000000000000", "cancelled")}), "s3"))}});
  daemon_.on("GET /v1/status", R"({"lcm": {"url": "", "ok": false, "message": "no multicast route"}})");
  const Outcome outcome = run({"watch"});
  EXPECT_EQ(outcome.code, ExitCode::kOk) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("1f0c0000 running"));
  EXPECT_THAT(outcome.out, HasSubstr("3b0c0000 queued"));
  EXPECT_THAT(outcome.out, HasSubstr("3b0c0000 cancelled"));
  EXPECT_THAT(outcome.out, Not(HasSubstr("2a0c0000"))) << "it has ended long ago";
}

TEST_F(Verbs, MovieOfWhatIsNotRunningHasNothingLive) {
  daemon_.on("GET /v1/jobs/1f0c", text({{"job", job("1f0c000000000000", "done")}}));
  EXPECT_THAT(test::said_with(ExitCode::kFailed, run({"movie", "1f0c", "--live"})),
              HasSubstr("job 1f0c0000 is done: nothing of it is live. `shaken movie 1f0c --frame last`"));
}

TEST_F(Verbs, WatchWithoutLiveStateAsksTheDaemonUntilTheEnd) {
  Json running = job("1f0c000000000000", "running");
  running["progress"] = {{"sim_time_s", 1.0}, {"sim_time_total_s", 4.0},   {"sim_rate", 0.5}, {"eta_s", 6.0},
                         {"order", 0.5},      {"order_running_mean", 0.4}, {"n_rods", 271},   {"max_overlap_mm", 0.01}};
  daemon_.on("GET /v1/status", R"({"lcm": {"url": "", "ok": false, "message": "no multicast route"}})");
  daemon_.on("GET /v1/sweeps/s1", {{200, text(sweep({running}))},
                                   {200, text(sweep({running}))},
                                   {200, text(sweep({job("1f0c000000000000", "done")}))}});
  const auto begin = std::chrono::steady_clock::now();
  const Outcome outcome = run({"watch", "s1"});
  EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(1900)) << "it asks once a second";
  EXPECT_EQ(outcome.code, ExitCode::kOk) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("no multicast route"));
  EXPECT_THAT(outcome.out, HasSubstr("1f0c0000 running  25.0 %  t 1.000/4.000 s  S 0.500 (mean 0.400)"));
  EXPECT_THAT(outcome.out, HasSubstr("1f0c0000 done 100.0 %  t 4.000/4.000 s  S 0.500"));
}

TEST_F(Verbs, WatchAsksTheDaemonWhatHasEnded) {
  // A message that anybody may have sent says "done"; the daemon does not.
  const std::string log = (root_.path() / "forged.log").string();
  {
    const auto bus = proto::Bus::open("file://" + log + "?mode=w");
    ASSERT_TRUE(bus);
    job_t forged{};
    forged.job_id = "1f0c000000000000";
    forged.state = "done";
    forged.reason = "\x1b]0;forged\x07";
    ASSERT_TRUE(bus.value()->publish(proto::kJobChannel, forged));
  }
  daemon_.on("GET /v1/sweeps/s1", {{200, text(sweep({job("1f0c000000000000", "running")}))},
                                   {200, text(sweep({job("1f0c000000000000", "running")}))},
                                   {200, text(sweep({job("1f0c000000000000", "running")}))},
                                   {200, text(sweep({job("1f0c000000000000", "failed")}))}});
  EXPECT_THAT(shown(run({"watch", "s1", "--lcm-url", "file://" + log + "?mode=r"})),
              AllOf(HasSubstr("1f0c0000 failed"), Not(HasSubstr("done")), Not(HasSubstr("forged"))));
}

TEST_F(Verbs, AReplayTakesAsLongAsItsLog) {
  const std::string log = (root_.path() / "job.log").string();
  const std::chrono::milliseconds apart(400);
  {
    const auto bus = proto::Bus::open("file://" + log + "?mode=w").value();
    for (int k = 0; k < 2; ++k) {
      if (k > 0) std::this_thread::sleep_for(apart);
      ASSERT_TRUE(bus->publish(proto::kJobChannel, job_t{}));
    }
  }
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THAT(run({"replay-log", log, "--lcm-url", "file://" + log + ".again?mode=w"}).err,
              HasSubstr("2 messages sent"));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, apart);
}

TEST_F(Verbs, NothingThatATerminalObeysIsPrinted) {
  const std::string evil = "e\x1b]0;title\x07\x7f\u009b2J\u202evil";
  Json failed = job("1f0c000000000000", "failed");
  failed["label"] = failed["reason"] = failed["directory"] = evil;
  failed["parameters"] = {{evil, evil}};
  Json one = sweep({failed});
  one["sweep"]["name"] = evil;
  const Json row{{"job", "1f0c000000000000"},    {"sweep", "s1"}, {"state", "failed"},        {"label", evil},
                 {"parameters", {{evil, evil}}}, {"replica", 1},  {"summary", {{evil, evil}}}};
  daemon_.on("GET /v1/status", text({{"version", evil}, {"host", evil}, {"lcm", {{"ok", false}, {"message", evil}}}}));
  daemon_.on("GET /v1/sweeps", text({{"sweeps", {one.at("sweep")}}}));
  daemon_.on("GET /v1/sweeps/s1", text(one));
  daemon_.on("GET /v1/jobs", text({{"jobs", {failed}}}));
  daemon_.on("GET /v1/jobs?state=failed", text({{"jobs", {failed}}}));
  daemon_.on("GET /v1/jobs?state=timed%20out", R"({"jobs": []})");
  daemon_.on("GET /v1/jobs/1f0c", text({{"job", failed}}));
  daemon_.on("GET /v1/jobs/1f0c000000000000", text({{"job", failed}}));
  daemon_.on("GET /v1/jobs/1f0c000000000000/log?offset=0",
             text({{"text", evil + "\n"}, {"offset", 9}, {"state", "failed"}, {"ended", true}}));
  daemon_.on("GET /v1/jobs/1f0c000000000000/log?offset=9",
             R"({"text": "", "offset": 9, "state": "failed", "ended": true})");
  daemon_.on("GET /v1/results?sweep=s1", text({{"rows", {row}}}));
  daemon_.on("POST /v1/sweeps/s1/cancel", R"({"cancelled": 0})");
  daemon_.on("GET /v1/sweeps/refused", {{400, text({{"error", evil}})}});
  const std::vector<std::vector<std::string>> commands{{"status"},
                                                       {"status", "s1"},
                                                       {"status", "1f0c"},
                                                       {"status", "--failed"},
                                                       {"status", "--json"},
                                                       {"status", "s1", "--json"},
                                                       {"logs", "1f0c"},
                                                       {"wait", "s1"},
                                                       {"watch", "s1"},
                                                       {"results", "s1", "--csv"},
                                                       {"results", "s1", "--json"},
                                                       {"results"},
                                                       {"cancel", "s1"},
                                                       {"status", "refused"},
                                                       {"results", "s1", "--columns", evil}};
  for (const std::vector<std::string>& command : commands) {
    const Outcome outcome = run(command);
    const std::string printed = outcome.out + outcome.err;
    EXPECT_EQ(printable(printed, Lines::kMany), printed) << command[0] << " " << command.back();
    EXPECT_THAT(printed, HasSubstr("vil")) << command[0];
  }
}

TEST_F(Verbs, CompletionOffersNothingThatAShellExpands) {
  Json sweeps = Json::array();
  for (const char* name : {"plain-1.5_Γ", "two words", "$(touch /tmp/x)", "$HOME", "`id`", "a;b", "a*", "~root",
                           "{a,b}", "'q'", "a\\b", "#a", "!a", "a>b"}) {
    Json one = sweep({}).at("sweep");
    one["name"] = name;
    sweeps.push_back(one);
  }
  daemon_.on("GET /v1/sweeps", text({{"sweeps", sweeps}}));
  daemon_.on("GET /v1/jobs", R"({"jobs": []})");
  EXPECT_EQ(run({"completion", "ids"}).out, "plain-1.5_Γ\ns1\ntwo words\n");
}

TEST_F(Verbs, CompletionKnowsTheIds) {
  daemon_.on("GET /v1/sweeps", text({{"sweeps", {sweep({}).at("sweep")}}}));
  daemon_.on("GET /v1/jobs", text({{"jobs", {job("1f0c000000000000", "done")}}}));
  EXPECT_EQ(run({"completion", "ids"}).out, "phases\ns1\n1f0c0000\n");
}

using std::chrono::seconds;
using testing::ElementsAre;
using testing::IsEmpty;

const std::string kRefused = "could not be started: sbatch: error: invalid partition. Next attempt at ";

std::vector<Json> jobs(int n, const std::string& state, const std::string& reason) {
  return std::vector<Json>(static_cast<std::size_t>(n),
                           Json{{"state", state}, {"ended", state == "failed"}, {"reason", reason}});
}

TEST(WaitingReasons, TellsEachOnceWhenItStands) {
  WaitingReasons reasons;
  const WaitingReasons::Clock::time_point start{};
  EXPECT_THAT(reasons.news(jobs(3, "queued", kRefused + "12:01"), start), IsEmpty()) << "it may be on its way";
  EXPECT_THAT(reasons.news(jobs(3, "queued", kRefused + "12:01"), start + seconds(3)),
              ElementsAre("3 jobs queued: " + kRefused + "12:01"));
  EXPECT_THAT(reasons.news({}, start + seconds(60)), IsEmpty());
  EXPECT_THAT(reasons.news(jobs(3, "queued", kRefused + "12:03"), start + seconds(62)), IsEmpty()) << "tried meanwhile";
  EXPECT_THAT(reasons.news(jobs(2, "queued", kRefused + "13:00"), start + seconds(200)), IsEmpty());
  EXPECT_THAT(reasons.news(jobs(2, "queued", kRefused + "13:00"), start + seconds(204)),
              ElementsAre("2 jobs queued: " + kRefused + "13:00"));
}

TEST(WaitingReasons, GroupsByWhatIsTheSameButForItsNumbers) {
  WaitingReasons reasons;
  std::vector<Json> all = jobs(1, "running", "waits as Slurm job 7_0 (Priority)");
  all.push_back(jobs(1, "running", "waits as Slurm job 7_11 (Priority)").front());
  all.push_back(jobs(1, "held", "held on request").front());
  all.push_back(jobs(1, "queued", "waits for s1: 3 of 4 done").front());
  all.push_back(jobs(1, "running", "").front());
  all.push_back(jobs(1, "failed", "exit 1").front());
  const WaitingReasons::Clock::time_point start{};
  reasons.news(all, start);
  EXPECT_THAT(reasons.news(all, start + seconds(5)),
              ElementsAre("2 jobs handed over: waits as Slurm job 7_0 (Priority)", "1 job held: held on request",
                          "1 job queued: waits for s1: 3 of 4 done"));
}

}  // namespace
}  // namespace shaken::client
