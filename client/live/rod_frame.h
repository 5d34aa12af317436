#pragma once

#include <vector>

#include "client/live/rod_colours.h"
#include "proto/frame_codec.h"
#include "sim/cell.h"

namespace shaken::client {

/// The outline of a rod seen from above: its radius changes linearly from the middle to the centres of its end beads.
struct RodOutline {
  double half_length = 0;  ///< to the centre of the last bead [mm]
  double middle = 0;       ///< radius in the middle [mm]
  double end = 0;          ///< radius of the last bead [mm]
};

/// Where a defect of the director field is.
struct DefectMark {
  double x = 0;  ///< [mm]
  double y = 0;  ///< [mm]
  bool is_positive = false;
};

/// All that is drawn of a run at one instant.
struct RodFrame {
  double time = 0;      ///< [s]
  double order = 0;     ///< S of the first species; NaN where there are no axes
  double director = 0;  ///< its angle [rad]
  std::vector<proto::RodPose> rods{};
  std::vector<double> heights{};       ///< of the rods' centres (n_rods) [mm]; empty where unknown, as of live rods
  Cell cell{};                         ///< periodic unless there are walls
  std::vector<RodOutline> outlines{};  ///< one per shape, at least one
};

/// The part of the box that is looked at.
struct RodView {
  double x = 0.5;   ///< the middle, as a part of the box side
  double y = 0.5;   ///< the same, upwards
  double zoom = 1;  ///< at 1 the whole box is seen
};

}  // namespace shaken::client
