// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "client/failure.h"
#include "client/paper/claims.h"
#include "client/paper/figures.h"
#include "client/plotting/sheet.h"
#include "client/process.h"
#include "run/files/directory.h"
#include "tests/unit/client/fake_daemon.h"

namespace shaken::client {
namespace {

using ::testing::HasSubstr;

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

TEST(Crossing, IsInterpolatedWithItsError) {
  const Curve curve{.x = {0.7, 0.5, 0.6}, .y = {0.9, 0.1, 0.3}, .y_error = {0.03, 0.01, 0.03}};
  const Quantity at = crossing(curve, 0.5);
  EXPECT_NEAR(at.value, 0.6 + 0.1 * 0.2 / 0.6, 1e-12);
  // y at that place has the error of 2/3 and 1/3 of its neighbours; the slope is 6
  EXPECT_NEAR(at.sem, std::hypot(2.0 / 3 * 0.03, 1.0 / 3 * 0.03) / 6, 1e-12);
  EXPECT_FALSE(crossing(curve, 0.95).is_known());
  EXPECT_FALSE(crossing({.x = {0, 1}, .y = {1, 0}}, 0.5).is_known()) << "it falls";
  EXPECT_FALSE(crossing({}, 0.5).is_known());
}

/// S against packing that passes 0.5 at `transition`.
void add_column(Runs& runs, RunSet& set, double length, double transition, const Json& measured = Json::object()) {
  for (const double fraction : {0.45, 0.55, 0.65, 0.75, 0.85}) {
    const double order = 0.05 + 0.85 / (1 + std::exp(-(fraction - transition) / 0.02));
    set.push_back(runs.make(length, fraction, order, 0.01, measured));
  }
}

std::string verdict_of(const Library& library, const std::string& claim) {
  for (const Json& finding : claims_json(library)) {
    if (finding.at("claim") == claim) return finding.at("verdict");
  }
  return "no such claim";
}

TEST(Claims, FollowTheRuns) {
  Runs runs;
  Library paper_like, inverted;
  RunSet set;
  add_column(runs, set, 2.5, 2);
  add_column(runs, set, 3.5, 0.75);
  add_column(runs, set, 4.5, 0.55);
  paper_like.add("phases", set);
  EXPECT_EQ(verdict_of(paper_like, "ordered"), "agrees");
  EXPECT_EQ(verdict_of(paper_like, "disordered"), "agrees");
  EXPECT_EQ(verdict_of(paper_like, "short"), "agrees");
  EXPECT_EQ(verdict_of(paper_like, "transition"), "agrees");

  set.clear();
  add_column(runs, set, 2.5, 0.5);
  add_column(runs, set, 3.5, 0.55);
  add_column(runs, set, 4.5, 0.80);
  inverted.add("phases", set);
  EXPECT_EQ(verdict_of(inverted, "ordered"), "disagrees");
  EXPECT_EQ(verdict_of(inverted, "short"), "disagrees");
  EXPECT_EQ(verdict_of(inverted, "transition"), "disagrees");
}

TEST(Claims, UnknownErrorsAndValuesDecideNothing) {
  Runs runs;
  const Json unknown{{"diffusion_mm2_s", {{"value", 1.0}, {"sem", nullptr}}},
                     {"rotational_diffusion_rad2_s", {{"value", nullptr}, {"sem", nullptr}}}};
  Json later = unknown;
  later["diffusion_mm2_s"]["value"] = 23.0;
  Library l;
  l.add("phases", {runs.make(2.5, 0.65, 0.1, 0.01, unknown), runs.make(2.5, 0.85, 0.1, 0.01, later)});
  EXPECT_EQ(verdict_of(l, "diffusion-rises"), "not resolved");
  EXPECT_EQ(verdict_of(l, "diffusion-law"), "not resolved");
  EXPECT_EQ(verdict_of(l, "rotation"), "not resolved");
  l.add("phases", {runs.make(4.5, 0.75, 0.9, 0.2), runs.make(4.5, 0.45, 0.05, 0.2)});
  EXPECT_EQ(verdict_of(l, "ordered"), "not resolved") << "the error is larger than what is allowed";
  EXPECT_EQ(verdict_of(l, "disordered"), "not resolved");
}

TEST(Claims, TrendsAreHeldAgainstTheirErrors) {
  Runs runs;
  const auto library = [&](double dilute, double dense, double sem) {
    const auto with = [&](double value) {
      return Json{{"rotational_diffusion_rad2_s", {{"value", value}, {"sem", sem}}}};
    };
    Library l;
    l.add("phases", {runs.make(2.5, 0.45, 0.1, 0.01, with(dilute)), runs.make(2.5, 0.85, 0.1, 0.01, with(dense))});
    return l;
  };
  EXPECT_EQ(verdict_of(library(2.0, 1.0, 0.1), "rotation"), "agrees");
  EXPECT_EQ(verdict_of(library(1.0, 2.0, 0.1), "rotation"), "disagrees");
  EXPECT_EQ(verdict_of(library(1.1, 1.0, 0.1), "rotation"), "not resolved");
}

TEST(Claims, LayersMustBeThereWhenDenseAndNotBefore) {
  Runs runs;
  const auto point = [&](double phi, std::optional<double> theta) {
    const Json value = theta ? Json(*theta) : Json();
    return runs.make(4.5, phi, 0.9, 0.01, {{"theta_m_deg", {{"value", value}, {"sem", 0.3}}}});
  };
  const auto library = [&](std::optional<double> a, std::optional<double> b, std::optional<double> c) {
    Library l;
    l.add("layers", {point(0.75, a), point(0.80, b), point(0.85, c)});
    return l;
  };
  EXPECT_EQ(verdict_of(library({}, 9.5, 11), "layers"), "agrees");
  EXPECT_EQ(verdict_of(library(8, 9.5, 11), "layers"), "in part") << "layers before 0.80";
  EXPECT_EQ(verdict_of(library(8, {}, 25), "layers"), "disagrees");
}

TEST(Claims, DiffusionLawIsThePapersFit) {
  Runs runs;
  const auto library = [&](double factor) {
    RunSet set;
    for (const double phi : {0.65, 0.75, 0.85}) {
      const double d = factor * (1.7 + 480 * (phi - 0.64) * (phi - 0.64));
      set.push_back(runs.make(2.5, phi, 0.1, 0.01, {{"diffusion_mm2_s", {{"value", d}, {"sem", 0.02 * d}}}}));
    }
    Library l;
    l.add("phases", set);
    return l;
  };
  EXPECT_EQ(verdict_of(library(1.0), "diffusion-law"), "agrees");
  EXPECT_EQ(verdict_of(library(2.0), "diffusion-law"), "disagrees");
  EXPECT_EQ(verdict_of(library(1.0), "diffusion-rises"), "agrees");
}

TEST(Claims, PeaksOfPOfSAreCounted) {
  Runs runs;
  const auto library = [&](std::vector<double> density) {
    std::vector<double> s;
    for (std::size_t k = 0; k < density.size(); ++k) s.push_back(static_cast<double>(k));
    Library l;
    l.add("phases", {runs.make(4.5, 0.65, 0.5, 0.01, Json::object(),
                               {{"/order/pdf/order", s}, {"/order/pdf/density", density}})});
    return l;
  };
  const auto bumps = [](std::initializer_list<double> centres) {
    std::vector<double> density(100);
    for (std::size_t k = 0; k < density.size(); ++k) {
      for (const double centre : centres) density[k] += std::exp(-std::pow((static_cast<double>(k) - centre) / 6, 2));
      density[k] *= k % 2 == 0 ? 1.2 : 0.8;  // noise from bin to bin
    }
    return density;
  };
  EXPECT_EQ(verdict_of(library(bumps({60})), "unimodal"), "agrees") << "noise is no peak";
  EXPECT_EQ(verdict_of(library(bumps({30, 60})), "unimodal"), "not resolved");
}

TEST(Claims, WithoutRunsThereIsNoData) {
  for (const Json& finding : claims_json(Library())) EXPECT_EQ(finding.at("verdict"), "no data") << finding;
  const std::string table = claims_table(Library());
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), static_cast<std::ptrdiff_t>(paper_claims().size() + 2));
}

TEST(Claims, PointAtFiguresThatExist) {
  std::set<std::string_view> figures;
  for (const PaperFigure& figure : paper_figures()) EXPECT_TRUE(figures.insert(figure.id).second) << figure.id;
  for (const Claim& claim : paper_claims()) EXPECT_TRUE(figures.contains(claim.figure)) << claim.id;
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

TEST(Sheet, DrawsPlotsMapsAndPicturesOnOnePage) {
  if (run_captured({"gnuplot", "--version"}).exit_code != 0) GTEST_SKIP() << "no gnuplot";
  const TemporaryFolder folder;
  const Figure plot{
      .name = "inner", .x_title = "x", .y_title = "y", .curves = {{.label = "a", .x = {1, 2}, .y = {3, 4}}}};
  const auto picture = draw(plot, folder.path());
  Sheet sheet{.name = "page", .title = "All kinds", .panels = {plot, {.title = "picture", .picture = picture}}};
  sheet.panels.push_back({.x_title = "x",
                          .y_title = "y",
                          .curves = {{.label = "cut", .x = {0, 1}, .y = {0, 1}}},
                          .title = "map",
                          .map = Map{.x = {0, 1}, .y = {0, 1, 2}, .z = {0, 1, 2, 3, NAN, 5}}});
  sheet.panels.push_back({.x_title = "nothing", .y_title = "here"});
  const auto page = draw(sheet, folder.path() / "sheets");
  EXPECT_GT(std::filesystem::file_size(page), 20000u);
  std::ifstream in(folder.path() / "sheets/page.dat");
  const std::string data((std::istreambuf_iterator<char>(in)), {});
  EXPECT_THAT(data, HasSubstr("# panel 3: map"));
  EXPECT_THAT(data, HasSubstr("1 1 3 0.5 1.5 0.5 1.5\n"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "sheets/page-2.png")) << "pictures lie beside the page";
}

}  // namespace
}  // namespace shaken::client
