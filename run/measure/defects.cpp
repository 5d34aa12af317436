// SPDX-License-Identifier: MIT
#include "run/measure/defects.h"

#include <utility>

#include "analysis/director_field.h"
#include "run/measure/registry.h"
#include "sim/effects/side_walls.h"

namespace shaken::run {

MeasuredDefects::MeasuredDefects(const MeasureContext& context) : walls_(context.plan.system.walls) {
  const double length = context.plan.system.rod.length;
  smoothing_ = context.plan.defects->smoothing > 0 ? context.plan.defects->smoothing : length / 2;
  mesh_ = context.plan.defects->grid > 0 ? context.plan.defects->grid : length / 8;
}

void MeasuredDefects::sample(const Moment& moment) {
  const analysis::DirectorField field(moment->position, moment->director, moment->box_side,
                                      analysis::grid_nodes(moment->box_side, mesh_), smoothing_);
  std::vector<analysis::Defect> defects = analysis::find_defects(field);
  if (walls_) {  // beyond them there are no rods to have any
    std::erase_if(defects, [&](const analysis::Defect& defect) {
      const Vec3 place(defect.position.x(), defect.position.y(), 0);
      return distance_to_walls(*walls_, moment->box_side, place) < 0;
    });
  }
  last_ = DefectSample{moment->tick, moment->time, smoothing_, std::move(defects)};
  series_.accumulate(moment->time, last_->defects);
}

void MeasuredDefects::reduce(Reduction& result) const {
  result.defects = series_.reduce(result.t_steady);
  result.arrays["/defects/time_s"] = series_.times();
  result.arrays["/defects/n_plus"] = series_.n_plus();
  result.arrays["/defects/n_minus"] = series_.n_minus();
  result.arrays["/defects/list/time_s"] = series_.list().time;
  result.arrays["/defects/list/x_mm"] = series_.list().x;
  result.arrays["/defects/list/y_mm"] = series_.list().y;
  result.arrays["/defects/list/charge"] = series_.list().charge;
  result.arrays["/defects/list/direction_rad"] = series_.list().direction;
}

std::unique_ptr<Measurement> make_defects(const MeasureContext& context) {
  return std::make_unique<MeasuredDefects>(context);
}

}  // namespace shaken::run
