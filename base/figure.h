// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/plot.h"

namespace shaken {

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
  std::vector<bool> unsteady{};  ///< empty, or as long as x: this point is not known to be of a steady state: hollow
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
  PlotOrigin origin{};              ///< what it is made from; said in its files. That of a panel is not used
};

/// The data: one block per curve, as gnuplot's `index` counts them, with its label in a comment and in another what its
/// columns are, with units. Points that are not finite are left out.
std::string figure_data(const Figure& figure);
/// The gnuplot script: run in its folder, it reads NAME.dat and writes NAME.png (.pdf, .svg).
std::string figure_script(const Figure& figure, PictureFormat format = PictureFormat::kPng);

/// Draws it by draw_plot: NAME.dat, NAME.gp and NAME.png (.pdf, .svg) in `folder`. Returns the picture's path.
std::filesystem::path draw(const Figure& figure, const std::filesystem::path& folder,
                           PictureFormat format = PictureFormat::kPng);

/// Several plots on one page, row by row: a figure of a paper with its panels.
struct Sheet {
  std::string name{};  ///< of the files: NAME.png, NAME.dat, NAME.gp
  std::string title{};
  int columns = 2;
  std::vector<Figure> panels{};  ///< their names are not used
  PlotOrigin origin{};           ///< what it is made from; said in its files
};

/// Draws NAME.dat, NAME.gp and NAME.png into `folder`; pictures of panels are copied beside them. Returns the path of
/// NAME.png.
std::filesystem::path draw(const Sheet& sheet, const std::filesystem::path& folder);

}  // namespace shaken
