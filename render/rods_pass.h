#pragma once

#include <memory>

#include "base/core/result.h"
#include "render/camera.h"
#include "render/image.h"
#include "render/picture.h"
#include "render/style.h"

namespace shaken::render {

/// Draws rods and plates as a camera sees them: from above, into the gap between the plates, or from anywhere.
/// Model:    one quad for each rod, on which each pixel's ray is cut with the beads themselves, so the outline is that
///           of the simulated body; the depth is the surface's own. Rods are repeated across the periodic border as far
///           as one sees. Each species is drawn with its own beads. The plates are where they are at the picture's
///           time; beyond side walls the floor is tinted, and posts, which stand on it, have the same colour.
/// Numerics: the samples of a pixel are averaged; the same bits for any number of rasteriser threads.
class RodsPass {
 public:
  /// Rods of more beads than this are refused: the shaders' arrays end there. Scenes have fewer.
  static constexpr std::size_t kMostDrawnBeads = 255;
  /// Pictures with a longer side than this are refused [pixels].
  static constexpr int kMaxSide = 5400;

  static Result<RodsPass> create();
  RodsPass(RodsPass&&) noexcept;
  RodsPass& operator=(RodsPass&&) noexcept;
  ~RodsPass();

  /// A picture of `width` x `height` pixels; from above it shows a square.
  template <class Channel = std::uint8_t>
  Result<ImageOf<Channel>> draw(const RodPicture& picture, const PictureStyle& style, int width, int height);

 private:
  struct Programs;
  explicit RodsPass(std::unique_ptr<Programs> programs);
  std::unique_ptr<Programs> programs_;
};

}  // namespace shaken::render
