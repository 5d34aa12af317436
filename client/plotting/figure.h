// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace shaken::client {

/// Points of one curve. `y_error` is empty, or as long as x and y; not finite: not known, no bar.
struct Curve {
  enum class Look { kAsFigure, kLine, kDashes, kPoints };  ///< dashes are for laws and fits, not for data

  std::string label{};     ///< in the key; empty for none
  std::size_t colour = 0;  ///< curves of one point share a colour
  std::vector<double> x{};
  std::vector<double> y{};
  std::vector<double> y_error{};
  Look look = Look::kAsFigure;
  bool band = false;             ///< errors as a band about the line instead of a bar at each point
  std::vector<bool> relaxing{};  ///< empty, or as long as x: this point is of a run that still relaxed, drawn hollow
};

/// Values on a rectangular grid, shown in colours; empty: there is nothing to show.
struct Map {
  std::vector<double> x{};  ///< (nx) centres
  std::vector<double> y{};  ///< (ny)
  std::vector<double> z{};  ///< (ny * nx), x fastest; not finite: left white
  bool diverging = false;   ///< blue - white - red about 0 instead of dark to light
};

/// A plot for a paper or a notebook, drawn by gnuplot. Axis titles and commands are gnuplot's enhanced text; labels of
/// curves are plain.
struct Figure {
  enum class Style { kLines, kPoints, kLinesPoints };

  std::string name{};  ///< of the files: NAME.png, NAME.dat, NAME.gp
  std::string x_title{};
  std::string y_title{};
  Style style = Style::kLines;
  std::vector<std::string> commands{};  ///< gnuplot commands before the plot: ranges, scales, tics, guide lines
  std::vector<Curve> curves{};
  std::string title{};              ///< above the plot
  std::optional<Map> map{};         ///< below the curves
  std::filesystem::path picture{};  ///< a PNG to show in place of a plot
};

/// The data: one block per curve, as gnuplot's `index` counts them, with its label and columns in comments. Points that
/// are not finite are left out.
std::string figure_data(const Figure& figure);
/// What a picture is written as: for the screen, for a paper, for the web or a drawing program.
enum class PictureFormat { kPng, kPdf, kSvg };
/// "png", "pdf", "svg"
const char* suffix_of(PictureFormat format);

/// The gnuplot script: run in its folder, it reads NAME.dat and writes NAME.png (.pdf, .svg).
std::string figure_script(const Figure& figure, PictureFormat format = PictureFormat::kPng);

/// Writes NAME.dat and NAME.gp into `folder` and has gnuplot draw NAME.png (.pdf, .svg). Returns the picture's path.
/// Throws Failure with gnuplot's words if it cannot be drawn; the two files stay.
std::filesystem::path draw(const Figure& figure, const std::filesystem::path& folder,
                           PictureFormat format = PictureFormat::kPng);

/// The part of a script that draws `figure` from blocks `first_block`, ... of `data_file`, once terminal and output
/// are set.
std::string plot_commands(const Figure& figure, const std::string& data_file, std::size_t first_block);
/// Blocks of data that a figure takes: one per curve, and one for a map.
std::size_t n_blocks(const Figure& figure);
/// Writes NAME.dat and NAME.gp into `folder` and has gnuplot draw NAME.png (.pdf, .svg), as draw() does.
std::filesystem::path draw_files(const std::string& name, const std::string& data, const std::string& script,
                                 const std::filesystem::path& folder, PictureFormat format = PictureFormat::kPng);

/// Colour of curve `index` of `count`, "#rrggbb": along viridis without its palest end, so that order shows.
std::string curve_colour(std::size_t index, std::size_t count);

}  // namespace shaken::client
