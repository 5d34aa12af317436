// SPDX-License-Identifier: MIT
#include "client/picture_options.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <sstream>
#include <string>

#include "client/live/json.h"
#include "client/verb.h"
#include "tests/unit/client/fake_daemon.h"

namespace shaken::client {
namespace {

TEST(PictureOptions, GoOnAsTheyWereGiven) {
  CLI::App app;
  Arguments arguments(app);
  PictureOptions options;
  options.declare(arguments, true);
  app.parse("1f0c --style mine.json --colour tilt --range=-0.2,0.2 --no-legend --defects --bare -o x.png");
  EXPECT_EQ(options.jobs, std::vector<std::string>{"1f0c"});
  EXPECT_EQ(options.out, "x.png");
  EXPECT_EQ(options.words({"rods.length=2.5"}),
            (std::vector<std::string>{"--style=mine.json", "--colour=tilt", "--range=-0.2,0.2", "--defects",
                                      "--no-legend", "--label=rods.length=2.5", "--bare"}));
}

TEST(PictureOptions, TheLabelOfTheCommandLineComesFirst) {
  CLI::App app;
  Arguments arguments(app);
  PictureOptions options;
  options.declare(arguments, true);
  app.parse("1f0c --label mine");
  EXPECT_EQ(options.words({"rods.length=2.5"}), (std::vector<std::string>{"--label=mine"}));
}

TEST(PictureOptions, EachOfSeveralRunsHasItsHeadline) {
  CLI::App app;
  Arguments arguments(app);
  PictureOptions options;
  options.declare(arguments, true);
  app.parse("1f0c 22ab");
  EXPECT_EQ(options.jobs, (std::vector<std::string>{"1f0c", "22ab"}));
  EXPECT_EQ(options.words({"rods.length=2.5", ""}), (std::vector<std::string>{"--label=rods.length=2.5", "--label="}));
  EXPECT_EQ(options.words({"", ""}), std::vector<std::string>{});
  EXPECT_EQ(labels_of({{.directory = "a", .name = "a"}, {.directory = "b", .name = "b", .label = "x"}}),
            (std::vector<std::string>{"a", "x"}))
      << "panels without a headline cannot be told apart";
  EXPECT_EQ(labels_of({{.directory = "a", .name = "a"}}), std::vector<std::string>{""});
}

TEST(SweepInset, HasThePointsOfTheSweepAndWhereTheRunsAre) {
  ScratchFolder root;
  FakeDaemon daemon(root.path());
  Json rows = Json::array();
  const auto add = [&](const char* id, Json parameters, const Json& summary) {
    rows.push_back({{"job", id},
                    {"sweep", "s1"},
                    {"state", summary.is_null() ? "queued" : "done"},
                    {"label", ""},
                    {"replica", 1},
                    {"parameters", std::move(parameters)},
                    {"summary", summary}});
  };
  add("a", {{"rods.area_fraction", 0.45}, {"rods.length", "2.5 mm"}}, {{"order", {{"mean", 0.25}}}});
  add("b", {{"rods.area_fraction", 0.75}, {"rods.length", "4.5 mm"}}, nullptr);
  add("c", {{"rods.area_fraction", 0.75}, {"rods.length", "2.5 mm"}}, nullptr);
  daemon.on("GET /v1/sweeps/s1", Json{{"sweep", {{"id", "s1"}, {"name", "x"}}}, {"jobs", Json::array()}}.dump());
  daemon.on("GET /v1/results?sweep=s1", Json{{"rows", rows}}.dump());
  std::ostringstream out;
  Console console{.out = out, .err = out};
  const CLI::App app;
  const Context context{console, root.path().string(), app};
  const auto drawn = [](const char* id, const char* sweep) {
    return Drawn{.directory = "", .name = id, .id = id, .sweep = sweep};
  };
  const Json said = Json::parse(sweep_of(context, {drawn("b", "s1"), drawn("a", "s1")}));
  EXPECT_EQ(said.at("x"), "rods.area_fraction");
  EXPECT_EQ(said.at("y"), "rods.length");
  EXPECT_EQ(said.at("points"), (Json{{0.45, 2.5, 0.25}, {0.75, 4.5, nullptr}, {0.75, 2.5, nullptr}}));
  EXPECT_EQ(said.at("here"), (Json{{0.75, 4.5}, {0.45, 2.5}}));
  EXPECT_THROW(sweep_of(context, {drawn("d", "s1")}), Failure) << "of another sweep";
  EXPECT_THROW(sweep_of(context, {drawn("a", "")}), Failure) << "a run directory";
  daemon.on("GET /v1/results?sweep=s1", Json{{"rows", {rows[0]}}}.dump());
  EXPECT_THROW(sweep_of(context, {drawn("a", "s1")}), Failure) << "nothing differs";
}

}  // namespace
}  // namespace shaken::client
