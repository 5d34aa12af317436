// Live state by way of the daemon's relay, with real runs and real LCM programs; recordings of it, by us and by LCM.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "base/descriptor.h"
#include "tests/e2e/free_port.h"
#include "tests/e2e/run_command.h"
#include "tests/support/good.h"

namespace shaken::test {
namespace relay_test {

using Json = nlohmann::json;
using std::chrono::seconds;
using std::chrono::steady_clock;
using testing::HasSubstr;

constexpr const char* kScene = R"({
  "rods": { "length": "4.5 mm", "area_fraction": 0.5 }, "box": { "side": "20 mm" }, "time": { "measure": "4 s" },
  "stream": { "rate": 20 }, "movie": null, "trajectory": null })";

/// A raw connection to "127.0.0.1:PORT".
Descriptor connected(const std::string& address) {
  Descriptor fd(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in where{};
  where.sin_family = AF_INET;
  where.sin_port = htons(static_cast<std::uint16_t>(std::stoi(address.substr(address.find(':') + 1))));
  where.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(connect(fd.value(), reinterpret_cast<const sockaddr*>(&where), sizeof(where)), 0);
  return fd;
}

class RelayedRun : public ::testing::Test {
 protected:
  RelayedRun() {
    std::ofstream(folder_.path() / "scene.json") << kScene;
    daemon_ = std::make_unique<Process>(std::vector<std::string>{program("shakend"), "--root", root(), "--slots", "1",
                                                                 "--relay", address_, "--lcm-url", url_},
                                        folder_.path() / "stdout");
    EXPECT_TRUE(daemon_->wait_for("shakend ready", seconds(20))) << daemon_->output();
  }
  ~RelayedRun() override {
    daemon_->signal(SIGTERM);
    EXPECT_EQ(daemon_->wait(seconds(60)), 0) << daemon_->output();
  }

  std::string root() const { return folder_.path().string(); }
  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
  Finished shaken(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), program("shaken"));
    arguments.insert(arguments.end(), {"--root", root()});
    return run_command(arguments, seconds(120));
  }
  std::unique_ptr<Process> recorder(const std::string& name) const {
    auto process = std::make_unique<Process>(std::vector<std::string>{program("lcm_recorder"), url_}, file(name));
    EXPECT_TRUE(process->wait_for("SHAKEN_STATUS", seconds(30))) << "it hears the daemon: " << process->output();
    return process;
  }
  /// What a recorder has heard, by channel.
  static std::map<std::string, std::vector<Json>> heard(const Process& recorder) {
    std::map<std::string, std::vector<Json>> messages;
    std::istringstream lines(recorder.output());
    for (std::string line; std::getline(lines, line);) {
      const Json message = Json::parse(line, nullptr, false);
      if (message.is_object()) messages[message.at("channel")].push_back(message);
    }
    return messages;
  }
  /// Ends a recorder, and returns what it has heard.
  static std::map<std::string, std::vector<Json>> stop(Process& recorder) {
    recorder.signal(SIGTERM);
    EXPECT_EQ(recorder.wait(seconds(20)), 0);
    return heard(recorder);
  }
  ScratchFolder folder_;
  std::string address_ = free_address();
  std::string url_ = "tcpq://" + address_;
  std::unique_ptr<Process> daemon_;
};

TEST_F(RelayedRun, BadClientsCostNeitherTheRunNorTheGoodOnesAnything) {
  const auto good = recorder("good"), stopped = recorder("stopped"), killed = recorder("killed");
  const Descriptor silent = connected(address_);
  const Descriptor rubbish = connected(address_);
  const std::string noise = "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n";
  EXPECT_EQ(send(rubbish.value(), noise.data(), noise.size(), MSG_NOSIGNAL), std::ssize(noise));
  stopped->signal(SIGSTOP);
  expect_end(0, shaken({"submit", file("scene.json")}));
  ASSERT_TRUE(good->wait_for("SHAKEN_FRAME\"", seconds(60)));
  killed->signal(SIGKILL);
  ASSERT_EQ(shaken({"wait"}).code, 0);
  stopped->signal(SIGCONT);

  auto messages = stop(*good);
  const std::vector<Json>& frames = messages["SHAKEN_FRAME"];
  ASSERT_GT(frames.size(), 3U);
  for (std::size_t i = 0; i < frames.size(); ++i) EXPECT_EQ(frames[i].at("sequence"), i) << "every frame has come";
  EXPECT_FALSE(messages["SHAKEN_FRAME_STATIC"].empty());
  EXPECT_FALSE(messages["SHAKEN_OBSERVABLES"].empty());
  EXPECT_EQ(messages["SHAKEN_JOB"].back().at("state"), "done");
  EXPECT_EQ(stop(*stopped)["SHAKEN_FRAME"].size(), frames.size()) << "so few wait for it";

  const Finished alone =
      run_command({program("shaken-worker"), file("scene.json"), "--out", file("alone"), "--no-lcm"}, seconds(120));
  ASSERT_EQ(alone.code, 0) << alone.output;
  const std::string id = frames[0].at("job");
  const auto hash = [](const std::filesystem::path& directory) {
    return Json::parse(std::ifstream(directory / "summary.json")).at("state_hash").get<std::string>();
  };
  EXPECT_EQ(hash(folder_.path() / "runs" / id), hash(file("alone")));
}

TEST_F(RelayedRun, IsRecordedAndReplayedByUsAndByLcm) {
  Process logger({"/usr/bin/lcm-logger", "--quiet", "--lcm-url=" + url_, file("theirs.lcmlog")}, file("logger.out"));
  Process ours({program("shaken"), "record", "--root", root(), "--force", "-o", file("all.lcmlog")}, file("all.out"));
  expect_end(0, shaken({"submit", file("scene.json")}));
  const std::string id =
      Json::parse(shaken({"results", "--json"}).output).at("rows").at(0).at("job").get<std::string>();
  EXPECT_THAT(said_with(0, shaken({"record", id, "-o", file("job.lcmlog")})), HasSubstr("the jobs have ended: "));
  ours.signal(SIGINT);
  EXPECT_EQ(ours.wait(seconds(20)), 130) << ours.output();
  EXPECT_NE(ours.output().find("interrupted: "), std::string::npos) << ours.output();
  logger.signal(SIGINT);
  logger.wait(seconds(20));

  EXPECT_THAT(said_with(2, shaken({"record", "-o", file("job.lcmlog")})), HasSubstr("--force"));

  const auto listener = recorder("heard");
  const auto heard_of = [&](const std::vector<std::string>& player) {
    const std::size_t before = heard(*listener)["SHAKEN_FRAME"].size();
    expect_end(0, run_command(player, seconds(60)));
    std::size_t n = 0;
    for (std::size_t last = 1; n != last;) {
      last = n;
      std::this_thread::sleep_for(std::chrono::milliseconds(300));
      n = heard(*listener)["SHAKEN_FRAME"].size() - before;
    }
    return n;
  };
  const std::string replay = program("shaken");
  const std::size_t n_ours = heard_of({replay, "replay-log", file("job.lcmlog"), "--lcm-url", url_, "--speed", "5"});
  EXPECT_GT(n_ours, 3U);
  EXPECT_EQ(heard_of({"/usr/bin/lcm-logplayer", "--speed=5", "--lcm-url=" + url_, file("job.lcmlog")}), n_ours);
  EXPECT_GE(heard_of({replay, "replay-log", file("all.lcmlog"), "--lcm-url", url_, "--speed", "5"}), n_ours);
  EXPECT_GE(heard_of({replay, "replay-log", file("theirs.lcmlog"), "--lcm-url", url_, "--speed", "5"}), n_ours);
  const std::size_t n_late =
      heard_of({replay, "replay-log", file("job.lcmlog"), "--lcm-url", url_, "--speed", "5", "--from", "1s"});
  const std::size_t n_first =
      heard_of({replay, "replay-log", file("job.lcmlog"), "--lcm-url", url_, "--speed", "5", "--to", "1s"});
  EXPECT_LT(n_late, n_ours);
  EXPECT_EQ(n_late + n_first, n_ours);
}

TEST_F(RelayedRun, ARecordingHasItsLimits) {
  EXPECT_THAT(said_with(0, shaken({"record", "--size", "300", "-o", file("small.lcmlog")})),
              HasSubstr("the log has its size: "));
  EXPECT_LE(std::filesystem::file_size(file("small.lcmlog")), 300U);
  EXPECT_THAT(said_with(0, shaken({"record", "--for", "1s", "-o", file("short.lcmlog")})),
              HasSubstr("the time is over: "));
  EXPECT_THAT(said_with(1, shaken({"record", "--force", "-o", "/dev/full"})),
              HasSubstr("No space left on device; what came before is kept"));
  EXPECT_EQ(shaken({"replay-log", file("scene.json"), "--lcm-url", url_}).code, 1) << "no log";
}

}  // namespace relay_test
}  // namespace shaken::test
