// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace shaken::client {

/// Points of one curve. `y_error` is empty, or as long as x and y.
struct Curve {
  std::string label{};     ///< in the key; empty for none
  std::size_t colour = 0;  ///< curves of one point share a colour
  std::vector<double> x{};
  std::vector<double> y{};
  std::vector<double> y_error{};
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
};

/// The data: one block per curve, as gnuplot's `index` counts them, with its label and columns in comments. Points that
/// are not finite are left out.
std::string figure_data(const Figure& figure);
/// The gnuplot script: run in its folder, it reads NAME.dat and writes NAME.png.
std::string figure_script(const Figure& figure);

/// Writes NAME.dat and NAME.gp into `folder` and has gnuplot draw NAME.png. Returns the picture's path. Throws Failure
/// with gnuplot's words if it cannot be drawn; the two files stay.
std::filesystem::path draw(const Figure& figure, const std::filesystem::path& folder);

/// Colour of curve `index` of `count`, "#rrggbb": along viridis without its palest end, so that order shows.
std::string curve_colour(std::size_t index, std::size_t count);

}  // namespace shaken::client
