#include "web/guard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace shaken::web {
namespace {

using http::Request;

constexpr const char* kToken = "0123456789abcdef0123456789abcdef";
constexpr int kPort = 8642;

const Guard kGuard(kToken, kPort);

Request request(const std::string& path = "/", std::multimap<std::string, std::string> headers = {}) {
  headers.emplace("host", "127.0.0.1:8642");
  return {.method = "GET", .path = path, .query = {}, .body = "", .headers = std::move(headers)};
}

std::pair<std::string, std::string> bearer(const std::string& token) { return {"authorization", "Bearer " + token}; }

/// The status of the refusal; 0 if the request may pass.
int stopped(const Request& asked) {
  const auto refusal = kGuard.stop(asked);
  return refusal ? refusal->status : 0;
}

TEST(Guard, LetsInWhoKnowsTheToken) {
  EXPECT_EQ(stopped(request("/v1/status", {bearer(kToken)})), 0);
  EXPECT_EQ(kGuard.address(), std::string("http://127.0.0.1:8642/#token=") + kToken)
      << "what follows the # is not sent, and in no log";
}

TEST(Guard, KeepsOutWhoDoesNot) {
  for (const char* path : {"/v1/status", "/live", "/runs/1f0c000000000000/files", "/tickets", "/palettes.json"}) {
    EXPECT_EQ(stopped(request(path)), 401) << path;
  }
  EXPECT_EQ(stopped(request("/v1/status", {bearer("0123456789abcdef0123456789abcdee")})), 401);
  EXPECT_EQ(stopped(request("/v1/status", {bearer("")})), 401);
  EXPECT_EQ(stopped(request("/v1/status", {{"authorization", std::string("Basic ") + kToken}})), 401);
  EXPECT_EQ(stopped(request("/v1/status", {{"cookie", std::string("token=") + kToken}})), 401)
      << "browsers send cookies to every port of the machine";
  Request asked = request("/v1/status");
  asked.query.emplace("token", kToken);
  EXPECT_EQ(stopped(asked), 401) << "addresses get into histories";
}

TEST(Guard, ThePagesOwnFilesAreNoSecret) {
  for (const char* path : {"/", "/page/main.js", "/chart.js", "/tickets/0123"}) {
    EXPECT_EQ(stopped(request(path)), 0) << path;
    Request asked = request(path);
    asked.method = "POST";
    EXPECT_EQ(stopped(asked), 401) << path;
  }
}

TEST(Guard, NoOtherNameOfThisMachineIsServed) {
  for (const char* host : {"evil.example:8642", "127.0.0.1", "127.0.0.1:8643", "localhost:8642", "[::1]:8642",
                           "127.0.0.1:8642.evil", ""}) {
    Request asked = request("/v1/status", {bearer(kToken)});
    asked.headers.erase("host");
    asked.headers.emplace("host", host);
    EXPECT_EQ(stopped(asked), 403) << host;
  }
}

TEST(Guard, AnotherPageChangesNothing) {
  const auto post = [](const char* origin) {
    Request asked = request("/v1/sweeps", {bearer(kToken)});
    asked.method = "POST";
    if (origin != nullptr) asked.headers.emplace("origin", origin);
    return stopped(asked);
  };
  EXPECT_EQ(post("http://127.0.0.1:8642"), 0);
  EXPECT_EQ(post(nullptr), 0) << "curl sends none, and no page can leave it out";
  for (const char* origin : {"https://evil.example", "null", "http://127.0.0.1:9000", "http://localhost:8642",
                             "https://127.0.0.1:8642", "http://"}) {
    EXPECT_EQ(post(origin), 403) << origin;
  }
}

TEST(Token, IsAnotherOneEachTime) {
  const auto one = make_token(), other = make_token();
  ASSERT_TRUE(one && other);
  EXPECT_THAT(*one, testing::MatchesRegex("[0-9a-f]+"));
  EXPECT_EQ(one->size(), 32u);
  EXPECT_NE(*one, *other);
}

TEST(Token, OnlyTheWholeOneFits) {
  const std::string token(32, 'a');
  EXPECT_TRUE(is_token(token, token));
  EXPECT_FALSE(is_token(std::string(31, 'a'), token));
  EXPECT_FALSE(is_token(std::string(33, 'a'), token));
  EXPECT_FALSE(is_token("", token));
  for (std::size_t i = 0; i < token.size(); ++i) {
    std::string other = token;
    other[i] = 'b';
    EXPECT_FALSE(is_token(other, token)) << i;
  }
}

TEST(Tickets, AreForOneThingOnce) {
  Tickets tickets;
  const std::string one = tickets.give("/runs/a/files/x", {}),
                    other = tickets.give("/runs/a/picture", {{"frame", "3"}});
  EXPECT_NE(one, other);
  EXPECT_FALSE(tickets.take("0123456789abcdef0123456789abcdef"));
  EXPECT_FALSE(tickets.take(""));
  const auto meant = tickets.take(other);
  ASSERT_TRUE(meant);
  EXPECT_EQ(meant->method, "GET");
  EXPECT_EQ(meant->path, "/runs/a/picture");
  EXPECT_EQ(meant->parameter("frame"), "3");
  EXPECT_FALSE(tickets.take(other)) << "it has been used";
  EXPECT_TRUE(tickets.take(one));
}

TEST(Tickets, LastAMinute) {
  Tickets::Clock::time_point now{};
  Tickets tickets([&] { return now; });
  const std::string used = tickets.give("/runs/a/files/x", {}), late = tickets.give("/runs/a/files/y", {});
  now += std::chrono::minutes(1);
  EXPECT_TRUE(tickets.take(used));
  now += std::chrono::milliseconds(1);
  EXPECT_FALSE(tickets.take(late));
}

}  // namespace
}  // namespace shaken::web
