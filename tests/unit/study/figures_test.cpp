// SPDX-License-Identifier: MIT
#include "study/figures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/process.h"
#include "tests/unit/study/made_up_run.h"
#include "tests/unit/study/run_directories.h"

namespace shaken::study {
namespace {

TEST(PaperFigures, OfNothingAreDrawnWithoutData) {
  const Library none;
  for (const PaperFigure& figure : paper_figures()) {
    if (figure.draw == nullptr) continue;
    const Sheet sheet = figure.draw({none, [](const FinishedRun&) { return std::filesystem::path(); }});
    for (const Figure& panel : sheet.panels) {
      for (const Curve& curve : panel.curves) {
        EXPECT_TRUE(curve.y.empty() || curve.look == Curve::Look::kDashes) << figure.id << " " << panel.title;
      }
    }
  }
}

TEST(PaperFigures, DiffusionShowsWhereDIsRead) {
  MadeUp run(2.5, 0.80);
  run.scalar("diffusion_lag_from_s", 4).scalar("diffusion_lag_to_s", 8);
  run.array("/msd/lag_s", {0, 1, 2, 4, 8, 16}).array("/msd/d_total_mm2_s", {NAN, 1, 2, 3, 3.5, 3.6});
  const Library library = library_of({{"diffusion", {run}}, {"phases", {MadeUp(2.5, 0.80).box(33)}}});
  const Sheet sheet = diffusion_figure({library, [](const FinishedRun&) { return std::filesystem::path(); }});
  const auto panel = std::find_if(sheet.panels.begin(), sheet.panels.end(),
                                  [](const Figure& figure) { return figure.y_title.starts_with("MSD / 4t"); });
  ASSERT_NE(panel, sheet.panels.end());
  ASSERT_EQ(panel->curves.size(), 2u) << "the long run alone, and its window";
  EXPECT_EQ(panel->curves[0].x.size(), 6u);
  EXPECT_EQ(panel->curves[1].x, (std::vector<double>{4, 8}));
  EXPECT_EQ(panel->curves[1].y, (std::vector<double>{3, 3.5}));
}

TEST(PaperFigures, OrderHasTheSpreadAsBarsAndRingsWhereItRelaxes) {
  const Library library =
      library_of({{"phases",
                   {MadeUp(4.5, 0.75).order(0.9, 0.001).scalar("susceptibility", 4, 1),
                    MadeUp(4.5, 0.80).order(0.9, 0.001).scalar("susceptibility", 1, 1).relaxing()}}});
  const Sheet sheet = order_figure({library, [](const FinishedRun&) { return std::filesystem::path(); }});
  const Curve& mean = sheet.panels[1].curves.at(0);
  EXPECT_EQ(mean.y_error, (std::vector<double>{0.1, 0.05})) << "sqrt(susceptibility / 400), not the standard error";
  EXPECT_EQ(mean.unsteady, (std::vector<bool>{false, true}));
}

TEST(ArrayCurve, ReplicasHaveErrorsAsNumbersHave) {
  const auto run = [](double value, double sem) {
    return MadeUp(2.5, 0.8).array("/x", {1}).array("/y", {value}).array("/y_sem", {sem}).run();
  };
  const Curve agreeing = array_curve({run(2, 0.3), run(2, 0.4)}, "/x", "/y", "", 0, "/y_sem");
  EXPECT_EQ(agreeing.y, (std::vector<double>{2}));
  EXPECT_DOUBLE_EQ(agreeing.y_error.at(0), 0.25) << "never below the errors within the runs";
  const Curve apart = array_curve({run(1, 0.1), run(3, 0.1)}, "/x", "/y", "", 0, "/y_sem");
  EXPECT_DOUBLE_EQ(apart.y_error.at(0), 1) << "the scatter between them";
  EXPECT_EQ(array_curve({run(2, 0.3)}, "/x", "/y", "", 0, "/y_sem").y_error, (std::vector<double>{0.3}));
  EXPECT_TRUE(array_curve({}, "/x", "/y", "", 0).y.empty());
}

TEST(PaperFigures, NeedSweepsThatExistAtEveryScale) {
  const auto known = all_sets();
  for (const PaperFigure& figure : paper_figures()) {
    for (const std::string_view set : figure.sets) {
      EXPECT_NE(std::find(known.begin(), known.end(), set), known.end()) << set;
    }
  }
  for (const char* scale : {"tiny", "laptop", "paper"}) {
    for (const std::string_view set : known) {
      const auto file =
          std::filesystem::path(SHAKEN_SOURCE_DIR) / "configs/figures" / scale / (std::string(set) + ".json");
      EXPECT_TRUE(std::filesystem::exists(file)) << file;
    }
  }
}

TEST(PaperFigures, OfNothingAreDrawnByGnuplotToo) {
  if (run_captured({"gnuplot", "--version"}).exit_code != 0) GTEST_SKIP() << "no gnuplot";
  const ScratchFolder folder;
  Runs runs;
  Library one;  // a map of one cell
  one.add("phases", {runs.make(4.5, 0.75, 0.9, 0.01)});
  for (const Library& library : {Library(), one}) {
    for (const auto figure : {order_figure, pair_map_figure, melting_figure}) {
      Sheet sheet = figure({library, [](const FinishedRun&) { return std::filesystem::path(); }});
      sheet.name = "sheet";
      if (sheet.panels.empty()) continue;
      EXPECT_TRUE(std::filesystem::exists(draw(sheet, folder.path())));
    }
  }
}

}  // namespace
}  // namespace shaken::study
