// SPDX-License-Identifier: MIT
#include "base/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "base/failure.h"
#include "base/files.h"
#include "base/process.h"

namespace shaken {
namespace {

constexpr int kNotFound = 127;  ///< exit code of a program that is not installed

std::string terminal_of(const Canvas& canvas, PictureFormat format) {
  const std::string font = fmt::format("enhanced font 'DejaVu Sans,{}'", canvas.font_size);
  if (format == PictureFormat::kPdf) {
    // letters as large as those of the text around the picture
    return fmt::format("pdfcairo size {:g}cm,{:g}cm {} fontscale 0.42", canvas.width / 100.0, canvas.height / 100.0,
                       font);
  }
  return fmt::format("{} size {},{} {} linewidth {:g}", format == PictureFormat::kSvg ? "svg" : "pngcairo",
                     canvas.width, canvas.height, font, canvas.line_width);
}

void replace_all(std::string& text, const std::string& old, const std::string& next) {
  for (std::size_t at = text.find(old); at != std::string::npos; at = text.find(old, at + next.size()))
    text.replace(at, old.size(), next);
}

/// Gives a PDF of Cairo's, which lets nobody choose, one date of creation, so that equal plots are equal files.
Result<void> without_date(const std::filesystem::path& file) {
  static constexpr std::string_view kKey = "/CreationDate (D:", kDate = "20000101000000";
  Result<std::string> content = read_file(file);
  if (!content) return content.error();
  const std::size_t at = content->find(kKey);
  if (at == std::string::npos || at + kKey.size() + kDate.size() > content->size()) return {};
  content->replace(at + kKey.size(), kDate.size(), kDate);
  return write_file(file, *content);
}

/// Writes into the picture what it is made from.
Result<void> sign(const std::filesystem::path& file, PictureFormat format, const PlotOrigin& origin) {
  if (format == PictureFormat::kPdf || origin.empty()) return {};
  Result<std::string> content = read_file(file);
  if (!content) return content.error();
  return write_file(file, format == PictureFormat::kPng ? png_with(*std::move(content), origin)
                                                        : svg_with(*std::move(content), origin));
}

struct RemovedAtEnd {
  std::vector<std::filesystem::path> files;
  ~RemovedAtEnd() {
    std::error_code ignored;
    for (const auto& file : files) std::filesystem::remove(file, ignored);
  }
};

}  // namespace

const char* suffix_of(PictureFormat format) {
  static constexpr std::array kSuffixes{"png", "pdf", "svg"};
  return kSuffixes.at(static_cast<std::size_t>(format));
}

std::string plot_head(const std::string& name, const Canvas& canvas, PictureFormat format) {
  return fmt::format(R"(# gnuplot {0}.gp  draws {0}.{1} from {0}.dat
set terminal {2} background '#ffffff'
set output {3}
)",
                     name, suffix_of(format), terminal_of(canvas, format),
                     gnuplot_literal(name + "." + suffix_of(format)));
}

std::string plot_axes(const std::string& axes) {
  return fmt::format(R"(set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid {}linetype 1 linecolor '#e2e2e2' linewidth 0.5
)",
                     axes.empty() ? "" : axes + " ");
}

std::string gnuplot_literal(const std::string& text) {
  std::string literal = "'";
  for (const char c : text) {
    if (c == '\'') literal += '\'';
    literal += c == '\n' ? ' ' : c;
  }
  return literal + "'";
}

std::string curve_colour(std::size_t index, std::size_t count) {
  // Nine anchors of viridis (van der Walt & Smith 2015), at 0, 1/8, ..., 1.
  static constexpr std::array<std::array<double, 3>, 9> kViridis{{{68, 1, 84},
                                                                  {71, 44, 122},
                                                                  {59, 81, 139},
                                                                  {44, 113, 142},
                                                                  {33, 144, 141},
                                                                  {39, 173, 129},
                                                                  {92, 200, 99},
                                                                  {170, 220, 50},
                                                                  {253, 231, 37}}};
  static constexpr double kPalest = 0.85;
  const double place = count < 2 ? 0.3 : kPalest * static_cast<double>(index) / static_cast<double>(count - 1);
  const auto anchor = std::min<std::size_t>(static_cast<std::size_t>(place * 8), 7);
  const double part = place * 8 - static_cast<double>(anchor);
  std::string colour = "#";
  for (std::size_t c = 0; c < 3; ++c) {
    const double value = (1 - part) * kViridis[anchor][c] + part * kViridis[anchor + 1][c];
    colour += fmt::format("{:02x}", static_cast<int>(std::lround(value)));
  }
  return colour;
}

std::filesystem::path draw_plot(const std::filesystem::path& folder, const std::string& name, const std::string& data,
                                const std::string& script, PictureFormat format, const PlotOrigin& origin) {
  done_or_fail(make_folder(folder));
  const std::string head = as_comments(origin);
  done_or_fail(write_file_atomically(folder / (name + ".dat"), head + data));
  done_or_fail(write_file_atomically(folder / (name + ".gp"), head + script));
  // What gnuplot reads and writes has names of its own: others may draw a picture of this name at the same time.
  const std::string picture_name = name + "." + suffix_of(format);
  std::filesystem::path picture = folder / picture_name;
  const std::filesystem::path own_data = temporary_for(folder / "plot.dat"),
                              own_script = temporary_for(folder / "plot.gp"), own_picture = temporary_for(picture);
  std::string own_text = script;
  replace_all(own_text, gnuplot_literal(name + ".dat"), gnuplot_literal(own_data.filename().string()));
  replace_all(own_text, gnuplot_literal(picture_name), gnuplot_literal(own_picture.filename().string()));
  const RemovedAtEnd removed{{own_data, own_script, own_picture}};
  done_or_fail(write_file(own_data, data));
  done_or_fail(write_file(own_script, own_text));
  // What stands in the user's environment and start-up files is not for this picture.
  Captured gnuplot = run_captured({"env", "-u", "GNUPLOT_LIB", "-u", "GNUTERM", "-u", "GNUPLOT_DRIVER_DIR", "TZ=UTC",
                                   "gnuplot", "-d", own_script.filename().string()},
                                  folder);
  replace_all(gnuplot.output, own_script.filename().string(), name + ".gp");
  if (gnuplot.exit_code == kNotFound) {
    throw Failure(ExitCode::kFailed,
                  "gnuplot is not here: `apt install gnuplot-nox`; the data and the script are in " + folder.string());
  }
  if (gnuplot.exit_code != 0 || !std::filesystem::exists(own_picture)) {
    throw Failure(ExitCode::kFailed, fmt::format("gnuplot did not draw {} (exit code {}): {}", picture.string(),
                                                 gnuplot.exit_code, gnuplot.output));
  }
  done_or_fail(sign(own_picture, format, origin));
  if (format == PictureFormat::kPdf) done_or_fail(without_date(own_picture));
  done_or_fail(replace_file(own_picture, picture));
  return picture;
}

}  // namespace shaken
