#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>

#include "base/keys/markdown.h"
#include "base/process.h"
#include "client/arguments.h"
#include "client/catalogue.h"
#include "client/console.h"
#include "client/live/json.h"
#include "client/picture_options.h"
#include "client/verb.h"
#include "tests/support/generated_page.h"
#include "tests/support/good.h"
#include "tests/unit/client/fake_daemon.h"
#include "tests/unit/client/run_client.h"

namespace shaken::client {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(Help, OfEveryVerbEndsWithExamplesOfThatVerbAndExitCodes) {
  const auto verbs = make_verbs();
  ASSERT_GE(verbs.size(), 14u);
  const Outcome all = run_client({"--help"});
  EXPECT_EQ(all.code, ExitCode::kOk);
  for (const auto& verb : verbs) {
    const std::string name = verb->info().name;
    EXPECT_THAT(all.out, HasSubstr("  " + name + " "));
    const Outcome help = run_client({name, "--help"});
    EXPECT_EQ(help.code, ExitCode::kOk) << name;
    EXPECT_EQ(help.err, "") << name;
    const auto examples = help.out.find("\nExamples:\n");
    ASSERT_NE(examples, std::string::npos) << name;
    EXPECT_NE(help.out.find("shaken " + name, examples), std::string::npos) << name;
    EXPECT_NE(help.out.find("\n\nExit codes: 0 ", examples), std::string::npos) << name;
    std::istringstream lines(help.out.substr(examples));
    const std::regex option(" (--?[a-z-]+)"), others(R"(   .*|\||&&|\$\(.*)");  // words beside it, and other commands
    for (std::string line; std::getline(lines, line) && name != "bench";) {     // whose options are of its benches
      if (!line.starts_with("  shaken " + name)) continue;
      line = line.substr(2);
      std::smatch end;
      if (std::regex_search(line, end, others)) line = end.prefix();
      for (std::sregex_iterator found(line.begin(), line.end(), option); found != std::sregex_iterator(); ++found)
        EXPECT_NE(help.out.substr(0, examples).find((*found)[1]), std::string::npos) << line;
    }
    EXPECT_EQ(help.out.back(), '\n') << name;
  }
}

TEST(Help, ListsTheExitCodes) {
  EXPECT_THAT(run_client({"--help"}).out, HasSubstr("0 done   1 failed   2 bad input   3 no daemon"));
}

TEST(Version, IsPrinted) {
  EXPECT_THAT(shown(run_client({"--version"})), ::testing::MatchesRegex("shaken [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

TEST(BadArguments, UnknownVerbSuggestsTheNearest) {
  EXPECT_THAT(test::said_with(ExitCode::kBadInput, run_client({"stauts"})),
              HasSubstr("'stauts'; did you mean status?"));
  EXPECT_THAT(run_client({"xyzzyx"}).err, Not(HasSubstr("did you mean")));
}

TEST(TwoDashes, EndTheOptionsOfEveryVerb) {
  EXPECT_THAT(test::said_with(ExitCode::kBadInput, run_client({"validate", "--", "-rf"})),
              HasSubstr("cannot open -rf"));
  EXPECT_THAT(run_client({"validate", "--", "-rf", "more"}).err, HasSubstr("'more'"));
  EXPECT_THAT(run_client({"validate", "--", "--"}).err, HasSubstr("cannot open --"));
}

TEST(BadArguments, UnknownOptionSuggestsTheNearest) {
  EXPECT_THAT(test::said_with(ExitCode::kBadInput, run_client({"results", "--agregate"})),
              HasSubstr("did you mean --aggregate?"));
  EXPECT_THAT(run_client({"--rot", "x", "status"}).err, HasSubstr("did you mean --root?"));
}

TEST(Rest, GoesOnAsItStands) {
  CLI::App app;
  app.fallthrough();
  CLI::App* verb = app.add_subcommand("verb", "");
  std::vector<std::string> words;
  Arguments(*verb).rest(words);
  app.parse("verb name --json -o out --help word");
  EXPECT_THAT(words, ::testing::ElementsAre("name", "--json", "-o", "out", "--help", "word"));
}

TEST(HandOn, GivesWhatHasNoVariable) {
  const auto handed = [](auto line) {
    CLI::App app;
    app.fallthrough();
    app.add_option("--root", "of the program");
    Arguments arguments(*app.add_subcommand("verb", ""));
    std::string own;
    std::vector<std::string> words;
    arguments.option("-n,--name", "NAME", "");
    arguments.option("--own", own, "NAME", "");
    arguments.repeatable("-w,--where", "CONDITION", "");
    arguments.flag("-y,--yes", "");
    arguments.list("WORD", "", "a|b");
    arguments.hand_on(words);
    app.parse(line);
    return words;
  };
  using ::testing::ElementsAre;
  EXPECT_THAT(handed("verb one --own x two -w a=1 --name=-5 --where b --root r -y three"),
              ElementsAre("--name=-5", "--where=a=1", "--where=b", "--yes", "--", "one", "two", "three"));
  EXPECT_THAT(handed("verb -y"), ElementsAre("--yes")) << "not every program takes words";
  EXPECT_THAT(handed(std::vector<std::string>{"", "--name", "verb"}), ElementsAre()) << "what is empty was not given";
}

TEST(BadArguments, AreAllExitCodeTwo) {
  for (const auto& arguments : std::vector<std::vector<std::string>>{{},
                                                                     {"validate"},
                                                                     {"cancel"},
                                                                     {"clean", "--older", "soon"},
                                                                     {"wait", "--timeout", "soon"},
                                                                     {"watch", "--graphics", "iterm"},
                                                                     {"validate", "no/such/file.json"},
                                                                     {"run", "no/such/scene.json"},
                                                                     {"movie", "x", "--frame", "-3"},
                                                                     {"movie", "x", "--frame", "1", "--live"},
                                                                     {"picture", "x", "--frame", "1", "--time", "2"},
                                                                     {"plot", "s1", "--map", "--x", "rods.length"},
                                                                     {"calibrate", "no/such/scene.json", "-d", "40"},
                                                                     {"calibrate", "-s", "rods.lenght=3", "-d", "40"},
                                                                     {"import"},
                                                                     {"import", "x"},
                                                                     {"import", "x", "--scene", "y", "--frame", "-1"},
                                                                     {"export", "x"},
                                                                     {"export", "--format", "gsd"},
                                                                     {"record", "-o", "x", "--size", "large"},
                                                                     {"record", "-o", "x", "--for", "soon"},
                                                                     {"record", "-o", "/"},
                                                                     {"replay-log"},
                                                                     {"replay-log", "x", "--speed", "0"},
                                                                     {"replay-log", "x", "--from", "-1s"},
                                                                     {"replay-log", "x", "--from", "2s", "--to", "1s"},
                                                                     {"results", "--csv", "--json"},
                                                                     {"results", "--where", "order"},
                                                                     {"completion", "fish"},
                                                                     {"schema", "film"},
                                                                     {"status", "a", "b"}}) {
    EXPECT_THAT(test::said_with(ExitCode::kBadInput, run_client(arguments)), HasSubstr("shaken: "))
        << ::testing::PrintToString(arguments);
  }
}

TEST(NoDaemon, IsExitCodeThreeAndSaysHowToStartOne) {
  const ScratchFolder root;
  for (const char* verb : {"status", "watch", "wait", "results", "plot"}) {
    const Outcome outcome = run_client({"--root", root.path().string(), verb});
    EXPECT_EQ(outcome.code, ExitCode::kNoDaemon) << verb;
    EXPECT_THAT(outcome.err, HasSubstr("shakend --root " + root.path().string())) << verb;
    EXPECT_THAT(run_client({verb, "--help"}).out, ::testing::ContainsRegex("3[ \n]no daemon")) << verb;
    EXPECT_EQ(outcome.out, "") << verb;
  }
}

TEST(NoDaemon, RootMayStandBehindTheVerbAndInTheEnvironment) {
  const ScratchFolder root;
  EXPECT_THAT(run_client({"status", "--root", root.path().string()}).err, HasSubstr(root.path().string()));
  setenv("SHAKEN_ROOT", root.path().c_str(), 1);
  EXPECT_THAT(run_client({"status"}).err, HasSubstr(root.path().string()));
  unsetenv("SHAKEN_ROOT");
}

TEST(NoDaemon, WithoutAnyRootIsRefusedOnlyWhereOneIsNeeded) {
  const char* given = std::getenv("HOME");
  const std::string home = given == nullptr ? "" : given;
  for (const char* name : {"HOME", "XDG_DATA_HOME", "SHAKEN_ROOT"}) unsetenv(name);
  const Outcome status = run_client({"status"}), completion = run_client({"completion", "bash"});
  if (given != nullptr) setenv("HOME", home.c_str(), 1);
  EXPECT_EQ(status.code, ExitCode::kBadInput);
  EXPECT_THAT(status.err, HasSubstr("no root directory: set --root, SHAKEN_ROOT, or HOME to an absolute path"));
  EXPECT_EQ(completion.code, ExitCode::kOk);
}

TEST(NoDaemon, TooLongARootIsRefusedRatherThanCut) {
  EXPECT_THAT(test::said_with(ExitCode::kBadInput, run_client({"status", "--root", "/tmp/" + std::string(120, 'x')})),
              HasSubstr("too long"));
}

class Validate : public ::testing::Test {
 protected:
  void write(const std::string& scene) const { std::ofstream(file_) << scene; }

  const ScratchFolder folder_;
  const std::string file_ = (folder_.path() / "scene.json").string();
};

TEST_F(Validate, ListsEveryProblemAtOnce) {
  write(R"({"rods": {"lenght": 4.5}, "box": {"gap": -1}})");
  EXPECT_THAT(test::said_with(ExitCode::kBadInput, run_client({"validate", file_})),
              AllOf(HasSubstr("2 problems"), HasSubstr("lenght"), HasSubstr("gap")));

  const Outcome json = run_client({"validate", file_, "--json"});
  EXPECT_EQ(json.code, ExitCode::kBadInput);
  EXPECT_THAT(json.out, HasSubstr("\"ok\": false"));
  EXPECT_THAT(json.out, HasSubstr("\"line\": 1"));
}

TEST_F(Validate, StarterSceneIsFineAndItsNumbersFollow) {
  ASSERT_EQ(run_client({"init", file_}).code, ExitCode::kOk);
  const Outcome summary = run_client({"validate", file_});
  EXPECT_EQ(summary.code, ExitCode::kOk) << summary.err;
  EXPECT_THAT(summary.out, HasSubstr("is fine: one run"));
  // 100 s in ticks of 4 us.
  EXPECT_THAT(summary.out, HasSubstr("2.5e+07"));

  EXPECT_THAT(run_client({"validate", file_, "--resolved"}).out, HasSubstr("\"amplitude\""));
  EXPECT_THAT(run_client({"validate", file_, "-s", "rods.length=2.5,3.5", "--replicas", "2"}).out, HasSubstr("4 runs"));
}

TEST_F(Validate, ShowsThePackingOfEachSpeciesAndOfAll) {
  write(R"({"rods": {"area_fraction": 0.3}, "rods_2": {"beads": 1, "count": 40}, "box": {"side": 40}})");
  EXPECT_THAT(shown(run_client({"validate", file_})),
              AllOf(HasSubstr("233 = 193 + 40"), HasSubstr("0.3132 = 0.3006 + 0.01257")));
  const Json json = Json::parse(run_client({"validate", file_, "--json"}).out);
  const Json& point = json.at("points").at(0);
  EXPECT_EQ(point.at("n_rods"), 233);
  EXPECT_NEAR(point.at("area_fraction").get<double>(), 0.3132, 1e-4);
  EXPECT_EQ(point.at("species").at(1).at("name"), "rods_2");
  EXPECT_EQ(point.at("species").at(1).at("count"), 40);
}

TEST_F(Validate, CountsTheFramesThatAMovieRecords) {
  const auto frames = [&](const std::string& recorded) {
    write(R"({"time": {"steady": 0, "measure": 2})" + recorded + "}");
    return Json::parse(run_client({"validate", file_, "--json"}).out).at("points").at(0).at("trajectory_frames");
  };
  EXPECT_EQ(frames(""), 0);
  EXPECT_EQ(frames(R"(, "movie": {"every": 0.1})"), 21);
  EXPECT_EQ(frames(R"(, "movie": {"every": 0.1}, "trajectory": {"every": 0.5})"), 21);
  EXPECT_EQ(frames(R"(, "movie": {"every": 0.5}, "trajectory": {"every": 0.1})"), 21);
}

TEST_F(Validate, PlacesTheRods) {
  write(R"({"rods": {"area_fraction": 0.915}, "box": {"side": 25}})");
  EXPECT_THAT(test::said_with(ExitCode::kBadInput, run_client({"validate", file_})),
              HasSubstr("do not fit into the box: in rows at most "));
  EXPECT_THAT(run_client({"validate", file_, "--json"}).out, HasSubstr("\"path\": \"/rods\""));
}

TEST_F(Validate, RemarksOnWhatIsHardlyMeant) {
  write(R"({"box": {"side": 25}, "trajectory": {"every": "20 s"}, "time": {"measure": "10 s"}})");
  EXPECT_THAT(shown(run_client({"validate", file_, "-s", "plates.gamma=0.5,7"})),
              AllOf(HasSubstr("remark: plates.gamma is 0.5"), HasSubstr("(in 1 of 2 runs)"),
                    HasSubstr("a single frame, of the start (in 2 of 2 runs)")));
  const Json json = Json::parse(run_client({"validate", file_, "--json"}).out);
  EXPECT_EQ(json.at("points").at(0).at("remarks").size(), 1u);
}

TEST(Init, DoesNotReplaceAFile) {
  const ScratchFolder folder;
  const std::string file = (folder.path() / "scene.json").string();
  std::ofstream(file) << "mine";
  EXPECT_THAT(test::said_with(ExitCode::kBadInput, run_client({"init", file})), HasSubstr("--force"));
  EXPECT_EQ(run_client({"init", file, "--force"}).code, ExitCode::kOk);
}

TEST(Init, NamesTheSchemaThatIsInstalled) {
  const Json scene = Json::parse(run_client({"init", "-"}).out, nullptr, true, true);
  const std::string url = scene.at("$schema").get<std::string>();
  ASSERT_THAT(url, ::testing::StartsWith("file:///"));
  std::ifstream file(url.substr(7));
  EXPECT_EQ(Json::parse(file).at("title"), "Scene of Shaken");
}

TEST(Schema, IsPrintedOfScenesAndOfSweeps) {
  const Json scene = Json::parse(run_client({"schema"}).out);
  EXPECT_EQ(Json::parse(run_client({"schema", "scene"}).out), scene);
  EXPECT_TRUE(scene.at("properties").contains("rods"));
  const Json sweep = Json::parse(run_client({"schema", "sweep"}).out);
  EXPECT_TRUE(sweep.at("then").at("properties").contains("sweep"));
  EXPECT_EQ(Json::parse(run_client({"schema", "style"}).out)["properties"]["theme"]["default"], "light");
  EXPECT_THAT(run_client({"schema", "film"}).err, HasSubstr("\"film\" is neither scene, sweep, style nor catalogue"));
}

TEST(CommandLine, HelpIsAVerbToo) {
  EXPECT_EQ(run_client({"help"}).out, run_client({"--help"}).out);
  EXPECT_EQ(run_client({"help", "plot"}).out, run_client({"plot", "--help"}).out);
  EXPECT_EQ(run_client({"help"}).code, ExitCode::kOk);
  EXPECT_THAT(run_client({"help", "plto"}).err, HasSubstr("did you mean plot?"));
}

// A list of problems is a line each, and nothing below.
TEST(CommandLine, NoRefusalEndsWithAnEmptyLine) {
  const ScratchFolder folder;
  const std::string file = (folder.path() / "a.json").string();
  std::ofstream(file) << R"({"rods": {"lenght": 3}, "box": {"sied": 3}})";
  for (const std::vector<std::string>& command : {std::vector<std::string>{"validate", file},
                                                  {"validate", file, "-s", "box.side"},
                                                  {"plot", "--format", "bmp"}}) {
    EXPECT_THAT(test::said_with(ExitCode::kBadInput, run_client(command)),
                AllOf(::testing::Not(::testing::EndsWith("\n\n")), ::testing::EndsWith("\n")));
  }
}

TEST(Completion, BashScriptCompletesVerbsAndOptions) {
  const ScratchFolder folder;
  const std::string script = (folder.path() / "shaken.bash").string();
  std::ofstream(script) << run_client({"completion", "bash"}).out;
  const auto completed = [&](const std::string& words, int index) {
    return run_captured({"bash", "-c",
                         "set -eu; complete() { :; }; source '" + script + "'; COMP_WORDS=(" + words +
                             "); COMP_CWORD=" + std::to_string(index) + "; _shaken || true; echo \"${COMPREPLY[@]}\""})
        .output;
  };
  EXPECT_EQ(completed("shaken sta", 1), "status\n");
  EXPECT_EQ(completed("shaken --root /tmp wat", 3), "watch\n");
  EXPECT_EQ(completed("shaken results --agg", 2), "--aggregate\n");
  EXPECT_EQ(completed("shaken plot --format s", 3), "svg\n");
  EXPECT_EQ(completed("shaken submit -s rods.le", 3), "rods.length= rods.length_spread=\n");
  EXPECT_EQ(completed("shaken submit -s rods.mi", 3), "rods.mid_diameter=\n");
  EXPECT_EQ(completed("shaken submit -s rods.start = al", 5), "aligned\n") << "bash splits words at =";
  EXPECT_EQ(completed("shaken picture x --style la", 4), "layers\n");
  EXPECT_EQ(completed("shaken schema sw", 2), "sweep\n");
  EXPECT_EQ(completed("shaken movie " + folder.path().string().substr(0, folder.path().string().size() - 1), 2),
            folder.path().string() + "\n");
  EXPECT_EQ(completed("shaken status " + folder.path().string().substr(0, folder.path().string().size() - 1), 2), "\n")
      << "a directory is no job";
  EXPECT_EQ(completed("shaken validate " + folder.path().string() + "/sh", 2), script + "\n");
  EXPECT_EQ(run_captured({"bash", "-n", script}).exit_code, 0);
  // a name with a blank is one word, and what looks like a command is none
  const auto of_sweeps = [&](const std::string& word) {
    return run_captured(
               {"bash", "-c",
                "set -eu; complete() { :; }; source '" + script +
                    "'; shaken() { printf '%s\\n' s1 'two words' 'two $(touch x)'; }; COMP_WORDS=(shaken status " +
                    word + "); COMP_CWORD=2; _shaken || true; printf '[%s]' \"${COMPREPLY[@]}\""})
        .output;
  };
  EXPECT_EQ(of_sweeps("'two\\ w'"), "[two words]");
  EXPECT_EQ(of_sweeps("s"), "[s1]");
  EXPECT_EQ(of_sweeps("two"), "[two words][two $(touch x)]") << "as it is: readline quotes what it puts in";
}

TEST(Agrees, AsksUntilTheAnswerIsClear) {
  std::ostringstream out;
  std::istringstream answers("perhaps\nn\n\ny\n");
  const Console console{.out = out, .err = out, .in = &answers};
  EXPECT_FALSE(console.agrees("Go on?", true));
  EXPECT_EQ(out.str(), "Go on? [Y/n] Go on? [Y/n] ");
  EXPECT_TRUE(console.agrees("Go on?", true)) << "an empty answer";
  EXPECT_TRUE(console.agrees("Go on?", false));
  EXPECT_FALSE(console.agrees("Go on?", false)) << "no answer at all";
}

TEST(Painted, ColoursOnlyWhereWanted) {
  std::ostringstream out;
  Console console{.out = out, .err = out};
  EXPECT_EQ(console.painted(Colour::kRed, "x"), "x");
  console.colour = true;
  EXPECT_EQ(console.painted(Colour::kRed, "x"), "\x1b[31mx\x1b[0m");
  EXPECT_EQ(console.painted(Colour::kPlain, "x"), "x");
}

/// What `shaken picture` makes of a line.
class PictureLine : public ::testing::Test {
 protected:
  PictureLine() { options.declare(arguments_, true); }
  CLI::App app;
  PictureOptions options;

 private:
  Arguments arguments_{app};
};

TEST_F(PictureLine, GoesOnAsItWasGiven) {
  app.parse("1f0c --style mine.json --colour tilt --range=-0.2,0.2 --no-legend --defects --bare -o x.png");
  EXPECT_EQ(options.jobs, std::vector<std::string>{"1f0c"});
  EXPECT_EQ(options.out, "x.png");
  EXPECT_EQ(options.words({"rods.length=2.5"}),
            (std::vector<std::string>{"--style=mine.json", "--colour=tilt", "--range=-0.2,0.2", "--defects",
                                      "--no-legend", "--label=rods.length=2.5", "--bare"}));
}

TEST_F(PictureLine, ItsLabelComesFirst) {
  app.parse("1f0c --label mine");
  EXPECT_EQ(options.words({"rods.length=2.5"}), (std::vector<std::string>{"--label=mine"}));
}

TEST_F(PictureLine, EachOfSeveralRunsHasItsHeadline) {
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

// The catalogue that Python reads is that of the programs. To write it anew: SHAKEN_UPDATE_DOCS=1 and run these tests.

TEST(Catalogue, IsTheOneThatPythonReads) {
  const std::string file = SHAKEN_SOURCE_DIR "/python/shaken/catalogue.json";
  if (std::getenv("SHAKEN_UPDATE_DOCS") != nullptr) std::ofstream(file) << catalogue();
  EXPECT_TRUE(content_of(file) == catalogue()) << file << ": run this test with SHAKEN_UPDATE_DOCS=1";
}

TEST(Catalogue, SaysOfEveryQuantityWhatItIs) {
  const Json all = Json::parse(catalogue());
  std::size_t n_titles = 0;
  for (const char* section : {"keys", "style_keys", "observables", "arrays", "numbers", "summary", "effects"}) {
    for (const auto& [name, row] : all[section].items()) {
      EXPECT_FALSE(row["doc"].get<std::string>().empty()) << name;
      if (!row.contains("unit")) continue;
      const std::string unit = row["unit"], title = row["title"], symbol = row["symbol"];
      EXPECT_EQ(symbol.find('$'), std::string::npos) << name << ": figures set it in mathematics";
      EXPECT_FALSE(title.empty() && !symbol.empty()) << name << " has a symbol without a name";
      EXPECT_EQ(unit.empty(), row.value("of", "") == "plain number" && unit.empty()) << name << " has no unit";
      n_titles += title.empty() ? 0 : 1;
    }
  }
  EXPECT_GE(n_titles, 130U);
}

TEST(Catalogue, ListsTheStatesOfJobsForItsReaders) {
  std::string table = keys::table_head({"state", "meaning", "worker", "ended"});
  const auto yes = [](const Json& is_so) { return is_so.get<bool>() ? "yes" : ""; };
  const Json states = Json::parse(catalogue())["job_states"];
  for (const auto& [word, row] : states.items()) {
    table += keys::table_line(
        {"`" + word + "`", row["doc"].get<std::string>(), yes(row["has_worker"]), yes(row["has_ended"])});
  }
  expect_generated(SHAKEN_SOURCE_DIR "/docs/protocol.md", "states", table);
}

TEST(Catalogue, HasAPartForThePage) {
  const Json all = Json::parse(catalogue());
  const auto table = [&](const char* name, const char* section, std::initializer_list<const char*> members) {
    std::string text = fmt::format("export const {} = {{\n", name);
    for (const auto& [word, row] : all[section].items()) {
      Json of_page;
      for (const char* member : members) of_page[member] = row[member];
      text += fmt::format("  {}: {},\n", Json(word).dump(), of_page.dump());
    }
    return text + "};\n";
  };
  Json averages;
  for (const auto& [name, row] : all["summary"].items()) {
    for (const Json& member : row.value("averages", Json::array()))
      averages.push_back(name + "." + member.get<std::string>());
  }
  expect_generated(SHAKEN_SOURCE_DIR "/web/page/catalogue.js", "catalogue",
                   table("kJobStates", "job_states", {"has_worker", "requests"}) +
                       table("kSteadiness", "steadiness", {"mark", "word"}) +
                       fmt::format("export const kAverages = {};\n", averages.dump()));
}

TEST(Catalogue, NamesAxesThatAreArraysWithoutAxes) {
  const Json arrays = Json::parse(catalogue())["arrays"];
  for (const auto& [name, row] : arrays.items()) {
    for (const Json& axis : row["axes"]) EXPECT_TRUE(arrays[axis.get<std::string>()]["axes"].empty()) << name;
  }
  EXPECT_EQ(arrays["/density/area_fraction"]["axes"], Json({"/density/time_s", "/density/y_mm", "/density/x_mm"}));
  EXPECT_EQ(arrays["/tilt/folded/v_along_mm_s"]["axes"], Json({"/tilt/folded/n_z"}));
  EXPECT_EQ(arrays["/defects/tracks/lasting/speed_plus_mm_s"]["axes"], Json({"/defects/tracks/span_s"}));
  EXPECT_EQ(arrays["/scattering/alpha_2"]["axes"], Json({"/scattering/lag_s"}));
  EXPECT_TRUE(arrays["/defects/list/charge"]["axes"].empty());
}

}  // namespace
}  // namespace shaken::client
