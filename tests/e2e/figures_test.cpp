// SPDX-License-Identifier: MIT
// `shaken figures --scale tiny` as a user runs it: a daemon of its own, every figure, interrupted and gone on with.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/e2e/process.h"

namespace shaken::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;
namespace fs = std::filesystem;

const std::string kShaken = SHAKEN_BIN_DIR "/shaken";

std::vector<std::string> command(const ScratchFolder& root, std::vector<std::string> words) {
  words.insert(words.begin(), {kShaken, "--root", root.path().string(), "figures", "--scale", "tiny", "--configs",
                               SHAKEN_SOURCE_DIR "/configs"});
  return words;
}

bool is_png(const fs::path& file) {
  std::string head(8, '\0');
  std::ifstream(file, std::ios::binary).read(head.data(), 8);
  return head == "\x89PNG\r\n\x1a\n";
}

/// Lines of a data file that hold numbers.
int n_points(const fs::path& file) {
  int n = 0;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) n += !line.empty() && line[0] != '#' && line.find("NaN") == line.npos;
  return n;
}

std::set<fs::path> runs_under(const fs::path& root) {
  std::set<fs::path> runs;
  for (const auto& entry : fs::directory_iterator(root / "runs")) runs.insert(entry.path());
  return runs;
}

TEST(Figures, TinyScaleMakesEveryFigureAndGoesOnAfterAnInterruption) {
  const ScratchFolder root, out;
  const fs::path folder = out.path() / "figures";
  {
    Process first(command(root, {"-o", folder.string()}), out.path() / "first.txt");
    ASSERT_TRUE(first.wait_for("fig10-tilt.png", std::chrono::seconds(120))) << first.output();
    first.signal(SIGINT);
    EXPECT_EQ(first.wait(std::chrono::seconds(60)), 130);
    EXPECT_THAT(first.output(), HasSubstr("runs to be done: about "));
    EXPECT_THAT(first.output(), HasSubstr("goes on from here"));
    EXPECT_FALSE(fs::exists(root.path() / "shakend.sock")) << "its daemon has gone with it";
  }
  std::set<fs::path> done;
  for (const fs::path& run : runs_under(root.path())) {
    if (fs::exists(run / "summary.json") &&
        Json::parse(std::ifstream(run / "summary.json"))["exit"]["state"] == "done") {
      done.insert(run);
    }
  }
  EXPECT_FALSE(done.empty());
  std::map<fs::path, fs::file_time_type> written;
  for (const fs::path& run : done) written[run] = fs::last_write_time(run / "summary.json");

  const Finished second = run_command(command(root, {"-o", folder.string(), "--json"}), std::chrono::seconds(240));
  ASSERT_EQ(second.code, 0) << second.output;
  for (const auto& [run, time] : written) {
    EXPECT_EQ(fs::last_write_time(run / "summary.json"), time) << run << " was done again";
  }
  const Finished list = run_command(command(root, {"--list", "--json"}));
  int n_figures = 0;
  for (const Json& figure : Json::parse(list.output)) n_figures += figure["id"] != "movies";
  int n_pages = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".gp") continue;
    ++n_pages;
    fs::path beside = entry.path();
    EXPECT_TRUE(is_png(beside.replace_extension(".png"))) << beside;
    EXPECT_GT(n_points(beside.replace_extension(".dat")), 2) << beside;
  }
  EXPECT_EQ(n_pages, n_figures);
  EXPECT_TRUE(fs::exists(folder / "movies" / "S1.mp4"));
  int n_with_data = 0;
  for (const Json& claim : Json::parse(std::ifstream(folder / "claims.json"))) {
    if (claim["verdict"] == "no data") continue;
    ++n_with_data;
    EXPECT_EQ(claim["verdict"], "not resolved") << "a third of a second decides nothing: " << claim;
    EXPECT_NE(claim["why"], "") << claim;
  }
  EXPECT_GT(n_with_data, 20);

  // Redrawn from what is there, without any daemon.
  fs::remove_all(folder);
  const Finished again = run_command(command(root, {"3", "--draw-only", "-o", folder.string()}));
  EXPECT_EQ(again.code, 0) << again.output;
  EXPECT_TRUE(is_png(folder / "fig03-order.png"));
  EXPECT_FALSE(fs::exists(root.path() / "shakend.sock"));
  for (const Json& claim : Json::parse(std::ifstream(folder / "claims.json"))) EXPECT_EQ(claim["figure"], "3") << claim;
}

TEST(Figures, WhatWouldFailAfterHoursFailsAtOnce) {
  const ScratchFolder root, out;
  std::ofstream(out.path() / "plain.md") << "no marks\n";
  const std::string blocked = (out.path() / "plain.md" / "below-a-file").string();
  const Finished refused = run_command(command(root, {"-o", blocked, "--report", (out.path() / "plain.md").string()}));
  EXPECT_EQ(refused.code, 2) << refused.output;
  EXPECT_THAT(refused.output, HasSubstr("below-a-file"));
  for (const char* section : {"origin", "claims", "sweeps", "figures"}) {
    EXPECT_THAT(refused.output, HasSubstr(std::string(section) + ": begin"));
  }
  EXPECT_FALSE(fs::exists(root.path() / "runs"));
  const Finished nothing = run_command(command(root, {"3", "--draw-only", "-o", (out.path() / "none").string()}));
  EXPECT_EQ(nothing.code, 1);
  EXPECT_THAT(nothing.output, HasSubstr("figure 3: no run is done yet"));
}

TEST(Figures, ADaemonThatDiesIsStartedAgain) {
  const ScratchFolder root, out;
  Process figures(command(root, {"10", "-o", (out.path() / "figures").string()}), out.path() / "out.txt");
  ASSERT_TRUE(figures.wait_for("0/2 runs", std::chrono::seconds(60))) << figures.output();
  const Finished status = run_command(
      {"/usr/bin/curl", "-s", "--unix-socket", (root.path() / "shakend.sock").string(), "http://shaken/v1/status"});
  kill(Json::parse(status.output).at("pid").get<pid_t>(), SIGKILL);
  EXPECT_EQ(figures.wait(std::chrono::seconds(120)), 0) << figures.output();
  EXPECT_THAT(figures.output(), HasSubstr("starting one"));
  EXPECT_TRUE(is_png(out.path() / "figures" / "fig10-tilt.png"));
  EXPECT_THAT(figures.output(), HasSubstr("2/2 runs")) << "a log does not end with how far it was a minute before";
}

TEST(Figures, SaysWhatIsQueuedBeforeIt) {
  const ScratchFolder root, out;
  Process figures(command(root, {"10", "-o", (out.path() / "figures").string()}), out.path() / "out.txt");
  ASSERT_TRUE(figures.wait_for("0/2 runs", std::chrono::seconds(60))) << figures.output();
  EXPECT_THAT(figures.output(), Not(HasSubstr("were queued here before")));
  figures.signal(SIGINT);
  EXPECT_EQ(figures.wait(std::chrono::seconds(60)), 130) << figures.output();
  const Finished again = run_command(command(root, {"10", "-o", (out.path() / "figures").string()}));
  EXPECT_EQ(again.code, 0) << again.output;
  EXPECT_THAT(again.output, HasSubstr("jobs were queued here before"));
}

// Without it, it would wait for hours and not say for what.
TEST(Figures, SaysWhatKeepsItsRunsWaiting) {
  const ScratchFolder root, out;
  for (const char* name : {"sbatch", "squeue", "scancel"}) {
    std::ofstream(out / name) << "#!/bin/sh\n[ \"$1\" != --version ] || exit 0\n[ ${0##*/} != sbatch ] || "
                                 "{ echo 'sbatch: error: invalid partition specified: shrot' >&2; exit 1; }\n";
    fs::permissions(out / name, fs::perms::owner_all);
  }
  std::vector<std::string> words =
      command(root, {"10", "-o", (out / "figures").string(), "--executor", "slurm", "--partition", "shrot"});
  words.insert(words.begin(), {"/usr/bin/env", "PATH=" + out.path().string() + ":/usr/bin:/bin"});
  Process figures(words, out / "out.txt");
  EXPECT_TRUE(
      figures.wait_for("2 jobs queued: could not be started: sbatch: error: invalid partition specified: shrot. "
                       "Next attempt at ",
                       std::chrono::seconds(60)))
      << figures.output();
  figures.signal(SIGINT);
  EXPECT_EQ(figures.wait(std::chrono::seconds(60)), 130) << figures.output();
}

TEST(Figures, WrongWordsAreAllTold) {
  const ScratchFolder root;
  const Finished refused = run_command({kShaken, "figures", "17", "layers?", "--scale", "huge"});
  EXPECT_EQ(refused.code, 2);
  for (const char* word : {"17", "layers?", "huge", "larger-box"}) EXPECT_THAT(refused.output, HasSubstr(word));
}

}  // namespace
}  // namespace shaken::test
