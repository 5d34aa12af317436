// What every program does alike with what it is told and what it says.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/e2e/run_command.h"
#include "tests/support/lazy_server.h"

namespace shaken::test {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;

/// A command of the shell in which programs are named by themselves.
Finished shell(const std::string& command) {
  return run_command({"/bin/sh", "-c", "PATH=" SHAKEN_BIN_DIR ":$PATH; " + command});
}

TEST(EveryProgram, EndsWithItsOwnCodeWhereNobodyCanBeToldWhy) {
  const std::vector<std::pair<std::string, int>> commands{
      {"shaken validate nothing.json", 2},   {"shaken-worker nothing.json --out x", 2},
      {"shaken-worker --nothing", 2},        {"shaken-worker replay nothing", 2},
      {"shaken-worker replay --nothing", 2}, {"shaken-render picture nothing -o x.png", 2},
      {"shaken-render nothing", 2},          {"shaken-task /nothing", 1},
      {"shaken-task --nothing", 2},          {"shaken-worker import nothing --scene nothing", 2},
  };
  for (const auto& [command, code] : commands) EXPECT_EQ(shell(command + " 2>/dev/full").code, code) << command;
}

// /bin/echo says what it was started with.
TEST(Worker, GoesOnAsTheWideBuildBesideItWhereTheProcessorCan) {
  const ScratchFolder folder;
  const std::string copy = "cd " + folder.path().string() + "; cp $(command -v shaken-worker) .; ";
  std::ofstream(folder / "scene.json") << R"({
    "rods": { "length": "4.5 mm", "count": 20 }, "box": { "side": "22 mm" },
    "time": { "steady": 0, "measure": "40 ms" }, "stream": null })";
  const auto hash = [&](const std::string& worker) {
    return shell(copy + worker +
                 " scene.json --out run$$ --no-lcm > /dev/null 2>&1; grep state_hash run$$/summary.json")
        .output;
  };
  EXPECT_THAT(hash("./shaken-worker"), HasSubstr("state_hash"));  // alone it goes on as it is
  EXPECT_EQ(hash("./shaken-worker"), hash("shaken-worker"));
  const bool can = shell("grep -qw avx2 /proc/cpuinfo && grep -qw bmi2 /proc/cpuinfo").code == 0;
  EXPECT_THAT(shell(copy + "ln -s /bin/echo shaken-worker-wide; ./shaken-worker wide 2>&1").output == "wide\n", can);
}

// Its log takes the last words of a worker, too; a run that is done is done without them.
TEST(Worker, DoesNotFailForALastWordThatItsLogHasNoRoomFor) {
  const ScratchFolder folder;
  std::ofstream(folder / "scene.json") << R"({
    "rods": { "length": "4.5 mm", "count": 20 }, "box": { "side": "22 mm" },
    "time": { "steady": 0, "measure": "20 ms" }, "stream": null })";
  const std::string run = "cd " + folder.path().string() + "; mkdir run; ln -s /dev/full run/worker.log; " +
                          "shaken-worker scene.json --out run --no-lcm > run/worker.log 2>&1; echo code $?";
  EXPECT_THAT(shell(run).output, HasSubstr("code 0"));
}

// The log, the summary and the last words of a run are read one below the other.
TEST(Run, SaysInOneSentenceWhyItIsNotSteady) {
  const ScratchFolder folder;
  std::ofstream(folder / "scene.json") << R"({
    "rods": { "length": "3 mm", "area_fraction": 0.6 }, "box": { "side": "12 mm" },
    "time": { "measure": "0.3 s" }, "measure": { "order": { "every": "2 ms" } }, "stream": null })";
  const Finished run = shell("cd " + folder.path().string() + "; shaken run scene.json -o run 2>&1");
  ASSERT_EQ(run.code, 0) << run.output;
  std::ifstream file(folder / "run/summary.json");
  const std::string summary{std::istreambuf_iterator<char>(file), {}};
  const std::string key = "\"why_not_steady\": \"";
  const std::size_t at = summary.find(key);
  ASSERT_NE(at, std::string::npos) << summary;
  const std::string why = summary.substr(at + key.size(), summary.find('"', at + key.size()) - at - key.size());
  const bool relaxes = summary.find("\"steady\": false") != std::string::npos;
  EXPECT_THAT(why, ::testing::StartsWith(relaxes ? "still relaxing: " : "not known to be steady: "));
  EXPECT_THAT(run.output, HasSubstr("warning " + why + "\n"));
  EXPECT_THAT(run.output, HasSubstr(std::string("\n") + (relaxes ? "~ " : "? ") + why + "\n"));
}

TEST(Plot, SaysWhoseRunItShows) {
  if (shell("/usr/bin/python3 -c 'import matplotlib, h5py'").code != 0) GTEST_SKIP() << "no matplotlib";
  const ScratchFolder folder;
  std::ofstream(folder / "scene.json") << R"({
    "rods": { "length": "3 mm", "count": 10 }, "box": { "side": "12 mm" },
    "time": { "measure": "20 ms" }, "measure": { "order": { "every": "2 ms" } }, "stream": null })";
  const Finished drawn =
      shell("cd " + folder.path().string() +
            "; shaken run scene.json -o run && shaken plot run -o plots && head -n 3 plots/order_time.csv "
            "&& grep -ac 'shaken plot ' plots/order_time.png && grep run_id run/summary.json");
  ASSERT_EQ(drawn.code, 0) << drawn.output;
  const std::size_t at = drawn.output.find("\"run_id\": \"") + 11;
  EXPECT_THAT(drawn.output, HasSubstr("plots/order_time.png\n"));
  EXPECT_THAT(drawn.output, HasSubstr("# Software: shaken plot "));
  EXPECT_THAT(drawn.output, HasSubstr("\n# Runs: " + drawn.output.substr(at, 16) + "\n"));
}

// As after `./dev demo`, which builds no benches.
TEST(Programs, BenchThatIsNotBuiltSaysHowItIs) {
  const ScratchFolder folder;
  const std::string here = "cd " + folder.path().string() + "; cp " SHAKEN_BIN_DIR "/shaken .; ";
  const Finished missing = shell(here + "./shaken bench speed 2>&1");
  EXPECT_EQ(missing.code, 1);
  EXPECT_THAT(missing.output,
              HasSubstr("shaken-bench is not in " + folder.path().string() + ": `./dev build` makes it"));
  const Finished doctor = shell(here + "PATH= ./shaken --root . doctor 2>&1");
  EXPECT_THAT(doctor.output, ContainsRegex("shaken-bench.*films.*apt install ffmpeg"));
}

// A relay that was stopped, or a port behind a proxy: it accepts, and never says a word.
TEST(EveryListener, EndsOnASignalWhereTheServerOfLiveStateSaysNothing) {
  const ScratchFolder folder;
  LazyServer server;
  const std::string root = (folder / "root").string();
  Process daemon({program("shakend"), "--root", root, "--no-lcm"}, folder / "daemon.log");
  ASSERT_TRUE(daemon.wait_for("shakend ready", std::chrono::seconds(20))) << daemon.output();
  std::ofstream(folder / "scene.json") << R"({"time": {"measure": "20000 s"}})";
  const std::string at_root = "shaken --root " + root;
  ASSERT_EQ(shell(at_root + " submit " + (folder / "scene.json").string() + " --name waits").code, 0);
  ASSERT_EQ(shell(at_root + " hold waits").code, 0);
  const std::string log = (folder / "x.lcmlog").string();
  const std::vector<std::vector<std::string>> listeners{{program("shaken"), "--root", root, "watch"},
                                                        {program("shaken"), "--root", root, "record", "-o", log},
                                                        {program("shaken-web"), "--root", root, "--port", "0"}};
  for (const auto& command : listeners) {
    for (const int signal : {SIGINT, SIGTERM}) {
      std::vector<std::string> words = command;
      words.insert(words.end(), {"--lcm-url", server.url()});
      std::filesystem::remove(log);
      Process listener(words, folder / "listener.log");
      server.wait_for_client();
      listener.signal(signal);
      EXPECT_NE(listener.wait(std::chrono::seconds(20)), -1) << words[0] << "\n" << listener.output();
    }
  }
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(std::chrono::seconds(20)), 0) << daemon.output();
}

TEST(EveryVerb, TakesNamesThatBeginWithADashAfterTwoDashes) {
  const ScratchFolder folder;
  std::ofstream(folder / "-s.json") << "{}";
  const Finished fine = shell("cd " + folder.path().string() + "; shaken validate -- -s.json");
  EXPECT_EQ(fine.code, 0) << fine.output;
}

}  // namespace
}  // namespace shaken::test
