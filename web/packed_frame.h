#pragma once

#include <string>

#include "client/live/rod_frame.h"

namespace shaken::web {

/// A frame as the page reads it, the same for live and for recorded ones. Little-endian:
///   u32 size of the head; the head, JSON padded with blanks to a multiple of 4 bytes:
///       {"time_s", "box_mm": [x, y], "order", "director_rad", "n_rods", "outlines": [[half length, radius in the
///       middle, radius at the ends], ...] of each shape [mm], "species_of_outline": [of each, from 0; empty if every
///       species has one shape], "gap_mm", "has_heights", "walls": {"arena", "size_mm", "inner_mm",
///       "length_mm" of a stadium, an ellipse or a wedge, "narrow_mm" of a wedge} or null, "posts": {"diameter_mm",
///       "centres_mm": [[x, y], ...]} or null};
///   i16 x[n_rods], y[n_rods], heading[n_rods], n_z[n_rods], in the units of frame_t (proto/frame_t.lcm);
///   i16 z[n_rods], if "has_heights": 32767 (z / gap - 1/2), z being the height of the rod's centre;
///   u8 shape[n_rods], if there are several.
std::string packed(const client::RodFrame& frame);

}  // namespace shaken::web
