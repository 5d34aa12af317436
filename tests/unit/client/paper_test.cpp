// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/failure.h"
#include "base/figure.h"
#include "base/process.h"
#include "client/paper/claims.h"
#include "client/paper/cost.h"
#include "client/paper/figures.h"
#include "run/files/directory.h"
#include "tests/unit/client/fake_daemon.h"
#include "tests/unit/client/made_up_run.h"

namespace shaken::client {
namespace {

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
    EXPECT_FALSE(run::write_observables(files.observables(), arrays));
    return FinishedRun(folder, {{"rods.area_fraction", fraction}});
  }
  const std::filesystem::path& path() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
  int n_ = 0;
};

TEST(FinishedRun, KnowsSceneSummaryAndArrays) {
  Runs runs;
  const FinishedRun run =
      runs.make(4.5, 0.75, 0.9, 0.01,
                {{"theta_m_deg", {{"value", 10.5}, {"sem", 0.5}}}, {"unknown", {{"value", nullptr}, {"sem", nullptr}}}},
                {{"/g2/r_mm", {1, 2}}});
  EXPECT_EQ(run.number("rods.length"), 4.5);
  EXPECT_TRUE(std::isnan(run.number("rods.colour")));
  EXPECT_EQ(run.scalar("order.mean").value, 0.9);
  EXPECT_EQ(run.scalar("order.mean").sem, 0.01);
  EXPECT_EQ(run.scalar("theta_m_deg").value, 10.5);
  EXPECT_EQ(run.scalar("theta_m_deg").sem, 0.5);
  EXPECT_FALSE(run.scalar("unknown").is_known());
  EXPECT_FALSE(run.scalar("never heard of").is_known());
  EXPECT_EQ(run.array("/g2/r_mm"), (std::vector<double>{1, 2}));
  EXPECT_TRUE(run.array("/g2/nothing").empty());
  EXPECT_TRUE(is_finished(run.directory()));
  EXPECT_FALSE(is_finished(runs.path()));
  EXPECT_THROW(FinishedRun(runs.path()), Failure);
}

TEST(MeanScalar, OfReplicasHasTheLargerOfBothErrors) {
  Runs runs;
  const auto set = [&](double a, double b, double sem) {
    return RunSet{runs.make(4.5, 0.75, a, sem), runs.make(4.5, 0.75, b, sem)};
  };
  EXPECT_NEAR(mean_scalar(set(0.8, 0.9, 0.001), "order.mean").value, 0.85, 1e-12);
  EXPECT_NEAR(mean_scalar(set(0.8, 0.9, 0.001), "order.mean").sem, 0.05, 1e-12) << "the scatter between them";
  EXPECT_NEAR(mean_scalar(set(0.85, 0.85, 0.02), "order.mean").sem, 0.02 / std::sqrt(2.0), 1e-12) << "their own";
  EXPECT_NEAR(mean_scalar({runs.make(4.5, 0.75, 0.8, 0.02)}, "order.mean").sem, 0.02, 1e-12);
  EXPECT_FALSE(mean_scalar({}, "order.mean").is_known());
}

TEST(MeanScalar, OfReplicasIsAsSteadyAsTheWorstOfThem) {
  const MadeUp steady = MadeUp(4.5, 0.75).order(0.9), relaxing = MadeUp(4.5, 0.75).order(0.9).relaxing(),
               untested = MadeUp(4.5, 0.75).order(0.9).untested();
  const auto of = [](const MadeUp& a, const MadeUp& b) {
    return mean_scalar({a.run(), b.run()}, "order.mean").steadiness;
  };
  EXPECT_EQ(of(steady, steady), Steadiness::kSteady);
  EXPECT_EQ(of(steady, relaxing), Steadiness::kRelaxing);
  EXPECT_EQ(of(steady, untested), Steadiness::kUnknown);
  EXPECT_EQ(of(untested, relaxing), Steadiness::kRelaxing);
}

TEST(FinishedRun, NumbersAreAsSteadyAsTheySayAndTheirRun) {
  const auto of = [](const Json& run, const Json& own) {
    const Json scalar{{"value", 1.0}, {"sem", 0.1}, {"steady", own}};
    return FinishedRun(Json::object(), Json{{"steady", run}, {"measured", {{"x", scalar}}}}, {}).scalar("x").steadiness;
  };
  EXPECT_EQ(of(true, nullptr), Steadiness::kSteady) << "no average over time: as its run";
  EXPECT_EQ(of(true, true), Steadiness::kSteady);
  EXPECT_EQ(of(nullptr, true), Steadiness::kSteady) << "S was not measured";
  EXPECT_EQ(of(true, false), Steadiness::kRelaxing);
  EXPECT_EQ(of(false, true), Steadiness::kRelaxing);
  EXPECT_EQ(of(nullptr, nullptr), Steadiness::kUnknown);
}

TEST(Crossing, IsInterpolatedWithItsError) {
  const auto at = [](double x, double y, double sem) { return Point{x, {y, sem, Steadiness::kSteady}}; };
  const std::vector<Point> points{at(0.7, 0.9, 0.03), at(0.5, 0.1, 0.01), at(0.6, 0.3, 0.03)};
  const Quantity found = crossing(points, 0.5);
  EXPECT_NEAR(found.value, 0.6 + 0.1 * 0.2 / 0.6, 1e-12);
  // y at that place has the error of 2/3 and 1/3 of its neighbours; the slope is 6
  EXPECT_NEAR(found.sem, std::hypot(2.0 / 3 * 0.03, 1.0 / 3 * 0.03) / 6, 1e-12);
  EXPECT_EQ(found.steadiness, Steadiness::kSteady);
  EXPECT_FALSE(crossing(points, 0.95).is_known());
  EXPECT_FALSE(crossing({at(0, 1, 0), at(1, 0, 0)}, 0.5).is_known()) << "it falls";
  EXPECT_FALSE(crossing({}, 0.5).is_known());
}

TEST(Origin, NamesTheVersionsThatMadeTheRuns) {
  const auto by = [](const char* version, const char* finished) {
    return MadeUp(4.5, 0.75)
        .number(Json::json_pointer("/versions/shaken"), version)
        .number(Json::json_pointer("/finished"), finished);
  };
  const Library runs =
      library_of({{"phases", {by("1.0", "2026-01-02"), by("1.0", "2026-01-03"), by("1.1", "2026-02-01")}}});
  const std::string_view sweeps[] = {"phases"};
  EXPECT_EQ(origin_text(runs, sweeps),
            "- 2 runs by shaken 1.0, the last of them finished at 2026-01-03\n"
            "- 1 runs by shaken 1.1, the last of them finished at 2026-02-01\n");
}

TEST(Report, TableGoesBetweenTheMarks) {
  const std::string document = "a\n<!-- measured: begin -->\nold\n<!-- measured: end -->\nb\n";
  EXPECT_EQ(with_section(document, "measured", "new\n"),
            "a\n<!-- measured: begin -->\nnew\n<!-- measured: end -->\nb\n");
  EXPECT_THROW(with_section("no marks", "measured", "new\n"), Failure);
}

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
  EXPECT_EQ(mean.relaxing, (std::vector<bool>{false, true}));
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
  const TemporaryFolder folder;
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
}  // namespace shaken::client
