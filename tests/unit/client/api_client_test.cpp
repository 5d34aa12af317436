#include "client/live/api_client.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <string_view>
#include <thread>

#include "base/failure.h"
#include "client/live/target.h"
#include "tests/support/in_child.h"
#include "tests/unit/client/fake_daemon.h"

namespace shaken::client {
namespace {

using ::testing::HasSubstr;

/// The failure that `action` ends with.
template <class Action>
std::pair<ExitCode, std::string> failure_of(Action action) {
  try {
    action();
  } catch (const Failure& failure) {
    return {failure.code, failure.what()};
  }
  return {ExitCode::kOk, ""};
}

TEST(UrlEncoded, LeavesOnlyUnreserved) {
  EXPECT_EQ(url_encoded("s1-a.b_c~"), "s1-a.b_c~");
  EXPECT_EQ(url_encoded("a b/c?d#e%"), "a%20b%2Fc%3Fd%23e%25");
  EXPECT_EQ(url_encoded("φ"), "%CF%86");
}

TEST(ProblemText, NamesPlaceAndPath) {
  EXPECT_EQ(problem_text({{"file", "a.json"}, {"line", 3}, {"column", 7}, {"path", "/rods/length"}, {"message", "no"}}),
            "a.json:3:7: /rods/length: no");
}

TEST(ApiClient, GetsAndPosts) {
  const ScratchFolder root;
  FakeDaemon daemon(root.path());
  daemon.on("GET /v1/status", R"({"version": "0.1.0"})");
  daemon.on("POST /v1/jobs/1f0c/cancel", R"({"cancelled": 1})");
  ApiClient session(root.path());
  EXPECT_EQ(session.get("/v1/status").at("version"), "0.1.0");
  EXPECT_EQ(session.post("/v1/jobs/1f0c/cancel", Json{{"a", 1}}).at("cancelled"), 1);
  ASSERT_EQ(daemon.requests().size(), 2u);
  EXPECT_EQ(daemon.requests()[1].body, R"({"a":1})");
}

TEST(ApiClient, DaemonsWordsBecomeTheMessage) {
  const ScratchFolder root;
  FakeDaemon daemon(root.path());
  daemon.on("GET /bad", {{400, R"({"error": "state: 'x' is none of queued"})"}});
  daemon.on("GET /broken", {{507, R"({"error": "the disk is full"})"}});
  daemon.on(
      "POST /refused",
      {{422,
        R"({"error": "long", "problems": [{"file": "a.json", "line": 1, "column": 2, "path": "/box", "message": "bad"}]})"}});
  ApiClient session(root.path());
  EXPECT_EQ(failure_of([&] { session.get("/bad"); }),
            std::pair(ExitCode::kBadInput, std::string("state: 'x' is none of queued")));
  EXPECT_EQ(failure_of([&] { session.get("/broken"); }), std::pair(ExitCode::kFailed, std::string("the disk is full")));
  EXPECT_EQ(failure_of([&] { session.post("/refused", Json::object()); }),
            std::pair(ExitCode::kBadInput, std::string("refused, with 1 problem\na.json:1:2: /box: bad")));
  EXPECT_EQ(failure_of([&] { session.get("/missing"); }).first, ExitCode::kBadInput);
  EXPECT_EQ(session.find("/missing").error().message, "no such thing: GET /missing");
}

TEST(ApiClient, GarbageIsAFailureNotACrash) {
  const ScratchFolder root;
  FakeDaemon daemon(root.path());
  ApiClient session(root.path());
  for (const char* body : {"", "hello", "[]", "{", "null", "{\"a\": \xff}"}) {
    daemon.on("GET /v1/status", body);
    const auto [code, message] = failure_of([&] { session.get("/v1/status"); });
    EXPECT_EQ(code, ExitCode::kFailed) << body;
    EXPECT_THAT(message, HasSubstr("not a JSON object")) << body;
  }
}

// A submit of 100,000 runs takes minutes, and is accepted in the end.
TEST(ApiClient, WaitsAsLongAsTheDaemonAnswersOthers) {
  const ScratchFolder root;
  FakeDaemon daemon(root.path());
  daemon.on("GET /v1/status", "{}");
  daemon.on("POST /v1/sweeps", {{200, R"({"sweep": 1})", std::chrono::seconds(7)}});
  ApiClient session(root.path(), std::chrono::seconds(3));
  EXPECT_EQ(session.post("/v1/sweeps", Json::object()).at("sweep"), 1);
}

TEST(ApiClient, DoesNotWaitForOneThatAnswersNobody) {
  const ScratchFolder root;
  FakeDaemon daemon(root.path());
  daemon.on("GET /v1/status", {{200, "{}", std::chrono::seconds(5)}});
  daemon.on("POST /v1/sweeps", {{200, "{}", std::chrono::seconds(5)}});
  ApiClient session(root.path(), std::chrono::milliseconds(200));
  const auto [code, message] = failure_of([&] { session.post("/v1/sweeps", Json::object()); });
  EXPECT_EQ(code, ExitCode::kNoDaemon);
  EXPECT_THAT(message, HasSubstr("gave no answer"));
}

// The daemon closes a connection that was silent for a second. Who asks once a second would meet that now and then.
TEST(ApiClient, DoesNotAskOnAConnectionThatTheDaemonIsAboutToClose) {
  const ScratchFolder root;
  const int listener = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strcpy(address.sun_path, (root.path() / "shakend.sock").c_str());
  ASSERT_EQ(bind(listener, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  ASSERT_EQ(listen(listener, 8), 0);
  std::thread daemon([listener] {
    for (int n = 0; n < 2; ++n) {  // one answer on each connection, closed at the next request or with the client
      const int client = accept(listener, nullptr, nullptr);
      char request[4096];
      if (recv(client, request, sizeof(request), 0) > 0) {
        const std::string_view answer = "HTTP/1.1 200 OK\r\nContent-Length: 2\r\n\r\n{}";
        send(client, answer.data(), answer.size(), MSG_NOSIGNAL);
        recv(client, request, sizeof(request), 0);
      }
      close(client);
    }
  });
  ApiClient session(root.path());
  EXPECT_EQ(session.get("/v1/status"), Json::object());
  EXPECT_EQ(failure_of([&] { session.get("/v1/status"); }), std::pair(ExitCode::kOk, std::string()));
  shutdown(listener, SHUT_RDWR);  // where the second connection never came
  daemon.join();
  close(listener);
}

TEST(ApiClient, SocketWithoutListenerIsNoDaemon) {
  const ScratchFolder root;
  // What a daemon that was killed leaves behind.
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, (root.path() / "shakend.sock").c_str(), sizeof(address.sun_path) - 1);
  const int fd = socket(AF_UNIX, SOCK_STREAM, 0);
  ASSERT_EQ(bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  close(fd);
  const auto [code, message] = failure_of([&] { ApiClient(root.path()).get("/v1/status"); });
  EXPECT_EQ(code, ExitCode::kNoDaemon);
  EXPECT_THAT(message, HasSubstr("start one with"));
}

TEST(ApiClient, WhereAnothersDaemonListensItSaysSo) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can be another user";
  const ScratchFolder root;  // for its owner alone
  EXPECT_EQ(in_child([&] {
              const bool is_nobody = setuid(65534) == 0;
              const auto [code, message] = failure_of([&] { ApiClient(root.path()).get("/v1/status"); });
              return is_nobody && code == ExitCode::kNoDaemon && message.ends_with("is another user's daemon");
            }),
            0);
}

TEST(FindTarget, SweepFirstThenJobThenNothing) {
  const ScratchFolder root;
  FakeDaemon daemon(root.path());
  daemon.on("GET /v1/sweeps/phases",
            R"({"sweep": {"id": "s7", "name": "phases"}, "jobs": [{"id": "aa"}, {"id": "bb"}]})");
  daemon.on("GET /v1/jobs/1f", R"({"job": {"id": "1f0c", "sweep": "s7", "state": "done"}})");
  daemon.on("GET /v1/jobs/2", {{409, R"({"error": "'2' fits several jobs: 2a, 2b"})"}});
  ApiClient session(root.path());

  const Target sweep = find_target(session, "phases");
  EXPECT_TRUE(sweep.is_sweep);
  EXPECT_EQ(sweep.path, "/v1/sweeps/s7");
  EXPECT_EQ(sweep.title(), "sweep s7 (phases)");
  EXPECT_EQ(jobs_of(sweep).size(), 2u);

  const Target job = find_target(session, "1f");
  EXPECT_FALSE(job.is_sweep);
  EXPECT_EQ(job.path, "/v1/jobs/1f0c");
  EXPECT_EQ(job.sweep_id(), "s7");

  EXPECT_THAT(failure_of([&] { find_target(session, "2"); }).second, HasSubstr("several jobs"));
  EXPECT_EQ(failure_of([&] { find_target(session, "zz"); }).first, ExitCode::kBadInput);
  EXPECT_EQ(failure_of([&] { find_target(session, ""); }).first, ExitCode::kBadInput);
  EXPECT_EQ(failure_of([&] { find_job(session, "phases"); }).first, ExitCode::kBadInput);
}

TEST(CountsText, InTheOrderOfAJobsLife) {
  EXPECT_EQ(counts_text({{"queued", 5}, {"done", 3}, {"running", 2}, {"failed", 0}}), "3 done, 2 running, 5 queued");
  EXPECT_EQ(counts_text(Json::object()), "no jobs");
}

}  // namespace
}  // namespace shaken::client
