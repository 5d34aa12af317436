// SPDX-License-Identifier: MIT
// `shaken figures` as far as it needs no daemon; tests/e2e/figures_test.cpp has the rest.
#include "study/verb.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "client/json.h"
#include "study/figures.h"
#include "tests/unit/client/run_client.h"

namespace shaken::study {
namespace {

using client::Outcome;
using ::testing::HasSubstr;

Outcome run_shaken(const std::vector<std::string>& arguments) {
  return client::run_client(arguments, 0, make_all_verbs());
}

TEST(AllVerbs, FiguresStandBehindPlot) {
  std::string names;
  for (const auto& verb : make_all_verbs()) names += std::string(verb->info().name) + " ";
  EXPECT_THAT(names, HasSubstr(" results plot figures picture movie "));
  const Outcome help = run_shaken({"figures", "--help"});
  EXPECT_EQ(help.code, ExitCode::kOk);
  EXPECT_THAT(help.out, HasSubstr("shaken figures --draw-only"));
}

TEST(Figures, ListsEveryOne) {
  const Outcome list = run_shaken({"figures", "--list", "--json"});
  EXPECT_EQ(list.code, ExitCode::kOk) << list.err;
  const Json figures = Json::parse(list.out);
  EXPECT_EQ(figures.size(), paper_figures().size());
  EXPECT_EQ(figures.at(0).at("number"), "2");
  EXPECT_EQ(figures.back().at("number"), Json());
  EXPECT_THAT(run_shaken({"figures", "--list"}).out, HasSubstr("PAPER  NAME"));
}

TEST(Figures, AreAskedForByThePapersNumberOrTheirName) {
  for (const char* word : {"14", "defects"}) {
    const Json list = Json::parse(run_shaken({"figures", word, "--list", "--json"}).out);
    ASSERT_EQ(list.size(), 1u) << word;
    EXPECT_EQ(list.at(0).at("id"), "14");
    EXPECT_EQ(list.at(0).at("name"), "defects");
  }
  EXPECT_THAT(run_shaken({"figures", "defect"}).err, HasSubstr("no figure 'defect'; did you mean defects?"));
}

TEST(Figures, RefusesAllThatIsWrongAtOnce) {
  const Outcome outcome = run_shaken({"figures", "17", "layers?", "--scale", "huge", "--draw-only", "--dry-run"});
  EXPECT_EQ(outcome.code, ExitCode::kBadInput);
  for (const char* words :
       {"--scale takes tiny, laptop or paper, not 'huge'", "there is no figure '17'", "there is no figure 'layers?'",
        "exclude each other", "figures: 2 3 4 5 6 7 8 9 10 11 12 13 14 start order "}) {
    EXPECT_THAT(outcome.err, HasSubstr(words));
  }
}

TEST(Figures, RefusesWhatSlurmCouldNotMean) {
  const Outcome outcome =
      run_shaken({"figures", "--executor", "slurm", "--partition", "a b", "--time", "4 mm", "--memory", "2GB",
                  "--runs-per-task", "0", "--slurm-option=--array=1", "--cores", "0"});
  EXPECT_EQ(outcome.code, ExitCode::kBadInput);
  for (const char* words :
       {"--partition: expected the name of a partition", "--time: ", "--memory: expected a whole",
        "--runs-per-task: ", "--slurm-option: --array is set by the daemon", "--cores must be at least 1"}) {
    EXPECT_THAT(outcome.err, HasSubstr(words));
  }
  EXPECT_THAT(run_shaken({"figures", "--executor", "slrum"}).err, HasSubstr("--executor takes local or slurm"));
  EXPECT_THAT(run_shaken({"figures", "--partition", "long"}).err, HasSubstr("with --executor slurm only"));
  EXPECT_THAT(run_shaken({"figures", "--plan", "plan.md"}).err, HasSubstr("add --executor slurm"));
}

TEST(Figures, ShellsAreOfferedNamesAndScales) {
  const std::string script = run_shaken({"completion", "bash"}).out;
  EXPECT_THAT(script, HasSubstr("figures)"));
  EXPECT_THAT(script, HasSubstr("\"tiny laptop paper\""));
  EXPECT_THAT(script, HasSubstr("\"2 3 4 5 6 7 8 9 10 11 12 13 14 start order "));
}

}  // namespace
}  // namespace shaken::study
