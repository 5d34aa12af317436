// A run that meets numerical trouble: what it leaves behind, and that it can be met again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/e2e/run_command.h"
#include "tests/support/good.h"

namespace shaken::test {
namespace {

using Json = nlohmann::json;
using testing::HasSubstr;

/// Ticks 25 times too long for shaking five times too strong: rods go through each other within some 100 ticks.
constexpr const char* kWildScene = R"({
  "rods": { "length": "2.5 mm", "area_fraction": 0.8 },
  "box": { "side": "12 mm" },
  "plates": { "gamma": 30 },
  "time": { "step": 1e-4, "steady": 0, "measure": "5 s" },
  "measure": { "order": { "every": "1 ms" } },
  "stream": null
})";

Json read_json(const std::filesystem::path& file) { return Json::parse(std::ifstream(file)); }

class Trouble : public testing::Test {
 protected:
  Trouble() : run_((directory_.path() / "wild").string()) {
    std::ofstream(directory_.path() / "wild.json") << kWildScene;
  }
  Finished worker(const std::string& checkpoint_every) {
    return run_command({program("shaken-worker"), (directory_.path() / "wild.json").string(), "--out", run_, "--no-lcm",
                        "--checkpoint-every", checkpoint_every});
  }
  Finished replay(std::vector<std::string> more = {}) {
    more.insert(more.begin(), {program("shaken"), "replay", run_});
    return run_command(more);
  }
  std::filesystem::path file(const char* name) const { return std::filesystem::path(run_) / name; }

  ScratchFolder directory_;
  std::string run_;
};

TEST_F(Trouble, EndsTheRunWithAllThatIsKnownAndComesBack) {
  EXPECT_THAT(said_with(1, worker("1000")), HasSubstr("numerical trouble at tick"));
  EXPECT_EQ(read_json(file("summary.json")).at("exit").at("state"), "failed");
  const Json trouble = read_json(file("trouble.json"));
  EXPECT_EQ(trouble.at("checkpoint_tick"), 0);
  EXPECT_EQ(trouble.at("before").at("tick"), trouble.at("tick").get<int>() - 1);
  EXPECT_EQ(trouble.at("scene").at("plates").at("frequency"), 200);

  const Json seen = Json::parse(said_with(0, replay({"--json"})));
  EXPECT_EQ(seen.at("same"), true);
  EXPECT_EQ(seen.at("met"), seen.at("recorded"));
  EXPECT_EQ(seen.at("started_at_tick"), 0);
  // the worker wrote down, after the trouble, exactly what the replay sees before it
  EXPECT_EQ(seen.at("before"), trouble.at("before"));
  ASSERT_FALSE(seen.at("before").at("rods").empty());
  EXPECT_EQ(seen.at("before").at("rods").at(0).at("rod"), trouble.at("rods").at(0));

  EXPECT_THAT(said_with(0, replay()), HasSubstr("the same trouble at the same tick"));
}

TEST_F(Trouble, ComesBackFromTheLastCheckpoint) {
  EXPECT_EQ(worker("0.0005").code, 1);
  const Json trouble = read_json(file("trouble.json"));
  ASSERT_GT(trouble.at("checkpoint_tick"), 0);
  ASSERT_TRUE(std::filesystem::exists(file("checkpoint.bin")));
  const Finished again = replay({"--json"});
  EXPECT_EQ(again.code, 0) << again.output;
  EXPECT_EQ(Json::parse(again.output).at("started_at_tick"), trouble.at("checkpoint_tick"));
  EXPECT_EQ(Json::parse(again.output).at("before"), trouble.at("before"));
}

TEST_F(Trouble, AnotherOutcomeIsToldApart) {
  worker("1000");
  Json trouble = read_json(file("trouble.json"));
  trouble["tick"] = trouble.at("tick").get<int>() - 1;
  std::ofstream(file("trouble.json")) << trouble;
  EXPECT_THAT(said_with(1, replay()), HasSubstr("NOT the same"));
}

TEST_F(Trouble, NoTroubleIsBadInput) {
  std::filesystem::create_directory(run_);
  EXPECT_THAT(said_with(2, replay()), HasSubstr("holds no run"));
  std::filesystem::copy(directory_.path() / "wild.json", file("scene.json"));
  EXPECT_THAT(said_with(2, replay()), HasSubstr("no trouble.json"));
}

}  // namespace
}  // namespace shaken::test
