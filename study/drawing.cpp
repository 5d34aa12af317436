// SPDX-License-Identifier: MIT
#include "study/drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <set>
#include <string>
#include <utility>

#include "base/process.h"
#include "base/text.h"
#include "run/files/directory.h"
#include "run/files/done.h"
#include "run/files/version.h"
#include "study/report.h"

namespace shaken::study {

namespace fs = std::filesystem;

namespace {

/// What a figure is made from: every run of its sweeps, and the versions that computed them.
PlotOrigin origin_of(const PaperFigure& figure, const Library& library) {
  std::vector<std::string> sweeps;
  std::set<std::string> runs;
  for (const std::string_view set : figure.sets) {
    sweeps.emplace_back(set);
    for (const FinishedRun& run : library[std::string(set)]) runs.insert(run.id());
  }
  runs.erase("");
  const std::set<std::string> versions = versions_of(library, figure.sets);
  PlotOrigin origin{{"Software", std::string("shaken figures ") + run::version()}};
  if (!versions.empty()) origin.emplace_back("Computed by", origin_list({versions.begin(), versions.end()}));
  origin.emplace_back("Sweeps", origin_list(sweeps));
  if (!runs.empty()) origin.emplace_back("Runs", printable(origin_list({runs.begin(), runs.end()})));
  return origin;
}

}  // namespace

FigureMaker::FigureMaker(const Selection& selection, fs::path runs_folder, fs::path out, bool quiet,
                         client::Console& console)
    : selection_(selection),
      runs_folder_(std::move(runs_folder)),
      out_(std::move(out)),
      quiet_(quiet),
      console_(console) {}

bool FigureMaker::draw(const PaperFigure& figure) {
  if (console_.err_is_terminal) console_.err << "\r\x1b[K" << std::flush;
  try {
    if (figure.draw == nullptr) return collect_films();
    const Library runs = for_figures(done_runs(selection_, runs_folder_));
    if (std::all_of(figure.sets.begin(), figure.sets.end(),
                    [&](std::string_view set) { return runs[std::string(set)].empty(); })) {
      console_.err << fmt::format("figure {}: no run is done yet\n", figure.id());
      return false;
    }
    Sheet sheet = figure.draw({runs, [&](const FinishedRun& run) { return snapshot(run); }});
    sheet.name = figure.file();
    sheet.origin = origin_of(figure, runs);
    tell(figure.id(), shaken::draw(sheet, out_));
    return true;
  } catch (const std::exception& problem) {
    console_.err << fmt::format("figure {}: {}\n", figure.id(), printable(problem.what(), Lines::kMany));
    return false;
  }
}

bool FigureMaker::collect_films() {
  const auto movies = std::find_if(selection_.sweeps.begin(), selection_.sweeps.end(),
                                   [](const NamedSweep& sweep) { return sweep.name == "movies"; });
  const fs::path folder = out_ / "movies";
  fs::create_directories(folder);
  std::size_t n_films = 0;
  for (std::size_t k = 0; k < movies->sweep.points.size(); ++k) {
    const run::RunDirectory files{directory_of(movies->sweep.points[k], runs_folder_)};
    if (!run::is_done(files) || !fs::exists(files.movie())) continue;
    const std::string name = fmt::format("S{}", k + 1);
    const fs::path film = folder / (name + ".mp4");
    std::error_code error;
    fs::copy_file(files.movie(), film, fs::copy_options::overwrite_existing, error);
    if (error) {
      console_.err << fmt::format("{}: {}\n", film.string(), error.message());
      continue;
    }
    if (const fs::path picture = snapshot(FinishedRun(files.root)); !picture.empty()) {
      fs::copy_file(picture, folder / (name + ".png"), fs::copy_options::overwrite_existing, error);
    }
    tell(name, film);
    ++n_films;
  }
  if (n_films == 0) console_.err << "movies: no run is done yet\n";
  return n_films == movies->sweep.points.size();
}

fs::path FigureMaker::snapshot(const FinishedRun& run) const {
  if (!fs::exists(run::RunDirectory{run.directory()}.trajectory())) return {};
  const fs::path folder = fs::absolute(out_) / "pictures";
  fs::path picture = folder / (run.directory().filename().string() + ".png");
  if (fs::exists(picture)) return picture;
  fs::create_directories(folder);
  const Captured drawn = run_captured({sibling_program("shaken-render").string(), "picture", run.directory().string(),
                                       "--frame", "last", "--bare", "--size", "640x640", "-o", picture.string()});
  if (drawn.exit_code == 0) return picture;
  console_.err << fmt::format("no picture of {}: {}\n", run.directory().string(),
                              printable(drawn.output, Lines::kMany));
  return {};
}

void FigureMaker::tell(std::string_view id, const fs::path& file) {
  made_.push_back({{"figure", id}, {"file", file.string()}});
  if (!quiet_) console_.out << file.string() << std::endl;
}

}  // namespace shaken::study
