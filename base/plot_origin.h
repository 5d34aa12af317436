// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace shaken {

/// What a plot is made from, as pairs of a keyword and a text of one line: {"Software", "shaken 0.1.0"}. No time of
/// day: equal runs make equal files. Keywords are those of PNG: Latin letters and single spaces, at most 79.
using PlotOrigin = std::vector<std::pair<std::string, std::string>>;

/// As comments at the head of a data file or a script: "# Software: shaken 0.1.0".
std::string as_comments(const PlotOrigin& origin);

/// A PNG with a text chunk for each pair behind its header: tEXt, or iTXt for what is not ASCII (PNG 1.2, 4.2.3). What
/// is no PNG stays as it is.
std::string png_with(std::string png, const PlotOrigin& origin);

/// gnuplot's SVG with the origin in its <desc>. What has none stays as it is.
std::string svg_with(std::string svg, const PlotOrigin& origin);

/// "a, b, c"; of more than `most`, "a, b and 7 more".
std::string origin_list(const std::vector<std::string>& names, std::size_t most = 200);

}  // namespace shaken
