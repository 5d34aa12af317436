// The daemon, or a worker, is killed with SIGKILL again and again at random moments. Whatever was acknowledged is done,
// once. As many times as SHAKEN_KILL_CYCLES says (`./dev kills N`), else as the tests below do.
#include <gtest/gtest.h>
#include <httplib.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <thread>

#include "run/files/directory.h"
#include "run/files/done.h"
#include "tests/e2e/run_command.h"
#include "tests/support/effort.h"

namespace shaken::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using std::chrono::milliseconds;
using std::chrono::seconds;

int cycles(int usual) {
  const char* given = std::getenv("SHAKEN_KILL_CYCLES");
  return given != nullptr ? std::max(1, std::atoi(given)) : usual;
}

/// A sweep of short runs with the seeds from `first` on.
std::string short_runs(int first, int count) {
  Json seeds = Json::array();
  for (int k = 0; k < count; ++k) seeds.push_back(first + k);
  const Json scene{{"rods", {{"count", 6}, {"length", "2.5 mm"}, {"beads", 7}}},
                   {"box", {{"side", "12 mm"}}},
                   {"time", {{"step", "20 us"}, {"measure", "40 ms"}}},
                   {"measure", {{"order", {{"every", "2 ms"}}}}}};
  return Json{{"text", Json{{"scene", scene}, {"sweep", {{"grid", {{"time.seed", seeds}}}}}}.dump()},
              {"name", "seeds from " + std::to_string(first)}}
      .dump();
}

class Daemon {
 public:
  explicit Daemon(const fs::path& root)
      : socket_((root / "shakend.sock").string()),
        process_({program("shakend"), "--root", root.string(), "--slots", "2", "--no-lcm"}, root / "stdout") {
    is_ready_ = process_.wait_for("shakend ready", seconds(60));
  }
  bool is_ready() const { return is_ready_; }
  Process& process() { return process_; }

  /// The answer; null if there is none, or it is a refusal.
  Json get(const std::string& path) const { return read(client().Get(path)); }
  Json submit(const std::string& body) const { return read(client().Post("/v1/sweeps", body, "application/json")); }

 private:
  httplib::Client client() const {
    httplib::Client client(socket_);
    client.set_address_family(AF_UNIX);
    client.set_read_timeout(seconds(60));
    return client;
  }
  static Json read(const httplib::Result& result) {
    return result && result->status / 100 == 2 ? Json::parse(result->body) : Json();
  }

  std::string socket_;
  Process process_;
  bool is_ready_ = false;
};

/// Processes whose command line names `root`.
std::vector<std::string> processes_of(const fs::path& root) {
  std::vector<std::string> found;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    std::ifstream file(entry.path() / "cmdline");
    const std::string line{std::istreambuf_iterator<char>(file), {}};
    if (line.find(root.string()) != std::string::npos) found.push_back(line);
  }
  return found;
}

void wait_until(const std::function<bool()>& condition, seconds limit) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (!condition() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(milliseconds(300));
}

TEST(KillCycles, WhatTheDaemonHasAcknowledgedIsDoneOnce) {
  const int n_cycles = cycles(draws(100));
  const ScratchFolder folder;
  const fs::path& root = folder.path();
  std::mt19937 random(7);
  std::set<std::string> acknowledged;
  int next_seed = 1;
  const auto submit = [&](const Daemon& daemon, int count) {
    const Json answer = daemon.submit(short_runs(next_seed, count));
    next_seed += count;
    if (answer.is_null()) return false;  // it was killed before it answered: the runs may be there or not
    for (const Json& job : answer.at("jobs")) acknowledged.insert(job.at("id").get<std::string>());
    return true;
  };

  milliseconds longest_start(0);
  for (int cycle = 0; cycle < n_cycles; ++cycle) {
    const auto begin = std::chrono::steady_clock::now();
    Daemon daemon(root);
    ASSERT_TRUE(daemon.is_ready()) << cycle << ": " << daemon.process().output();
    longest_start =
        std::max(longest_start, std::chrono::duration_cast<milliseconds>(std::chrono::steady_clock::now() - begin));
    const milliseconds life(std::uniform_int_distribution(0, 150)(random));
    std::thread killer([&] {
      std::this_thread::sleep_for(life);
      daemon.process().signal(SIGKILL);
    });
    if (cycle == 0) {
      submit(daemon, 200);
    } else {
      while (submit(daemon, 2)) std::this_thread::sleep_for(milliseconds(40));
    }
    killer.join();
    ASSERT_EQ(daemon.process().wait(seconds(20)), 128 + SIGKILL);
  }

  Daemon daemon(root);
  ASSERT_TRUE(daemon.is_ready()) << daemon.process().output();
  if (acknowledged.size() < 200) submit(daemon, 200);  // the first cycle was too short for it
  Json jobs;
  wait_until(
      [&] {
        jobs = daemon.get("/v1/jobs").at("jobs");
        return std::all_of(jobs.begin(), jobs.end(), [](const Json& job) { return job.at("state") == "done"; });
      },
      seconds(240 + n_cycles));
  std::set<std::string> known;
  for (const Json& job : jobs) {
    const std::string id = job.at("id").get<std::string>();
    EXPECT_TRUE(known.insert(id).second) << id << " is there twice";
    EXPECT_EQ(job.at("state"), "done") << id << ": " << job.at("reason");
    EXPECT_TRUE(run::is_done(run::RunDirectory{root / "runs" / id}, id)) << id;
    int n_ends = 0;
    const Json history = daemon.get("/v1/jobs/" + id + "/history");
    for (const Json& change : history.at("changes")) n_ends += change.at("to") == "done";
    EXPECT_EQ(n_ends, 1) << id << ": " << history.dump(1);
  }
  for (const std::string& id : acknowledged) EXPECT_TRUE(known.contains(id)) << id << " is lost";
  EXPECT_GE(acknowledged.size(), 200U);

  daemon.process().signal(SIGTERM);
  EXPECT_EQ(daemon.process().wait(seconds(60)), 0);
  wait_until([&] { return processes_of(root).empty(); }, seconds(20));
  EXPECT_TRUE(processes_of(root).empty()) << processes_of(root).front();
  std::printf("%d kills, %zu runs acknowledged, %zu done; the slowest start took %.2f s\n", n_cycles,
              acknowledged.size(), known.size(), 1e-3 * static_cast<double>(longest_start.count()));
}

}  // namespace
}  // namespace shaken::test
