#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "analysis/defects.h"
#include "analysis/geometry/director_field.h"
#include "analysis/geometry/periodic.h"
#include "analysis/order.h"
#include "render/picture.h"
#include "scene/keys/measure_plan.h"

namespace shaken::render {
namespace {

/// The area fraction around each rod: the areas of all rods, each weighted with a Gaussian of standard deviation
/// `width` [mm] of its distance. Cut at three of them, and then normalised on the cut disc. Beyond walls there are no
/// rods, so it falls towards them.
std::vector<double> densities(const Cell& box, const Frame& frame, double width) {
  const std::size_t n = frame.position.size();
  const double reach = 3 * width;
  const Box& sides = box.box;
  const Vec2 period = box.period();
  // Cells at least as wide as the reach, so that neighbours lie in nine of them; fewer than three would count twice.
  const auto cells_along = [&](double side) {
    const int cells = static_cast<int>(std::clamp(std::floor(side / reach), 1.0, 512.0));
    return cells < 3 ? 1 : cells;
  };
  const int columns = cells_along(sides.x()), rows = cells_along(sides.y());
  std::vector<std::vector<std::size_t>> in_cell(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  std::vector<Vec2> place(n);
  std::vector<double> area;
  for (const BeadRow& beads : box.shapes) area.push_back(beads.area());
  const auto column_of = [&](const Vec2& at) {
    return std::min(static_cast<int>(at.x() / sides.x() * columns), columns - 1);
  };
  const auto row_of = [&](const Vec2& at) { return std::min(static_cast<int>(at.y() / sides.y() * rows), rows - 1); };
  const auto cell = [&](int i, int j) -> std::vector<std::size_t>& {
    return in_cell[static_cast<std::size_t>((j + rows) % rows) * static_cast<std::size_t>(columns) +
                   static_cast<std::size_t>((i + columns) % columns)];
  };
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3& at = frame.position[i];
    place[i] = Vec2(analysis::wrapped(at.x(), sides.x()), analysis::wrapped(at.y(), sides.y()));
    cell(column_of(place[i]), row_of(place[i])).push_back(i);
  }
  const double norm = 2 * kPi * width * width * (1 - std::exp(-4.5));
  std::vector<double> density(n);
  const int wide = columns > 1 ? 1 : 0, high = rows > 1 ? 1 : 0;
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0;
    const auto add = [&](std::size_t j) {
      Vec2 d = place[j] - place[i];
      for (int axis = 0; axis < 2; ++axis) {
        if (period[axis] > 0) d[axis] = analysis::wrapped_difference(d[axis], period[axis]);
      }
      const double square = d.squaredNorm();
      if (square < reach * reach) sum += area[box.shape_of(j)] * std::exp(-square / (2 * width * width));
    };
    for (int dj = -high; dj <= high; ++dj) {
      for (int di = -wide; di <= wide; ++di) {
        for (const std::size_t j : cell(column_of(place[i]) + di, row_of(place[i]) + dj)) add(j);
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
  const analysis::Grid grid(cell.box, settings.grid_for(length));
  picture.found.field = std::make_shared<analysis::DirectorField>(cell.of_species(0, picture.frame.position), directors,
                                                                  analysis::Region(cell.box, cell.walls), grid,
                                                                  settings.smoothing_for(length));
  if (asked.defects) picture.found.defects = analysis::find_defects(*picture.found.field);
}

}  // namespace shaken::render
