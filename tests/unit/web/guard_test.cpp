// SPDX-License-Identifier: MIT
#include "web/guard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace shaken::web {
namespace {

using server::Request;
using testing::HasSubstr;
using testing::Pair;

constexpr const char* kToken = "0123456789abcdef0123456789abcdef";
constexpr int kPort = 8642;

const Guard kGuard(kToken, kPort);

Request request(const std::string& path = "/", std::multimap<std::string, std::string> headers = {}) {
  headers.emplace("host", "127.0.0.1:8642");
  return {.method = "GET", .path = path, .query = {}, .body = "", .headers = std::move(headers)};
}

std::pair<std::string, std::string> cookie(const std::string& token) {
  return {"cookie", "other=1; shaken_8642=" + token + "; shaken_1=x"};
}

/// The status of the answer in place of what was asked for; 0 if the request may pass.
int stopped(const Request& asked) {
  const auto reply = kGuard.stop(asked);
  return reply ? reply->status : 0;
}

TEST(Guard, LetsInWhoKnowsTheToken) {
  EXPECT_EQ(stopped(request("/v1/status", {cookie(kToken)})), 0);
  EXPECT_EQ(stopped(request("/v1/status", {{"authorization", std::string("Bearer ") + kToken}})), 0);
  EXPECT_EQ(kGuard.address(), std::string("http://127.0.0.1:8642/?token=") + kToken);
}

TEST(Guard, KeepsOutWhoDoesNot) {
  EXPECT_EQ(stopped(request("/v1/status")), 401);
  EXPECT_EQ(stopped(request("/page/main.js")), 401) << "the page's files too";
  EXPECT_EQ(stopped(request("/v1/status", {cookie("0123456789abcdef0123456789abcdee")})), 401);
  EXPECT_EQ(stopped(request("/v1/status", {cookie("")})), 401);
  EXPECT_EQ(stopped(request("/v1/status", {{"cookie", std::string("shaken_8643=") + kToken}})), 401)
      << "another port's page";
  EXPECT_EQ(stopped(request("/v1/status", {{"cookie", std::string("xshaken_8642=") + kToken}})), 401);
  EXPECT_EQ(stopped(request("/v1/status", {{"authorization", std::string("Basic ") + kToken}})), 401);
  EXPECT_EQ(stopped(request("/v1/status", {{"authorization", "Bearer "}})), 401);
}

TEST(Guard, TheAddressWithTheTokenLeavesACookieAndGoes) {
  Request asked = request("/");
  asked.query.emplace("token", kToken);
  const auto reply = kGuard.stop(asked);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 303);
  EXPECT_THAT(reply->headers, testing::Contains(Pair("Location", "/")));
  EXPECT_THAT(reply->headers,
              testing::Contains(Pair("Set-Cookie", AllOf(HasSubstr(std::string("shaken_8642=") + kToken),
                                                         HasSubstr("HttpOnly"), HasSubstr("SameSite=Strict")))));
  asked.query = {{"token", "ffffffffffffffffffffffffffffffff"}};
  EXPECT_EQ(stopped(asked), 401);
  asked.query = {{"token", kToken}};
  asked.path = "/v1/status";
  EXPECT_EQ(stopped(asked), 401) << "the token opens the page only: addresses get into histories";
  asked.path = "/";
  asked.method = "POST";
  EXPECT_EQ(stopped(asked), 401);
}

TEST(Guard, NoOtherNameOfThisMachineIsServed) {
  for (const char* host :
       {"evil.example:8642", "127.0.0.1", "127.0.0.1:8643", "localhost", "127.0.0.1:8642.evil", ""}) {
    Request asked = request("/v1/status", {cookie(kToken)});
    asked.headers.erase("host");
    asked.headers.emplace("host", host);
    EXPECT_EQ(stopped(asked), 403) << host;
  }
  Request asked = request("/v1/status", {cookie(kToken)});
  asked.headers.erase("host");
  asked.headers.emplace("host", "localhost:8642");
  EXPECT_EQ(stopped(asked), 0);
}

TEST(Guard, AnotherPageChangesNothing) {
  const auto post = [](const char* origin) {
    Request asked = request("/v1/sweeps", {cookie(kToken)});
    asked.method = "POST";
    if (origin != nullptr) asked.headers.emplace("origin", origin);
    return stopped(asked);
  };
  EXPECT_EQ(post("http://127.0.0.1:8642"), 0);
  EXPECT_EQ(post("http://localhost:8642"), 0);
  EXPECT_EQ(post(nullptr), 0) << "curl sends none, and no page can leave it out";
  for (const char* origin :
       {"https://evil.example", "null", "http://127.0.0.1:9000", "https://127.0.0.1:8642", "http://"}) {
    EXPECT_EQ(post(origin), 403) << origin;
  }
}

}  // namespace
}  // namespace shaken::web
