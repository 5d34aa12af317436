// SPDX-License-Identifier: MIT
#include "base/figure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "base/process.h"
#include "base/scratch_folder.h"

namespace shaken {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(CurveColour, RunsFromDarkToLight) {
  EXPECT_EQ(curve_colour(0, 5), "#440154");
  EXPECT_NE(curve_colour(4, 5), curve_colour(0, 5));
  EXPECT_EQ(curve_colour(0, 1).size(), 7u);
}

TEST(FigureData, OneBlockPerCurveWithoutWhatIsNotFinite) {
  const Figure figure{.name = "f",
                      .curves = {{.label = "a", .x = {1, 2, 3}, .y = {4, NAN, 6}},
                                 {.label = "b", .x = {1}, .y = {2}, .y_error = {0.5}},
                                 {.label = "empty", .x = {1}, .y = {NAN}}}};
  EXPECT_EQ(figure_data(figure),
            "# a\n# x  y\n1 4\n3 6\n\n\n# b\n# x  y  y_error\n1 2 0.5\n\n\n# empty\n# x  y\nNaN NaN\n");
}

TEST(FigureScript, QuotesLabels) {
  const Figure figure{.name = "f", .curves = {{.label = "it's a_b", .x = {1}, .y = {2}}}};
  EXPECT_THAT(figure_script(figure), HasSubstr("title 'it''s a_b'"));
}

TEST(FigureScript, FormatsForThePaperAndTheWeb) {
  const Figure figure{.name = "f", .curves = {{.label = "a", .x = {1}, .y = {2}}}};
  EXPECT_THAT(figure_script(figure, PictureFormat::kPdf), HasSubstr("pdfcairo"));
  EXPECT_THAT(figure_script(figure, PictureFormat::kPdf), HasSubstr("set output 'f.pdf'"));
  EXPECT_THAT(figure_script(figure, PictureFormat::kSvg), HasSubstr("set output 'f.svg'"));
}

TEST(PlotHead, SizesInPixelsOrCentimetres) {
  EXPECT_EQ(plot_head("f", {.width = 700, .height = 500}),
            "# gnuplot f.gp  draws f.png from f.dat\n"
            "set terminal pngcairo size 700,500 enhanced font 'DejaVu Sans,16' linewidth 2 background '#ffffff'\n"
            "set output 'f.png'\n");
  EXPECT_THAT(plot_head("f", {}, PictureFormat::kPdf), HasSubstr("pdfcairo size 14cm,9.5cm "));
}

TEST(Sheet, DrawsPlotsMapsAndPicturesOnOnePage) {
  if (run_captured({"gnuplot", "--version"}).exit_code != 0) GTEST_SKIP() << "no gnuplot";
  const ScratchFolder folder;
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

TEST(Figure, EqualPlotsAreEqualFilesAndNothingElseIsLeft) {
  if (run_captured({"gnuplot", "--version"}).exit_code != 0) GTEST_SKIP() << "no gnuplot";
  const ScratchFolder folder;
  setenv("GNUPLOT_LIB", "/nowhere", 1);
  for (const std::string name : {"plot", "it's", "<a"}) {
    const Figure figure{
        .name = name, .x_title = "x", .y_title = "y", .curves = {{.label = "a", .x = {1, 2}, .y = {3, 4}}}};
    const auto file = draw(figure, folder.path() / name, PictureFormat::kPdf);
    std::ifstream in(file, std::ios::binary);
    const std::string pdf((std::istreambuf_iterator<char>(in)), {});
    EXPECT_THAT(pdf, HasSubstr("/CreationDate (D:20000101000000Z")) << name;
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path() / name), {}), 3) << name;
  }
  unsetenv("GNUPLOT_LIB");
}

// One key in a row explains all panels of the row that have the same curves; their axes stand at one height.
TEST(Sheet, AKeyIsNotRepeatedWithinARow) {
  if (run_captured({"gnuplot", "--version"}).exit_code != 0) GTEST_SKIP() << "no gnuplot";
  const ScratchFolder folder;
  const auto panel = [](const std::string& label) {
    return Figure{.x_title = "x", .y_title = "y", .curves = {{.label = label, .x = {1, 2}, .y = {3, 4}}}};
  };
  const auto scripts_of = [&](std::vector<Figure> panels) {
    draw(Sheet{.name = "page", .columns = 2, .panels = std::move(panels)}, folder.path());
    std::ifstream in(folder.path() / "page.gp");
    std::vector<std::string> scripts{""};
    for (std::string line; std::getline(in, line);) {
      if (line == "reset") scripts.emplace_back();
      scripts.back() += line + "\n";
    }
    scripts.erase(scripts.begin());
    return scripts;
  };
  const auto same = scripts_of({panel("a"), panel("a"), panel("a"), panel("b")});
  ASSERT_EQ(same.size(), 4u);
  EXPECT_THAT(same[0], Not(HasSubstr("unset key")));
  EXPECT_THAT(same[1], HasSubstr("unset key"));
  const std::string margin = same[0].substr(same[0].find("set tmargin"), 15);
  EXPECT_THAT(same[1], HasSubstr(margin));
  EXPECT_THAT(same[2], Not(HasSubstr("unset key"))) << "another row";
  EXPECT_THAT(same[3], Not(HasSubstr("unset key"))) << "another curve";
  EXPECT_THAT(same[3], Not(HasSubstr("tmargin"))) << "nothing is shared";
}

}  // namespace
}  // namespace shaken
