// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "run/files/directory.h"
#include "study/run_set.h"
#include "tests/unit/client/fake_daemon.h"

namespace shaken::study {

/// Run directories as a worker leaves them, with the numbers that a test wants.
class Runs {
 public:
  FinishedRun make(double length, double fraction, double order, double sem, const Json& measured = Json::object(),
                   const run::Observables& arrays = {{"/none", {0.0}}}, double side = 33.5) {
    const auto folder = folder_.path() / std::to_string(++n_);
    std::filesystem::create_directories(folder);
    const run::RunDirectory files{folder};
    std::ofstream(files.scene()) << Json{
        {"rods", {{"length", length}, {"area_fraction", 0.998 * fraction}, {"end_diameter", 0.4}}},
        {"box", {{"side", side}, {"gap", 1.2}}}};
    std::ofstream(files.summary()) << Json{{"n_rods", 400},
                                           {"order", {{"mean", order}, {"sem", sem}, {"std", 3 * sem}}},
                                           {"measured", measured},
                                           {"exit", {{"state", "done"}}}};
    EXPECT_TRUE(run::write_observables(files.observables(), arrays));
    return FinishedRun(folder, {{"rods.area_fraction", fraction}});
  }
  const std::filesystem::path& path() const { return folder_.path(); }

 private:
  ScratchFolder folder_;
  int n_ = 0;
};

}  // namespace shaken::study
