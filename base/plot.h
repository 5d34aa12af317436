// SPDX-License-Identifier: MIT
// Plots by gnuplot: NAME.dat with the numbers, NAME.gp that draws them, and the picture.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "base/plot_origin.h"

namespace shaken {

/// What a picture is written as: for the screen, for a paper, for the web or a drawing program.
enum class PictureFormat { kPng, kPdf, kSvg };
/// "png", "pdf", "svg"
const char* suffix_of(PictureFormat format);

/// Size of a picture, and of what is drawn on it.
struct Canvas {
  int width = 1400;  ///< [pixels]; on paper 100 of them are a centimetre
  int height = 950;
  int font_size = 16;
  double line_width = 2;
};

/// The lines that every script begins with: what it draws, terminal and output.
std::string plot_head(const std::string& name, const Canvas& canvas, PictureFormat format = PictureFormat::kPng);
/// The lines that give axes their look, with a grid of lines from the tics of `axes`: "x y", "y"; from both if empty.
std::string plot_axes(const std::string& axes = "");
/// A string literal of gnuplot in which nothing is special.
std::string gnuplot_literal(const std::string& text);

/// Colour of curve `index` of `count`, "#rrggbb": along viridis without its palest end, so that order shows.
std::string curve_colour(std::size_t index, std::size_t count);
/// Writes NAME.dat and NAME.gp into `folder`, which is made if need be, and has gnuplot draw NAME.png (.pdf, .svg). All
/// but a PDF, in which there is no place for it, say what they are made from. Returns the picture's path. Throws
/// Failure with gnuplot's words if it cannot be drawn; the two files stay.
std::filesystem::path draw_plot(const std::filesystem::path& folder, const std::string& name, const std::string& data,
                                const std::string& script, PictureFormat format = PictureFormat::kPng,
                                const PlotOrigin& origin = {});

}  // namespace shaken
