#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/scratch_folder.h"
#include "render/image.h"
#include "render/painter.h"
#include "render/picture.h"

namespace shaken::render {

/// The paper's rod (4.5 mm, 0.8 mm thick in the middle, 0.4 mm at the ends, 15 beads) in a box; no rods yet.
RodPicture empty_picture(double box_side);

/// Adds a rod at (x, y) in mid-gap; `angle` in the plane, `n_z` the vertical part of its axis.
void add_rod(RodPicture& picture, double x, double y, double angle, double n_z = 0);

/// Half the width of the rod's outline at distance x from its centre, seen from the side: the widest bead there [mm].
double half_width(const RodPicture& picture, double x);

/// The painter that all tests of a process share.
Painter& painter();

/// Reads a PNG through libpng's simplified interface.
Image read_png(const std::filesystem::path& file);

/// Names of all that is in a folder, sorted, with spaces between.
std::string listing(const ScratchFolder& folder);

/// Writes DIR/trajectory.h5 with these frames, of the same rods.
void plant_frames(const std::filesystem::path& directory, const std::vector<RodPicture>& frames,
                  const std::string& scene_json = "{}");
/// The same: frame f at f * 0.05 s has three rods, all turned by f * 10 degrees.
void plant_trajectory(const std::filesystem::path& directory, int n_frames, const std::string& scene_json = "{}");

}  // namespace shaken::render
