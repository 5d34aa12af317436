// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "base/process.h"
#include "client/plotting/run_figures.h"
#include "tests/unit/client/fake_daemon.h"
#include "tests/unit/client/run_client.h"

namespace shaken::client {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

bool have_gnuplot() { return run_captured({"gnuplot", "--version"}).exit_code == 0; }

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

TEST(AxisTitle, NamesWithUnits) {
  EXPECT_EQ(axis_title("rods.length"), "rod length ℓ (mm)");
  EXPECT_EQ(axis_title("measure.order.every"), "measure.order.every (s)");
  EXPECT_EQ(axis_title("no.such_path"), "no.such\\_path");
}

TEST(RunFigures, OnlyOfWhatWasMeasured) {
  EXPECT_TRUE(run_figures({{"a", {}}}).empty());
  run::Observables order{{"/order/time_s", {0, 1, 2}}, {"/order/order", {1, 0.5}}};
  const auto figures = run_figures({{"a", order}, {"b", {}}});
  ASSERT_EQ(figures.size(), 1u);
  EXPECT_EQ(figures[0].name, "order_time");
  ASSERT_EQ(figures[0].curves.size(), 1u);
  // The time whose order is not on the disk yet is left out.
  EXPECT_EQ(figures[0].curves[0].x, (std::vector<double>{0, 1}));
}

TEST(RunFigures, ReplicasShareAColourAndTheirMeanIsDrawn) {
  run::Observables one{{"/order/time_s", {0, 1}},
                       {"/order/order", {1, 0.5}},
                       {"/tilt/n_z", {-0.1, 0.1}},
                       {"/tilt/v_along_mm_s", {1, 2}},
                       {"/tilt/v_along_sem_mm_s", {9, 9}}};
  run::Observables two = one;
  two["/tilt/v_along_mm_s"] = {3, NAN};
  const auto figures = run_figures({{"a", one}, {"a", two}, {"b", one}});
  ASSERT_EQ(figures.size(), 2u);
  const auto& order = figures[0].curves;
  ASSERT_EQ(order.size(), 3u);
  EXPECT_EQ(order[0].label, "a");
  EXPECT_EQ(order[1].label, "");
  EXPECT_EQ(order[1].colour, order[0].colour);
  EXPECT_EQ(order[2].label, "b");
  EXPECT_NE(order[2].colour, order[0].colour);
  const auto& tilt = figures[1].curves;
  ASSERT_EQ(tilt.size(), 2u);
  EXPECT_EQ(tilt[0].y, (std::vector<double>{2, 2}));  // the mean of 1 and 3; of 2 alone
  // Of two the errors of both together, 9 / sqrt(2), which is more than their scatter; of one its own.
  EXPECT_EQ(tilt[0].y_error, (std::vector<double>{std::sqrt(2 * 81.0) / 2, 9}));
  EXPECT_EQ(tilt[1].y_error, (std::vector<double>{9, 9}));
}

TEST(RunFigures, WhatStillRelaxesSaysSo) {
  const run::Observables arrays{
      {"/tilt/n_z", {-0.1, 0.1}}, {"/tilt/v_along_mm_s", {1, 2}}, {"/g2/r_mm", {1, 2}}, {"/g2/g2", {0.5, 0.25}}};
  const auto figures = run_figures({{"a", arrays, Steadiness::kRelaxing}, {"b", arrays}});
  ASSERT_EQ(figures.size(), 2u);
  for (const Figure& figure : figures) {
    EXPECT_EQ(figure.curves[0].label, "a (still relaxing)") << figure.name;
    EXPECT_EQ(figure.curves[1].label, "b") << figure.name;
  }
  EXPECT_EQ(figures[0].name, "tilt");
  EXPECT_EQ(figures[0].curves[0].unsteady, std::vector<bool>(2, true));
  EXPECT_THAT(figure_data(figures[0]), HasSubstr("; 1 where not known to be steady\n-0.1 1 1\n"));
  EXPECT_THAT(figure_script(figures[0]), HasSubstr("using 1:($3==1?$2:NaN) with points"));
  EXPECT_EQ(run_figures({{"", arrays, Steadiness::kRelaxing}})[0].curves[0].label, "still relaxing");
  const auto unknown = run_figures({{"a", arrays, Steadiness::kNotKnown}, {"a", arrays}});
  EXPECT_EQ(unknown[0].curves[0].label, "a (not known to be steady)");
  EXPECT_EQ(unknown[0].curves[0].unsteady, std::vector<bool>(2, true));
}

TEST(RunFigures, VersionsAreNoReplicasOfEachOther) {
  const run::Observables one{{"/tilt/n_z", {-0.1, 0.1}}, {"/tilt/v_along_mm_s", {1, 2}}};
  run::Observables two = one;
  two["/tilt/v_along_mm_s"] = {3, 4};
  const auto figures =
      run_figures({{"a", one, Steadiness::kSteady, {"0.1.0", "3"}}, {"a", two, Steadiness::kSteady, {"0.1.0", "4"}}});
  ASSERT_EQ(figures.size(), 1u);
  ASSERT_EQ(figures[0].curves.size(), 2u);
  EXPECT_EQ(figures[0].curves[0].label, "a, shaken 0.1.0, physics 3");
  EXPECT_EQ(figures[0].curves[1].label, "a, shaken 0.1.0, physics 4");
}

TEST(RunFigures, ErrorsOfCurvesAreBands) {
  const run::Observables arrays{{"/msd/lag_s", {1, 2}}, {"/msd/total_mm2", {1, 2}}, {"/msd/total_sem_mm2", {0.1, 0.2}}};
  const auto figures = run_figures({{"a", arrays}});
  ASSERT_EQ(figures.size(), 1u);
  EXPECT_EQ(figures[0].curves[0].y_error, (std::vector<double>{0.1, 0.2}));
  EXPECT_THAT(figure_script(figures[0]), HasSubstr("using 1:($2-$3):($2+$3) with filledcurves"));
}

TEST(PointLabel, AsInPrint) {
  EXPECT_EQ(point_label({{"rods.area_fraction", 0.6}, {"rods.length", 2.5}, {"time.engine", "scheduled"}}),
            "φ = 0.6, ℓ = 2.5 mm, time.engine = scheduled");
  EXPECT_EQ(point_label(Json::object()), "");
}

/// A point as `aggregated` makes it.
ResultRow point(double length, double fraction, double order, double sem) {
  ResultRow row;
  row.parameters = {{"rods.length", length}, {"rods.area_fraction", fraction}};
  row.fields = row.parameters;
  row.fields["order.mean"] = order;
  row.fields["order.sem"] = sem;
  return row;
}

TEST(SweepFigures, LongestParameterIsTheAxisOthersAreCurves) {
  const auto figures = sweep_figures(
      {point(2.5, 0.7, 0.3, 0.03), point(2.5, 0.6, 0.2, 0.02), point(2.5, 0.5, 0.1, 0.01), point(4.5, 0.6, 0.8, 0.02)});
  ASSERT_EQ(figures.size(), 1u);
  EXPECT_EQ(figures[0].name, "order_rods_area_fraction");
  ASSERT_EQ(figures[0].curves.size(), 2u);
  EXPECT_EQ(figures[0].curves[0].label, "ℓ = 2.5 mm");
  EXPECT_EQ(figures[0].curves[0].x, (std::vector<double>{0.5, 0.6, 0.7}));
  EXPECT_EQ(figures[0].curves[0].y, (std::vector<double>{0.1, 0.2, 0.3}));
  EXPECT_EQ(figures[0].curves[0].y_error, (std::vector<double>{0.01, 0.02, 0.03}));
  EXPECT_EQ(figures[0].curves[1].x, (std::vector<double>{0.6}));
}

TEST(SweepFigures, AnyFieldAgainstAnyOther) {
  ResultRow a = point(2.5, 0.5, 0.1, 0.01), b = point(2.5, 0.7, 0.3, 0.03), without = point(2.5, 0.9, 0.3, 0.03);
  a.fields["measured.theta_m_deg.value"] = 8.5;
  a.fields["measured.theta_m_deg.sem"] = 0.5;
  b.fields["measured.theta_m_deg.value"] = 9.5;
  b.fields["steady"] = false;
  const auto figures = sweep_figures({a, b, without}, {.y = "measured.theta_m_deg.value"});
  ASSERT_EQ(figures.size(), 1u);
  EXPECT_EQ(figures[0].name, "theta_m_deg_rods_area_fraction");
  ASSERT_EQ(figures[0].curves.size(), 1u);
  const Curve& curve = figures[0].curves[0];
  EXPECT_EQ(curve.x, (std::vector<double>{0.5, 0.7}));
  EXPECT_EQ(curve.y, (std::vector<double>{8.5, 9.5}));
  EXPECT_EQ(curve.y_error[0], 0.5);
  EXPECT_TRUE(std::isnan(curve.y_error[1])) << "no error is not an error of zero";
  EXPECT_EQ(curve.unsteady, (std::vector<bool>{false, true}));
  EXPECT_THAT(figures[0].title, HasSubstr("hollow: still relaxing"));
  const auto other = sweep_figures({a, b}, {.x = "order.mean", .y = "measured.theta_m_deg.value"});
  ASSERT_EQ(other.size(), 1u);
  EXPECT_EQ(other[0].x_title, "nematic order ⟨S⟩");
}

TEST(SweepFigures, NothingSweptNothingDrawn) {
  EXPECT_TRUE(sweep_figures({point(2.5, 0.7, 0.3, 0.03)}).empty());
  EXPECT_TRUE(sweep_figures({}).empty());
}

TEST(Plot, DrawsARunDirectory) {
  if (!have_gnuplot()) GTEST_SKIP() << "no gnuplot";
  const ScratchFolder folder;
  std::ofstream(folder.path() / "scene.json") << "{}";
  ASSERT_TRUE(run::write_observables(folder.path() / "observables.h5", observables(0.4)));
  const Outcome outcome = run_client({"plot", folder.path().string(), "-o", (folder.path() / "out").string()});
  EXPECT_EQ(outcome.code, ExitCode::kOk) << outcome.err;
  for (const char* name : {"order_time", "angles", "tilt", "defects", "g2", "msd"}) {
    const auto file = folder.path() / "out" / name;
    EXPECT_TRUE(is_png(file.string() + ".png")) << name;
    EXPECT_TRUE(std::filesystem::exists(file.string() + ".dat")) << name;
    EXPECT_THAT(outcome.out, HasSubstr(file.string() + ".png\n"));
    // The script stands for itself.
    std::filesystem::remove(file.string() + ".png");
    EXPECT_EQ(run_captured({"gnuplot", std::string(name) + ".gp"}, folder.path() / "out").output, "") << name;
    EXPECT_TRUE(is_png(file.string() + ".png")) << name;
  }
}

TEST(Plot, DrawsASweepFromTheDaemon) {
  if (!have_gnuplot()) GTEST_SKIP() << "no gnuplot";
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
  const Outcome outcome = run_client({"plot", "s1", "--root", root.path().string(), "-o", out.string()});
  EXPECT_EQ(outcome.code, ExitCode::kOk) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("left out: "));
  EXPECT_THAT(outcome.err, Not(HasSubstr("errno"))) << "in words, not in those of the library";
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
  EXPECT_EQ(one({"-o", "all.pdf"}).code, ExitCode::kBadInput) << "several figures, one file";
  EXPECT_EQ(one({"--format", "gif"}).code, ExitCode::kBadInput);
  EXPECT_EQ(one({"--y", "order.maen"}).code, ExitCode::kBadInput);
}

TEST(Plot, NothingMeasuredIsAFailure) {
  const ScratchFolder folder;
  std::ofstream(folder.path() / "scene.json") << "{}";
  const Outcome outcome = run_client({"plot", folder.path().string()});
  EXPECT_EQ(outcome.code, ExitCode::kFailed);
  EXPECT_THAT(outcome.err, HasSubstr("nothing to plot"));
}

}  // namespace
}  // namespace shaken::client
