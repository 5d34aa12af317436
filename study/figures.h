// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "study/panels.h"

namespace shaken::study {

/// One figure of Sharma & Soni, Soft Matter 20, 6608 (2024), or one that goes beyond it. The numbers follow the order
/// in which the paper presents its results.
struct PaperFigure {
  std::string_view id;                 ///< as asked for: "2", "defects"
  std::string_view file;               ///< name of its files: "fig02-order"
  std::string_view title;              ///< what it shows
  std::vector<std::string_view> sets;  ///< sweeps in configs/figures/SCALE/ that it is drawn from
  Sheet (*draw)(const Material&);      ///< its panels; null for the films, which are only collected
};

/// All of them, the paper's own first.
std::span<const PaperFigure> paper_figures();
/// Every sweep that some figure is drawn from, in the order in which they are best run.
std::vector<std::string_view> all_sets();

Sheet order_figure(const Material& material);             ///< 2
Sheet order_statistics_figure(const Material& material);  ///< 3
Sheet correlation_figure(const Material& material);       ///< 4
Sheet pair_map_figure(const Material& material);          ///< 5
Sheet layers_figure(const Material& material);            ///< 6
Sheet layer_trends_figure(const Material& material);      ///< 7
Sheet mechanism_figure(const Material& material);         ///< 8
Sheet diffusion_figure(const Material& material);         ///< 9
Sheet rotation_figure(const Material& material);          ///< 10
Sheet defects_figure(const Material& material);
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
