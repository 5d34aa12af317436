// SPDX-License-Identifier: MIT
#include "study/figures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

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
        EXPECT_TRUE(curve.y.empty() || curve.look == Curve::Look::kDashes) << figure.id() << " " << panel.title;
      }
    }
  }
}

// A reader with the paper open looks for its figure 8, and not for the eighth result of ours.
TEST(PaperFigures, HaveThePapersNumbers) {
  const std::vector<std::pair<std::string, std::string>> paper{{"2", "order settles"},
                                                               {"3", "Nematic order"},
                                                               {"4", "Statistics of the order"},
                                                               {"5", "Orientational"},
                                                               {"6", "along and across"},
                                                               {"7", "Pair correlation"},
                                                               {"8", "layered phase"},
                                                               {"9", "Diffusion"},
                                                               {"10", "How a rod swims"},
                                                               {"11", "Paths of single rods"},
                                                               {"12", "Correlations in time"},
                                                               {"13", "Rotation"},
                                                               {"14", "Defects"}};
  const Library none;
  const auto figures = paper_figures();
  for (std::size_t k = 0; k < paper.size(); ++k) {
    EXPECT_EQ(figures[k].number, paper[k].first);
    const Sheet sheet = figures[k].draw({none, [](const FinishedRun&) { return std::filesystem::path(); }});
    EXPECT_NE(sheet.title.find(paper[k].second), std::string::npos) << paper[k].first << ": " << sheet.title;
  }
  for (const PaperFigure& figure : figures.subspan(paper.size())) EXPECT_EQ(figure.number, "") << figure.name;
  EXPECT_EQ(figures[0].file(), "fig02-start");
  EXPECT_EQ(figures.back().file(), "movies");
}

TEST(PaperFigures, OfTheDocumentsAreNamedAsTheyAreDrawn) {
  const auto folder = std::filesystem::path(SHAKEN_SOURCE_DIR) / "docs/figures";
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.insert(entry.path().stem().string());
  for (const PaperFigure& figure : paper_figures()) {
    if (figure.draw == nullptr) continue;
    EXPECT_EQ(names.erase(figure.file()), 1u) << figure.file();
    for (const char* ending : {".png", ".dat", ".gp"}) {
      EXPECT_TRUE(std::filesystem::exists(folder / (figure.file() + ending))) << figure.file() << ending;
    }
  }
  EXPECT_TRUE(names.empty()) << *names.begin();
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
  const Curve& mean = sheet.panels[0].curves.at(0);
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
    for (const auto figure : {start_figure, order_figure, g2_map_figure, distances_figure, melting_figure}) {
      Sheet sheet = figure({library, [](const FinishedRun&) { return std::filesystem::path(); }});
      sheet.name = "sheet";
      if (sheet.panels.empty()) continue;
      EXPECT_TRUE(std::filesystem::exists(draw(sheet, folder.path())));
    }
  }
}

}  // namespace
}  // namespace shaken::study
