// SPDX-License-Identifier: MIT
#include "bench/picture.h"

#include <fmt/format.h>

#include "base/failure.h"
#include "base/files.h"
#include "base/process.h"

namespace shaken::bench {

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Failure(ExitCode::kFailed, fmt::format("{}: {}", folder.string(), error.message()));
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  if (const auto error = write_file_atomically(file, text)) throw Failure(ExitCode::kFailed, error->message);
}

std::string gnuplot_prologue(const std::string& name, int width, int height) {
  return fmt::format(R"(# gnuplot {0}.gp  draws {0}.png from {0}.dat
set terminal pngcairo size {1},{2} enhanced font 'DejaVu Sans,16' linewidth 2 background '#ffffff'
set output '{0}.png'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid y linetype 1 linecolor '#e2e2e2' linewidth 0.5
)",
                     name, width, height);
}

void draw(const std::filesystem::path& folder, const std::string& name, const std::string& data,
          const std::string& script) {
  write_text(folder / (name + ".dat"), data);
  write_text(folder / (name + ".gp"), script);
  const Captured gnuplot = run_captured({"gnuplot", name + ".gp"}, folder);
  if (gnuplot.exit_code == 127) {
    throw Failure(ExitCode::kFailed,
                  "gnuplot is not here: `apt install gnuplot-nox`; the data and the script are in " + folder.string());
  }
  if (gnuplot.exit_code != 0) {
    throw Failure(ExitCode::kFailed, fmt::format("gnuplot did not draw {}.png: {}", name, gnuplot.output));
  }
}

}  // namespace shaken::bench
