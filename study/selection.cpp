// SPDX-License-Identifier: MIT
#include "study/selection.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <set>

#include "base/failure.h"
#include "base/files.h"
#include "base/paths.h"
#include "run/files/directory.h"
#include "run/files/done.h"
#include "scene/nearest.h"

namespace shaken::study {

namespace fs = std::filesystem;

double NamedSweep::rod_seconds() const {
  double sum = 0;
  for (const scene::SweepPoint& point : sweep.points) sum += point.plan.system.n_all_rods() * point.plan.total_time();
  return sum;
}

std::vector<std::string> figure_words() {
  std::vector<std::string> words;
  for (const PaperFigure& figure : paper_figures()) {
    if (!figure.number.empty()) words.emplace_back(figure.number);
  }
  for (const PaperFigure& figure : paper_figures()) words.emplace_back(figure.name);
  return words;
}

Selection selected(const std::vector<std::string>& ids, std::string& problems) {
  const auto all = paper_figures();
  for (const std::string& id : ids) {
    if (std::any_of(all.begin(), all.end(), [&](const PaperFigure& figure) { return figure.is_called(id); })) continue;
    problems += fmt::format("there is no figure '{}'{}\n", id, scene::did_you_mean(scene::nearest(id, figure_words())));
  }
  Selection selection;
  std::set<std::string_view> needed;
  for (const PaperFigure& figure : all) {
    const auto is_asked_for = [&](const std::string& id) { return figure.is_called(id); };
    if (!ids.empty() && std::none_of(ids.begin(), ids.end(), is_asked_for)) continue;
    selection.figures.push_back(&figure);
    needed.insert(figure.sets.begin(), figure.sets.end());
  }
  for (const std::string_view set : all_sets()) {
    selection.sweeps.push_back({.name = std::string(set), .needed = needed.contains(set)});
  }
  return selection;
}

fs::path sweeps_folder(const std::string& configs, const std::string& scale) {
  const auto root = [&]() -> fs::path {
    if (!configs.empty()) return configs;
    if (const char* given = std::getenv("SHAKEN_CONFIGS"); given != nullptr && *given != '\0') return given;
    return fs::exists("configs/figures") ? "configs" : shipped_configs();
  };
  return root() / "figures" / scale;
}

void load(Selection& selection, const fs::path& folder) {
  for (NamedSweep& sweep : selection.sweeps) {
    sweep.input = client::read_scene_input((folder / (sweep.name + ".json")).string());
    sweep.sweep = client::load_points(sweep.input, {}, std::nullopt);
  }
}

fs::path directory_of(const scene::SweepPoint& point, const fs::path& runs_folder) {
  return runs_folder / client::derived_quantities(point).at("id").get<std::string>();
}

scene::Sweep rest_of(const scene::Sweep& sweep, const fs::path& runs_folder) {
  scene::Sweep rest = sweep;
  std::erase_if(rest.points, [&](const scene::SweepPoint& point) {
    return run::is_done(run::RunDirectory{directory_of(point, runs_folder)}, point.plan);
  });
  return rest;
}

namespace {

/// Why the summary of a run cannot tell whether it is done; none if it can, or if there is none.
std::optional<std::string> unreadable_summary(const fs::path& directory) {
  const fs::path file = run::RunDirectory{directory}.summary();
  std::error_code error;
  if (!fs::exists(file, error)) return std::nullopt;
  const Result<std::string> text = read_file(file);
  if (!text) return text.error().message;
  if (!Json::parse(*text, nullptr, false).is_object()) return file.string() + " is no JSON object";
  return std::nullopt;
}

}  // namespace

Library done_runs(const Selection& selection, const fs::path& runs_folder, std::vector<std::string>* left_out) {
  Library library;
  for (const NamedSweep& sweep : selection.sweeps) {
    RunSet set;
    for (const scene::SweepPoint& point : sweep.sweep.points) {
      const fs::path directory = directory_of(point, runs_folder);
      std::optional<std::string> problem;
      try {
        if (run::is_done(run::RunDirectory{directory}, point.plan)) {
          set.emplace_back(directory, point.parameters);
        } else {
          problem = unreadable_summary(directory);
        }
      } catch (const Failure& failure) {
        problem = failure.what();
      }
      if (problem && left_out != nullptr) {
        left_out->push_back(fmt::format("{}: a run is left out: {}", sweep.name, *problem));
      }
    }
    library.add(sweep.name, std::move(set));
  }
  return library;
}

Library for_figures(Library runs) {
  runs.add("phases", joined(runs["phases"], runs["transition"]));
  return runs;
}

}  // namespace shaken::study
