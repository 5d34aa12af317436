// SPDX-License-Identifier: MIT
// The contract of docs/web.md, over a real port, with a daemon whose answers are laid down.
#include "web/site.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <httplib.h>

#include <atomic>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/failure.h"
#include "base/paths.h"
#include "base/scratch_folder.h"
#include "tests/unit/client/fake_daemon.h"
#include "web/guard.h"
#include "web/queue_feed.h"

namespace shaken::web {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kToken = "0123456789abcdef0123456789abcdef";
constexpr const char* kRun = "1f0c000000000000";
const httplib::Headers kIn{{"Authorization", std::string("Bearer ") + kToken}};

class SiteTest : public testing::Test {
 protected:
  SiteTest() {
    guard_ = &made_;
    daemon_.on("GET /v1/status", R"({"version": "1", "host": "here", "slots": 2})");
    daemon_.on("GET /v1/sweeps", R"({"sweeps": [{"id": "s1", "name": "<img src=x onerror=alert(1)>"}]})");
    daemon_.on("GET /v1/jobs?state=running", std::string(R"({"jobs": [{"id": ")") + kRun + "\"}]}");
    daemon_.on("GET /v1/jobs?state=stopping", R"({"jobs": []})");
    fs::create_directories(root_ / "runs" / kRun);
  }
  ~SiteTest() override { site_.close(); }

  httplib::Result get(const std::string& path) { return client_.Get(path, kIn); }

  ScratchFolder root_;
  client::FakeDaemon daemon_{root_.path()};
  DaemonLink link_{root_.path()};
  Site site_{SiteSetup{.root = root_.path(), .page = shipped_page()}};
  std::atomic<const Guard*> guard_ = nullptr;
  server::HttpServer server_{0, [this](const server::Request& request) {
                               auto stopped = guard_.load()->stop(request);
                               return stopped ? std::move(*stopped) : site_.answer(request);
                             }};
  const Guard made_{kToken, server_.port()};
  httplib::Client client_{"127.0.0.1", server_.port()};
};

TEST_F(SiteTest, NothingIsSeenWithoutTheToken) {
  for (const char* path : {"/", "/page/main.js", "/chart.js", "/live", "/v1/status", "/runs/1f0c000000000000/files"}) {
    const auto answer = client_.Get(path);
    ASSERT_TRUE(answer) << path;
    EXPECT_EQ(answer->status, 401) << path;
    EXPECT_THAT(answer->body, Not(HasSubstr(kToken)));
  }
  EXPECT_EQ(client_.Post("/v1/sweeps", "{}", "application/json")->status, 401);
  EXPECT_EQ(client_.Get("/v1/status", httplib::Headers{{"Host", "evil.example"}, *kIn.begin()})->status, 403);
}

TEST_F(SiteTest, ThePageAndAllItsFilesAreServed) {
  const auto page = get("/");
  ASSERT_EQ(page->status, 200);
  EXPECT_EQ(page->get_header_value("Content-Type"), "text/html; charset=utf-8");
  int n_files = 0;
  for (const auto& entry : fs::directory_iterator(shipped_page())) {
    const std::string name = entry.path().filename().string();
    if (name == "index.html") continue;
    EXPECT_EQ(get("/page/" + name)->status, 200) << name << " lies there, but is not served";
    ++n_files;
  }
  EXPECT_GE(n_files, 8);
  EXPECT_EQ(get("/page/..%2f..%2fCMakeLists.txt")->status, 404);
  EXPECT_EQ(get("/page/index.html")->status, 404);
  EXPECT_EQ(get("/nothing")->status, 404);
}

TEST_F(SiteTest, EveryAnswerForbidsWhatIsNotServedHere) {
  for (const char* path : {"/", "/v1/status", "/nothing", "/page/main.js"}) {
    const auto answer = get(path);
    const std::string policy = answer->get_header_value("Content-Security-Policy");
    EXPECT_THAT(policy, HasSubstr("default-src 'none'")) << path;
    EXPECT_THAT(policy, HasSubstr("script-src 'self';")) << path;
    EXPECT_THAT(policy, Not(HasSubstr("unsafe"))) << path;
    EXPECT_EQ(answer->get_header_value("X-Content-Type-Options"), "nosniff") << path;
  }
}

TEST_F(SiteTest, TheDaemonsInterfaceIsHandedOn) {
  daemon_.on("POST /v1/jobs/1f0c/cancel", R"({"cancelled": 1})");
  EXPECT_EQ(nlohmann::json::parse(get("/v1/status")->body)["slots"], 2);
  EXPECT_EQ(get("/v1/nothing")->status, 404);
  const auto cancelled = client_.Post("/v1/jobs/1f0c/cancel", kIn, R"({"a": 1})", "application/json");
  EXPECT_EQ(cancelled->status, 200);
  EXPECT_EQ(daemon_.requests().back().body, R"({"a": 1})");
}

TEST_F(SiteTest, TheQueueComesAsEvents) {
  std::string seen;
  client_.Get("/live", kIn, [&](const char* bytes, std::size_t size) {
    seen.append(bytes, size);
    return seen.find("\n\n") == std::string::npos;
  });
  ASSERT_THAT(seen, testing::StartsWith("event: queue\ndata: "));
  const auto queue = nlohmann::json::parse(seen.substr(seen.find('{'), seen.find("\n\n") - seen.find('{')));
  EXPECT_EQ(queue["sweeps"][0]["id"], "s1");
  EXPECT_EQ(queue["jobs"][0]["id"], kRun);
}

TEST_F(SiteTest, AnswersThatAreNotTheDaemonsEndNothing) {
  for (const char* answer : {"[]", "no JSON", "{\"jobs\": [1, 2]}", "{\"jobs\": 7}", "{}"}) {
    daemon_.on("GET /v1/jobs?state=running", answer);
    QueueFeed feed(link_, [](const std::set<std::string>&) {});
    std::int64_t seen = 0;
    EXPECT_TRUE(feed.wait(seen, std::chrono::seconds(20))) << answer;
  }
}

TEST_F(SiteTest, FilesOfARunAreSavedAndNothingElseIs) {
  std::ofstream(root_ / "runs" / kRun / "scene.json") << "{\"a\": 1}";
  std::ofstream(root_ / "secret") << "secret";
  fs::create_symlink(root_ / "secret", root_ / "runs" / kRun / "link");
  const std::string files = std::string("/runs/") + kRun + "/files";
  EXPECT_THAT(get(files)->body, HasSubstr("scene.json"));
  const auto scene = get(files + "/scene.json");
  EXPECT_EQ(scene->body, "{\"a\": 1}");
  EXPECT_THAT(scene->get_header_value("Content-Disposition"), testing::StartsWith("attachment"));
  for (const char* name : {"/link", "/..%2f..%2fsecret", "/%2e%2e", "/nothing"}) {
    EXPECT_EQ(get(files + name)->status, 404) << name;
  }
  for (const char* id : {"../secret", "..", "1f0c", "%2e%2e%2fsecret"}) {
    EXPECT_EQ(get(std::string("/runs/") + id + "/files")->status, 404) << id;
  }
}

TEST_F(SiteTest, WhatIsNotThereIsSaid) {
  EXPECT_THAT(get(std::string("/runs/") + kRun + "/frames")->body, HasSubstr("records no rods"));
  EXPECT_EQ(get(std::string("/runs/") + kRun + "/frames/last")->status, 404);
  EXPECT_EQ(get(std::string("/runs/") + kRun + "/curves")->status, 404);
  EXPECT_EQ(get(std::string("/runs/") + kRun + "/picture?frame=0")->status, 404);
  EXPECT_EQ(get(std::string("/live/") + kRun)->status, 503) << "no bus";
  EXPECT_EQ(client_.Post("/live", kIn, "", "text/plain")->status, 405);
}

TEST(SiteWithoutADaemon, SaysSo) {
  const ScratchFolder root;
  Site site(SiteSetup{.root = root.path(), .page = shipped_page()});
  const auto reply = site.answer({.method = "GET", .path = "/v1/status", .query = {}, .body = ""});
  EXPECT_EQ(reply.status, 503);
  EXPECT_THAT(reply.body, HasSubstr("start shakend"));
  site.close();
}

TEST(Port, OfAnotherProgramIsRefused) {
  const server::HttpServer first(0, [](const server::Request&) { return server::Reply{}; });
  EXPECT_THROW(server::HttpServer(first.port(), [](const server::Request&) { return server::Reply{}; }), Failure);
}

}  // namespace
}  // namespace shaken::web
