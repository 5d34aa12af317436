// SPDX-License-Identifier: MIT
#include "client/plotting/sheet.h"

#include <fmt/format.h>

#include "base/failure.h"

namespace shaken::client {
namespace {

constexpr int kPanelWidth = 720;  ///< [pixels]
constexpr int kPanelHeight = 560;
constexpr int kTitleHeight = 50;

/// What one panel has set must not reach the next.
constexpr const char* kAfresh = R"(
reset
unset title
)";

}  // namespace

std::filesystem::path draw(const Sheet& sheet, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Failure(ExitCode::kFailed, fmt::format("{}: {}", folder.string(), error.message()));
  const int n = static_cast<int>(sheet.panels.size());
  const int rows = (n + sheet.columns - 1) / sheet.columns;
  std::string script = fmt::format(R"(# gnuplot {0}.gp  draws {0}.png from {0}.dat
set terminal pngcairo size {1},{2} enhanced font 'DejaVu Sans,14' linewidth 1.6 background '#ffffff'
set output '{0}.png'
set multiplot layout {3},{4} title "{5}" font ',17'
)",
                                   sheet.name, sheet.columns * kPanelWidth, rows * kPanelHeight + kTitleHeight, rows,
                                   sheet.columns, sheet.title);
  std::string data;
  std::size_t block = 0;
  for (std::size_t i = 0; i < sheet.panels.size(); ++i) {
    Figure panel = sheet.panels[i];
    if (!panel.picture.empty()) {
      const std::string copy = fmt::format("{}-{}.png", sheet.name, i + 1);
      if (std::filesystem::absolute(panel.picture) != std::filesystem::absolute(folder / copy)) {
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
  return draw_files(sheet.name, data, script, folder);
}

}  // namespace shaken::client
