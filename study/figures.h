// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "study/panels.h"

namespace shaken::study {

/// One figure of Sharma & Soni, Soft Matter 20, 6608 (2024), or one that is not in the paper's main text. A number is
/// the paper's own; there is none for its figure 1, a schematic. What the paper lacks has a name only.
struct PaperFigure {
  std::string_view number;             ///< in the paper: "14"; empty for all others
  std::string_view name;               ///< "defects"
  std::string_view title;              ///< what it shows
  std::vector<std::string_view> sets;  ///< sweeps in configs/figures/SCALE/ that it is drawn from
  Sheet (*draw)(const Material&);      ///< its panels; null for the films, which are only collected

  /// What it is called in tables: its number if it has one, else its name. Both are taken where one asks for it.
  std::string_view id() const { return number.empty() ? name : number; }
  bool is_called(std::string_view word) const { return word == name || (!number.empty() && word == number); }
  /// The name of its files: "fig14-defects", or "gap".
  std::string file() const;
};

/// All of them, the paper's own first.
std::span<const PaperFigure> paper_figures();
/// Every sweep that some figure is drawn from, in the order in which they are best run.
std::vector<std::string_view> all_sets();

Sheet start_figure(const Material& material);             ///< 2
Sheet order_figure(const Material& material);             ///< 3
Sheet order_statistics_figure(const Material& material);  ///< 4
Sheet g2_figure(const Material& material);                ///< 5
Sheet g2_map_figure(const Material& material);            ///< 6
Sheet distances_figure(const Material& material);         ///< 7
Sheet layers_figure(const Material& material);            ///< 8
Sheet diffusion_figure(const Material& material);         ///< 9
Sheet tilt_figure(const Material& material);              ///< 10
Sheet paths_figure(const Material& material);             ///< 11
Sheet memory_figure(const Material& material);            ///< 12
Sheet rotation_figure(const Material& material);          ///< 13
Sheet defects_figure(const Material& material);           ///< 14
Sheet layer_trends_figure(const Material& material);
Sheet larger_box_figure(const Material& material);
Sheet gap_figure(const Material& material);
Sheet steady_state_figure(const Material& material);
Sheet shaking_figure(const Material& material);
Sheet melting_figure(const Material& material);
Sheet size_figure(const Material& material);
Sheet fluctuations_figure(const Material& material);
Sheet elasticity_figure(const Material& material);
Sheet equilibrium_figure(const Material& material);

}  // namespace shaken::study
