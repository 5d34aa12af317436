// From a scene file to live frames, tables and pixels, with the programs as they are installed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>
#include <signal.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "run/files/trajectory.h"
#include "tests/e2e/run_command.h"
#include "tests/support/good.h"

namespace shaken::test {
namespace e2e_test {

using Json = nlohmann::json;
using std::chrono::seconds;
using testing::HasSubstr;

/// LCM's multicast may only be used where it cannot leave the machine.
bool own_network() { return std::getenv("SHAKEN_OWN_NETWORK") != nullptr; }

/// A daemon in a directory of its own.
class Daemon {
 public:
  Daemon() {
    // a port for each test process: multicast addresses on one port hear each other
    url_ = "udpm://239.255.76.67:" + std::to_string(30000 + getpid() % 20000) + "?ttl=0&recv_buf_size=2097152";
    start();
  }

  void start() {
    std::vector<std::string> command{program("shakend"), "--root", root().string(), "--slots", "2"};
    if (own_network()) {
      command.insert(command.end(), {"--lcm-url", url_});
    } else {
      command.emplace_back("--no-lcm");
    }
    process_ = std::make_unique<Process>(command, root() / "stdout");
    if (!process_->wait_for("shakend ready", seconds(20))) throw std::runtime_error(process_->output());
  }

  Finished shaken(std::vector<std::string> arguments, seconds limit = seconds(120)) const {
    arguments.insert(arguments.begin(), program("shaken"));
    arguments.insert(arguments.end(), {"--root", root().string()});
    return run_command(arguments, limit);
  }
  Json json(std::vector<std::string> arguments) const {
    arguments.emplace_back("--json");
    return Json::parse(said_with(0, shaken(std::move(arguments))));
  }

  const std::filesystem::path& root() const { return directory_.path(); }
  const std::string& url() const { return url_; }
  Process& process() { return *process_; }

 private:
  ScratchFolder directory_;
  std::string url_;
  std::unique_ptr<Process> process_;
};

std::filesystem::path write_file(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file) << text;
  return file;
}

constexpr const char* kSweep = R"({
  "scene": {
    "rods": { "length": "2.5 mm" },
    "box": { "side": "12 mm" },
    "time": { "measure": "300 ms" },
    "measure": { "order": {}, "angles": {}, "tilt": {}, "defects": {} },
    "trajectory": { "every": "5 ms" },
    "movie": { "every": "20 ms", "size": [640, 360] }
  },
  "sweep": { "grid": { "rods.area_fraction": [0.5, 0.7] } }
})";

/// RGB pixels of a PNG.
struct Pixels {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

Pixels read_png(const std::filesystem::path& file) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  Pixels pixels;
  if (png_image_begin_read_from_file(&image, file.c_str()) == 0) return pixels;
  image.format = PNG_FORMAT_RGB;
  pixels.width = image.width;
  pixels.height = image.height;
  pixels.rgb.resize(PNG_IMAGE_SIZE(image));
  png_image_finish_read(&image, nullptr, pixels.rgb.data(), 0, nullptr);
  return pixels;
}

TEST(EndToEnd, EveryProgramNamesItselfWhereItsArgumentsAreWrong) {
  const ScratchFolder out;
  const std::string nowhere = (out.path() / "nowhere").string();
  struct Case {
    std::vector<std::string> command;
    std::string words;
  };
  const std::vector<Case> cases{
      {{program("shakend"), "--bogus"}, "shakend: "},
      {{program("shaken-worker"), "scene.json", "--bogus"}, "shaken-worker: "},
      {{program("shaken-render"), "picture", "--bogus"}, "shaken-render: "},
      {{program("shaken-bench"), "sped"}, "shaken-bench: there is no bench 'sped'; did you mean speed?"},
      {{program("shaken"), "replay", nowhere}, nowhere + ": there is no such directory"},
      {{program("shaken"), "run", "scene.json", "--threads", "0"}, "--threads takes a number from 1 to 64, not 0"}};
  for (const auto& [command, words] : cases) {
    EXPECT_THAT(said_with(2, run_command(command)), HasSubstr(words)) << words;
  }
}

TEST(EndToEnd, ARunEndsWithWhatCameOut) {
  const ScratchFolder out;
  const auto scene = write_file(out.path() / "scene.json", R"({
    "rods": { "length": "2.5 mm", "area_fraction": 0.5 }, "box": { "side": "10 mm" },
    "time": { "measure": "100 ms" }, "measure": { "order": { "every": "1 ms" } } })");
  const std::string folder = (out.path() / "run").string();
  const Finished run = run_command({program("shaken"), "run", scene.string(), "--out", folder});
  ASSERT_EQ(run.code, 0) << run.output;
  EXPECT_NE(run.output.find("S = 0."), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("  summary.json "), std::string::npos) << run.output;
  EXPECT_EQ(run.output.find("  trajectory.h5 "), std::string::npos) << "there is none";
  EXPECT_NE(run.output.find("next: shaken plot " + folder), std::string::npos) << run.output;
}

TEST(EndToEnd, AQuietDaemonKeepsItsLogToItsFile) {
  const ScratchFolder root;
  Process daemon({program("shakend"), "--root", root.path().string(), "--no-lcm", "--quiet"}, root.path() / "stdout");
  ASSERT_TRUE(daemon.wait_for("shakend ready", seconds(20))) << daemon.output();
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(seconds(20)), 0);
  const std::string output = daemon.output();
  EXPECT_NE(output.find("log in " + (root.path() / "shakend.log").string()), std::string::npos) << output;
  EXPECT_EQ(std::count(output.begin(), output.end(), '\n'), 1) << output;
  std::ifstream log(root.path() / "shakend.log");
  const std::string logged((std::istreambuf_iterator<char>(log)), {});
  EXPECT_NE(logged.find("stopped"), std::string::npos) << logged;
}

TEST(EndToEnd, SweepIsRunStreamedTabledPlottedAndDrawn) {
  Daemon daemon;
  const ScratchFolder out;
  std::unique_ptr<Process> recorder;
  if (own_network()) {
    recorder = std::make_unique<Process>(std::vector<std::string>{program("lcm_recorder"), daemon.url()},
                                         out.path() / "messages");
    ASSERT_TRUE(recorder->wait_for("ready", seconds(10))) << recorder->output();
  }

  // submit twice: the second time nothing is new
  const auto file = write_file(out.path() / "sweep.json", kSweep);
  const Json first = daemon.json({"submit", file.string()});
  ASSERT_EQ(first.at("jobs").size(), 2u);
  EXPECT_EQ(first.at("counts").at("new"), 2);
  expect_end(0, daemon.shaken({"wait", "--timeout", "100"}));
  EXPECT_EQ(daemon.json({"submit", file.string()}).at("counts").at("done"), 2);

  // table
  const Json rows = daemon.json({"results"}).at("rows");
  ASSERT_EQ(rows.size(), 2u);
  for (const Json& row : rows) {
    EXPECT_EQ(row.at("state"), "done");
    const Json& summary = row.at("summary");
    EXPECT_NEAR(summary.at("sim_seconds").get<double>(), 0.3, 1e-9);
    const double area_fraction = row.at("parameters").at("rods.area_fraction").get<double>();
    EXPECT_NEAR(summary.at("n_rods").get<double>(), area_fraction * 144 / 1.3676, 1);
    EXPECT_GT(summary.at("collisions").at("rod_rod").get<int>(), 1000);
    EXPECT_LT(summary.at("max_overlap_mm").get<double>(), 3e-3);
    for (const char* key : {"cpu_seconds", "rod_seconds_per_cpu_second", "order", "effects", "state_hash", "exit"}) {
      EXPECT_TRUE(summary.contains(key)) << key;
    }
  }
  const Finished csv = daemon.shaken({"results", "--csv"});
  EXPECT_EQ(std::count(csv.output.begin(), csv.output.end(), '\n'), 3) << csv.output;

  // files, plots, movie
  for (const Json& row : rows) {
    const auto directory = daemon.root() / "runs" / row.at("job").get<std::string>();
    for (const char* name : {"scene.json", "trajectory.h5", "observables.h5", "summary.json", "checkpoint.bin",
                             "worker.log", "movie.mp4"}) {
      EXPECT_TRUE(std::filesystem::exists(directory / name)) << name;
    }
    const Finished probe = run_command({"/usr/bin/ffprobe", "-v", "error", "-count_frames", "-select_streams", "v",
                                        "-show_entries", "stream=codec_name,pix_fmt,width,height,nb_read_frames", "-of",
                                        "csv=p=0", directory / "movie.mp4"});
    EXPECT_EQ(probe.output, "h264,640,360,yuv420p,16\n");  // 0, 20, ... 300 ms
  }
  expect_end(0, daemon.shaken({"plot", "-o", out.path() / "plots"}));
  int n_plots = 0;
  for (const auto& entry : std::filesystem::directory_iterator(out.path() / "plots")) {
    if (entry.path().extension() != ".png") continue;
    ++n_plots;
    EXPECT_GT(read_png(entry.path()).width, 300u) << entry.path();
  }
  EXPECT_GE(n_plots, 3);

  // a picture of the last frame: rods cover about their area fraction of the box, in orange, blue and what lies between
  const std::string job = rows.at(1).at("job");
  const auto png = out.path() / "last.png";
  expect_end(0, daemon.shaken({"movie", job, "--frame", "last", "-o", png.string()}));
  const Pixels pixels = read_png(png);
  ASSERT_GE(pixels.width, 640u);
  std::map<std::uint32_t, int> histogram;
  for (std::size_t p = 0; p + 2 < pixels.rgb.size(); p += 3)
    ++histogram[pixels.rgb[p] << 16 | pixels.rgb[p + 1] << 8 | pixels.rgb[p + 2]];
  EXPECT_GT(histogram.size(), 500u) << "a blank picture";
  int reddish = 0;
  for (const auto& [rgb, n] : histogram) {
    const int r = rgb >> 16 & 255, g = rgb >> 8 & 255, b = rgb & 255;
    if (r > g + 40 && r >= b) reddish += n;
  }
  EXPECT_GT(reddish, 2000) << "no coloured rods";

  // what an LCM subscriber saw
  if (!recorder) GTEST_SKIP() << "no network of its own: LCM left out";
  recorder->signal(SIGTERM);
  ASSERT_EQ(recorder->wait(seconds(10)), 0);
  std::map<std::string, int> n_messages;
  std::map<std::string, std::vector<Json>> frames;
  std::map<std::string, std::map<std::string, std::int64_t>> last_sequence;
  std::istringstream lines(recorder->output());
  for (std::string line; std::getline(lines, line);) {
    const Json message = Json::parse(line);
    const std::string channel = message.at("channel");
    if (channel == "ready") continue;
    ++n_messages[channel];
    EXPECT_GT(message.at("utime").get<std::int64_t>(), 1600000000000000);
    // sequences count without gaps: each worker's from 0, the daemon's over all jobs
    const std::string source =
        message.contains("job") && channel != "SHAKEN_JOB" ? message.at("job").get<std::string>() : "daemon";
    const std::int64_t sequence = message.at("sequence");
    auto& channels = last_sequence[source];
    if (channels.contains(channel)) {
      EXPECT_EQ(sequence, channels[channel] + 1) << channel << " of " << source;
    }
    channels[channel] = sequence;
    if (channel == "SHAKEN_FRAME") frames[source].push_back(message);
  }
  for (const char* channel :
       {"SHAKEN_STATUS", "SHAKEN_JOB", "SHAKEN_OBSERVABLES", "SHAKEN_FRAME_STATIC", "SHAKEN_FRAME"}) {
    EXPECT_GT(n_messages[channel], 0) << channel;
  }
  // live frames of recorded ticks are those of the trajectory, value by value; the last one always is
  ASSERT_EQ(frames.size(), 2u);
  for (const auto& [id, messages] : frames) {
    EXPECT_EQ(messages.front().at("sequence"), 0);
    auto reader = run::TrajectoryReader::open(daemon.root() / "runs" / id / "trajectory.h5");
    ASSERT_TRUE(static_cast<bool>(reader)) << reader.error().message;
    std::map<Tick, std::size_t> index_of;
    for (std::size_t k = 0; k < reader->n_frames(); ++k) index_of[(*reader->frame(k)).tick] = k;
    for (const Json& message : messages) {
      const Tick tick = message.at("tick");
      ASSERT_TRUE(&message != &messages.back() || index_of.contains(tick)) << "the last state is recorded, and sent";
      if (!index_of.contains(tick)) continue;
      const Snapshot frame = *reader->frame(index_of[tick]);
      const double side = message.at("box_mm").at(0);
      EXPECT_EQ(side, 12.0);
      ASSERT_EQ(message.at("x").size(), frame.position.size());
      for (std::size_t i = 0; i < frame.position.size(); ++i) {
        const auto unfold = [&](const char* axis) { return (message.at(axis)[i].get<double>() / 65536 + 0.5) * side; };
        const auto around = [&](double difference) {
          return std::abs(difference - side * std::round(difference / side));
        };
        ASSERT_LT(around(unfold("x") - frame.position[i].x()), side / 65536);
        ASSERT_LT(around(unfold("y") - frame.position[i].y()), side / 65536);
        const double theta = message.at("heading")[i].get<double>() * 2 * kPi / 65536;
        const double n_z = message.at("n_z")[i].get<double>() / 32767;
        const Vec3 n(std::sqrt(1 - n_z * n_z) * std::cos(theta), std::sqrt(1 - n_z * n_z) * std::sin(theta), n_z);
        ASSERT_GT(n.dot(frame.director[i]), 1 - 1e-7);
      }
    }
  }
}

TEST(EndToEnd, StoppedDaemonGoesOnWhereItWas) {
  Daemon daemon;
  const ScratchFolder out;
  // long enough to be stopped half way, short enough to be finished
  const auto file = write_file(out.path() / "scene.json", R"({"rods": {"length": "2.5 mm", "area_fraction": 0.5},
    "box": {"side": "12 mm"}, "time": {"measure": "3 s"}, "trajectory": {"every": "20 ms"}})");
  const std::string job = daemon.json({"submit", file.string()}).at("jobs")[0].at("id");
  const auto progress = [&] {
    const Json now = daemon.json({"status", job}).at("job");
    return now.at("progress").is_null() ? 0.0 : now.at("progress").at("sim_time_s").get<double>();
  };
  for (int k = 0; k < 200 && progress() <= 0.05; ++k) usleep(50000);
  daemon.process().signal(SIGTERM);
  ASSERT_EQ(daemon.process().wait(seconds(20)), 0) << daemon.process().output();
  daemon.start();
  expect_end(0, daemon.shaken({"wait", job, "--timeout", "100"}));

  // the same run without a stop, by the worker alone
  const Finished alone = run_command({program("shaken"), "run", file, "--out", out.path() / "alone"}, seconds(100));
  ASSERT_EQ(alone.code, 0) << alone.output;
  const auto hash = [](const std::filesystem::path& directory) {
    return Json::parse(std::ifstream(directory / "summary.json")).at("state_hash").get<std::string>();
  };
  EXPECT_EQ(hash(daemon.root() / "runs" / job), hash(out.path() / "alone"));
}

TEST(EndToEnd, AProtocolIsAChainOfRunsForEachReplica) {
  const Daemon daemon;
  const auto file = write_file(daemon.root() / "ramp.json", R"({
    "scene": { "accuracy": "desk", "rods": { "length": "2.5 mm", "count": 60, "area_fraction": 0.4 },
               "time": { "measure": "100 ms" }, "measure": { "order": { "every": "5 ms" } } },
    "sweep": { "replicas": 2, "stages": [
      {}, { "rods.area_fraction": [0.5, 0.6] }, { "plates.gamma": 5, "time.measure": "50 ms" } ] } })");
  ASSERT_EQ(daemon.shaken({"submit", file.string()}).code, 0);
  expect_end(0, daemon.shaken({"wait", "ramp"}));
  const Json rows = daemon.json({"results", "ramp"}).at("rows");
  ASSERT_EQ(rows.size(), 8u);
  std::map<int, std::vector<double>> sides;  // by stage
  for (const Json& row : rows) {
    const int stage = row.at("parameters").at("stage").get<int>();
    EXPECT_EQ(row.at("parameters").at("plates.gamma"), stage == 4 ? 5.0 : 7.0);
    EXPECT_EQ(row.at("summary").at("start").is_null(), stage == 1);
    EXPECT_EQ(row.at("summary").at("n_rods"), 60);
    const Json scene = Json::parse(std::ifstream(row.at("directory").get<std::string>() + "/scene.json"));
    sides[stage].push_back(scene.at("box").at("side").get<double>());
  }
  EXPECT_GT(sides[1][0], sides[2][1]);
  EXPECT_GT(sides[2][0], sides[3][1]);
  EXPECT_EQ(sides[3], sides[4]);
  EXPECT_EQ(daemon.shaken({"submit", file.string()}).code, 0) << "again, which is nothing new";
}

TEST(EndToEnd, WhatCannotBePlacedIsRefusedByEveryVerbInTheSameWords) {
  const ScratchFolder out;
  const auto file = write_file(out.path() / "dense.json", R"({"rods": {"area_fraction": 0.915}, "box": {"side": 25}})");
  const auto directory = out.path() / "run";
  const std::vector<std::vector<std::string>> verbs{
      {"validate", file},
      {"run", file, "--out", directory},
      {"explain", file},
      {"submit", file, "--dry-run"},
      {"submit", file, "--root", out.path() / "nowhere"},
  };
  for (const std::vector<std::string>& verb : verbs) {
    std::vector<std::string> command{program("shaken")};
    command.insert(command.end(), verb.begin(), verb.end());
    EXPECT_THAT(said_with(2, run_command(command)),
                HasSubstr("dense.json: /rods: 229 rods (area fraction 0.913) do not fit into the box: in rows "
                          "at most 228 rods"))
        << verb.front();
  }
  EXPECT_FALSE(std::filesystem::exists(directory));
}

}  // namespace e2e_test
}  // namespace shaken::test
