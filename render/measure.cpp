// SPDX-License-Identifier: MIT
#include "analysis/defects.h"
#include "analysis/director_field.h"
#include "analysis/order.h"
#include "render/picture.h"

namespace shaken::render {

void measure(RodPicture& picture, bool with_defects) {
  const analysis::NematicOrder mean = analysis::nematic_order(picture.director);
  picture.order = mean.order;
  picture.director_angle = mean.director;
  picture.defects.clear();
  if (!with_defects || picture.n_rods() == 0) return;
  const double length = picture.rod_length();
  const int nodes = analysis::grid_nodes(picture.box_side, length / 8);
  picture.defects = analysis::find_defects(
      analysis::DirectorField(picture.position, picture.director, picture.box_side, nodes, length / 2));
}

}  // namespace shaken::render
