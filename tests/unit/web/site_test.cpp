// The contract of docs/web.md, over a real port, with a daemon whose answers are laid down.
#include "web/site.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <httplib.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <future>
#include <nlohmann/json.hpp>
#include <numbers>
#include <thread>

#include "base/failure.h"
#include "base/palettes.h"
#include "base/paths.h"
#include "base/scratch_folder.h"
#include "tests/unit/client/fake_daemon.h"
#include "tests/unit/web/small_recording.h"
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
  SiteTest() { promised_.set_value(Guard(kToken, server_.port())); }
  ~SiteTest() override { site_.close(); }

  httplib::Result get(const std::string& path) { return client_.Get(path, kIn); }

  /// A daemon that knows what to answer before anybody asks.
  struct Daemon : client::FakeDaemon {
    explicit Daemon(const fs::path& root) : FakeDaemon(root) {
      on("GET /v1/status", R"({"version": "1", "host": "here", "slots": 2, "uptime_s": 7})");
      on("GET /v1/sweeps", R"({"sweeps": [{"id": "s1", "name": "<img src=x onerror=alert(1)>"}]})");
      on("GET /v1/jobs?state=running", std::string(R"({"jobs": [{"id": ")") + kRun + "\"}]}");
      on("GET /v1/jobs?state=stopping", R"({"jobs": []})");
      fs::create_directories(root / "runs" / kRun);
    }
  };

  ScratchFolder root_;
  Daemon daemon_{root_.path()};
  DaemonLink link_{root_.path()};
  Site site_{SiteSetup{.root = root_.path(), .page = shipped_page()}};
  std::promise<Guard> promised_;  // requests wait until the port is known
  std::shared_future<Guard> guard_{promised_.get_future()};
  http::HttpServer server_{0, [this](const http::Request& head) { return guard_.get().stop(head); },
                           [this](const http::Request& request) { return site_.answer(request); }, Guard::headers()};
  httplib::Client client_{"127.0.0.1", server_.port()};
};

TEST_F(SiteTest, NothingIsSeenWithoutTheToken) {
  for (const char* path : {"/live", "/v1/status", "/runs/1f0c000000000000/files", "/palettes.json", "/nothing"}) {
    const auto answer = client_.Get(path);
    ASSERT_TRUE(answer) << path;
    EXPECT_EQ(answer->status, 401) << path;
    EXPECT_THAT(nlohmann::json::parse(answer->body)["error"], HasSubstr("shaken web"));
  }
  EXPECT_EQ(client_.Get("/v1/status", httplib::Headers{{"Host", "evil.example"}, *kIn.begin()})->status, 403);
}

// Anybody on the machine can connect: what he sends must not be held in memory.
TEST_F(SiteTest, TheBodyOfARefusedRequestIsNotRead) {
  const int connection = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(server_.port()));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(connect(connection, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  const std::string head = "POST /v1/sweeps HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(server_.port()) +
                           "\r\nContent-Length: 1000000\r\n\r\n";
  ASSERT_EQ(send(connection, head.data(), head.size(), 0), static_cast<ssize_t>(head.size()));
  char answer[1000] = {};
  EXPECT_GT(recv(connection, answer, sizeof(answer) - 1, 0), 0) << "without a byte of the body";
  EXPECT_THAT(std::string(answer), HasSubstr(" 401 "));
  close(connection);
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
  std::vector<std::pair<std::string, httplib::Result>> answers;
  for (const char* path : {"/", "/v1/status", "/nothing", "/page/main.js"}) answers.emplace_back(path, get(path));
  answers.emplace_back("without the token", client_.Get("/v1/status"));
  answers.emplace_back("another name", client_.Get("/", httplib::Headers{{"Host", "evil.example"}}));
  answers.emplace_back("a path that is too long", get("/" + std::string(2000, 'a')));
  for (const auto& [path, answer] : answers) {
    ASSERT_TRUE(answer) << path;
    EXPECT_EQ(answer->get_header_value_count("Content-Security-Policy"), 1u) << path;
    const std::string policy = answer->get_header_value("Content-Security-Policy");
    EXPECT_THAT(policy, HasSubstr("default-src 'none'")) << path;
    EXPECT_THAT(policy, HasSubstr("script-src 'self';")) << path;
    EXPECT_THAT(policy, Not(HasSubstr("unsafe"))) << path;
    EXPECT_THAT(policy, HasSubstr("media-src 'self' blob:;"))
        << path << ": films that the page has asked for are played";
    EXPECT_EQ(answer->get_header_value("X-Content-Type-Options"), "nosniff") << path;
  }
}

TEST_F(SiteTest, TheDaemonsInterfaceIsHandedOn) {
  daemon_.on("POST /v1/jobs/1f0c/cancel", R"({"cancelled": 1})");
  EXPECT_EQ(nlohmann::json::parse(get("/v1/status")->body)["slots"], 2);
  EXPECT_EQ(get("/v1/nothing")->status, 404);
  const auto cancelled = client_.Post("/v1/jobs/1f0c/cancel", kIn, R"({"a": 1})", "application/json");
  EXPECT_EQ(cancelled->status, 200);
  const auto requests = daemon_.requests();  // the feed's are among them
  const auto posted = std::find_if(requests.begin(), requests.end(),
                                   [](const auto& request) { return request.line == "POST /v1/jobs/1f0c/cancel"; });
  ASSERT_NE(posted, requests.end());
  EXPECT_EQ(posted->body, R"({"a": 1})");
}

TEST_F(SiteTest, TheQueueComesAsEvents) {
  for (const std::string path : {"/live", "/live?run=1f0c000000000000"}) {
    std::string seen;
    client_.Get(path, kIn, [&](const char* bytes, std::size_t size) {
      seen.append(bytes, size);
      const std::size_t begin = seen.find("event: queue\n");
      return begin == std::string::npos || seen.find("\n\n", begin) == std::string::npos;
    });
    const std::size_t begin = seen.find("event: queue\ndata: ");
    ASSERT_NE(begin, std::string::npos) << seen;
    EXPECT_THAT(seen, Not(HasSubstr("event: order"))) << "there is no bus";
    const std::size_t data = seen.find('{', begin);
    const auto queue = nlohmann::json::parse(seen.substr(data, seen.find("\n\n", data) - data));
    EXPECT_EQ(queue["status"], nlohmann::json({{"version", "1"}, {"host", "here"}, {"slots", 2}}))
        << "without what is another at each look";
    EXPECT_EQ(queue["sweeps"][0]["id"], "s1");
    EXPECT_EQ(queue["jobs"][0]["id"], kRun);
  }
}

TEST_F(SiteTest, WhatTheBusSaysOfARunComesAsEvents) {
  const std::string log = "file://" + (root_ / "bus.log").string();
  {
    const auto bus = proto::Bus::open(log + "?mode=w").value();
    observables_t order{};
    order.job_id = kRun;
    order.sim_time_s = 1.5;
    order.order = 0.75;
    defects_t defects{};
    defects.job_id = kRun;
    defects.sim_time_s = 1.5;
    defects.n_defects = 2;
    defects.x_mm = {1, 2};
    defects.y_mm = {3, 4};
    defects.charge = {0.5, -0.5};
    defects.direction_rad = {0.25, 0};
    for (int k = 0; k < 2; ++k) {  // and again once the site knows from the daemon that the run is there
      if (k > 0) std::this_thread::sleep_for(std::chrono::milliseconds(600));
      bus->publish(proto::kObservablesChannel, order);
      bus->publish(proto::kDefectsChannel, defects);
    }
  }
  Site site({.root = root_.path(), .page = shipped_page(), .bus = proto::Bus::open(log + "?mode=r").value()});
  const auto reply = site.answer({.method = "GET", .path = "/live", .query = {{"run", kRun}}, .body = ""});
  std::string seen;
  const auto has = [&](const char* event) { return seen.find(std::string("event: ") + event) != std::string::npos; };
  for (int k = 0; k < 200 && !(has("defects") && has("observables")); ++k) seen += reply.stream().value_or("");
  const auto data = [&](const std::string& event) {
    const std::size_t begin = seen.find("event: " + event + "\ndata: ");
    if (begin == std::string::npos) return nlohmann::json();
    const std::size_t at = seen.find("data: ", begin) + 6;
    return nlohmann::json::parse(seen.substr(at, seen.find("\n\n", at) - at));
  };
  EXPECT_EQ(data("defects"),
            nlohmann::json::parse(R"({"time_s": 1.5, "defects": [[1, 3, 0.5, 0.25], [2, 4, -0.5, 0]]})"));
  EXPECT_EQ(data("observables")["order"], 0.75);
  EXPECT_TRUE(data("order").contains("time_s")) << "what came before";
  site.close();
}

TEST(Feed, AsksSeldomWhileNobodyLooks) {
  const ScratchFolder root;
  client::FakeDaemon daemon(root.path());
  daemon.on("GET /v1/status", R"({"version": "1"})");
  daemon.on("GET /v1/sweeps", R"({"sweeps": []})");
  daemon.on("GET /v1/jobs?state=running", R"({"jobs": []})");
  daemon.on("GET /v1/jobs?state=stopping", R"({"jobs": []})");
  const DaemonLink link(root.path());
  QueueFeed feed(
      link, [](const std::set<std::string>&) {}, std::chrono::milliseconds(50));
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  EXPECT_LE(daemon.requests().size(), 4u) << "once, four questions";
  daemon.on("GET /v1/sweeps", R"({"sweeps": [{"id": "s7"}]})");
  std::int64_t seen = 0;
  EXPECT_THAT(feed.wait(seen, std::chrono::seconds(20)).value_or(""), HasSubstr("s7"))
      << "who comes then is not told what is old";
  daemon.on("GET /v1/sweeps", R"({"sweeps": [{"id": "s8"}]})");
  EXPECT_THAT(feed.wait(seen, std::chrono::seconds(20)).value_or(""), HasSubstr("s8"));
}

TEST_F(SiteTest, AnswersThatAreNotTheDaemonsEndNothing) {
  for (const char* answer : {"[]", "no JSON", "7"}) {
    daemon_.on("GET /v1/status", answer);
    QueueFeed feed(link_, [](const std::set<std::string>&) {});
    std::int64_t seen = 0;
    EXPECT_THAT(feed.wait(seen, std::chrono::seconds(20)).value_or(""), HasSubstr("error")) << answer;
  }
  daemon_.on("GET /v1/status", R"({"version": "1"})");
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
  for (const auto& [name, type] : {std::pair("a.svg", "image/svg+xml"),
                                   {"a.png", "image/png"},
                                   {"a.mp4", "video/mp4"},
                                   {"a.webm", "video/webm"},
                                   {"a.pdf", "application/pdf"},
                                   {"a.h5", "application/octet-stream"}}) {
    std::ofstream(root_ / "runs" / kRun / name) << "1";
    EXPECT_EQ(get(files + "/" + name)->get_header_value("Content-Type"), type) << name;
  }
  // By a ticket, as browsers save things: once, without the token.
  const auto given = client_.Post("/tickets?path=" + files + "/scene.json", kIn, "{}", "application/json");
  ASSERT_EQ(given->status, 200) << given->body;
  const std::string ticket = "/tickets/" + nlohmann::json::parse(given->body)["ticket"].get<std::string>();
  EXPECT_EQ(client_.Get(ticket)->body, "{\"a\": 1}");
  EXPECT_EQ(client_.Get(ticket)->status, 404) << "a second time";
  EXPECT_EQ(client_.Post("/tickets?path=/v1/status", kIn, "{}", "application/json")->status, 400);
  EXPECT_EQ(client_.Post("/tickets?path=" + files, "{}", "application/json")->status, 401);
  for (const char* id : {"../secret", "..", "1f0c", "%2e%2e%2fsecret"}) {
    EXPECT_EQ(get(std::string("/runs/") + id + "/files")->status, 404) << id;
  }
}

TEST_F(SiteTest, RodsOfARunAreReadInThreeWays) {
  record_two_frames({root_ / "runs" / kRun}, kRun);
  const std::string run = std::string("/runs/") + kRun;
  EXPECT_EQ(get(run + "/newest")->body, get(run + "/frames/1")->body);
  const auto order = nlohmann::json::parse(get(run + "/order")->body);
  EXPECT_EQ(order["time_s"].size(), 2u);
  EXPECT_EQ(order["order"][1], 1.0);
  for (const char* frame : {"1", "last"}) {
    const auto path = nlohmann::json::parse(get(run + "/path?rod=0&frame=" + frame)->body);
    EXPECT_EQ(path["time_s"].size(), 2u) << frame;
    EXPECT_EQ(path["x_mm"][1], 1.0);
    EXPECT_EQ(path["n_z"][0], 0.0);
  }
  for (const char* query : {"", "?rod=1&frame=1", "?rod=0&frame=2", "?rod=-1&frame=1", "?rod=0&frame=--out"}) {
    EXPECT_EQ(get(run + "/path" + query)->status, 404) << query;
  }
}

TEST_F(SiteTest, WhatIsNotThereIsSaid) {
  EXPECT_THAT(get(std::string("/runs/") + kRun + "/frames")->body, HasSubstr("records no rods"));
  EXPECT_EQ(get(std::string("/runs/") + kRun + "/frames/last")->status, 404);
  EXPECT_EQ(get(std::string("/runs/") + kRun + "/curves")->status, 404);
  EXPECT_EQ(get(std::string("/runs/") + kRun + "/picture?frame=0")->status, 404);
  EXPECT_EQ(get("/live?run=1f0c")->status, 404);
  EXPECT_EQ(client_.Post("/live", kIn, "", "text/plain")->status, 405);
}

TEST_F(SiteTest, PalettesReachFromEndToEnd) {
  const auto palettes = nlohmann::json::parse(get("/palettes.json")->body);
  const auto expect = [&](const char* name, std::size_t size, std::size_t at, const Colour& colour) {
    EXPECT_EQ(palettes[name].size(), size) << name;
    EXPECT_EQ(palettes[name][at], client::ink_of(colour)) << name << " " << at;
  };
  expect("tilt", 25, 0, diverging_colour(-1));
  expect("tilt", 25, 24, diverging_colour(1));
  expect("layers", 73, 0, layer_colour(-std::numbers::pi / 2));
  expect("layers", 73, 36, layer_colour(0));
  expect("wheel", 24, 12, wheel_colour(std::numbers::pi / 2));
}

// One picture is drawn at a time: a renderer that hangs must not be the last.
TEST_F(SiteTest, ARendererThatHangsIsEnded) {
  record_two_frames({root_ / "runs" / kRun}, kRun);
  const fs::path renderer = root_ / "renderer";
  std::ofstream(renderer) << "#!/bin/sh\nkill -STOP $$\n";
  fs::permissions(renderer, fs::perms::owner_all);
  Site site(SiteSetup{
      .root = root_.path(), .page = shipped_page(), .renderer = renderer, .drawing = std::chrono::milliseconds(200)});
  http::Request picture{
      .method = "GET", .path = std::string("/runs/") + kRun + "/picture", .query = {{"frame", "0"}}, .body = ""};
  for (int i = 0; i < 2; ++i) {
    const auto reply = site.answer(picture);
    EXPECT_EQ(reply.status, 504) << reply.body;
    EXPECT_THAT(reply.body, HasSubstr("shaken-render"));
  }
  std::ofstream(renderer)
      << "#!/bin/sh\nwhile [ \"$1\" != -o ]; do shift; done; f=$2; shift 2; echo drawn \"$@\" > $f\n";
  Site next(SiteSetup{.root = root_.path(), .page = shipped_page(), .renderer = renderer});
  EXPECT_EQ(next.answer(picture).body, "drawn\n");
  picture.query.insert({{"style", "dark"}, {"size", "300"}});
  EXPECT_EQ(next.answer(picture).body, "drawn --style=dark --size=300\n");
  site.close();
  next.close();
}

TEST_F(SiteTest, ScenesToBeginFromAreThose) {
  const auto answer = nlohmann::json::parse(get("/examples")->body)["examples"];
  ASSERT_GE(answer.size(), 5u);
  std::vector<std::string> names;
  for (const auto& scene : answer) {
    EXPECT_THAT(scene["text"], HasSubstr("\"rods\"")) << scene["name"];
    names.push_back(scene["name"]);
  }
  EXPECT_THAT(names, testing::IsSupersetOf({"coarsening", "demo", "quickstart"}));
  EXPECT_TRUE(std::ranges::is_sorted(names));
}

// What the client prints is handed on, and what it refuses; one that hangs is ended.
TEST_F(SiteTest, ACostIsWhatTheClientEstimates) {
  const auto site_with = [&](const std::string& script, std::chrono::milliseconds limit) {
    const fs::path program = root_ / "client";
    std::ofstream(program) << "#!/bin/sh\n" << script;
    fs::permissions(program, fs::perms::owner_all);
    return std::make_unique<Site>(
        SiteSetup{.root = root_.path(), .page = shipped_page(), .client = program, .estimating = limit});
  };
  const auto ask = [](Site& site, const std::string& body) {
    return site.answer({.method = "POST", .path = "/cost", .query = {}, .body = body});
  };
  constexpr std::chrono::seconds kLong{60};
  const auto good = site_with(R"(grep -q seven "$2" && echo "{\"estimate\": {\"words\": \"$*\"}}")", kLong);
  const auto reply = ask(*good, R"({"text": "seven", "replicas": 3})");
  EXPECT_EQ(reply.status, 200) << reply.body;
  EXPECT_THAT(reply.body, HasSubstr("--dry-run --json --replicas=3"));
  EXPECT_EQ(ask(*good, R"({"text": "eight"})").status, 422);
  for (const char* body : {"", "[]", "{}", R"({"text": 7})", R"({"text": "seven", "replicas": "three"})"}) {
    EXPECT_EQ(ask(*good, body).status, 400) << body;
  }
  good->close();
  const auto hangs = site_with("kill -STOP $$", std::chrono::milliseconds(200));
  EXPECT_EQ(ask(*hangs, R"({"text": "seven"})").status, 504);
  hangs->close();
  const auto odd = site_with("echo no JSON", kLong);
  EXPECT_EQ(ask(*odd, R"({"text": "seven"})").status, 500);
  odd->close();
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
  const auto answer = [](const http::Request&) { return http::Reply{}; };
  const http::HttpServer first(0, {}, answer);
  EXPECT_THROW(http::HttpServer(first.port(), {}, answer), Failure);
}

TEST(Port, OfRootIsRefusedWithWhatToDo) {
  constexpr int kPort = 80, kNobody = 65534;
  int first_of_everybody = 1024;
  std::ifstream("/proc/sys/net/ipv4/ip_unprivileged_port_start") >> first_of_everybody;
  if (first_of_everybody <= kPort) GTEST_SKIP() << "everybody may listen on port 80 here";
  const auto listen = [] {
    if (getuid() == 0 && setuid(kNobody) != 0) _exit(1);
    try {
      const http::HttpServer server(kPort, {}, [](const http::Request&) { return http::Reply{}; });
    } catch (const Failure& failure) {
      std::fputs(failure.what(), stderr);
      _exit(static_cast<int>(failure.code));
    }
    _exit(0);
  };
  EXPECT_EXIT(listen(), testing::ExitedWithCode(2), "port 80 .*ports below 1024 are root's; choose another");
}

}  // namespace
}  // namespace shaken::web
