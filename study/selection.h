// SPDX-License-Identifier: MIT
// Which figures are asked for, the sweeps that they need, and the runs of these that are done.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "client/scene_input.h"
#include "scene/sweep.h"
#include "study/figures.h"

namespace shaken::study {

/// A sweep that figures are drawn from.
struct NamedSweep {
  std::string name;
  bool needed = false;  ///< for the figures asked for; the claims look at all
  client::SceneInput input{};
  scene::Sweep sweep{};

  double rod_seconds() const;
};

/// Figures, and every sweep, in the order in which they are best run.
struct Selection {
  std::vector<const PaperFigure*> figures;
  std::vector<NamedSweep> sweeps;
};

/// What a figure may be called by where one asks for it: the paper's numbers, then all names.
std::vector<std::string> figure_words();
/// The figures of these numbers or names, all if there are none. What no figure is called is added to
/// `problems`, a line each, with the nearest of figure_words().
Selection selected(const std::vector<std::string>& ids, std::string& problems);

/// Where the sweeps of a scale lie: in `configs`, or if that is empty in $SHAKEN_CONFIGS, ./configs, or where Shaken
/// was built.
std::filesystem::path sweeps_folder(const std::string& configs, const std::string& scale);
/// Reads all sweeps of `folder`. Throws Failure (kBadInput) with every problem of the first that is refused.
void load(Selection& selection, const std::filesystem::path& folder);

/// Where the run of a point lies.
std::filesystem::path directory_of(const scene::SweepPoint& point, const std::filesystem::path& runs_folder);
/// The points of a sweep that are not done yet.
scene::Sweep rest_of(const scene::Sweep& sweep, const std::filesystem::path& runs_folder);

/// The runs that are done, by sweep and in its order. Those that may be, but cannot be read, are left out; `left_out`
/// gets a sentence for each.
Library done_runs(const Selection& selection, const std::filesystem::path& runs_folder,
                  std::vector<std::string>* left_out = nullptr);
/// As figures and claims see them: `transition` holds replicas of points of `phases`.
Library for_figures(Library runs);

}  // namespace shaken::study
