#include "run/loop/summary.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "base/scratch_folder.h"
#include "run/files/directory.h"
#include "run/files/done.h"

namespace shaken::run {
namespace {

Summary example() {
  Summary s;
  s.run_id = "0123456789abcdef";
  s.n_rods = 2000;
  s.sim_seconds = 10;
  s.cpu_seconds = 100;
  s.wall_seconds = 110;
  s.physics = 7;
  s.collisions_rod_rod = 5'000'000'000;
  s.collisions_rod_base = 2;
  s.collisions_rod_lid = 3;
  s.max_overlap = 0.001;
  s.t_steady = 2;
  s.order = analysis::SteadySummary{0.9, 0.02, 0.001, 0.5, 2, 400, true, {}};
  s.effects["rod_rod_friction"] = {true, {{"impulses", 5e9}}};
  s.effects["movie"] = {};
  s.state_hash = 0xab;
  s.tick = 2'500'000;
  return s;
}

nlohmann::json written(const Summary& summary) {
  const ScratchFolder folder;
  EXPECT_TRUE(write_summary(folder / "summary.json", summary));
  return nlohmann::json::parse(*read_file(folder / "summary.json"));
}

TEST(Summary, HasTheAgreedFields) {
  const auto json = written(example());
  EXPECT_EQ(json["n_rods"], 2000);
  EXPECT_EQ(json["sim_seconds"], 10.0);
  EXPECT_EQ(json["rod_seconds_per_cpu_second"], 200.0);
  EXPECT_EQ(json["collisions"]["rod_rod"], 5'000'000'000);
  EXPECT_EQ(json["versions"]["physics"], 7);
  EXPECT_EQ(json["order"]["mean"], 0.9);
  EXPECT_EQ(json["order"]["tau_s"], 0.5);
  EXPECT_EQ(json["order"]["t_steady_s"], 2.0);
  EXPECT_TRUE(json["defects"].is_null()) << "not measured is not zero";
  EXPECT_EQ(json["effects"]["rod_rod_friction"]["on"], true);
  EXPECT_EQ(json["effects"]["rod_rod_friction"]["impulses"].dump(), "5000000000") << "counts are whole numbers";
  EXPECT_EQ(json["effects"]["movie"]["on"], false);
  EXPECT_EQ(json["state_hash"], "00000000000000ab");
  EXPECT_EQ(json["exit"]["state"], "done");
  EXPECT_EQ(json["exit"]["tick"], 2'500'000);
  EXPECT_EQ(json["versions"]["shaken"], "0.1.0");
}

// Two seconds from an ordered start: the scatter alone would promise four digits.
TEST(Summary, TheErrorOfWhatMayBeOnItsWayHoldsItsDrift) {
  Summary summary = example();
  summary.order->sem = 0.0007;
  summary.order->steady = std::nullopt;
  summary.order->drift = {-0.03, 0.02};
  summary.scalars["dip"] = {{0.5, 0.01, 30, false, 0.3, 0.4}};
  summary.scalars["diffusion"] = {{2.0, 0.1, 30, std::nullopt}};  // no average over time
  auto json = written(summary);
  EXPECT_NEAR(json["order"]["sem"].get<double>(), std::hypot(0.0007, 0.03, 0.02), 1e-12);
  EXPECT_EQ(json["order"]["sem_if_steady"], 0.0007);
  EXPECT_NE(json["order"]["why_not_steady"], "");
  EXPECT_NEAR(json["measured"]["dip"]["sem"].get<double>(), std::hypot(0.01, 0.3, 0.4), 1e-12);
  EXPECT_EQ(json["measured"]["diffusion"]["sem"], 0.1);
  summary.order->drift = {};
  EXPECT_TRUE(written(summary)["order"]["sem"].is_null()) << "what drifts by nobody knows how much has no error";
  summary.order->steady = true;
  json = written(summary);
  EXPECT_EQ(json["order"]["sem"], 0.0007);
  EXPECT_FALSE(json["order"].contains("why_not_steady") || json["order"].contains("sem_if_steady"));
}

TEST(Summary, SaysOfEveryNumberWhatItIsWorth) {
  Summary summary = example();
  summary.order->steady = true;
  summary.order->drift = {0.01, 0.02};
  summary.scalars["theta_m_deg"] = {{12.5, 0.25, 30, true, -0.5, 0.75}};
  summary.scalars["dip"] = {{0.5, NAN, 3, std::nullopt}};
  summary.scalars["psi_6"] = {{0.5, 0.01, 20, false}};
  auto json = written(summary);
  EXPECT_EQ(json["steady"], true);
  EXPECT_EQ(json["order"]["steady"], true);
  EXPECT_EQ(json["order"]["drift"], nlohmann::json::parse(R"({"value": 0.01, "sem": 0.02})"));
  EXPECT_EQ(json["measured"]["theta_m_deg"],
            nlohmann::json::parse(R"({"value": 12.5, "sem": 0.25, "n_effective": 30.0, "steady": true,
                                      "drift": {"value": -0.5, "sem": 0.75}})"));
  EXPECT_EQ(json["measured"]["dip"],
            nlohmann::json::parse(R"({"value": 0.5, "sem": null, "n_effective": 3.0, "steady": null,
                                      "drift": {"value": null, "sem": null}})"));
  EXPECT_EQ(json["measured"]["psi_6"]["steady"], false);

  summary.order->steady = false;
  summary.order->sem = NAN;
  json = written(summary);
  EXPECT_EQ(json["steady"], false);
  EXPECT_TRUE(json["order"]["sem"].is_null());
  summary.order.reset();
  EXPECT_TRUE(written(summary)["steady"].is_null()) << "what was not measured is not known";
}

TEST(Summary, SaysOfEveryNullWhy) {
  Summary summary = example();
  summary.scalars["dip"] = {{NAN, NAN, 3, std::nullopt}, "no dip was found"};
  summary.balance.energy_start = INFINITY;
  const auto json = written(summary), why = json["why_null"], flat = json.flatten();
  EXPECT_EQ(why["defects"], "the scene does not measure them (measure.defects)");
  EXPECT_EQ(why["energy_pJ.start"], "a sum became too large, or was no number");
  EXPECT_EQ(why["measured.dip.value"], "no dip was found");
  EXPECT_EQ(why["measured.dip.sem"], "no average over time, or of too few independent samples");
  std::size_t n_nulls = 0;
  for (const auto& [pointer, value] : flat.items()) {
    if (!json.at(nlohmann::json::json_pointer(pointer)).is_null()) continue;  // but empty
    std::string path = pointer.substr(1);
    std::ranges::replace(path, '/', '.');
    EXPECT_TRUE(why.contains(path)) << path;
    ++n_nulls;
  }
  EXPECT_EQ(why.size(), n_nulls);
}

TEST(Summary, SaysWhyItIsNotSteady) {
  analysis::SteadySummary order{0.9, 0.02, 0.001, 0.5, 8, 400, true, {}};
  EXPECT_EQ(why_not_steady(order, 10), "");
  order.steady = false;
  order.drift = {-0.02, 0.004, 40};
  EXPECT_NE(why_not_steady(order, 10).find("still relaxing: S changes by -0.020 +- 0.004"), std::string::npos);
  for (const auto& [drift, n] : {std::pair(-0.002, 40), {analysis::kDriftErrors * 0.004, 40}, {-0.002, 6}}) {
    order.drift = {drift, 0.004, 1.0 * n};
    EXPECT_NE(why_not_steady(order, 10).find("until 8 s of 10 s"), std::string::npos)
        << drift << ": what is known is the reason";
  }
  order.steady = std::nullopt;
  order.n_effective = 7.2;
  EXPECT_NE(why_not_steady(order, 10).find("about 7 independent samples"), std::string::npos);
  order.drift = {};
  EXPECT_NE(why_not_steady(order, 10).find("not known to be steady: "), std::string::npos);
}

TEST(Summary, TellsTheTrouble) {
  Summary summary = example();
  summary.state = "failed";
  summary.reason = "numerical trouble";
  summary.rods = {7, 11};
  const auto json = written(summary);
  EXPECT_EQ(json["exit"]["reason"], "numerical trouble");
  EXPECT_EQ(json["exit"]["rods"], (std::vector<int>{7, 11}));
}

TEST(Summary, IsDoneOnlyForTheSameRun) {
  const ScratchFolder folder;
  const RunDirectory directory{folder.path()};
  const auto file = directory.summary();
  EXPECT_FALSE(is_done(directory, "0123456789abcdef"));
  Summary summary = example();
  ASSERT_TRUE(write_summary(file, summary));
  EXPECT_TRUE(is_done(directory, "0123456789abcdef"));
  EXPECT_FALSE(is_done(directory, "fedcba9876543210"));
  EXPECT_TRUE(is_done(directory)) << "whichever run it is";
  summary.state = "stopped";
  ASSERT_TRUE(write_summary(file, summary));
  EXPECT_FALSE(is_done(directory, "0123456789abcdef"));
  for (const char* damaged : {"", "{", "[]", "{}", R"({"run_id": "0123456789abcdef", "exit": 3})",
                              R"({"run_id": 5, "exit": {"state": "done"}})"}) {
    ASSERT_TRUE(write_file_atomically(file, damaged));
    EXPECT_FALSE(is_done(directory, "0123456789abcdef")) << damaged;
  }
}

}  // namespace
}  // namespace shaken::run
