// SPDX-License-Identifier: MIT
#include <vector>

#include "analysis/defects.h"
#include "analysis/director_field.h"
#include "analysis/order.h"
#include "render/picture.h"
#include "scene/measure_plan.h"

namespace shaken::render {

void measure(RodPicture& picture, bool with_defects) {
  const std::vector<Vec3> directors = picture.first_directors();
  const analysis::NematicOrder mean = analysis::nematic_order(directors);
  picture.order = mean.order;
  picture.director_angle = mean.director;
  picture.defects.clear();
  if (!with_defects || directors.empty()) return;
  std::vector<Vec3> positions;
  for (std::size_t i = 0; i < picture.n_rods(); ++i) {
    if (picture.species_of(i) == 0) positions.push_back(picture.position[i]);
  }
  const double length = picture.rod_length();
  const analysis::Region region(picture.box_side, picture.walls);
  scene::MeasureDefects settings;
  settings.smoothing = picture.smoothing;
  settings.grid = picture.grid;
  const int nodes = analysis::grid_nodes(picture.box_side, settings.grid_for(length));
  picture.defects = analysis::find_defects(
      analysis::DirectorField(positions, directors, region, nodes, settings.smoothing_for(length)));
}

}  // namespace shaken::render
