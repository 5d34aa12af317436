// A worker is killed, or refused by the disk, at every single change that it makes to its files (in the gate, at every
// one of a run from its beginning, else at each fifth). Whatever comes of it, the next start goes on to the same end.
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "base/files.h"
#include "run/files/directory.h"
#include "run/files/observables_file.h"
#include "run/files/trajectory.h"
#include "tests/e2e/run_command.h"
#include "tests/support/effort.h"
#include "tests/support/good.h"

namespace shaken::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kScene = R"({
  "rods": { "count": 12, "length": "2.5 mm", "beads": 7 },
  "box": { "side": "12 mm" },
  "time": { "step": "20 us", "measure": "120 ms", "steady": "10 ms" },
  "measure": { "order": { "every": "2 ms" }, "defects": { "every": "20 ms" } },
  "trajectory": { "every": "4 ms" }
})";

/// Runs the worker in `directory` with `fault` (tests/e2e/failing_calls.cpp) until it ends.
Finished work(const fs::path& scene, const fs::path& directory, const std::string& fault = "none:0") {
  return run_command({"/usr/bin/env", std::string("LD_PRELOAD=") + SHAKEN_FAILING_CALLS, "SHAKEN_FAULT=" + fault,
                      "SHAKEN_FAULT_BELOW=" + directory.string(), program("shaken-worker"), scene.string(), "--out",
                      directory.string(), "--no-lcm", "--checkpoint-every", "0.004"});
}

std::string state_hash(const fs::path& directory) {
  const auto text = read_file(run::RunDirectory{directory}.summary());
  return text ? nlohmann::json::parse(*text).at("state_hash").get<std::string>() : "";
}

/// What differs between the results of two runs; empty if nothing does.
std::string difference(const fs::path& a, const fs::path& b) {
  if (state_hash(a) != state_hash(b)) return "state_hash";
  const auto arrays_a = run::read_observables(run::RunDirectory{a}.observables());
  const auto arrays_b = run::read_observables(run::RunDirectory{b}.observables());
  if (!arrays_a || !arrays_b || arrays_a->size() != arrays_b->size()) return "observables.h5";
  for (const auto& [path, values] : *arrays_a) {
    const auto other = arrays_b->find(path);
    if (other == arrays_b->end() || other->second.size() != values.size()) return path;
    if (std::memcmp(other->second.data(), values.data(), values.size() * sizeof(double)) != 0) return path;
  }
  const auto frames_a = run::TrajectoryReader::open(run::RunDirectory{a}.trajectory());
  const auto frames_b = run::TrajectoryReader::open(run::RunDirectory{b}.trajectory());
  if (!frames_a || !frames_b || frames_a->n_frames() != frames_b->n_frames()) return "trajectory.h5";
  for (std::size_t i = 0; i < frames_a->n_frames(); ++i) {
    const auto x = frames_a->recorded().frame(i), y = frames_b->recorded().frame(i);
    if (!x || !y || x->tick != y->tick || x->position != y->position || x->velocity != y->velocity ||
        x->orientation != y->orientation || x->image != y->image) {
      return "frame " + std::to_string(i);
    }
  }
  return "";
}

class CrashPoints : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(scene_) << kScene;
    expect_end(0, work(scene_, undisturbed_));
    ASSERT_EQ(run::TrajectoryReader::open(run::RunDirectory{undisturbed_}.trajectory())->n_frames(), 33U);
  }

  /// The n-th change goes wrong, for every n: the worker starts in a copy of `begin` (or in none), then once more
  /// without a fault. What `begin` holds has a checkpoint, so that nothing may start from the beginning.
  void everywhere(const std::string& kind, const fs::path& begin = {}) {
    constexpr int kMost = 2000;
    const int step = begin.empty() || at_night() ? 1 : 5;
    int n = 1;
    for (; n < kMost; n += step) {
      const std::string fault = kind + ":" + std::to_string(n);
      fs::remove_all(directory_);
      if (!begin.empty()) fs::copy(begin, directory_, fs::copy_options::recursive);
      const Finished first = work(scene_, directory_, fault);
      EXPECT_TRUE(first.code == 0 || first.code == 97 || first.code == 98 || first.code == 128 + SIGKILL)
          << fault << ": " << first.output;
      const Finished second = work(scene_, directory_);
      ASSERT_EQ(second.code, 0) << fault << ": " << second.output << "\nafter:\n" << first.output;
      EXPECT_EQ(difference(undisturbed_, directory_), "") << fault << ": " << first.output << second.output;
      if (!begin.empty()) {
        EXPECT_EQ(second.output.find("from the beginning"), std::string::npos) << fault << ": " << second.output;
      }
      EXPECT_FALSE(fs::exists(run::RunDirectory{directory_}.frames())) << fault;
      if (first.output.find("fault met") == std::string::npos) break;
    }
    EXPECT_GT(n, 40) << "changes that went wrong";
    EXPECT_LT(n, kMost);
  }

  /// A directory whose run was killed soon after its first checkpoint.
  fs::path killed_midway() {
    const run::RunDirectory midway{folder_.path() / "midway"};
    for (int n = 4; n < 200 && !fs::exists(midway.checkpoint()); n += 2) {
      fs::remove_all(midway.root);
      EXPECT_EQ(work(scene_, midway.root, "kill:" + std::to_string(n)).code, 128 + SIGKILL);
    }
    EXPECT_TRUE(fs::exists(midway.checkpoint()));
    return midway.root;
  }

  ScratchFolder folder_;
  fs::path scene_ = folder_.path() / "scene.json";
  fs::path undisturbed_ = folder_.path() / "undisturbed";
  fs::path directory_ = folder_.path() / "run";
};

TEST_F(CrashPoints, KilledAnywhereTheNextStartGoesOnToTheSameEnd) { everywhere("kill"); }

// What was promised is on the disk, wherever the power fails.
TEST_F(CrashPoints, WithoutPowerNothingStartsFromTheBeginning) { everywhere("lose", killed_midway()); }

TEST_F(CrashPoints, WithoutPowerAndLateRenamesNothingStartsFromTheBeginning) { everywhere("undo", killed_midway()); }

TEST_F(CrashPoints, KilledInTheMiddleOfAWriteToo) { everywhere("half", killed_midway()); }

TEST_F(CrashPoints, AnExtensionKilledAnywhereGoesOnToTheEndOfTheLongRun) {
  std::string scene = kScene;
  scene.replace(scene.find("120 ms"), 6, "60 ms");
  const fs::path short_scene = folder_.path() / "short.json", begin = folder_.path() / "short";
  std::ofstream(short_scene) << scene;
  expect_end(0, work(short_scene, begin));
  ASSERT_NE(difference(undisturbed_, begin), "");
  everywhere("kill", begin);
}

/// SIGKILL from outside, at random moments of the clock: 200 times at night, or as often as SHAKEN_KILL_CYCLES says.
TEST_F(CrashPoints, KilledAtRandomItGoesOnToTheSameEnd) {
  const char* given = std::getenv("SHAKEN_KILL_CYCLES");
  const int n_kills = given != nullptr ? std::atoi(given) : draws(200);
  std::mt19937 random(3);
  int killed = 0, ended = 0;
  for (int k = 0; k < 20 * n_kills && killed < n_kills; ++k) {
    Process worker({program("shaken-worker"), scene_.string(), "--out", directory_.string(), "--no-lcm",
                    "--checkpoint-every", "0.004"},
                   folder_.path() / "output");
    std::this_thread::sleep_for(std::chrono::microseconds(std::uniform_int_distribution(1000, 100'000)(random)));
    worker.signal(SIGKILL);
    const int code = worker.wait(std::chrono::seconds(60));
    killed += code == 128 + SIGKILL;
    if (code == 128 + SIGKILL) continue;
    ASSERT_EQ(code, 0) << worker.output();
    ++ended;
    EXPECT_EQ(difference(undisturbed_, directory_), "") << "after " << killed << " kills";
    fs::remove_all(directory_);
  }
  EXPECT_EQ(killed, n_kills);
  expect_end(0, work(scene_, directory_));
  EXPECT_EQ(difference(undisturbed_, directory_), "");
  std::printf("%d kills, %d runs came to their end\n", killed, ended + 1);
}

TEST_F(CrashPoints, AFullDiskLosesNothing) { everywhere("full", killed_midway()); }

TEST_F(CrashPoints, AnErrorOfTheDiskLosesNothing) { everywhere("once", killed_midway()); }

}  // namespace
}  // namespace shaken::test
