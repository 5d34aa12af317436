// SPDX-License-Identifier: MIT
#include "base/figure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "base/files.h"
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
            "# a\n# x; y\n1 4\n3 6\n\n\n# b\n# x; y; standard error\n1 2 0.5\n\n\n# empty\n# x; y\nNaN NaN\n");
}

TEST(FigureData, NamesItsColumnsWithUnits) {
  const Figure figure{.x_title = "gap w (mm)",
                      .y_title = "{/Symbol q}_m (degrees) ± standard error",
                      .curves = {{.label = "a", .x = {1}, .y = {9}, .y_error = {0.2}, .unsteady = {true}}}};
  EXPECT_EQ(figure_data(figure),
            "# a\n# gap w (mm); θ_m (degrees); standard error; 1 where not known to be steady\n1 9 0.2 1\n");
}

// Years later a picture must still say whose runs it shows; and equal runs make equal files.
TEST(Draw, FilesSayWhatTheyAreMadeFrom) {
  if (run_captured({"gnuplot", "--version"}).exit_code != 0) GTEST_SKIP() << "no gnuplot";
  const ScratchFolder folder;
  Figure figure{.name = "f", .curves = {{.label = "a", .x = {1, 2}, .y = {3, 4}}}};
  figure.origin = {{"Software", "shaken 0.1.0"}, {"Sweep", "θ & <w>"}};
  draw(figure, folder.path());
  draw(figure, folder.path(), PictureFormat::kSvg);
  const std::string png = *read_file(folder / "f.png"), svg = *read_file(folder / "f.svg");
  for (const char* file : {"f.dat", "f.gp"}) {
    EXPECT_THAT(*read_file(folder / file), ::testing::StartsWith("# Software: shaken 0.1.0\n# Sweep: θ & <w>\n"))
        << file;
  }
  EXPECT_NE(png.find(std::string("tEXtSoftware") + '\0' + "shaken 0.1.0"), std::string::npos);
  EXPECT_NE(png.find(std::string("iTXtSweep") + std::string(5, '\0') + "θ & <w>"), std::string::npos);
  EXPECT_THAT(svg, HasSubstr("<desc>Software: shaken 0.1.0\nSweep: θ &amp; &lt;w&gt;\n"));
  const ScratchFolder other;
  draw(figure, other.path());
  EXPECT_EQ(*read_file(other / "f.png"), png);
}

// From the specification of PNG: the checksum of IEND, which has no bytes, is AE426082.
TEST(PngWith, AddsChunksBehindTheHeader) {
  const std::string head = std::string("\x89PNG\r\n\x1a\n", 8) + std::string(25, 'h');
  const std::string with = png_with(head + "rest", {{"A", "b"}});
  EXPECT_TRUE(with.starts_with(head));
  EXPECT_TRUE(with.ends_with("rest"));
  EXPECT_EQ(with.substr(33, 12), std::string("\0\0\0\x03tEXtA\0b", 11) + with[44]);
  EXPECT_EQ(png_with("no picture", {{"A", "b"}}), "no picture");
  EXPECT_EQ(origin_list({"a", "b", "c"}, 2), "a, b and 1 more");
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
