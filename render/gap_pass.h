// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "base/core/result.h"
#include "render/gl_context.h"
#include "render/image.h"
#include "render/picture.h"
#include "render/style.h"

namespace shaken::render {

/// The camera of a look into the gap; lengths in mm.
struct GapCamera {
  Vec3 eye{0, 0, 0};   ///< looks along y
  double front = 0;    ///< from the eye to the plane where the plates are cut open
  double far = 0;      ///< from the eye to where everything has faded
  Vec2 tangent{0, 0};  ///< of half the angle of view, to the side and upwards
};
/// Of a stage that is `aspect` times as wide as it is high: opened at `focus`, or at the rod that is followed; the gap
/// is over a quarter of the stage's height there, times the zoom.
GapCamera gap_camera(const RodPicture& picture, const PictureStyle& style, double aspect);

/// Draws rods and plates as one sees them who looks into the gap between the plates, in perspective. The plates are
/// drawn where they are at the picture's time. Rods that the opening would cut are left out, so that each is whole; a
/// periodic box is repeated as far as one sees.
/// Model:    as the rods pass, with rays from the eye: each ray is cut with the beads themselves.
/// Numerics: the samples of a pixel are averaged; the same bits for any number of rasteriser threads.
class GapPass {
 public:
  static Result<GapPass> create();
  GapPass(GapPass&&) noexcept;
  GapPass& operator=(GapPass&&) noexcept;
  ~GapPass();
  /// A picture of `width` x `height` pixels.
  template <class Channel = std::uint8_t>
  Result<ImageOf<Channel>> draw(const RodPicture& picture, const PictureStyle& style, int width, int height);

 private:
  struct Programs;
  GapPass(GlContext context, std::unique_ptr<Programs> programs);
  GlContext context_;
  std::unique_ptr<Programs> programs_;
};

}  // namespace shaken::render
