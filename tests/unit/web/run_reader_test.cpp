// With the program shaken-web itself as the reader.
#include "web/run_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <future>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "base/scratch_folder.h"
#include "run/files/directory.h"
#include "run/files/observables_file.h"
#include "tests/support/damaged_hdf5.h"
#include "tests/support/good.h"
#include "tests/unit/web/small_recording.h"

namespace shaken::web {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;
using testing::HasSubstr;

constexpr const char* kGood = "1f0c000000000000";
constexpr const char* kBad = "bad0000000000000";

class RunReaderTest : public testing::Test {
 protected:
  RunReaderTest() {
    for (const char* run : {kGood, kBad}) {
      std::filesystem::create_directories(folder_ / run);
      const run::RunDirectory directory{folder_ / run};
      EXPECT_TRUE(run::write_observables(directory.observables(), {{"/order/order", {0.5, 0.25}}}));
      record_two_frames(directory, run);
    }
  }
  std::filesystem::path trajectory(const std::string& run) const {
    return run::RunDirectory{folder_ / run}.trajectory();
  }

  ScratchFolder folder_;
};

TEST_F(RunReaderTest, TellsWhatTheRunHas) {
  RunReader reader(folder_.path(), {}, hours(1));
  const auto answer = test::good(reader.ask(kGood, {"curves", "/order/order"}));
  const auto json = nlohmann::json::parse(*answer);
  EXPECT_EQ(json["names"][0]["points"], 2);
  EXPECT_EQ(json["curves"]["/order/order"][1], 0.25);
  EXPECT_EQ(nlohmann::json::parse(reader.ask(kGood, {"frames"}).value())["n"], 2);
  EXPECT_THAT(reader.ask(kGood, {"frame", "1"}).value(), HasSubstr("\"n_rods\":1"));
  EXPECT_THAT(reader.ask(kGood, {"frame", "2"}).error().message, HasSubstr("has no frame 2"));
  EXPECT_THAT(reader.ask("ffffffffffffffff", {"frames"}).value(), HasSubstr("records no rods"));
  std::vector<std::future<bool>> others;  // who wait for each other
  for (int i = 0; i < 4; ++i)
    others.push_back(std::async(std::launch::async, [&] { return bool(reader.ask(kGood, {"frames"})); }));
  for (std::future<bool>& one : others) EXPECT_TRUE(one.get());
}

TEST_F(RunReaderTest, AFileThatHdf5ComesToNoEndWithKeepsOnlyThoseWhoAskForIt) {
  ASSERT_TRUE(make_endless(trajectory(kBad)));
  std::atomic<bool> stop = false;
  RunReader reader(
      folder_.path(), [&] { return stop.load(); }, hours(1));
  auto kept = std::async(std::launch::async, [&] { return reader.ask(kBad, {"frames"}); });
  EXPECT_TRUE(reader.ask(kGood, {"frames"}));
  EXPECT_TRUE(reader.ask(kGood, {"curves"}));
  stop = true;  // and whoever is kept is let go at the end
  EXPECT_FALSE(kept.get());
}

TEST_F(RunReaderTest, AFileThatHdf5ComesToNoEndWithIsNamedAndNotTriedAtOnceAgain) {
  ASSERT_TRUE(make_endless(trajectory(kBad)));
  std::atomic<int> n_looks = 0;
  RunReader reader(
      folder_.path(), [&] { return ++n_looks < 0; }, milliseconds(1000));
  const auto first = reader.ask(kBad, {"frames"});
  ASSERT_FALSE(first);
  EXPECT_THAT(first.error().message, HasSubstr(trajectory(kBad).string()));
  EXPECT_THAT(first.error().message, HasSubstr("submit the scene again"));
  const int n = n_looks;
  EXPECT_EQ(reader.ask(kBad, {"frames"}).error().message, first.error().message);
  EXPECT_EQ(n_looks, n) << "a reader was started for it";
}

TEST_F(RunReaderTest, AFileThatEndsItsReaderIsNamed) {
  setenv("ASAN_OPTIONS", "abort_on_error=1", 1);  // where a sanitizer sees first what would end it by a signal
  ASSERT_TRUE(make_fatal(trajectory(kBad)));
  RunReader reader(folder_.path(), {}, hours(1));
  EXPECT_THAT(test::refusal(reader.ask(kBad, {"frames"})), HasSubstr(trajectory(kBad).string()));
}

TEST_F(RunReaderTest, ADamagedFileIsRefusedByItsHash) {
  ASSERT_TRUE(write_file(run::RunDirectory{folder_ / kBad}.summary(),
                         R"({"files": {"trajectory.h5": {"bytes": 1, "xxh3": "0"}}})"));
  RunReader reader(folder_.path(), {}, hours(1));
  EXPECT_THAT(reader.ask(kBad, {"frames"}).error().message, HasSubstr("is damaged"));
}

}  // namespace
}  // namespace shaken::web
