#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <sstream>
#include <streambuf>

#include "base/files.h"
#include "base/scratch_folder.h"
#include "client/live/json.h"
#include "run/files/frame_log.h"
#include "run/files/observables_file.h"
#include "tests/unit/client/fake_daemon.h"
#include "tests/unit/client/run_client.h"

namespace shaken::client {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A run directory with a log of 5 frames of one rod, at 0, 1 ... 4 s, and a few observables.
class ExportVerb : public ::testing::Test {
 protected:
  ExportVerb() {
    std::filesystem::create_directory(run_);
    write("scene.json", "{}");
    write("summary.json", R"({"n_rods": 1, "measured": {"alpha": {"value": 2, "sem": 0.5}}})");
    EXPECT_TRUE(run::write_observables(run_ / "observables.h5",
                                       {{"/msd/lag_s", {1, 2}}, {"/msd/total_mm2", {0.5, 0.75}}, {"/g2/r_mm", {1}}}));
    const shaken::Cell cell{.box = 10, .gap = 1.5, .shapes = {{{0}, {0.25}}}};
    auto log = run::FrameLog::create(run_ / "trajectory.part", {1, cell, 0.5, "", {}});
    EXPECT_TRUE(log) << log.error().message;
    for (int f = 0; f < 5; ++f) {
      EXPECT_TRUE(log->append({2 * f, 1.0 * f, {1, 2, 0.5}, {0, 0, 0}, {1, 0, 0, 0}, {f, 0, 0}}));
    }
  }

  void write(const std::string& name, const std::string& text) const {
    EXPECT_TRUE(write_file_atomically(run_ / name, text));
  }
  Outcome exported(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"export", run_.string()});
    return run_client(arguments);
  }
  std::string out(const std::string& name) const { return (folder_ / name).string(); }
  /// What there is beside the run.
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      if (entry.path() != run_) names.push_back(entry.path().filename().string());
    }
    return names;
  }

  ScratchFolder folder_;
  std::filesystem::path run_ = folder_ / "first";
};

constexpr const char* kFrame =
    "1\nLattice=\"10 0 0 0 10 0 0 0 1.5\" Properties=species:S:1:pos:R:3:radius:R:1:molecule:I:1 pbc=\"T T F\" "
    "Time={} Step={} units=\"mm s\"\nA1 1 2 0.5 0.25 0\n";

std::string frame_at(int seconds) {
  std::string text = kFrame;
  text.replace(text.find("{}"), 2, std::to_string(seconds));
  return text.replace(text.find("{}"), 2, std::to_string(2 * seconds));
}

TEST_F(ExportVerb, WritesAFileOrPrints) {
  const Outcome written = exported({"-o", out("a.xyz"), "--from", "1 s", "--to", "3000 ms", "--every", "2"});
  EXPECT_EQ(written.code, ExitCode::kOk) << written.err;
  EXPECT_EQ(written.out, out("a.xyz") + ": 2 frames of 1 rod, 292 B\n");
  EXPECT_EQ(*read_file(out("a.xyz")), frame_at(1) + frame_at(3));
  EXPECT_THAT(files(), ::testing::ElementsAre("a.xyz"));

  const Outcome printed = exported({"--format", "xyz", "--last", "-o", "-"});
  EXPECT_EQ(printed.code, ExitCode::kOk);
  EXPECT_EQ(printed.out, frame_at(4));
  EXPECT_EQ(printed.err, "");
}

TEST_F(ExportVerb, FindsAJobOfTheDaemon) {
  const ScratchFolder root;
  FakeDaemon daemon(root.path());
  daemon.on("GET /v1/jobs/1f0c", Json{{"job", {{"id", "1f0c5e2a00000000"}, {"directory", run_.string()}}}}.dump());
  const Outcome outcome =
      run_client({"export", "1f0c", "--format", "xyz", "--last", "-o", "-", "--root", root.path().string()});
  EXPECT_EQ(outcome.code, ExitCode::kOk) << outcome.err;
  EXPECT_EQ(outcome.out, frame_at(4));
}

TEST_F(ExportVerb, ReplacesAFile) {
  ASSERT_TRUE(write_file(out("a.xyz"), "old"));
  EXPECT_EQ(exported({"-o", out("a.xyz"), "--last"}).code, ExitCode::kOk);
  EXPECT_EQ(*read_file(out("a.xyz")), frame_at(4));
}

TEST_F(ExportVerb, MakesTablesOfObservables) {
  EXPECT_EQ(exported({"--format", "csv", "--observable", "msd", "-o", "-"}).out, "lag_s,total_mm2\n1,0.5\n2,0.75\n");
  EXPECT_EQ(exported({"--observable", "g2", "-o", out("g.csv")}).out, out("g.csv") + "\n");
  EXPECT_EQ(*read_file(out("g.csv")), "r_mm\n1\n");
  EXPECT_EQ(exported({"--observable", "summary", "--format", "csv", "-o", "-"}).out,
            "name,value,sem,n_effective,steady,over_s\nn_rods,1,,,,\nalpha,2,0.5,,,\n");
  const Outcome list = exported({"--list"});
  EXPECT_EQ(list.code, ExitCode::kOk);
  EXPECT_THAT(list.out, StartsWith("summary\ng2\n  g2/r_mm "));
}

TEST_F(ExportVerb, SaysAllThatIsWrongWithItsOptions) {
  const auto problems = [&](const std::vector<std::string>& arguments) {
    const Outcome outcome = exported(arguments);
    EXPECT_EQ(outcome.code, ExitCode::kBadInput) << ::testing::PrintToString(arguments);
    EXPECT_EQ(outcome.out, "");
    return outcome.err;
  };
  EXPECT_EQ(problems({}), "shaken: --format is missing: extxyz, gsd, xyz or csv\n");
  EXPECT_THAT(problems({"--format", "pdb\x1b"}), HasSubstr("--format takes extxyz, gsd, xyz or csv, not 'pdb\\u001b'"));
  EXPECT_THAT(problems({"--format", "gsd", "-o", "-"}), HasSubstr("gsd is no text"));
  EXPECT_THAT(problems({"--format", "csv"}), HasSubstr("csv takes --observable NAME; `shaken export "));
  EXPECT_THAT(problems({"--format", "csv", "--observable", "msd", "--last"}), HasSubstr("choose frames, not csv"));
  EXPECT_THAT(problems({"--observable", "summary", "--observable", "msd", "-o", "x.csv"}),
              HasSubstr("--observable summary stands by itself"));
  EXPECT_THAT(problems({"--list", "--last"}), HasSubstr("--list prints names and takes no other option"));
  EXPECT_THAT(problems({"--format", "gsd", "-o", out("")}),
              HasSubstr("is no file that could be replaced: give a name"));
  EXPECT_THAT(problems({"--format", "xyz", "-o", "/dev/null"}), HasSubstr("--out - writes to stdout"));
  const std::string several =
      problems({"-o", out("a.xyz"), "--format", "gsd", "--from", "2 m", "--every", "0", "--observable", "msd"});
  for (const char* problem : {"--from: \"m\" is a unit of length", "--every takes a number from 1, not 0",
                              "--format gsd does not go with ", "--observable goes with --format csv"}) {
    EXPECT_THAT(several, HasSubstr(problem));
  }
  EXPECT_THAT(problems({"--format", "xyz", "--from", "3 s", "--to", "2 s"}), HasSubstr("--from is later than --to"));
  EXPECT_THAT(problems({"--format", "xyz", "--from", "9 s"}), HasSubstr("the 5 frames are from 0 s to 4 s"));
  EXPECT_THAT(problems({"-o", out("a.csv"), "--observable", "mds"}), HasSubstr("is called 'mds'"));
  EXPECT_THAT(files(), ::testing::IsEmpty());
}

TEST_F(ExportVerb, SaysWhatARunDoesNotHave) {
  std::filesystem::remove(run_ / "trajectory.part");
  std::filesystem::remove(run_ / "observables.h5");
  std::filesystem::remove(run_ / "summary.json");
  for (const auto& [arguments, why] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"--format", "gsd"},
            "trajectory.h5: the run records no frames: its scene needs a \"trajectory\" or \"movie\" block"},
           {{"--format", "csv", "--observable", "msd"}, "observables.h5: the run has measured nothing yet"},
           {{"--list"}, "observables.h5: the run has measured nothing yet"},
           {{"--format", "csv", "--observable", "summary"}, "summary.json: the run has not ended"}}) {
    const Outcome outcome = exported(arguments);
    EXPECT_EQ(outcome.code, ExitCode::kBadInput);
    EXPECT_THAT(outcome.err, HasSubstr(why));
  }
}

TEST_F(ExportVerb, DamageLeavesTheFormerFile) {
  std::string bytes = *read_file(run_ / "trajectory.part");
  bytes[bytes.size() - 100] = static_cast<char>(bytes[bytes.size() - 100] ^ 1);
  write("trajectory.part", bytes);
  ASSERT_TRUE(write_file(out("a.gsd"), "old"));
  const Outcome outcome = exported({"-o", out("a.gsd")});
  EXPECT_EQ(outcome.code, ExitCode::kFailed);
  EXPECT_THAT(outcome.err, HasSubstr("frame 3 is damaged"));
  EXPECT_EQ(*read_file(out("a.gsd")), "old");
  EXPECT_THAT(files(), ::testing::ElementsAre("a.gsd"));
}

/// Presses Ctrl-C as soon as something is written.
class Finger : public std::streambuf {
 protected:
  int overflow(int character) override {
    if (!std::exchange(pressed_, true)) std::raise(SIGINT);
    return character;
  }

 private:
  bool pressed_ = false;
};

TEST_F(ExportVerb, InterruptionLeavesTheFormerFile) {
  ASSERT_TRUE(write_file(out("a.xyz"), "old"));
  Finger finger;
  std::ostream terminal(&finger);
  std::ostringstream output;
  Console console{.out = output, .err = terminal, .err_is_terminal = true};
  EXPECT_EQ(run_program({"export", run_.string(), "-o", out("a.xyz")}, console, make_verbs()), ExitCode::kInterrupted);
  EXPECT_EQ(output.str(), "");
  EXPECT_EQ(*read_file(out("a.xyz")), "old");
  EXPECT_THAT(files(), ::testing::ElementsAre("a.xyz"));
}

/// An output that takes nothing, as a pipe that nobody reads.
class Closed : public std::streambuf {};

TEST_F(ExportVerb, AClosedPipeIsAFailure) {
  Closed closed;
  std::ostream pipe(&closed);
  std::ostringstream errors;
  Console console{.out = pipe, .err = errors};
  EXPECT_EQ(run_program({"export", run_.string(), "--format", "xyz", "-o", "-"}, console, make_verbs()),
            ExitCode::kFailed);
  EXPECT_THAT(errors.str(), HasSubstr("cannot write to stdout"));
}

}  // namespace
}  // namespace shaken::client
