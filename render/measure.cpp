// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "analysis/defects.h"
#include "analysis/director_field.h"
#include "analysis/order.h"
#include "analysis/periodic.h"
#include "render/picture.h"
#include "scene/measure_plan.h"

namespace shaken::render {
namespace {

/// The area fraction around each rod: the areas of all rods, each weighted with a Gaussian of standard deviation
/// `width` [mm] of its distance. Cut at three of them, and then normalised on the cut disc. Beyond walls there are no
/// rods, so it falls towards them.
std::vector<double> densities(const Cell& box, const Frame& frame, double width) {
  const std::size_t n = frame.position.size();
  const double reach = 3 * width, side = box.box_side;
  const bool is_periodic = !box.walls;
  // Cells at least as wide as the reach, so that neighbours lie in nine of them; fewer than three would count twice.
  const int cells = static_cast<int>(std::clamp(std::floor(side / reach), 1.0, 512.0));
  std::vector<std::vector<std::size_t>> in_cell(static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells));
  std::vector<Vec2> place(n);
  std::vector<double> area;
  for (const BeadRow& beads : box.species) area.push_back(beads.area());
  const auto cell_of = [&](double x) { return std::min(static_cast<int>(x / side * cells), cells - 1); };
  const auto cell = [&](int i, int j) -> std::vector<std::size_t>& {
    return in_cell[static_cast<std::size_t>((j + cells) % cells) * static_cast<std::size_t>(cells) +
                   static_cast<std::size_t>((i + cells) % cells)];
  };
  for (std::size_t i = 0; i < n; ++i) {
    place[i] = Vec2(analysis::wrapped(frame.position[i].x(), side), analysis::wrapped(frame.position[i].y(), side));
    cell(cell_of(place[i].x()), cell_of(place[i].y())).push_back(i);
  }
  const double norm = 2 * kPi * width * width * (1 - std::exp(-4.5));
  std::vector<double> density(n);
  const int around = cells >= 3 ? 1 : 0;
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0;
    const auto add = [&](std::size_t j) {
      Vec2 d = place[j] - place[i];
      if (is_periodic) d = Vec2(analysis::nearest_image(d.x(), side), analysis::nearest_image(d.y(), side));
      const double square = d.squaredNorm();
      if (square < reach * reach) sum += area[box.species_of(j)] * std::exp(-square / (2 * width * width));
    };
    if (around == 0) {
      for (std::size_t j = 0; j < n; ++j) add(j);
    } else {
      for (int dj = -1; dj <= 1; ++dj) {
        for (int di = -1; di <= 1; ++di) {
          for (const std::size_t j : cell(cell_of(place[i].x()) + di, cell_of(place[i].y()) + dj)) add(j);
        }
      }
    }
    density[i] = sum / norm;
  }
  return density;
}

}  // namespace

void measure(RodPicture& picture, const Asked& asked) {
  const Cell& cell = picture.cell;
  const analysis::NematicOrder mean = analysis::nematic_order(cell, picture.frame.director);
  picture.found.order = mean.order;
  picture.found.director_angle = mean.director;
  picture.found.defects.clear();
  picture.found.field.reset();
  picture.found.density.clear();
  const double length = picture.rod_length();
  if (asked.density) picture.found.density = densities(cell, picture.frame, length / 2);
  const std::vector<Vec3> directors = cell.of_species(0, picture.frame.director);
  if (!(asked.defects || asked.field) || directors.empty() || !cell.has_axes()) return;
  scene::MeasureDefects settings;
  settings.smoothing = asked.smoothing;
  settings.grid = asked.grid;
  const int nodes = analysis::grid_nodes(cell.box_side, settings.grid_for(length));
  picture.found.field = std::make_shared<analysis::DirectorField>(cell.of_species(0, picture.frame.position), directors,
                                                                  analysis::Region(cell.box_side, cell.walls), nodes,
                                                                  settings.smoothing_for(length));
  if (asked.defects) picture.found.defects = analysis::find_defects(*picture.found.field);
}

}  // namespace shaken::render
