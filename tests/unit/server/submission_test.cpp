#include "server/submission.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <nlohmann/json.hpp>

#include "scene/sweeps/sweep.h"
#include "tests/support/generated_page.h"
#include "tests/support/good.h"
#include "tests/unit/server/server_support.h"

namespace shaken::server {
namespace {

using testing::HasSubstr;

std::string refusal(const std::string& body) {
  const auto request = submit_keys().read(body, "body");
  return request ? "" : to_string(request.error());
}

TEST(SubmitRequestTest, EveryKeyIsRead) {
  const SubmitRequest request = *submit_keys().read(
      R"({"text": "{}", "file": "a/b.json", "settings": ["x=1", "y=2"], "replicas": 3, "name": "my sweep", "priority": -2,
          "soft_limit_s": 600, "time_limit_s": 0.5, "at_most": 4, "after": ["s1", "1f0c"], "stop_if": "failed > 10 %"})",
      "body");
  EXPECT_EQ(request.text, "{}");
  EXPECT_EQ(request.file, "a/b.json");
  EXPECT_THAT(request.settings, testing::ElementsAre("x=1", "y=2"));
  EXPECT_EQ(request.replicas, 3);
  EXPECT_EQ(request.name, "my sweep");
  EXPECT_EQ(request.priority, -2);
  EXPECT_EQ(request.terms.soft_limit, std::chrono::minutes(10));
  EXPECT_EQ(request.terms.time_limit, std::chrono::milliseconds(500));
  EXPECT_EQ(request.terms.at_most, 4);
  EXPECT_THAT(request.after, testing::ElementsAre("s1", "1f0c"));
  EXPECT_EQ(request.terms.stop_if->text(), "failed>10%");
}

TEST(SubmitRequestTest, WhatIsWrongIsSaidInWords) {
  EXPECT_THAT(refusal(""), HasSubstr("syntax error"));
  EXPECT_THAT(refusal("{\"text\": "), HasSubstr("body:1:10: syntax error"));
  EXPECT_THAT(refusal("[]"), HasSubstr("expected an object"));
  EXPECT_EQ(refusal("{}"), "body:1:1: \"text\" is missing. A scene or sweep file.\n");
  EXPECT_EQ(refusal(R"({"text": 1, "replica": 1, "replicas": 0})"),
            "body:1:10: /text: expected a text, not the number 1\n"
            "body:1:13: /replica: unknown key; did you mean replicas?\n"
            "body:1:39: /replicas: 0 is outside [1, 10000]\n");
  EXPECT_THAT(refusal(R"({"text": "", "replicas": 1.5})"), HasSubstr("not a whole number"));
  EXPECT_THAT(refusal(R"({"text": "", "replicas": 99999999999999999999})"), HasSubstr("/replicas"));
  EXPECT_THAT(refusal(R"({"text": "", "settings": "x=1"})"), HasSubstr("expected a list of texts"));
  EXPECT_THAT(refusal(R"({"text": "", "settings": [1]})"), HasSubstr("expected a text"));
  for (const char* time : {"0", "-1", "1e10", "\"1 mm\"", "[1]", "1e-9"}) {
    EXPECT_THAT(refusal(R"({"text": "", "time_limit_s": )" + std::string(time) + "}"), HasSubstr("/time_limit_s"))
        << time;
  }
  EXPECT_THAT(refusal(R"({"text": "", "at_most": 0})"), HasSubstr("0 is outside [1, "));
  EXPECT_THAT(refusal(R"({"text": "", "after": "s1"})"), HasSubstr("expected a list of texts"));
  EXPECT_THAT(refusal(R"({"text": "", "stop_if": "failed>lots"})"), HasSubstr("write \"failed>10%\""));
  EXPECT_THAT(refusal(R"({"text": "", "name": ""})"), HasSubstr("name"));
  EXPECT_THAT(refusal(R"({"text": "", "name": "a/b"})"), HasSubstr("name"));
  EXPECT_THAT(refusal(R"({"text": "", "name": "\u009b2J"})"), HasSubstr("name"));
  EXPECT_THAT(refusal(R"({"text": "", "name": "\u202e"})"), HasSubstr("name"));
  EXPECT_THAT(refusal(R"({"text": "", "name": "s12"})"), HasSubstr("sweep's id"));
}

// A parser takes 80 bytes for each bracket: a body of 16 MiB took 1.25 GB.
TEST(SubmitRequestTest, NothingIsNestedDeeply) {
  const std::string brackets(1'000'000, '[');
  EXPECT_EQ(refusal(brackets), "body:1:65: nested more than 64 deep\n");
  EXPECT_EQ(refusal(R"({"settings": )" + brackets), "body:1:77: nested more than 64 deep\n");
  EXPECT_EQ(refusal(R"({"text": "\"{[{[{[{[{[{[{[{[{[{[", "name": "x"})"), "") << "brackets in a text are none";
}

TEST(Submission, RodsThatCannotBePlacedAreRefusedAtOnce) {
  SubmitRequest request;
  request.text = R"({"rods": {"area_fraction": 0.915}, "box": {"side": 25}})";
  request.file = "dense.json";
  const auto submission = expand(request, "/nonexistent");
  ASSERT_FALSE(submission);
  ASSERT_EQ(submission.error().size(), 1u);
  EXPECT_THAT(keys::to_string(submission.error().front()), HasSubstr("dense.json: /rods: "));
  EXPECT_THAT(submission.error().front().message, HasSubstr("do not fit into the box: in rows at most "));
}

TEST(SubmitRequestTest, NoBytesCrashIt) {
  EXPECT_TRUE(rc::check("any bytes", [](const std::string& body) { refusal(body); }));
  const std::string good = R"({"text": "{}", "settings": ["x=1"], "replicas": 3, "name": "n"})";
  EXPECT_TRUE(rc::check("one byte changed", [&good] {
    std::string body = good;
    body[*rc::gen::inRange<std::size_t>(0, good.size())] = *rc::gen::arbitrary<char>();
    refusal(body);
  }));
}

// The tables in docs/protocol.md. To write them anew: SHAKEN_UPDATE_DOCS=1 and run this test.
TEST(SubmitRequestTest, TheReferenceIsUpToDate) {
  expect_generated(SHAKEN_SOURCE_DIR "/docs/protocol.md", "submission", submit_keys().as_markdown());
  expect_generated(SHAKEN_SOURCE_DIR "/docs/protocol.md", "cleaning", clean_keys().as_markdown());
}

TEST(ExpandTest, APlainSceneIsOneJobNamedAfterItsFile) {
  const ScratchFolder directory;
  SubmitRequest request;
  request.text = "{}";
  request.file = "folder/plain.json";
  const auto submission = test::good(expand(request, directory.path()));
  EXPECT_EQ(submission->name, "plain");
  ASSERT_EQ(submission->jobs.size(), 1U);
  EXPECT_EQ(submission->jobs[0].has_results, false);
}

// The points of this one would not fit: a name is looked at before there are any.
TEST(ExpandTest, ANameIsCheckedBeforeThePoints) {
  const std::string far_too_many = R"({"sweep": {"replicas": 1000000000}})";
  for (const auto& [text, file] : {std::pair{far_too_many, std::string("s9.json")},
                                   {R"({"name": "s9", )" + far_too_many.substr(1), std::string("a.json")},
                                   {far_too_many, std::string("a\nb.json")}}) {
    SubmitRequest request;
    request.text = text;
    request.file = file;
    EXPECT_THAT(test::refusal(expand(request, "/nowhere")),
                testing::AnyOf(HasSubstr("sweep's id"), HasSubstr("a name has 1 to")));
  }
}

TEST(ExpandTest, ANameIsCheckedWhereverItComesFrom) {
  SubmitRequest request;
  request.text = R"({"name": "s12", "scene": {}})";
  EXPECT_THAT(test::refusal(expand(request, "/nonexistent")), HasSubstr("sweep's id"));
  request.name = "named";
  EXPECT_TRUE(expand(request, "/nonexistent"));
  request.text = R"({"name": "\u001b[2J", "scene": {}})";
  EXPECT_FALSE(expand(request, "/nonexistent"));
}

TEST(ExpandTest, WhatTheWorkerReadsIsTheSameRun) {
  const ScratchFolder directory;
  SubmitRequest request;
  request.text = R"({"scene": {"box": {"gap": "1.3 mm"}}, "sweep": {"grid": {"rods.area_fraction": [0.5, 0.6]}}})";
  request.replicas = 2;
  request.name = "named";
  const auto submission = test::good(expand(request, directory.path()));
  EXPECT_EQ(submission->name, "named");
  ASSERT_EQ(submission->jobs.size(), 4U);
  for (const NewJob& job : submission->jobs) {
    request.text = job.scene;
    request.replicas.reset();
    const auto again = test::good(expand(request, directory.path()));
    EXPECT_EQ(again->jobs.at(0).id, job.id);
    EXPECT_TRUE(nlohmann::json::parse(job.parameters).contains("rods.area_fraction"));
  }
}

TEST(ExpandTest, AllThatIsWrongIsListed) {
  SubmitRequest request;
  request.text = R"({"rodz": {}, "box": {"gap": "1.2 kg"}})";
  const auto submission = expand(request, "/nonexistent");
  ASSERT_FALSE(submission);
  EXPECT_EQ(submission.error().size(), 2U);
}

}  // namespace
}  // namespace shaken::server
