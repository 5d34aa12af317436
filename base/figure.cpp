// SPDX-License-Identifier: MIT
#include "base/figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "base/failure.h"
#include "base/files.h"
#include "base/text.h"

namespace shaken {
namespace {

/// A key of more entries hides the plot.
constexpr std::size_t kMostKeyEntries = 16;

constexpr int kPanelWidth = 720;  ///< [pixels]
constexpr int kPanelHeight = 560;
constexpr int kTitleHeight = 50;

/// What one panel has set must not reach the next.
constexpr const char* kAfresh = R"(
reset
unset title
)";

bool has_errors(const Curve& curve) { return !curve.y_error.empty(); }

bool any_unsteady(const Curve& curve) {
  return std::find(curve.unsteady.begin(), curve.unsteady.end(), true) != curve.unsteady.end();
}

/// Whether any point has an error to be shown.
bool shows_errors(const Curve& curve) {
  return std::any_of(curve.y_error.begin(), curve.y_error.end(), [](double error) { return std::isfinite(error); });
}

bool has_map(const Figure& figure) { return figure.map && !figure.map->z.empty(); }

/// Where the cell of each place ends towards its neighbours: half way, and as far out at the ends.
std::vector<double> cell_borders(const std::vector<double>& places) {
  std::vector<double> borders;
  for (std::size_t k = 0; k + 1 < places.size(); ++k) borders.push_back((places[k] + places[k + 1]) / 2);
  const double first = borders.empty() ? 0.5 : borders.front() - places.front();
  const double last = borders.empty() ? 0.5 : places.back() - borders.back();
  borders.insert(borders.begin(), places.front() - first);
  borders.push_back(places.back() + last);
  return borders;
}

/// The title of an axis without gnuplot's marks: "{/Symbol q}_m (degrees)" is "θ_m (degrees)".
std::string plain(std::string title) {
  static constexpr std::pair<std::string_view, const char*> kSymbols[] = {
      {"{/Symbol a}", "α"}, {"{/Symbol d}", "δ"}, {"{/Symbol D}", "Δ"},   {"{/Symbol f}", "φ"},
      {"{/Symbol G}", "Γ"}, {"{/Symbol l}", "λ"}, {"{/Symbol q}", "θ"},   {"{/Symbol t}", "τ"},
      {"{/Symbol y}", "ψ"}, {"{/Symbol m}", "µ"}, {"{/Symbol dq}", "δθ"}, {" ± standard error", ""},
      {"{/Symbol p}", "π"}, {"{/Symbol S}", "Σ"}, {"{/Symbol r}", "ρ"},   {"\n", " "}};
  for (const auto& [marked, text] : kSymbols) {
    for (std::size_t at = title.find(marked); at != std::string::npos; at = title.find(marked, at)) {
      title.replace(at, marked.size(), text);
    }
  }
  return title;
}

/// "# time t (s); nematic order S; standard error": the columns of `figure`'s curves.
std::string column_names(const Figure& figure, const Curve& curve) {
  return fmt::format("# {}; {}{}{}\n", figure.x_title.empty() ? "x" : plain(figure.x_title),
                     figure.y_title.empty() ? "y" : plain(figure.y_title), has_errors(curve) ? "; standard error" : "",
                     curve.unsteady.empty() ? "" : "; 1 where not known to be steady");
}

std::string curve_data(const Figure& figure, const Curve& curve) {
  std::string text =
      fmt::format("# {}\n", curve.label.empty() ? figure.name : curve.label) + column_names(figure, curve);
  bool any = false;
  for (std::size_t k = 0; k < curve.x.size(); ++k) {
    if (!std::isfinite(curve.x[k]) || !std::isfinite(curve.y[k])) continue;
    text += fmt::format("{:.7g} {:.7g}", curve.x[k], curve.y[k]);
    if (has_errors(curve)) text += fmt::format(" {:.4g}", curve.y_error[k]);
    if (!curve.unsteady.empty()) text += curve.unsteady[k] ? " 1" : " 0";
    text += '\n';
    any = true;
  }
  // An empty block would not be counted by `index`.
  if (!any) text += has_errors(curve) ? "NaN NaN NaN\n" : "NaN NaN\n";
  return text;
}

/// A line for each cell, with its borders: grids need not be even.
std::string map_data(const Figure& figure) {
  const Map& map = *figure.map;
  std::string text = fmt::format("# {}; {}; value; lower and upper border of the first; of the second\n",
                                 figure.x_title.empty() ? "x" : plain(figure.x_title),
                                 figure.y_title.empty() ? "y" : plain(figure.y_title));
  bool any = false;
  const std::vector<double> x = cell_borders(map.x), y = cell_borders(map.y);
  for (std::size_t j = 0; j < map.y.size(); ++j) {
    for (std::size_t i = 0; i < map.x.size(); ++i) {
      const double z = map.z[j * map.x.size() + i];
      if (!std::isfinite(z)) continue;
      any = true;
      text += fmt::format("{:.5g} {:.5g} {:.5g} {:.5g} {:.5g} {:.5g} {:.5g}\n", map.x[i], map.y[j], z, x[i], x[i + 1],
                          y[j], y[j + 1]);
    }
  }
  // An empty block would not be counted by `index`.
  return any ? text : text + "NaN NaN NaN 0 0 0 0\n";
}

/// Blocks of data that a figure takes: one per curve, and one for a map.
std::size_t n_blocks(const Figure& figure) { return figure.curves.size() + (has_map(figure) ? 1 : 0); }

struct KeyShape {
  std::size_t columns = 0;        ///< at most; 0: no key
  std::size_t rows_in_panel = 0;  ///< where as many columns stand beside each other as a panel of a sheet has room for
};

KeyShape key_shape(const Figure& figure) {
  std::size_t n_labels = 0, longest = 0;
  for (const Curve& curve : figure.curves) {
    if (curve.label.empty()) continue;
    ++n_labels;
    longest = std::max(longest, display_width(curve.label));
  }
  if (n_labels == 0 || n_labels > kMostKeyEntries) return {};
  const std::size_t columns = longest < 16 ? 5 : (longest < 32 ? 3 : 2);
  constexpr std::size_t kLetters = 80, kSample = 6;  // across a panel; before a label
  const std::size_t fitting = std::clamp<std::size_t>(kLetters / (longest + kSample), 1, columns);
  return {columns, (n_labels + fitting - 1) / fitting};
}

/// What a key explains: two panels with the same need it once.
std::vector<std::pair<std::string, std::size_t>> legend_of(const Figure& figure) {
  std::vector<std::pair<std::string, std::size_t>> legend;
  for (const Curve& curve : figure.curves) {
    if (!curve.label.empty()) legend.emplace_back(curve.label, curve.colour);
  }
  return legend;
}

/// Leaves the key of a panel out where one to its left in the same row explains the same, and gives all panels of such
/// a row the same room above their axes, so that these stand at one height.
void share_keys(Sheet& sheet) {
  const auto columns = static_cast<std::size_t>(sheet.columns);
  for (std::size_t begin = 0; begin < sheet.panels.size(); begin += columns) {
    const std::size_t end = std::min(begin + columns, sheet.panels.size());
    std::size_t rows = 0;
    bool is_shared = false;
    std::vector<std::string> hide(end - begin);
    for (std::size_t i = begin; i < end; ++i) {
      const auto legend = legend_of(sheet.panels[i]);
      rows = std::max(rows, key_shape(sheet.panels[i]).rows_in_panel);
      for (std::size_t j = begin; j < i && !legend.empty(); ++j) {
        if (legend_of(sheet.panels[j]) == legend) hide[i - begin] = "unset key";
      }
      is_shared = is_shared || !hide[i - begin].empty();
    }
    if (!is_shared) continue;
    for (std::size_t i = begin; i < end; ++i) {
      std::vector<std::string>& commands = sheet.panels[i].commands;
      commands.push_back(fmt::format("set tmargin {:.1f}", 2.5 + 0.95 * static_cast<double>(rows)));
      if (!hide[i - begin].empty()) commands.push_back(hide[i - begin]);
    }
  }
}

/// The part of a script that draws `figure` from blocks `first_block`, ... of `data_file`, once terminal and output
/// are set.
std::string plot_commands(const Figure& figure, const std::string& data_file, std::size_t first_block) {
  std::string script = figure.title.empty() ? "" : fmt::format("set title {}\n", gnuplot_literal(figure.title));
  if (!figure.picture.empty()) {
    return script + fmt::format(
                        "unset border\nunset tics\nunset key\nset size ratio -1\nset lmargin 1\nset rmargin 1\n"
                        "plot {} binary filetype=png with rgbimage notitle\n",
                        gnuplot_literal(figure.picture.string()));
  }
  script += plot_axes() + "set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'\n";
  const KeyShape key = key_shape(figure);
  if (key.columns == 0) {
    script += "unset key\n";
  } else {
    // Above the axes, where no curve can run through it.
    script += fmt::format("set key outside top center horizontal maxcols {}\n", key.columns);
  }
  script +=
      fmt::format("set xlabel {}\nset ylabel {}\n", gnuplot_literal(figure.x_title), gnuplot_literal(figure.y_title));
  if (has_map(figure)) {
    script += figure.map->diverging
                  ? "set palette defined (-1 '#2166ac', -0.5 '#92c5de', 0 '#f7f7f7', 0.5 '#f4a582', 1 '#b2182b')\n"
                  : "set palette defined (0 '#440154', 0.25 '#3b528b', 0.5 '#21918c', 0.75 '#5ec962', 1 '#fde725')\n";
    script += "unset grid\nset size ratio -1\nset autoscale xfix\nset autoscale yfix\n";
  }
  for (const std::string& command : figure.commands) script += command + "\n";

  std::size_t n_colours = 0;
  for (const Curve& curve : figure.curves) n_colours = std::max(n_colours, curve.colour + 1);
  std::vector<std::string> plots;
  std::size_t block = first_block;
  if (has_map(figure)) {
    plots.push_back(
        fmt::format("{} index {} using 1:2:4:5:6:7:3 with boxxyerror fillstyle solid noborder palette notitle",
                    gnuplot_literal(data_file), block++));
  }
  for (const Curve& curve : figure.curves) {
    const std::string colour = curve_colour(curve.colour, n_colours);
    const std::string data = fmt::format("{} index {}", gnuplot_literal(data_file), block++);
    const std::string title = curve.label.empty() ? "notitle" : "title " + gnuplot_literal(curve.label);
    bool lines = figure.style != Figure::Style::kPoints;
    bool points = figure.style != Figure::Style::kLines;
    if (curve.look != Curve::Look::kAsFigure) {
      points = curve.look == Curve::Look::kPoints;
      lines = !points;
    }
    if (shows_errors(curve) && curve.band) {
      plots.push_back(
          fmt::format("{} using 1:($2-$3):($2+$3) with filledcurves fillcolor '{}' fillstyle transparent solid 0.2 "
                      "noborder notitle",
                      data, colour));
    } else if (shows_errors(curve)) {
      plots.push_back(
          fmt::format("{} using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '{}' notitle", data, colour));
    }
    plots.push_back(fmt::format("{} using 1:2 with {} linecolor '{}'{}{} {}", data,
                                lines && points ? "linespoints" : (lines ? "lines" : "points"), colour,
                                points ? " pointtype 7 pointsize 1.2" : " linewidth 1",
                                curve.look == Curve::Look::kDashes ? " dashtype 2" : "", title));
    if (points && any_unsteady(curve)) {
      const std::string hollow = fmt::format("{} using 1:(${}==1?$2:NaN) with points pointsize 0.9 pointtype 7", data,
                                             has_errors(curve) ? 4 : 3);
      plots.push_back(hollow + " linecolor '#ffffff' notitle");
    }
  }
  // Axes without data still say what is missing; gnuplot wants a range then.
  const bool any = std::any_of(figure.curves.begin(), figure.curves.end(), [](const Curve& curve) {
    for (std::size_t k = 0; k < curve.x.size(); ++k) {
      if (std::isfinite(curve.x[k]) && std::isfinite(curve.y[k])) return true;
    }
    return false;
  });
  if (!any && !has_map(figure)) {
    if (!figure.x_title.empty()) script += "set label 'no data' at graph 0.5, graph 0.5 center textcolor '#999999'\n";
    plots.assign(1, "NaN notitle");
  }
  script += any || has_map(figure) ? "plot " : "plot [1:2][1:2] ";
  for (std::size_t i = 0; i < plots.size(); ++i) script += (i > 0 ? ", \\\n     " : "") + plots[i];
  return script + "\n";
}

}  // namespace

std::string figure_data(const Figure& figure) {
  std::string text;
  if (has_map(figure)) text += map_data(figure);
  for (const Curve& curve : figure.curves) {
    if (!text.empty()) text += "\n\n";
    text += curve_data(figure, curve);
  }
  return text;
}

std::string figure_script(const Figure& figure, PictureFormat format) {
  // On paper this is one column and a half wide.
  return plot_head(figure.name, {.font_size = 20}, format) + plot_commands(figure, figure.name + ".dat", 0);
}

std::filesystem::path draw(const Figure& figure, const std::filesystem::path& folder, PictureFormat format) {
  return draw_plot(folder, figure.name, figure_data(figure), figure_script(figure, format), format, figure.origin);
}

std::filesystem::path draw(const Sheet& original, const std::filesystem::path& folder) {
  done_or_fail(make_folder(folder));
  Sheet sheet = original;
  share_keys(sheet);
  const int n = static_cast<int>(sheet.panels.size());
  const int rows = (n + sheet.columns - 1) / sheet.columns;
  std::string script =
      plot_head(sheet.name, {sheet.columns * kPanelWidth, rows * kPanelHeight + kTitleHeight, 14, 1.6}) +
      fmt::format("set multiplot layout {},{} title \"{}\" font ',17'\n", rows, sheet.columns, sheet.title);
  std::string data;
  std::size_t block = 0;
  for (std::size_t i = 0; i < sheet.panels.size(); ++i) {
    Figure panel = sheet.panels[i];
    if (!panel.picture.empty()) {
      const std::string copy = fmt::format("{}-{}.png", sheet.name, i + 1);
      if (std::filesystem::absolute(panel.picture) != std::filesystem::absolute(folder / copy)) {
        std::error_code error;
        std::filesystem::copy_file(panel.picture, folder / copy, std::filesystem::copy_options::overwrite_existing,
                                   error);
        if (error) throw Failure(ExitCode::kFailed, fmt::format("{}: {}", panel.picture.string(), error.message()));
      }
      panel.picture = copy;
    }
    panel.commands.insert(panel.commands.begin(), "set key font ',11' spacing 1.0");  // panels are small
    const std::string blocks = figure_data(panel);
    if (!data.empty() && !blocks.empty()) data += "\n\n";
    if (!blocks.empty()) data += fmt::format("# panel {}: {}\n{}", i + 1, panel.title, blocks);
    script += kAfresh + plot_commands(panel, sheet.name + ".dat", block);
    block += n_blocks(panel);
  }
  script += "unset multiplot\n";
  return draw_plot(folder, sheet.name, data, script, PictureFormat::kPng, sheet.origin);
}

}  // namespace shaken
