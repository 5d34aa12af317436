// The contract of docs/protocol.md, over a real socket.
#include "server/api.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <httplib.h>
#include <rapidcheck.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <sstream>
#include <thread>

#include "base/failure.h"
#include "run/files/directory.h"
#include "scene/canonical.h"
#include "scene/load.h"
#include "tests/support/effort.h"
#include "tests/support/good.h"
#include "tests/unit/server/server_support.h"

namespace shaken::server {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* kSweep =
    R"({"scene": {}, "sweep": {"grid": {"rods.length": [2.5, 3.5], "box.gap": [1.1, 1.2]}}})";

struct Response {
  int status = 0;
  Json json;
  std::string error() const { return json.value("error", ""); }
};

std::string done_summary(const std::string& id) {
  return R"({"run_id": ")" + id + R"(", "n_rods": 7, "exit": {"state": "done", "tick": 1000000000}})";
}

class ApiTest : public testing::Test {
 protected:
  ApiTest() { client_.set_address_family(AF_UNIX); }

  DaemonInfo info() const {
    DaemonInfo info;
    info.version = "1.2.3";
    info.host = "here";
    info.pid = 42;
    info.root = directory_.path();
    info.slots = 3;
    info.lcm_url = "memq://";
    info.lcm_ok = true;
    return info;
  }
  static Response read(const httplib::Result& result) {
    if (!result) return {0, {{"error", "no answer: " + httplib::to_string(result.error())}}};
    EXPECT_EQ(result->get_header_value("Content-Type"), "application/json");
    return {result->status, Json::parse(result->body)};
  }
  Response get(const std::string& path) { return read(client_.Get(path)); }
  Response post(const std::string& path) { return read(client_.Post(path)); }
  Response post(const std::string& path, const std::string& body) {
    return read(client_.Post(path, body, "application/json"));
  }
  Response submit(Json request) { return post("/v1/sweeps", request.dump()); }
  /// Submits kSweep; returns the ids of its four jobs.
  std::vector<std::string> submit_four(const std::string& name = "four") {
    std::vector<std::string> ids;
    const Response response = submit({{"text", kSweep}, {"name", name}});
    for (const Json& job : response.json["jobs"]) ids.push_back(job["id"]);
    return ids;
  }

  /// Runs a job to its end, which takes so long.
  void finish(const std::string& id, std::chrono::milliseconds wall = {}) {
    begin(queue_, id);
    queue_.add_wall(std::vector{std::pair{id, wall}});
    queue_.ended(id, JobEvent::kWorkerDone);
  }
  std::filesystem::path run_folder(const std::string& id) const { return directory_ / "runs" / id; }
  /// What a run leaves in its folder.
  void leave(const std::string& id, const std::string& name, const std::string& text) const {
    std::filesystem::create_directories(run_folder(id));
    write_text(run_folder(id) / name, text);
  }

  /// The part that jobs have in the work of their sweep s1.
  double part(std::initializer_list<std::string> ids) const {
    double work = 0, all = 0;
    for (const std::string& id : ids) work += queue_.job(id)->work;
    for (const Job& job : queue_.jobs(1, std::nullopt)) all += job.work;
    return work / all;
  }

  /// A bare connection.
  int connect() const {
    const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strcpy(address.sun_path, info().socket().c_str());
    EXPECT_EQ(::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
    const timeval limit{20, 0};
    setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof(limit));
    return fd;
  }
  /// Sends bytes as they are and goes away.
  void throw_in(const std::string& bytes) const {
    const int fd = connect();
    send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    close(fd);
  }
  /// Sends bytes as they are; returns all that comes back until the server closes.
  std::string exchange(const std::string& bytes) const {
    const int fd = connect();
    send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    return read_all(fd);
  }
  /// All that comes until the server closes; closes, too.
  static std::string read_all(int fd) {
    std::string answer;
    char buffer[4096];
    for (ssize_t n = 0; (n = recv(fd, buffer, sizeof(buffer), 0)) > 0;) {
      answer.append(buffer, static_cast<std::size_t>(n));
    }
    close(fd);
    return answer;
  }

  ScratchFolder directory_;
  Queue queue_{directory_ / "queue.db"};
  Api api_{queue_, info()};
  http::HttpServer server_{info().socket(), [this](const http::Request& request) { return api_.handle(request); }};
  httplib::Client client_{info().socket().string()};
};

TEST_F(ApiTest, StatusTellsAboutTheDaemon) {
  submit_four();
  const Response status = get("/v1/status");
  EXPECT_EQ(status.status, 200);
  EXPECT_EQ(status.json["version"], "1.2.3");
  EXPECT_EQ(status.json["api"], 1);
  EXPECT_EQ(status.json["pid"], 42);
  EXPECT_EQ(status.json["root"], directory_.path().string());
  EXPECT_EQ(status.json["host"], "here");
  EXPECT_GE(status.json["uptime_s"], 0.0);
  EXPECT_EQ(status.json["slots"], 3);
  EXPECT_EQ(status.json["lcm"], Json({{"url", "memq://"}, {"ok", true}, {"message", ""}}));
  EXPECT_EQ(status.json["jobs"].dump(),
            R"({"queued":4,"held":0,"running":0,"stopping":0,"done":0,"failed":0,"timed out":0,"cancelled":0})");
}

TEST_F(ApiTest, TheSocketIsPrivate) {
  struct stat info_of_socket {};
  ASSERT_EQ(stat(info().socket().c_str(), &info_of_socket), 0);
  EXPECT_EQ(info_of_socket.st_mode & 0777U, 0600U);
}

TEST_F(ApiTest, AnotherUserIsRefusedEvenWhereTheSocketIsOpen) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can be another user";
  std::filesystem::permissions(directory_.path(), std::filesystem::perms::all);
  std::filesystem::permissions(info().socket(), std::filesystem::perms::all);
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    constexpr uid_t kNobody = 65534;
    if (setuid(kNobody) != 0) _exit(1);
    const std::string answer = exchange("GET /v1/status HTTP/1.1\r\n\r\n");
    _exit(write(ends[1], answer.data(), answer.size()) < 0 ? 1 : 0);
  }
  int status = -1;
  waitpid(child, &status, 0);
  close(ends[1]);
  EXPECT_EQ(status, 0);
  std::string answer(4096, '\0');
  answer.resize(static_cast<std::size_t>(std::max<ssize_t>(0, ::read(ends[0], answer.data(), answer.size()))));
  close(ends[0]);
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(answer, HasSubstr("another user"));
  EXPECT_EQ(get("/v1/status").status, 200) << "its own user";
}

TEST_F(ApiTest, ASubmitAnswersWithSweepJobsAndCounts) {
  const Response response = submit({{"text", kSweep}, {"file", "folder/grid.json"}});
  EXPECT_EQ(response.status, 201);
  const Json& sweep = response.json["sweep"];
  EXPECT_EQ(sweep["id"], "s1");
  EXPECT_EQ(sweep["name"], "grid");
  EXPECT_EQ(sweep["n_jobs"], 4);
  EXPECT_EQ(sweep["n_ended"], 0);
  EXPECT_EQ(sweep["counts"]["queued"], 4);
  EXPECT_EQ(sweep["progress"], 0.0);
  EXPECT_EQ(sweep["eta_s"], -1.0);
  EXPECT_GT(sweep["created_utime"], 1'600'000'000'000'000);
  EXPECT_EQ(response.json["counts"]["new"], 4);
  EXPECT_EQ(response.json["counts"]["queued"], 4);

  ASSERT_EQ(response.json["jobs"].size(), 4U);
  const Json& job = response.json["jobs"][1];
  EXPECT_EQ(job["id"].get<std::string>().size(), 16U);
  EXPECT_EQ(job["sweep"], "s1");
  EXPECT_EQ(job["state"], "queued");
  EXPECT_EQ(job["label"], "rods.length=2.5 box.gap=1.2");
  EXPECT_EQ(job["parameters"], Json({{"rods.length", 2.5}, {"box.gap", 1.2}}));
  EXPECT_EQ(job["attempt"], 0);
  EXPECT_EQ(job["directory"], (directory_ / "runs" / job["id"].get<std::string>()).string());
  EXPECT_TRUE(job["progress"].is_null());
}

TEST_F(ApiTest, TheSameSubmitAgainDoesNothingTwice) {
  const auto ids = submit_four();
  begin(queue_, ids[0]);
  begin(queue_, ids[1]);
  leave(ids[1], "summary.json", done_summary(ids[1]));
  queue_.ended(ids[1], JobEvent::kWorkerDone);
  begin(queue_, ids[2]);
  queue_.ended(ids[2], JobEvent::kWorkerFailed, "why");

  const Response again = submit({{"text", kSweep}, {"name", "four"}});
  EXPECT_EQ(again.status, 200);
  EXPECT_EQ(again.json["sweep"]["id"], "s1");
  EXPECT_EQ(
      again.json["counts"].dump(),
      R"({"queued":2,"held":0,"running":1,"stopping":0,"done":1,"failed":0,"timed out":0,"cancelled":0,"new":0,"requeued":1,"extended":0,"found":0})");

  // A done job whose results were deleted is done again.
  std::filesystem::remove_all(run_folder(ids[1]));
  EXPECT_EQ(submit({{"text", kSweep}, {"name", "four"}}).json["counts"]["requeued"], 1);
}

TEST_F(ApiTest, ADoneJobWhoseResultsAreDamagedOrAnothersIsDoneAgain) {
  const std::string id = submit_four()[0];
  std::filesystem::create_directories(directory_ / "runs" / id);
  for (const std::string& damaged :
       {std::string(), std::string("{torn"), std::string("{}"), done_summary("fedcba9876543210")}) {
    write_text(directory_ / "runs" / id / "summary.json", damaged);
    finish(id);
    EXPECT_TRUE(get("/v1/results?state=done").json["rows"][0]["summary"].is_null()) << damaged;
    EXPECT_EQ(submit({{"text", kSweep}, {"name", "four"}}).json["counts"]["requeued"], 1) << damaged;
  }
}

TEST_F(ApiTest, ASummaryNestedTooDeepIsNoDanger) {
  const std::string id = submit_four()[0];
  leave(id, "summary.json",
        R"({"run_id": ")" + id + R"(", "n_rods": 7, "deep": )" + std::string(200'000, '[') + std::string(200'000, ']') +
            "}");
  finish(id);
  EXPECT_EQ(get("/v1/results?state=done").json["rows"][0]["summary"]["n_rods"], 7);
}

TEST_F(ApiTest, JobsAreHeldResumedRetriedAndPutFirst) {
  const auto ids = submit_four();
  EXPECT_EQ(post("/v1/jobs/" + ids[1] + "/hold").json.dump(), R"({"held":1})");
  EXPECT_EQ(get("/v1/jobs/" + ids[1]).json["job"]["state"], "held");
  EXPECT_EQ(get("/v1/jobs/" + ids[1]).json["job"]["ended"], false) << "whoever waits for it waits on";
  EXPECT_EQ(get("/v1/jobs/" + ids[1]).json["job"]["reason"], "held on request");
  EXPECT_EQ(post("/v1/sweeps/s1/hold").json.dump(), R"({"held":3})");
  EXPECT_TRUE(queue_.next(10).empty());
  EXPECT_EQ(post("/v1/jobs/" + ids[1] + "/resume").json.dump(), R"({"resumed":1})");
  EXPECT_EQ(post("/v1/jobs/" + ids[1] + "/resume").json.dump(), R"({"resumed":0})");
  EXPECT_EQ(post("/v1/sweeps/s1/resume").json.dump(), R"({"resumed":3})");
  EXPECT_EQ(post("/v1/jobs/" + ids[3] + "/priority", R"({"priority": 5})").json.dump(), R"({"changed":1})");
  EXPECT_EQ(queue_.next(1).at(0).id, ids[3]);
  EXPECT_EQ(post("/v1/jobs/" + ids[3] + "/priority", R"({"priority": "high"})").status, 400);
  EXPECT_EQ(post("/v1/jobs/" + ids[3] + "/priority", R"({"prio": 5})").status, 400);
  begin(queue_, ids[0]);
  queue_.ended(ids[0], JobEvent::kWorkerFailed, "why");
  queue_.cancel(ids[2]);
  EXPECT_EQ(post("/v1/sweeps/s1/resume").json.dump(), R"({"resumed":0})");
  EXPECT_EQ(post("/v1/sweeps/s1/retry").json.dump(), R"({"retried":2})");
  EXPECT_EQ(queue_.counts()[JobState::kQueued], 4);
  const Json changes = get("/v1/jobs/" + ids[0] + "/history").json["changes"];
  EXPECT_EQ(changes.front()["to"], "queued");
  EXPECT_EQ(changes.back()["cause"], "retried on request");
  EXPECT_EQ(changes[changes.size() - 2]["cause"], "why");
}

TEST_F(ApiTest, RunsAreExtended) {
  const auto ids = submit_four();
  EXPECT_EQ(post("/v1/sweeps/s1/extend", R"({"measure": "20 s"})").json.dump(), R"({"extended":4})");
  EXPECT_EQ(post("/v1/sweeps/s1/extend", R"({"measure": 15})").json.dump(), R"({"extended":0})");
  EXPECT_EQ(post("/v1/jobs/" + ids[0] + "/extend", R"({"order_sem": 0.001, "at_most": "1 h"})").json.dump(),
            R"({"extended":1})");
  const auto plan = scene::load_scene(queue_.scene(ids[0]), "f");
  EXPECT_EQ(plan->measure_time, 20);
  EXPECT_EQ(plan->until, (scene::Until{0.001, 3600}));
  EXPECT_EQ(post("/v1/jobs/" + ids[0] + "/extend", "{}").status, 400);
  EXPECT_EQ(post("/v1/jobs/" + ids[0] + "/extend", R"({"measure": [1]})").status, 400);
  EXPECT_EQ(post("/v1/jobs/" + ids[0] + "/extend", R"({"mesure": 1})").status, 400);
  const Response wrong = post("/v1/sweeps/s1/extend", R"({"measure": "20 mm"})");
  EXPECT_EQ(wrong.status, 422);
  EXPECT_EQ(wrong.json["problems"].size(), 1U);
}

// One that is longer already does not keep the others from going on.
TEST_F(ApiTest, OfASweepThoseJobsAreExtendedThatCanBe) {
  const auto ids = submit_four();
  post("/v1/jobs/" + ids[0] + "/extend", R"({"measure": "60 s"})");
  const Response some = post("/v1/sweeps/s1/extend", R"({"order_sem": 0.001, "at_most": "40 s"})");
  EXPECT_EQ(some.status, 200);
  EXPECT_EQ(some.json["extended"], 3);
  ASSERT_EQ(some.json["refused"].size(), 1U);
  EXPECT_EQ(some.json["refused"][0]["job"], ids[0]);
  EXPECT_EQ(some.json["refused"][0]["reason"], "until.at_most 40 s is shorter than time.measure 60 s");
  const Response none = post("/v1/jobs/" + ids[0] + "/extend", R"({"order_sem": 0.001, "at_most": "40 s"})");
  EXPECT_EQ(none.status, 422);
  EXPECT_EQ(none.json["error"],
            "job " + ids[0] + ": /until/at_most: until.at_most 40 s is shorter than time.measure 60 s");
}

TEST_F(ApiTest, TimeLimitsAreTakenAndShown) {
  const Json job = submit({{"text", "{}"}, {"soft_limit_s", 600}, {"time_limit_s", 7200.5}}).json["jobs"][0];
  EXPECT_EQ(job["soft_limit_s"], 600.0);
  EXPECT_EQ(job["time_limit_s"], 7200.5);
  EXPECT_EQ(job["wall_s"], 0.0);
  const std::string id = job["id"];
  begin(queue_, id);
  queue_.add_wall(std::vector{std::pair(id, std::chrono::milliseconds(1500))});
  queue_.time_out(id);
  queue_.ended(id, JobEvent::kWorkerStopped, "checkpoint");
  const Json ended = get("/v1/jobs?state=timed%20out").json["jobs"][0];
  EXPECT_EQ(ended["state"], "timed out");
  EXPECT_EQ(ended["ended"], true);
  EXPECT_EQ(get("/v1/sweeps").json["sweeps"][0]["n_ended"], 1);
  EXPECT_EQ(ended["wall_s"], 1.5);
  EXPECT_EQ(ended["reason"], "it ran for 2 h 00 min, its time limit; `shaken retry` gives it as much again");

  const Json again = submit({{"text", "{}"}}).json["jobs"][0];
  EXPECT_TRUE(again["time_limit_s"].is_null()) << "the last submission decides";
  EXPECT_EQ(again["state"], "queued");
}

TEST_F(ApiTest, TermsOfASweepAreTakenAndShown) {
  const auto ids = submit_four("first");
  const Response second = submit({{"text", "{}"},
                                  {"name", "second"},
                                  {"after", {"first", ids[0].substr(0, 8)}},
                                  {"at_most", 3},
                                  {"stop_if", "failed > 10%"}});
  ASSERT_EQ(second.status, 201) << second.error();
  const Json& sweep = second.json["sweep"];
  EXPECT_EQ(sweep["at_most"], 3);
  EXPECT_EQ(sweep["after"], Json({"s1", ids[0]}));
  EXPECT_EQ(sweep["stop_if"], "failed>10%");
  EXPECT_EQ(sweep["stopped"], false);
  EXPECT_EQ(second.json["jobs"][0]["reason"], "waits for s1: 0 of 4 done, " + ids[0]);
  EXPECT_TRUE(get("/v1/sweeps/s1").json["sweep"]["at_most"].is_null());
  EXPECT_TRUE(get("/v1/sweeps/s1").json["sweep"]["stop_if"].is_null());

  EXPECT_EQ(submit({{"text", "{}"}, {"after", {"third"}}}).status, 404);
  EXPECT_THAT(test::said_with(409, submit({{"text", kSweep}, {"name", "circle"}, {"after", {"second"}}})),
              HasSubstr("wait for themselves"));
  EXPECT_EQ(get("/v1/sweeps").json["sweeps"].size(), 2U);
}

TEST_F(ApiTest, ResultsThatAreThereAreFoundByANewQueue) {
  const std::string id = submit_four()[0];
  leave(id, "summary.json", done_summary(id));
  Queue empty(directory_ / "empty.db");
  const Api api(empty, info());
  const http::Reply reply = api.handle({"POST", "/v1/sweeps", {}, Json({{"text", kSweep}}).dump()});
  const Json answer = Json::parse(reply.body);
  EXPECT_EQ(answer["counts"]["found"], 1);
  EXPECT_EQ(answer["counts"]["new"], 3);
  EXPECT_EQ(answer["jobs"][0]["state"], "done");
  EXPECT_EQ(answer["jobs"][0]["attempt"], 0) << "it was not run";
  EXPECT_EQ(empty.history(id).at(0).cause, "submitted in s1; its results were there already");
}

TEST_F(ApiTest, CleaningRemovesWhatFitsAndWhatItIsAllowedTo) {
  const auto ids = submit_four();
  const auto runs = directory_ / "runs";
  for (const std::string& id : ids) {
    std::filesystem::create_directories(runs / id / "inner");
    write_text(runs / id / "inner" / "file", std::string(1000, 'x'));
  }
  write_text(directory_ / "precious", "precious");
  std::filesystem::create_symlink(directory_ / "precious", runs / ids[0] / "link");
  const std::string unknown(16, '7');
  std::filesystem::create_directories(runs / unknown);
  std::filesystem::create_directories(runs / "notes");
  std::filesystem::create_directory_symlink(directory_.path(), runs / std::string(16, '8'));
  begin(queue_, ids[0]);
  queue_.ended(ids[0], JobEvent::kWorkerFailed, "why");
  queue_.cancel(ids[1]);
  finish(ids[2]);

  const Json dry = post("/v1/clean", R"({"dry_run": true})").json;
  ASSERT_EQ(dry["runs"].size(), 3U) << dry;
  EXPECT_EQ(dry["bytes"], 2000) << "of failed and cancelled jobs; done ones are asked for by name";
  EXPECT_EQ(dry["runs"][0]["id"] == unknown, !dry["runs"][0]["known"].get<bool>());
  EXPECT_TRUE(std::filesystem::exists(runs / ids[0]));
  EXPECT_EQ(post("/v1/clean", R"({"older_s": 3600})").json["runs"].size(), 0U) << "all of it is young";

  Json body{{"states", {"failed"}}, {"sweep", "s1"}};
  const Json cleaned = post("/v1/clean", body.dump()).json;
  ASSERT_EQ(cleaned["runs"].size(), 1U);
  EXPECT_EQ(cleaned["runs"][0]["removed"], true);
  EXPECT_EQ(cleaned["bytes"], 1000);
  EXPECT_FALSE(std::filesystem::exists(runs / ids[0]));
  EXPECT_EQ(read_text(directory_ / "precious"), "precious");
  const Json job = get("/v1/jobs/" + ids[0]).json["job"];
  EXPECT_EQ(job["state"], "cancelled");
  EXPECT_EQ(job["reason"], "cleaned on request");
  EXPECT_EQ(get("/v1/jobs/" + ids[0] + "/history").json["changes"].back()["cause"], "cleaned on request");

  // One that somebody uses stays, and so does its job's state.
  {
    const auto lock = run::DirectoryLock::acquire(runs / ids[2] / "lock");
    const Json kept = post("/v1/clean", R"({"states": ["done"]})").json;
    ASSERT_EQ(kept["runs"].size(), 2U);
    for (const Json& run : kept["runs"]) EXPECT_EQ(run["removed"], false);
    EXPECT_TRUE(std::filesystem::exists(runs / ids[2]));
    EXPECT_EQ(queue_.job(ids[2])->state, JobState::kDone);
  }
  // A lock that is a link would be written through.
  std::filesystem::remove(runs / ids[2] / "lock");
  std::filesystem::create_symlink(directory_ / "precious", runs / ids[2] / "lock");
  EXPECT_EQ(post("/v1/clean", R"({"states": ["done"]})").json["bytes"], 0);
  EXPECT_EQ(read_text(directory_ / "precious"), "precious");
  std::filesystem::remove(runs / ids[2] / "lock");

  std::filesystem::create_directories(runs / (".leaving-" + unknown));  // by a daemon that was killed meanwhile
  body = {{"states", {"done", "cancelled"}}, {"unknown", true}, {"only", {ids[2], unknown, "../precious", ids[3]}}};
  EXPECT_EQ(post("/v1/clean", body.dump()).json["bytes"], 1000);
  EXPECT_FALSE(std::filesystem::exists(runs / ids[2]));
  EXPECT_FALSE(std::filesystem::exists(runs / unknown));
  EXPECT_FALSE(std::filesystem::exists(runs / (".leaving-" + unknown)));
  EXPECT_TRUE(std::filesystem::exists(runs / ids[1])) << "it was not named";
  EXPECT_TRUE(std::filesystem::exists(runs / ids[3])) << "it has not ended";
  EXPECT_TRUE(std::filesystem::exists(runs / "notes"));
  EXPECT_TRUE(std::filesystem::is_symlink(runs / std::string(16, '8')));
  EXPECT_TRUE(std::filesystem::exists(directory_ / "precious"));
  EXPECT_EQ(submit({{"text", kSweep}, {"name", "four"}}).json["counts"]["requeued"], 3) << "to be done anew";
}

TEST_F(ApiTest, ARequestToCleanThatIsWrongRemovesNothing) {
  for (const char* body : {"[]", R"({"states": ["running"]})", R"({"states": "failed"})", R"({"older_s": "30d"})",
                           R"({"dryrun": true})", R"({"dry_run": 1})", R"({"only": "x"})"}) {
    EXPECT_EQ(post("/v1/clean", body).status, 400) << body;
  }
  EXPECT_EQ(post("/v1/clean", R"({"sweep": "nobody"})").status, 404);
}

TEST_F(ApiTest, SettingsAndReplicasAreApplied) {
  const Response response =
      submit({{"text", "{}"}, {"settings", {"rods.length=2.5,4.5", "box.gap=1.3"}}, {"replicas", 2}});
  ASSERT_EQ(response.status, 201) << response.error();
  EXPECT_EQ(response.json["jobs"].size(), 4U);
  EXPECT_EQ(response.json["jobs"][0]["replica"], 1);
  EXPECT_EQ(response.json["jobs"][1]["replica"], 2);
}

TEST_F(ApiTest, ARefusedSceneListsAllProblemsAndQueuesNothing) {
  const Response response =
      submit({{"text", "{\n  \"rodz\": {},\n  \"box\": {\"gap\": \"1 kg\"}\n}"}, {"file", "my.json"}});
  EXPECT_EQ(response.status, 422);
  ASSERT_EQ(response.json["problems"].size(), 2U);
  const Json& problem = response.json["problems"][0];
  EXPECT_EQ(problem["file"], "my.json");
  EXPECT_EQ(problem["line"], 2);
  EXPECT_EQ(problem["column"], 3);
  EXPECT_EQ(problem["path"], "/rodz");
  EXPECT_THAT(problem["message"].get<std::string>(), HasSubstr("did you mean rods?"));
  EXPECT_THAT(response.error(), StartsWith("2 problems; the first: my.json:2:3: /rodz: "));
  EXPECT_EQ(queue_.counts().total(), 0);
  EXPECT_TRUE(queue_.sweeps().empty());
}

TEST_F(ApiTest, ADryRunChecksEverythingAndQueuesNothing) {
  const Response good = submit({{"text", kSweep}, {"name", "dry"}, {"replicas", 3}, {"dry_run", true}});
  EXPECT_EQ(good.status, 200);
  EXPECT_EQ(good.json["name"], "dry");
  EXPECT_EQ(good.json["n_jobs"], 12);
  EXPECT_EQ(good.json["n_done"], 0);
  EXPECT_GT(good.json["n_rods"][0], 0);
  EXPECT_GT(good.json["n_rods"][1], good.json["n_rods"][0]);
  EXPECT_GT(good.json["simulated_s"], 0);
  const Response bad = submit({{"text", R"({"rodz": {}, "box": {"gap": "1 kg"}})"}, {"dry_run", true}});
  EXPECT_EQ(bad.status, 422);
  EXPECT_EQ(bad.json["problems"].size(), 2u);
  EXPECT_EQ(submit({{"text", R"({"start": {"run": "0123456789abcdef", "time": "1 s"}})"}, {"dry_run", true}}).status,
            422);
  EXPECT_TRUE(get("/v1/sweeps").json["sweeps"].empty());
}

TEST_F(ApiTest, ABodyThatIsNoRequestIsRefused) {
  for (const char* body : {"", "hello", "[]", "{}", R"({"text": 3})", R"({"text": "{}", "nam": "x"})"}) {
    const Response response = post("/v1/sweeps", body);
    EXPECT_EQ(response.status, 400) << body;
    EXPECT_FALSE(response.error().empty()) << body;
  }
}

TEST_F(ApiTest, SweepsAreFoundByIdAndByName) {
  submit_four("first");
  submit_four("second");
  const Response list = get("/v1/sweeps");
  ASSERT_EQ(list.json["sweeps"].size(), 2U);
  EXPECT_EQ(list.json["sweeps"][1]["name"], "second");
  EXPECT_EQ(get("/v1/sweeps/s1").json["sweep"]["name"], "first");
  EXPECT_EQ(get("/v1/sweeps/second").json["sweep"]["id"], "s2");
  EXPECT_EQ(get("/v1/sweeps/second").json["jobs"].size(), 4U);
  EXPECT_EQ(get("/v1/sweeps/secnd").status, 404);
  EXPECT_THAT(get("/v1/sweeps/secnd").error(), HasSubstr("did you mean second?"));
  EXPECT_EQ(get("/v1/sweeps/s9").status, 404);
}

TEST_F(ApiTest, JobsAreFilteredBySweepAndState) {
  const auto ids = submit_four("first");
  submit({{"text", "{}"}, {"name", "plain"}});
  begin(queue_, ids[2]);
  EXPECT_EQ(get("/v1/jobs").json["jobs"].size(), 5U);
  EXPECT_EQ(get("/v1/jobs?sweep=first").json["jobs"].size(), 4U);
  EXPECT_EQ(get("/v1/jobs?sweep=s2").json["jobs"].size(), 1U);
  EXPECT_EQ(get("/v1/jobs?state=running").json["jobs"][0]["id"], ids[2]);
  EXPECT_EQ(get("/v1/jobs?state=running&sweep=plain").json["jobs"].size(), 0U);
  EXPECT_EQ(get("/v1/jobs?state=runing").status, 400);
  EXPECT_THAT(get("/v1/jobs?state=runing").error(), HasSubstr("queued, held, running"));
  EXPECT_THAT(get("/v1/jobs?stat=running").error(), HasSubstr("did you mean state?"));
  EXPECT_EQ(get("/v1/jobs?sweep=nobody").status, 404);
}

TEST_F(ApiTest, AJobIsFoundByAnyPrefixThatFitsOnlyOne) {
  for (const char* id : {"abcd000000000000", "abce000000000000", "f000000000000000"}) {
    NewJob job = new_job('0');
    job.id = id;
    queue_.submit(id, 0, std::vector{job});
  }
  EXPECT_EQ(get("/v1/jobs/f").json["job"]["id"], "f000000000000000");
  EXPECT_EQ(get("/v1/jobs/abcd").json["job"]["id"], "abcd000000000000");
  EXPECT_EQ(get("/v1/jobs/abcd000000000000").status, 200);
  EXPECT_EQ(get("/v1/jobs/abc").status, 409);
  EXPECT_EQ(get("/v1/jobs/abc").error(), "'abc' fits several jobs: abcd000000000000, abce000000000000");
  EXPECT_EQ(get("/v1/jobs/abcx000").status, 404);
  EXPECT_THAT(get("/v1/jobs/abdc00000000000").error(), HasSubstr("did you mean abcd000000000000?"));
  std::vector<NewJob> many(12, new_job('0'));
  for (std::size_t k = 0; k < many.size(); ++k) many[k].id = fmt::format("e{:015x}", k);
  queue_.submit("many", 0, many);
  EXPECT_THAT(get("/v1/jobs/e").error(), EndsWith("e000000000000008, e000000000000009, ..."));
}

/// The progress of a run that is half done, with `eta` seconds to go.
void write_progress(const std::filesystem::path& file, double eta = 10) {
  std::filesystem::create_directories(file.parent_path());
  write_text(file, fmt::format(R"({{"state": "running", "message": "", "pid": 1, "n_rods": 9, "fraction": 0.5,
                                    "sim_time_s": 1, "sim_time_total_s": 2, "sim_rate": 0.1, "eta_s": {}, "order": 0.25,
                                    "order_running_mean": 0.2, "max_overlap_mm": 0}})",
                               eta));
}

TEST_F(ApiTest, ARunningJobShowsItsProgress) {
  const auto ids = submit_four();
  begin(queue_, ids[0]);
  EXPECT_TRUE(get("/v1/jobs/" + ids[0]).json["job"]["progress"].is_null());
  const auto file = run_folder(ids[0]) / "progress.json";
  write_progress(file);
  EXPECT_EQ(get("/v1/jobs/" + ids[0]).json["job"]["progress"]["order"], 0.25);
  EXPECT_DOUBLE_EQ(get("/v1/sweeps/s1").json["sweep"]["progress"].get<double>(), 0.5 * part({ids[0]}));
  EXPECT_EQ(get("/v1/sweeps/s1").json["sweep"]["eta_s"], -1.0) << "nothing is known of the queued ones yet";
  submit({{"text", R"({"rods": {"length": 3.25}})"}, {"name", "held"}});
  EXPECT_EQ(post("/v1/sweeps/held/hold").status, 200);
  EXPECT_EQ(get("/v1/sweeps/held").json["sweep"]["eta_s"], -1.0) << "what is held has no end in sight";

  finish(ids[1]);
  queue_.cancel(ids[2]);
  queue_.cancel(ids[3]);
  const Json sweep = get("/v1/sweeps/s1").json["sweep"];
  EXPECT_DOUBLE_EQ(sweep["progress"].get<double>(), 0.5 * part({ids[0]}) + part({ids[1]}))
      << "one done, one half, two that came to nothing";
  EXPECT_EQ(sweep["eta_s"], 10.0);
  write_progress(file, 0.5);
  EXPECT_EQ(get("/v1/sweeps/s1").json["sweep"]["eta_s"], 0.5);

  write_text(file, "{torn");
  EXPECT_TRUE(get("/v1/jobs/" + ids[0]).json["job"]["progress"].is_null());
}

/// `file` is as old as if it was written before or after now.
void set_age(const std::filesystem::path& file, std::chrono::seconds age) {
  std::filesystem::last_write_time(file, std::filesystem::file_time_type::clock::now() - age);
}

// Until the daemon looks at its worker, or Slurm's task has told, a run that is done is `running` still.
TEST_F(ApiTest, ProgressNeverFallsWhileTheEndOfARunIsNotSeenYet) {
  const auto ids = submit_four();
  begin(queue_, ids[0]);
  const auto folder = run_folder(ids[0]);
  std::filesystem::create_directories(folder);
  write_text(folder / "scene.json", "{}");
  write_text(folder / "progress.json",
             R"({"state": "done", "message": "", "pid": 7, "n_rods": 4, "sim_time_s": 2,
                 "sim_time_total_s": 2, "sim_rate": 0.1, "eta_s": 0, "order": 0.25, "order_running_mean": 0.2,
                 "max_overlap_mm": 0})");
  set_age(folder / "scene.json", std::chrono::seconds(100));
  set_age(folder / "progress.json", std::chrono::seconds(50));
  EXPECT_EQ(get("/v1/jobs/" + ids[0]).json["job"]["progress"]["sim_time_s"], 2);
  EXPECT_DOUBLE_EQ(get("/v1/sweeps/s1").json["sweep"]["progress"].get<double>(), part({ids[0]}));
  // the daemon has started it anew since, for it was extended
  set_age(folder / "scene.json", std::chrono::seconds(20));
  EXPECT_TRUE(get("/v1/jobs/" + ids[0]).json["job"]["progress"].is_null());
  EXPECT_EQ(get("/v1/sweeps/s1").json["sweep"]["progress"], 0.0);
}

TEST_F(ApiTest, WhatARunHasDoneCountsWhileItIsHandedOn) {
  const auto ids = submit_four();
  begin(queue_, ids[0]);
  write_progress(run_folder(ids[0]) / "progress.json");
  const double half = 0.5 * part({ids[0]});
  EXPECT_DOUBLE_EQ(get("/v1/sweeps/s1").json["sweep"]["progress"].get<double>(), half);
  queue_.ended(ids[0], JobEvent::kWorkerStopped, "its task is over");
  EXPECT_DOUBLE_EQ(get("/v1/sweeps/s1").json["sweep"]["progress"].get<double>(), half);
  EXPECT_DOUBLE_EQ(get("/v1/sweeps").json["sweeps"][0]["progress"].get<double>(), half);
}

TEST_F(ApiTest, ARunThatTellsOfItsWorkDoesNotWaitForItsTurn) {
  const auto ids = submit_four();
  begin(queue_, ids[0]);
  queue_.set_notes(std::vector{std::pair{ids[0], std::string("waits as Slurm job 7_0 (Priority)")}});
  const auto reason = [&] { return get("/v1/jobs/" + ids[0]).json["job"]["reason"]; };
  const auto folder = run_folder(ids[0]);
  write_progress(folder / "progress.json");
  write_text(folder / "scene.json", "{}");
  set_age(folder / "progress.json", std::chrono::seconds(100));
  EXPECT_EQ(reason(), "waits as Slurm job 7_0 (Priority)") << "that was the attempt before";
  set_age(folder / "scene.json", std::chrono::seconds(200));
  EXPECT_EQ(reason(), "waits as Slurm job 7_0 (Priority)") << "its node has failed, it waits for another";
  set_age(folder / "progress.json", std::chrono::seconds(1));
  EXPECT_EQ(reason(), "");
}

// As in a cluster, where runs that are handed over wait for nodes.
TEST_F(ApiTest, RunsThatWaitElsewhereCountAsWaitingForThoseAtWork) {
  const auto ids = submit_four();
  finish(ids[0], std::chrono::milliseconds(30'000));
  for (const auto& id : {ids[1], ids[2], ids[3]}) begin(queue_, id);
  EXPECT_EQ(get("/v1/sweeps/s1").json["sweep"]["eta_s"], -1.0) << "none is at work";
  const auto file = run_folder(ids[1]) / "progress.json";
  write_progress(file);
  EXPECT_DOUBLE_EQ(get("/v1/sweeps/s1").json["sweep"]["eta_s"].get<double>(),
                   10.0 + 30.0 * part({ids[2], ids[3]}) / part({ids[0]}))
      << "one after the other";
}

// As in a chain whose first stage is short.
TEST_F(ApiTest, ProgressAndEtaOfASweepCountItsWorkAndNotItsJobs) {
  std::vector<NewJob> jobs;
  for (const auto& [digit, rods, seconds] : {std::tuple{'1', 10, 20}, {'2', 10, 20}, {'3', 30, 100}, {'4', 30, 100}}) {
    jobs.push_back(new_job(digit));
    jobs.back().scene =
        fmt::format(R"({{"rods": {{"count": {}}}, "rods_2": {{"count": 10}}, "time": {{"steady": 5, "measure": {}}}}})",
                    rods, seconds - 5);
  }
  queue_.submit("chains", 0, jobs);
  for (const int k : {0, 1}) {
    finish(jobs[k].id, std::chrono::milliseconds(40'000));
  }
  const auto sweep = [&] { return get("/v1/sweeps/s1").json["sweep"]; };
  EXPECT_DOUBLE_EQ(sweep()["progress"].get<double>(), 800.0 / 8800.0);
  EXPECT_DOUBLE_EQ(sweep()["eta_s"].get<double>(), 4000 * 0.1) << "side by side in three slots";
  begin(queue_, jobs[2].id);
  write_progress(directory_ / "runs" / jobs[2].id / "progress.json");
  EXPECT_DOUBLE_EQ(sweep()["progress"].get<double>(), 2800.0 / 8800.0) << "half of the third";
  EXPECT_DOUBLE_EQ(sweep()["eta_s"].get<double>(), 4000 * 0.1) << "of the fourth";
  queue_.ended(jobs[2].id, JobEvent::kWorkerStopped);
  EXPECT_DOUBLE_EQ(sweep()["eta_s"].get<double>(), 4000 * 0.1) << "of the fourth";
  queue_.cancel(jobs[3].id);
  EXPECT_DOUBLE_EQ(sweep()["eta_s"].get<double>(), 2000 * 0.1 / 3) << "it goes on from where it was";
  queue_.retry(jobs[3].id);
  // asked for more
  std::string scene = jobs[3].scene;
  scene.replace(scene.find("95"), 2, "195");
  queue_.extend(std::vector{std::pair{jobs[3].id, scene}});
  EXPECT_DOUBLE_EQ(sweep()["progress"].get<double>(), 2800.0 / 12800.0);
}

TEST_F(ApiTest, EtaCountsWhatOtherSweepsHaveBeforeIt) {
  const auto submit = [&](const std::string& name, int priority, const std::string& digits) {
    std::vector<NewJob> jobs;
    for (const char digit : digits) {
      jobs.push_back(new_job(digit));
      jobs.back().scene = R"({"rods": {"count": 10}, "time": {"measure": 10}})";
    }
    queue_.submit(name, priority, jobs);
    return jobs;
  };
  const auto ours = submit("ours", 0, "1234");
  finish(ours[0].id, std::chrono::milliseconds(30'000));
  const auto eta = [&] { return get("/v1/sweeps/ours").json["sweep"]["eta_s"].get<double>(); };
  const auto eta_in_the_list = [&] { return get("/v1/sweeps").json["sweeps"][0]["eta_s"].get<double>(); };
  EXPECT_DOUBLE_EQ(eta(), 3 * 30.0 / 3);
  submit("later", 0, "56");
  EXPECT_DOUBLE_EQ(eta(), 3 * 30.0 / 3) << "their turn is later";
  const auto sooner = submit("sooner", 1, "789");
  EXPECT_DOUBLE_EQ(eta(), 6 * 30.0 / 3);
  EXPECT_DOUBLE_EQ(eta_in_the_list(), 6 * 30.0 / 3);
  begin(queue_, sooner[0].id);
  write_progress(directory_ / "runs" / sooner[0].id / "progress.json");
  EXPECT_DOUBLE_EQ(eta(), (10 + 5 * 30.0) / 3) << "10 s are left of the one that runs";
  EXPECT_DOUBLE_EQ(eta_in_the_list(), (10 + 5 * 30.0) / 3);
  queue_.set_priority(target_named("s1"), 2);
  EXPECT_DOUBLE_EQ(eta(), (10 + 3 * 30.0) / 3) << "before all that wait";
  queue_.cancel(sooner[0].id);
  EXPECT_DOUBLE_EQ(eta(), 3 * 30.0 / 3) << "that one stops, whatever it had left";
}

TEST_F(ApiTest, EtaOfAChainDoesNotShareItsStagesOutToSlots) {
  std::vector<NewJob> jobs;
  for (const char digit : {'1', '2', '3', '4'}) {
    jobs.push_back(new_job(digit));
    jobs.back().scene = R"({"rods": {"count": 10}, "time": {"measure": 10}})";
    if (digit > '1') jobs.back().starts_from = jobs[jobs.size() - 2].id;
  }
  queue_.submit("chain", 0, jobs);
  finish(jobs[0].id, std::chrono::milliseconds(40'000));
  const auto eta = [&] { return get("/v1/sweeps/s1").json["sweep"]["eta_s"].get<double>(); };
  EXPECT_DOUBLE_EQ(eta(), 3 * 40.0) << "three slots, but one after the other";
  begin(queue_, jobs[1].id);
  EXPECT_EQ(eta(), -1.0) << "handed over, and none is at work";
  queue_.set_worker(jobs[1].id, 4711, "");
  EXPECT_DOUBLE_EQ(eta(), 2 * 40.0) << "it has just begun, here";
}

TEST_F(ApiTest, ALogIsReadPieceByPiece) {
  const auto ids = submit_four();
  EXPECT_EQ(get("/v1/jobs/" + ids[0] + "/log").json.dump(), R"({"text":"","offset":0,"state":"queued","ended":false})");
  leave(ids[0], "worker.log", "one\ntwo\n\xff");
  const Response log = get("/v1/jobs/" + ids[0] + "/log?offset=4");
  EXPECT_EQ(log.json["text"], "two\n\ufffd") << "what is not UTF-8 is replaced";
  EXPECT_EQ(log.json["offset"], 9);
  EXPECT_EQ(get("/v1/jobs/" + ids[0] + "/log?offset=9").json["text"], "");
  for (const char* offset : {"-1", "x", "1x", "99999999999999999999"}) {
    EXPECT_EQ(get("/v1/jobs/" + ids[0] + "/log?offset=" + offset).status, 400) << offset;
  }
}

TEST_F(ApiTest, ResultsAreARowPerJob) {
  const auto ids = submit_four();
  begin(queue_, ids[0]);
  leave(ids[0], "summary.json", done_summary(ids[0]));
  queue_.ended(ids[0], JobEvent::kWorkerDone);
  const Response results = get("/v1/results?sweep=four");
  ASSERT_EQ(results.json["rows"].size(), 4U);
  EXPECT_EQ(results.json["rows"][0]["job"], ids[0]);
  EXPECT_EQ(results.json["rows"][0]["summary"]["n_rods"], 7);
  EXPECT_EQ(results.json["rows"][0]["parameters"]["rods.length"], 2.5);
  EXPECT_TRUE(results.json["rows"][1]["summary"].is_null());
  EXPECT_EQ(get("/v1/results?state=done").json["rows"].size(), 1U);

  const std::int64_t finished = queue_.job(ids[0])->finished;
  const auto since = [&](std::int64_t utime) {
    return get("/v1/results?sweep=four&since=" + std::to_string(utime)).json["rows"];
  };
  ASSERT_EQ(since(finished).size(), 1U);
  EXPECT_EQ(since(finished)[0]["job"], ids[0]);
  EXPECT_EQ(since(finished + 1).size(), 0U);
  EXPECT_EQ(since(0).size(), 4U);
  EXPECT_EQ(get("/v1/results?since=yesterday").status, 400);
}

TEST_F(ApiTest, CancelIsOnTheDiskWhenItAnswersAndMayBeRepeated) {
  const auto ids = submit_four();
  begin(queue_, ids[0]);
  EXPECT_EQ(post("/v1/jobs/" + ids[1] + "/cancel").json.dump(), R"({"cancelled":1})");
  EXPECT_EQ(queue_.job(ids[1])->state, JobState::kCancelled);
  EXPECT_EQ(post("/v1/jobs/" + ids[1] + "/cancel").json.dump(), R"({"cancelled":0})");
  EXPECT_EQ(post("/v1/sweeps/four/cancel").json.dump(), R"({"cancelled":3})");
  EXPECT_EQ(queue_.job(ids[0])->state, JobState::kStopping);
  EXPECT_EQ(post("/v1/sweeps/s1/cancel").json.dump(), R"({"cancelled":0})");
  EXPECT_EQ(post("/v1/sweeps/s7/cancel").status, 404);
  EXPECT_EQ(post("/v1/jobs/zz/cancel").status, 404);
}

TEST_F(ApiTest, UnknownPathsAndMethodsGetHelp) {
  const Response nowhere = get("/v1/job");
  EXPECT_EQ(nowhere.status, 404);
  EXPECT_THAT(nowhere.json["routes"].get<std::vector<std::string>>(), testing::Contains("GET /v1/jobs/ID"));
  EXPECT_EQ(get("/").status, 404);
  EXPECT_EQ(get("/v1/jobs/a/b/c").status, 404);

  const auto wrong = client_.Delete("/v1/sweeps");
  ASSERT_TRUE(wrong);
  EXPECT_EQ(wrong->status, 405);
  EXPECT_EQ(wrong->get_header_value("Allow"), "POST, GET");
  EXPECT_EQ(post("/v1/status").status, 405);
  EXPECT_EQ(read(client_.Put("/v1/status", "{}", "application/json")).status, 405);
}

TEST_F(ApiTest, EveryRouteIsDocumented) {
  const std::string protocol = read_text(SHAKEN_SOURCE_DIR "/docs/protocol.md");
  const Response nowhere = get("/nowhere");
  for (const Json& route : nowhere.json["routes"]) {
    EXPECT_THAT(protocol, HasSubstr(route.get<std::string>()));
  }
}

TEST_F(ApiTest, ARequestThatIsTooLargeIsRefused) {
  EXPECT_THAT(test::said_with(413, post("/v1/sweeps", std::string((std::size_t{16} << 20) + 1, ' '))),
              HasSubstr("16 MiB"));
  EXPECT_EQ(get("/v1/jobs/" + std::string(2000, 'a')).status, 414);
  EXPECT_EQ(get("/v1/status").status, 200);
}

/// A body of `n` bytes in chunks of `size`.
std::string chunks(std::size_t n, std::size_t size) {
  std::ostringstream head;
  head << std::hex << size << "\r\n";
  const std::string chunk = head.str() + std::string(size, ' ') + "\r\n";
  std::string all;
  for (std::size_t i = 0; i < n / size; ++i) all += chunk;
  return all + "0\r\n\r\n";
}

TEST_F(ApiTest, ABodyInChunksIsTakenUpToTheSameLimit) {
  const std::string head = "POST /v1/sweeps HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n";
  EXPECT_THAT(exchange(head + "d\r\n{\"text\":\"{}\"}\r\n0\r\n\r\n"), StartsWith("HTTP/1.1 201"));
  constexpr std::size_t kTooLarge = std::size_t{17} << 20;
  // what frames the chunks counts too; sanitizers take longer to read millions of them than a request may
  const std::string framed = test::kSanitized ? chunks(kTooLarge, 16) : chunks(kTooLarge / 2, 1);
  for (const std::string& body : {chunks(kTooLarge, 1 << 16), framed, std::string(kTooLarge, '1')}) {
    const std::string answer = exchange(head + body);
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 413"));
    EXPECT_THAT(answer, HasSubstr("16 MiB"));
  }
  const std::string both = "POST /v1/sweeps HTTP/1.1\r\nTransfer-Encoding: chunked\r\nContent-Length: 3\r\n\r\n";
  EXPECT_THAT(exchange(both + "0\r\n\r\n"), StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(exchange("POST /v1/sweeps HTTP/1.1\r\nTransfer-Encoding: gzip\r\n\r\n"), StartsWith("HTTP/1.1 400"));
  EXPECT_EQ(get("/v1/status").status, 200);
}

TEST_F(ApiTest, ACompressedBodyIsRefused) {
  for (const char* encoding : {"gzip", "deflate", "br", "GZIP"}) {
    const Response response =
        read(client_.Post("/v1/sweeps", {{"Content-Encoding", encoding}}, "{}", "application/json"));
    EXPECT_EQ(response.status, 415) << encoding;
    EXPECT_THAT(response.error(), HasSubstr("compressed"));
  }
}

TEST_F(ApiTest, AHeadIsTakenUpTo64KiB) {
  const std::string line = "GET /v1/status HTTP/1.1\r\n";
  std::string many;
  for (int i = 0; i < 10'000; ++i) many += "X-" + std::to_string(i) + ": y\r\n";
  for (const std::string& head : {line + many + "\r\n", line + "X: " + std::string(100'000, 'y') + "\r\n\r\n",
                                  "GET /v1/status?x=" + std::string(100'000, 'y') + " HTTP/1.1\r\n\r\n"}) {
    EXPECT_THAT(exchange(head), StartsWith("HTTP/1.1 431"));
    EXPECT_THAT(exchange("POST /v1/sweeps HTTP/1.1\r\nHost: x\r\nContent-Length: 2\r\n\r\n{}" + head),
                HasSubstr("HTTP/1.1 431"))
        << "after a body";
  }
  EXPECT_THAT(exchange(line + "X: " + std::string(9'000, 'y') + "\r\n\r\n"), StartsWith("HTTP/1.1 400"));
  EXPECT_EQ(get("/v1/status").status, 200);
}

TEST_F(ApiTest, RangesAreNotAnswered) {
  submit_four();
  std::string ranges = "bytes=0-";
  for (int i = 0; i < 2700; ++i) ranges += ",0-";
  for (const std::string& range : {ranges, std::string("bytes=0-3")}) {
    const Response response = read(client_.Get("/v1/jobs", {{"Range", range}}));
    EXPECT_EQ(response.status, 200);
    EXPECT_EQ(response.json["jobs"].size(), 4U);
  }
}

TEST_F(ApiTest, AClientThatHasSaidAllGetsItsAnswer) {
  const int fd = connect();
  const std::string request = "GET /v1/status HTTP/1.1\r\n\r\n";
  send(fd, (request + request).data(), 2 * request.size(), MSG_NOSIGNAL);
  shutdown(fd, SHUT_WR);
  const std::string answers = read_all(fd);
  EXPECT_THAT(answers, StartsWith("HTTP/1.1 200"));
  EXPECT_NE(answers.find("HTTP/1.1 200", 1), std::string::npos) << "the second of two requests was dropped";
}

TEST_F(ApiTest, ABodyThatNobodyReadsIsNoRequest) {
  const std::string hidden = "GET /v1/nowhere HTTP/1.1\r\n\r\n";
  const std::string request =
      "GET /v1/status HTTP/1.1\r\nContent-Length: " + std::to_string(hidden.size()) + "\r\n\r\n";
  EXPECT_THAT(exchange(request + hidden),
              testing::AllOf(StartsWith("HTTP/1.1 200"), testing::Not(HasSubstr("HTTP/1.1 404"))));
}

TEST_F(ApiTest, FormsAreReadAsTheyAre) {
  // What curl -d sends unless told otherwise, beyond the 8 KiB that cpp-httplib allows for forms.
  const std::string body = Json({{"text", "{}" + std::string(20'000, ' ')}}).dump();
  EXPECT_EQ(read(client_.Post("/v1/sweeps", body, "application/x-www-form-urlencoded")).status, 201);
  const httplib::MultipartFormDataItems items{{"text", "{}", "", ""}};
  EXPECT_EQ(read(client_.Post("/v1/sweeps", items)).status, 415);
}

TEST_F(ApiTest, APostWithoutABodyNeedsNoLength) {
  submit_four();
  EXPECT_THAT(exchange("POST /v1/sweeps/s1/cancel HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n"),
              HasSubstr("{\"cancelled\":4}"));
}

TEST_F(ApiTest, GarbageOnTheSocketHarmsNobody) {
  EXPECT_THAT(exchange("\r\n\r\n"), HasSubstr("400"));
  EXPECT_THAT(exchange("GET /v1/status\r\n\r\n"), HasSubstr("400"));
  EXPECT_THAT(exchange("POST /v1/sweeps HTTP/1.1\r\nContent-Length: -5\r\n\r\n{}"), HasSubstr("HTTP/1.1 4"));
  EXPECT_THAT(exchange("POST /v1/sweeps HTTP/1.1\r\nContent-Length: 100\r\n\r\n{}"), HasSubstr("408"));
  EXPECT_THAT(exchange("GET /v1/jobs/%00%ff%zz HTTP/1.1\r\nConnection: close\r\n\r\n"), HasSubstr("404"));
  EXPECT_TRUE(rc::check("any bytes", [this](const std::string& bytes) { throw_in(bytes); }));
  const std::string good = "POST /v1/sweeps HTTP/1.1\r\nHost: x\r\nContent-Length: 2\r\nConnection: close\r\n\r\n{}";
  EXPECT_TRUE(rc::check("one byte changed", [&] {
    std::string bytes = good;
    bytes[*rc::gen::inRange<std::size_t>(0, good.size())] = *rc::gen::arbitrary<char>();
    throw_in(bytes);
  }));
  const Response status = get("/v1/status");
  EXPECT_EQ(status.status, 200) << status.error();
}

TEST_F(ApiTest, FiveHundredClientsAtOnceAreAllTaken) {
  // More than are served at once; none sends anything. cpp-httplib connects without waiting: a full backlog refuses it.
  std::vector<int> silent;
  for (int i = 0; i < 500; ++i) silent.push_back(connect());
  client_.set_read_timeout(20);
  const Response status = get("/v1/status");
  EXPECT_EQ(status.status, 200) << status.error();
  for (const int fd : silent) close(fd);
}

TEST_F(ApiTest, SlowClientsDoNotKeepOthersWaiting) {
  // As many clients as are served at once send a request byte by byte, without end: no single read takes too long.
  constexpr int kSlowClients = 256;
  const std::string endless = "GET /v1/status HTTP/1.1\r\nX: ";
  std::vector<int> slow;
  for (int i = 0; i < kSlowClients; ++i) {
    slow.push_back(connect());
    send(slow.back(), endless.data(), endless.size(), MSG_NOSIGNAL);
  }
  std::atomic<bool> enough = false;
  std::thread dripping([&] {
    while (!enough) {
      for (const int fd : slow) send(fd, "x", 1, MSG_NOSIGNAL);
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  });
  client_.set_read_timeout(20);
  EXPECT_EQ(get("/v1/status").status, 200);
  enough = true;
  dripping.join();
  EXPECT_THAT(read_all(slow.front()), StartsWith("HTTP/1.1 408"));
  for (std::size_t i = 1; i < slow.size(); ++i) close(slow[i]);
}

TEST_F(ApiTest, AClosedServerLeavesNoSocket) {
  server_.close();
  EXPECT_FALSE(std::filesystem::exists(info().socket()));
  EXPECT_EQ(get("/v1/status").status, 0);
  EXPECT_TRUE(server_.ended_within(std::chrono::seconds(20)));
}

TEST(HttpServerTest, APathTooLongForASocketIsRefusedInWords) {
  const std::filesystem::path socket = "/tmp/" + std::string(200, 'x');
  EXPECT_THAT([&] { http::HttpServer(socket, [](const http::Request&) { return http::Reply{}; }); },
              testing::ThrowsMessage<Failure>(AllOf(HasSubstr("too long"), HasSubstr("--root"))));
}

TEST(HttpServerTest, AFolderThatIsNotThereIsRefusedInWords) {
  EXPECT_THROW(http::HttpServer("/nonexistent/sock", [](const http::Request&) { return http::Reply{}; }), Failure);
}

TEST_F(ApiTest, ARunThatStartsFromAnotherWaitsForIt) {
  const std::string parent = submit({{"text", "{}"}, {"name", "first"}}).json["jobs"][0]["id"];
  const auto scene = [&](const char* time) {
    return R"({"start": {"run": ")" + parent + R"(", "time": )" + time + "}}";
  };
  EXPECT_THAT(test::said_with(422, submit({{"text", scene("9")}, {"name", "wrong"}})),
              HasSubstr("ends at 10 s, where its last state is kept, not at start.time 9 s"));
  const Json job = submit({{"text", scene("10")}, {"name", "second"}}).json["jobs"][0];
  EXPECT_EQ(job["state"], "queued");
  EXPECT_EQ(job["reason"], "waits for run " + parent + ", from which it starts");
  EXPECT_EQ(job["starts_from"], parent);
  EXPECT_FALSE(begin(queue_, job["id"]));
  finish(parent);
  EXPECT_TRUE(begin(queue_, job["id"]));

  const std::string unknown = R"({"start": {"run": "0123456789abcdef", "time": 10}})";
  EXPECT_THAT(submit({{"text", unknown}}).error(), HasSubstr("no run 0123456789abcdef is known here"));
  // one that no queue knows, but whose directory is there
  std::filesystem::create_directories(directory_ / "runs/0123456789abcdef");
  write_text(directory_ / "runs/0123456789abcdef/scene.json", "{}");
  EXPECT_EQ(submit({{"text", unknown}}).status, 201);
  const std::string elsewhen = R"({"start": {"run": "0123456789abcdef", "time": 9}})";
  EXPECT_THAT(submit({{"text", elsewhen}}).error(), HasSubstr("ends at 10 s"));
}

TEST_F(ApiTest, ARunStartsFromImportedRodsAtZero) {
  const std::string id = "0123456789abcdef";
  const auto start = [&](const std::string& time) {
    return submit({{"text", R"({"start": {"run": ")" + id + R"(", "time": )" + time + "}}"}});
  };
  EXPECT_THAT(start("0").error(), HasSubstr("no run 0123456789abcdef is known here"));
  leave(id, "scene.json", "{}");
  write_text(directory_ / "runs" / id / "imported.json", "{}");
  const Response submitted = start("0");
  ASSERT_EQ(submitted.status, 201) << submitted.error();
  const Json kept = post("/v1/clean", R"({"unknown": true})").json["runs"][0];
  EXPECT_EQ(kept["removed"], false);
  EXPECT_EQ(kept["kept"], "job " + submitted.json["jobs"][0]["id"].get<std::string>() + " is to start from it");
  EXPECT_TRUE(begin(queue_, submitted.json["jobs"][0]["id"])) << "it waits for nothing";
  EXPECT_THAT(start("9").error(), HasSubstr("the rods of run 0123456789abcdef are imported: set start.time to 0"));

  const Json run = post("/v1/clean", R"({"dry_run": true})").json["runs"][0];
  EXPECT_EQ(run["id"], id);
  EXPECT_EQ(run["known"], false);
  EXPECT_EQ(run["state"], "imported");
}

// How long such a parent takes is known only once it has ended.
TEST_F(ApiTest, ARunStartsOnlyWhereItsParentWithAConditionCanHaveEnded) {
  const std::string until =
      R"({"time": {"steady": 0, "measure": "2 s"}, "until": {"order_sem": 0.01, "at_most": "8 s"}})";
  const std::string parent = submit({{"text", until}, {"name", "first"}}).json["jobs"][0]["id"];
  const auto start = [&](const char* time) {
    return submit({{"text", R"({"start": {"run": ")" + parent + R"(", "time": )" + time + "}}"}});
  };
  EXPECT_EQ(start("3").status, 201);
  EXPECT_THAT(start("9").error(), HasSubstr("ends at the latest at 8 s, so it has no state at start.time 9 s"));
  leave(parent, "summary.json", R"({"run_id": ")" + parent + R"(", "exit": {"state": "done", "tick": 1000000}})");
  EXPECT_EQ(start("4").status, 201);
  EXPECT_THAT(start("3").error(), HasSubstr("ended at 4 s"));
}

TEST_F(ApiTest, StagesAreChainsThatRunBesideEachOther) {
  const std::string stages =
      R"({"sweep": {"stages": [{}, {"plates.gamma": [6, 5]}, {"time.measure": "1 s"}], "replicas": 2}})";
  const Response two = submit({{"text", stages}, {"name", "ramp"}});
  ASSERT_EQ(two.status, 201) << two.error();
  const Json& jobs = two.json["jobs"];
  ASSERT_EQ(jobs.size(), 8U);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(jobs[i]["starts_from"], i < 2 ? Json(nullptr) : jobs[i - 2]["id"]) << i;
    EXPECT_EQ(jobs[i]["parameters"]["stage"], 1 + i / 2);
  }
  EXPECT_EQ(queue_.next(10).size(), 2U) << "the first stage of each";
  finish(jobs[0]["id"]);
  EXPECT_TRUE(begin(queue_, jobs[2]["id"])) << "whatever the other replica does";
  EXPECT_FALSE(begin(queue_, jobs[3]["id"]));

  // a further replica is a further chain, as if submitted so
  const Response three = post("/v1/sweeps/ramp/replicas", R"({"replicas": 3})");
  ASSERT_EQ(three.json["jobs"].size(), 12U);
  EXPECT_EQ(three.json["counts"]["new"], 4);
  for (std::size_t i = 3; i < 12; ++i) EXPECT_EQ(three.json["jobs"][i]["starts_from"], three.json["jobs"][i - 3]["id"]);
  const Response same = submit({{"text", stages}, {"name", "ramp"}, {"replicas", 3}});
  EXPECT_EQ(same.json["counts"]["new"], 0);

  // one that others are to start from ends when they expect it to
  const Response longer = post("/v1/sweeps/ramp/extend", R"({"measure": "20 s"})");
  EXPECT_EQ(longer.json["extended"], 4) << "the last of each chain, and the first of one whose second runs";
  ASSERT_EQ(longer.json["refused"].size(), 8U);
  EXPECT_EQ(longer.json["refused"][0]["job"], jobs[1]["id"]);
  EXPECT_EQ(longer.json["refused"][0]["reason"],
            "job " + jobs[3]["id"].get<std::string>() + " is to start from its end");

  const std::string other = R"({"sweep": [{"stages": [{}, {"plates.gamma": 6}]},
                                          {"stages": [{"time.measure": "2 s"}, {"plates.gamma": 5}]}]})";
  EXPECT_THAT(submit({{"text", other}, {"name", "other"}}).error(),
              HasSubstr("stages that say the same from the start on must last equally long"));
}

/// Two stages, of which the first ends at `time` s.
std::string two_stages(const std::string& time) {
  return R"({"sweep": {"stages": [{"time.measure": ")" + time +
         R"( s"}, {"plates.gamma": 6, "time.measure": "1 s"}]}})";
}

// A run may be in several sweeps, and its length is not part of its id.
TEST_F(ApiTest, ARunEndsWhereOthersStartFromIt) {
  const std::string parent = submit({{"text", R"({"time": {"measure": "4 s"}})"}}).json["jobs"][0]["id"];
  for (const bool dry_run : {true, false}) {
    EXPECT_THAT(test::said_with(409, submit({{"text", two_stages("2")}, {"dry_run", dry_run}})),
                HasSubstr("from the end of run " + parent + " at 2 s, but that run goes on to 4 s"));
  }
  const Json chain = submit({{"text", two_stages("5")}}).json["jobs"];
  ASSERT_EQ(chain.size(), 2U) << "a run that waits for longer stages becomes longer";
  EXPECT_EQ(chain[0]["id"], parent);
  for (const bool is_done : {false, true}) {
    if (is_done) {
      finish(parent);
    }
    EXPECT_THAT(test::said_with(409, submit({{"text", R"({"time": {"measure": "9 s"}})"}})),
                HasSubstr("cannot end elsewhere: job " + chain[1]["id"].get<std::string>()));
  }
  post("/v1/jobs/" + chain[1]["id"].get<std::string>() + "/cancel");
  EXPECT_EQ(submit({{"text", R"({"time": {"measure": "9 s"}})"}}).json["counts"]["extended"], 1);
}

TEST_F(ApiTest, ARunOnTheDiskThatWentOnFurtherIsNoFirstStage) {
  const std::string parent = submit({{"text", two_stages("2")}, {"dry_run", true}}).status == 200
                                 ? scene::run_id(*scene::load_scene(R"({"time": {"measure": "2 s"}})", "scene"))
                                 : "";
  leave(parent, "summary.json", R"({"run_id": ")" + parent + R"(", "exit": {"state": "done", "tick": 1000000}})");
  EXPECT_THAT(test::said_with(422, submit({{"text", two_stages("2")}})),
              HasSubstr("run " + parent + " went on to 4 s, where its last state is kept"));
}

TEST_F(ApiTest, AStageThatHasBegunNeedsItsStartNoMore) {
  const Json jobs = submit({{"text", R"({"sweep": {"stages": [{}, {"plates.gamma": 6}]}})"}}).json["jobs"];
  const std::string first = jobs[0]["id"], second = jobs[1]["id"];
  finish(first);
  ASSERT_TRUE(begin(queue_, second));
  queue_.hold(second);
  queue_.ended(second, JobEvent::kWorkerStopped);
  ASSERT_TRUE(queue_.clean(first, JobState::kDone));
  EXPECT_EQ(queue_.resume(second), 1);
  EXPECT_TRUE(begin(queue_, second)) << "it goes on from its own state";
}

TEST_F(ApiTest, ReplicasOfAStageEndWhereTheNextOneStarts) {
  const Json jobs =
      submit({{"text", R"({"sweep": {"stages": [{}, {"plates.gamma": 6}]}})"}, {"name", "ramp"}}).json["jobs"];
  for (const Json& job : jobs) {
    finish(job["id"]);
  }
  ASSERT_EQ(post("/v1/sweeps/ramp/extend", R"({"measure": "20 s"})").json["extended"], 2);
  const Json more = post("/v1/sweeps/ramp/replicas", R"({"replicas": 2})").json;
  const auto plan = [&](int k) {
    return *scene::load_scene(queue_.scene(more["jobs"][k]["id"].get<std::string>()), "of a test");
  };
  ASSERT_EQ(more["counts"]["new"], 2);
  EXPECT_GT(plan(0).total_time(), plan(1).total_time()) << "the first stage was extended";
  EXPECT_EQ(plan(1).total_time(), plan(3).start->time);
  EXPECT_EQ(plan(3).start->run, more["jobs"][1]["id"]);
  EXPECT_EQ(plan(3).measure_time, 20);
}

TEST_F(ApiTest, ASweepGetsMoreReplicasAsIfSubmittedSo) {
  const auto ids = submit_four();
  const Response more = post("/v1/sweeps/four/replicas", R"({"replicas": 3})");
  EXPECT_EQ(more.status, 201);
  EXPECT_EQ(more.json["counts"]["new"], 8);
  ASSERT_EQ(more.json["jobs"].size(), 12U);
  EXPECT_EQ(more.json["jobs"][3]["id"], ids[1]);
  EXPECT_EQ(more.json["jobs"][4]["label"], "rods.length=2.5 box.gap=1.2 replica=2");
  // submitted with so many, it is the same sweep
  const Response same = submit({{"text", kSweep}, {"name", "four"}, {"replicas", 3}});
  EXPECT_EQ(same.status, 200);
  EXPECT_EQ(same.json["counts"]["new"], 0);
  EXPECT_EQ(same.json["sweep"]["id"], more.json["sweep"]["id"]);
  // never fewer, and further ones go on from those
  EXPECT_EQ(post("/v1/sweeps/four/replicas", R"({"replicas": 2})").json["sweep"]["id"], same.json["sweep"]["id"]);
  EXPECT_EQ(post("/v1/sweeps/four/replicas", R"({"replicas": 4})").json["counts"]["new"], 4);
  EXPECT_EQ(submit({{"text", kSweep}, {"name", "four"}, {"replicas", 4}}).json["counts"]["new"], 0);

  submit({{"text", "{}"}, {"name", "long"}, {"soft_limit_s", 600}, {"time_limit_s", 3600}, {"priority", 5}});
  const Json twice = post("/v1/sweeps/long/replicas", R"({"replicas": 2})").json;
  ASSERT_EQ(twice["jobs"].size(), 2U);
  for (const Json& job : twice["jobs"]) {
    EXPECT_EQ(job["soft_limit_s"], 600) << "the limits and the priority stay";
    EXPECT_EQ(job["time_limit_s"], 3600);
    EXPECT_EQ(job["priority"], 5);
  }
  EXPECT_EQ(post("/v1/sweeps/four/replicas", R"({"replicas": 0})").status, 400);
  EXPECT_EQ(post("/v1/sweeps/four/replicas", "{}").status, 400);
  submit({{"text", R"({"scene": {}, "sweep": {"grid": {"time.seed": [1, 2]}}})"}, {"name", "seeds"}});
  EXPECT_THAT(post("/v1/sweeps/seeds/replicas", R"({"replicas": 2})").error(), HasSubstr("its seeds are swept"));
}

TEST_F(ApiTest, AnExtendedRunKeepsItsResultsAndShowsNoFormerProgress) {
  const auto ids = submit_four();
  finish(ids[0]);
  const auto folder = run_folder(ids[0]);
  std::filesystem::create_directories(folder);
  write_text(folder / "summary.json", done_summary(ids[0]));
  write_text(folder / "progress.json", R"({"state": "done", "fraction": 1})");
  post("/v1/jobs/" + ids[0] + "/extend", R"({"measure": "20 s"})");
  const auto row = [&] { return get("/v1/results?sweep=s1").json["rows"][0]; };
  EXPECT_EQ(row()["state"], "queued");
  EXPECT_EQ(row()["summary"]["n_rods"], 7);
  begin(queue_, ids[0]);
  EXPECT_TRUE(get("/v1/jobs/" + ids[0]).json["job"]["progress"].is_null());
  EXPECT_EQ(get("/v1/sweeps/s1").json["sweep"]["progress"], 0.0);
  // stopped on the way: partial while it may go on, all that there is once it was cancelled
  std::string stopped = done_summary(ids[0]);
  stopped.replace(stopped.find("\"done\""), 6, "\"stopped\"");
  write_text(folder / "summary.json", stopped);
  EXPECT_TRUE(row()["summary"].is_null());
  // unless it knows of an end that there was
  std::string went_on = stopped;
  went_on.replace(went_on.find("\"stopped\""), 9, R"("stopped", "done_before_s": 10)");
  write_text(folder / "summary.json", went_on);
  EXPECT_EQ(row()["summary"]["n_rods"], 7);
  write_text(folder / "summary.json", stopped);
  queue_.cancel(ids[0]);
  queue_.ended(ids[0], JobEvent::kWorkerStopped, "checkpoint");
  EXPECT_EQ(row()["state"], "cancelled");
  EXPECT_EQ(row()["summary"]["exit"]["state"], "stopped");
}

}  // namespace
}  // namespace shaken::server
