#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "base/plots_by_python.h"
#include "client/live/json.h"
#include "run/files/observables_file.h"
#include "tests/support/good.h"
#include "tests/unit/client/fake_daemon.h"
#include "tests/unit/client/run_client.h"

namespace shaken::client {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Whether there is what draws.
bool have_matplotlib() {
  try {
    return !plots_by_python({"check"}).empty();
  } catch (const Failure&) {
    return false;
  }
}

bool is_png(const std::filesystem::path& file) {
  std::string head(8, '\0');
  std::ifstream(file, std::ios::binary).read(head.data(), 8);
  return head == "\x89PNG\r\n\x1a\n";
}

/// All observables of a run, with shapes like real ones.
run::Observables observables(double order) {
  run::Observables arrays;
  for (int i = 0; i <= 200; ++i) {
    const double t = 0.01 * i;
    arrays["/order/time_s"].push_back(t);
    arrays["/order/order"].push_back(order + (1 - order) * std::exp(-4 * t) + 0.02 * std::sin(70 * t));
    arrays["/defects/time_s"].push_back(t);
    arrays["/defects/n_plus"].push_back(i / 50);
    arrays["/defects/n_minus"].push_back(i / 50);
  }
  for (int i = 0; i < 60; ++i) {
    const double theta = -std::acos(0.0) + (i + 0.5) * std::acos(-1.0) / 60;
    arrays["/angles/theta_rad"].push_back(theta);
    arrays["/angles/density_per_rad"].push_back(std::exp(-theta * theta * 8 * order));
    arrays["/tilt/n_z"].push_back(-0.2 + i / 150.0);
    arrays["/tilt/v_along_mm_s"].push_back(std::sin(i / 10.0));
    arrays["/tilt/v_along_sem_mm_s"].push_back(0.1);
    arrays["/g2/r_mm"].push_back(0.5 * i);
    arrays["/g2/g2"].push_back(order * order + std::exp(-0.3 * i) * (1 - order * order));
    arrays["/msd/lag_s"].push_back(std::pow(10.0, -3 + i / 15.0) * (i > 0));
    arrays["/msd/total_mm2"].push_back(arrays["/msd/lag_s"].back() * 2);
  }
  return arrays;
}

TEST(Plot, DrawsARunDirectory) {
  if (!have_matplotlib()) GTEST_SKIP() << "no matplotlib";
  const ScratchFolder folder;
  std::ofstream(folder.path() / "scene.json") << "{}";
  ASSERT_TRUE(run::write_observables(folder.path() / "observables.h5", observables(0.4)));
  const Outcome outcome = run_client({"plot", folder.path().string(), "-o", (folder.path() / "out").string()});
  EXPECT_EQ(outcome.code, ExitCode::kOk) << outcome.err;
  for (const char* name : {"order_time", "angles", "tilt", "defects", "g2", "msd"}) {
    const auto file = folder.path() / "out" / name;
    EXPECT_TRUE(is_png(file.string() + ".png")) << name;
    EXPECT_TRUE(std::filesystem::exists(file.string() + ".csv")) << name;
    EXPECT_THAT(outcome.out, HasSubstr(file.string() + ".png\n"));
  }
}

TEST(Plot, DrawsASweepFromTheDaemon) {
  if (!have_matplotlib()) GTEST_SKIP() << "no matplotlib";
  const ScratchFolder root;
  FakeDaemon daemon(root.path());
  Json jobs = Json::array();
  Json rows = Json::array();
  for (const double fraction : {0.55, 0.65, 0.75}) {
    const auto directory = root.path() / std::to_string(fraction);
    std::filesystem::create_directory(directory);
    // The last run has left no file: it is named and left out.
    if (fraction < 0.7) {
      ASSERT_TRUE(run::write_observables(directory / "observables.h5", observables(fraction)));
    }
    const Json parameters{{"rods.area_fraction", fraction}};
    const std::string label = "rods.area_fraction=" + std::to_string(fraction);
    jobs.push_back({{"id", label},
                    {"state", "done"},
                    {"label", label},
                    {"parameters", parameters},
                    {"directory", directory.string()}});
    rows.push_back({{"job", label},
                    {"sweep", "s1"},
                    {"state", "done"},
                    {"label", label},
                    {"parameters", parameters},
                    {"replica", 1},
                    {"summary", {{"order", {{"mean", fraction}, {"sem", 0.02}}}}}});
  }
  daemon.on("GET /v1/sweeps/s1", Json{{"sweep", {{"id", "s1"}, {"name", "x"}}}, {"jobs", jobs}}.dump());
  daemon.on("GET /v1/results?sweep=s1", Json{{"rows", rows}}.dump());
  const auto out = root.path() / "plots";
  EXPECT_THAT(
      test::said_with(ExitCode::kOk, run_client({"plot", "s1", "--root", root.path().string(), "-o", out.string()})),
      AllOf(HasSubstr("left out: "), Not(HasSubstr("errno"))))
      << "in words, not in those of the library";
  EXPECT_TRUE(is_png(out / "order_rods_area_fraction.png"));
  EXPECT_TRUE(is_png(out / "order_time.png"));

  const auto one = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"plot", "s1", "--root", root.path().string()});
    return run_client(options);
  };
  const auto pdf = root.path() / "paper" / "s.pdf";
  const Outcome drawn = one({"--x", "rods.area_fraction", "--y", "order.mean", "-o", pdf.string()});
  EXPECT_EQ(drawn.code, ExitCode::kOk) << drawn.err;
  EXPECT_EQ(drawn.out, pdf.string() + "\n");
  std::string head(4, '\0');
  std::ifstream(pdf).read(head.data(), 4);
  EXPECT_EQ(head, "%PDF");
  const Outcome svg = one({"--y", "order.mean", "--format", "svg", "-o", (root.path() / "web").string()});
  EXPECT_EQ(svg.code, ExitCode::kOk) << svg.err;
  EXPECT_TRUE(std::filesystem::exists(root.path() / "web" / "order_rods_area_fraction.svg"));
  const Outcome chosen =
      one({"--where", "rods.area_fraction<0.7", "--width", "183mm", "-o", (root.path() / "w").string()});
  EXPECT_EQ(chosen.code, ExitCode::kOk) << chosen.err;
  EXPECT_EQ(chosen.err, "") << "the run without a file is not asked for";
  EXPECT_THAT(test::said_with(ExitCode::kFailed, one({"--where", "rods.area_fraction>0.8"})),
              HasSubstr("nothing to plot"));
  EXPECT_EQ(one({"--where", "no.such_field=1 or x"}).code, ExitCode::kBadInput);
  EXPECT_THAT(test::said_with(ExitCode::kBadInput, one({"--width", "4mm", "--format", "bmp"})),
              ::testing::AllOf(HasSubstr("--width takes 89mm"), HasSubstr("--format takes png")));
  EXPECT_EQ(one({"-o", "all.pdf"}).code, ExitCode::kBadInput) << "several figures, one file";
  EXPECT_THAT(test::said_with(ExitCode::kFailed, one({"--map", "-o", (root.path() / "map.png").string()})),
              HasSubstr("nothing was recorded"))
      << "in any of these runs";
  EXPECT_EQ(one({"--format", "gif"}).code, ExitCode::kBadInput);
  EXPECT_EQ(one({"--y", "order.maen"}).code, ExitCode::kBadInput);
}

TEST(Plot, TakesFoldersWhoseNamesAreNoUtf8) {
  if (!have_matplotlib()) GTEST_SKIP() << "no matplotlib";
  const ScratchFolder folder;
  const auto run = folder.path() / "o\xff 100%", out = folder.path() / "p\xfd";
  std::filesystem::create_directory(run);
  std::ofstream(run / "scene.json") << "{}";
  ASSERT_TRUE(run::write_observables(run / "observables.h5", observables(0.4)));
  const Outcome outcome = run_client({"plot", run.string(), "-o", out.string()});
  EXPECT_EQ(outcome.code, ExitCode::kOk) << outcome.err;
  EXPECT_TRUE(is_png(out / "order_time.png"));
}

TEST(Plot, PackagesOfTheUserAreNotInTheWay) {
  if (!have_matplotlib()) GTEST_SKIP() << "no matplotlib";
  const ScratchFolder folder;
  const auto site = folder.path() / "lib/python3.11/site-packages/numpy";
  std::filesystem::create_directories(site);
  std::ofstream(site / "__init__.py") << "raise ImportError('another numpy')\n";
  setenv("PYTHONUSERBASE", folder.path().c_str(), 1);
  setenv("PYTHONPATH", site.parent_path().c_str(), 1);
  EXPECT_NO_THROW(plots_by_python({"check"}));
  setenv("PYTHONHOME", "/no/such/home", 1);
  EXPECT_NO_THROW(plots_by_python({"check"}));
  setenv("SHAKEN_PYTHON", "/usr/bin/python3", 1);
  EXPECT_THROW(plots_by_python({"check"}), Failure) << "who chooses an interpreter has its packages, too";
  for (const char* name : {"PYTHONUSERBASE", "PYTHONPATH", "PYTHONHOME", "SHAKEN_PYTHON"}) unsetenv(name);
}

TEST(Plot, NothingMeasuredIsAFailure) {
  if (!have_matplotlib()) GTEST_SKIP() << "no matplotlib";
  const ScratchFolder folder;
  std::ofstream(folder.path() / "scene.json") << "{}";
  EXPECT_THAT(test::said_with(ExitCode::kFailed, run_client({"plot", folder.path().string()})),
              HasSubstr("nothing to plot"));
}

TEST(Plot, SaysWhatIsNotInstalled) {
  const ScratchFolder folder;
  std::ofstream(folder.path() / "scene.json") << "{}";
  // a Python that knows nothing but its own library
  const std::filesystem::path bare = folder.path() / "python3";
  std::ofstream(bare) << "#!/bin/sh\nshift 2\nexec /usr/bin/python3 -I -S \"$@\"\n";
  std::filesystem::permissions(bare, std::filesystem::perms::owner_all);
  setenv("SHAKEN_PYTHON", bare.c_str(), 1);
  const Outcome outcome = run_client({"plot", folder.path().string()});
  unsetenv("SHAKEN_PYTHON");
  EXPECT_EQ(outcome.code, ExitCode::kBadInput);
  EXPECT_THAT(outcome.err, HasSubstr("`apt install python3-matplotlib python3-numpy python3-h5py`"));
  EXPECT_THAT(outcome.err, Not(HasSubstr("Traceback")));
}

}  // namespace
}  // namespace shaken::client
