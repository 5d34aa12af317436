#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "base/core/result.h"
#include "run/files/recorded_frame.h"
#include "run/files/recorded_frames.h"

namespace shaken::run {

/// What formats call a species that want a name: "A" for the first.
inline std::string letter_of(std::size_t species) { return {static_cast<char>('A' + species)}; }

/// Where exported bytes go, piece by piece.
using Sink = std::function<Result<void>(std::string_view)>;

/// Frames as another program reads them: all bytes follow from the header, the number of frames and the frames in their
/// order, and none is touched twice. So no more than one frame is held at a time. A failure is the sink's.
class FrameFormat {
 public:
  virtual ~FrameFormat() = default;
  /// What stands before the first frame; once.
  virtual Result<void> begin(const Sink& sink) = 0;
  /// The next frame, of as many rods as the header has.
  virtual Result<void> write(const RecordedFrame& frame, const Sink& sink) = 0;
};

/// Extended XYZ with one line a rod, which OVITO and ASE open: Lattice, Properties, Time and Step in the comment line;
/// of each rod its species (from 1), centre, index, orientation (x, y, z, w), the semi-axes of an ellipsoid as long and
/// as wide as the rod, how often it left the box, velocity, director and angle. docs/files.md lists the columns.
std::unique_ptr<FrameFormat> make_extended_xyz(const TrajectoryHeader& header);

/// XYZ with one line a bead, which VMD, MDAnalysis and OVITO open: name, centre, radius and index of the rod. The name
/// is the letter of the rod's species and the number of the bead from the tail (A1, A2 ...), so a name has one radius.
/// The beads of a rod stay together where it lies across the border of the box.
std::unique_ptr<FrameFormat> make_beads_xyz(const TrajectoryHeader& header);

/// GSD 2 with the schema "hoomd" 1.4, `n_frames` of them: centres, from the middle of the box, orientations
/// (w, x, y, z), velocities, images, angles, and each species as the union of its beads.
/// Source: the file layer and the schema of https://gsd.readthedocs.io.
std::unique_ptr<FrameFormat> make_gsd(const TrajectoryHeader& header, std::size_t n_frames);

}  // namespace shaken::run
