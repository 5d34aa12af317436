// A run that meets numerical trouble: what it leaves behind, and that it can be met again.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/e2e/run_command.h"

namespace shaken::test {
namespace {

using Json = nlohmann::json;

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
  const Finished run = worker("1000");
  EXPECT_EQ(run.code, 1) << run.output;
  EXPECT_NE(run.output.find("numerical trouble at tick"), std::string::npos) << run.output;
  EXPECT_EQ(read_json(file("summary.json")).at("exit").at("state"), "failed");
  const Json trouble = read_json(file("trouble.json"));
  EXPECT_EQ(trouble.at("checkpoint_tick"), 0);
  EXPECT_EQ(trouble.at("before").at("tick"), trouble.at("tick").get<int>() - 1);
  EXPECT_EQ(trouble.at("scene").at("plates").at("frequency"), 200);

  const Finished again = replay({"--json"});
  EXPECT_EQ(again.code, 0) << again.output;
  const Json seen = Json::parse(again.output);
  EXPECT_EQ(seen.at("same"), true);
  EXPECT_EQ(seen.at("met"), seen.at("recorded"));
  EXPECT_EQ(seen.at("started_at_tick"), 0);
  // the worker wrote down, after the trouble, exactly what the replay sees before it
  EXPECT_EQ(seen.at("before"), trouble.at("before"));
  ASSERT_FALSE(seen.at("before").at("rods").empty());
  EXPECT_EQ(seen.at("before").at("rods").at(0).at("rod"), trouble.at("rods").at(0));

  const Finished in_words = replay();
  EXPECT_EQ(in_words.code, 0);
  EXPECT_NE(in_words.output.find("the same trouble at the same tick"), std::string::npos) << in_words.output;
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
  const Finished again = replay();
  EXPECT_EQ(again.code, 1);
  EXPECT_NE(again.output.find("NOT the same"), std::string::npos) << again.output;
}

TEST_F(Trouble, NoTroubleIsBadInput) {
  std::filesystem::create_directory(run_);
  const Finished nothing = replay();
  EXPECT_EQ(nothing.code, 2);
  EXPECT_NE(nothing.output.find("holds no run"), std::string::npos) << nothing.output;
  std::filesystem::copy(directory_.path() / "wild.json", file("scene.json"));
  const Finished none = replay();
  EXPECT_EQ(none.code, 2);
  EXPECT_NE(none.output.find("no trouble.json"), std::string::npos) << none.output;
}

}  // namespace
}  // namespace shaken::test
