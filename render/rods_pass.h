// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "base/core/result.h"
#include "render/gl_context.h"
#include "render/image.h"
#include "render/picture.h"
#include "render/style.h"

namespace shaken::render {

/// What keeps a picture from being drawn `side` pixels wide, if anything.
Result<void> check_drawable(const RodPicture& picture, int side);

/// Draws the rods in their box, seen from above along -z, without perspective.
/// Model:    one quad for each rod, on which each pixel's ray is cut with the beads themselves, so the outline is that
///           of the simulated body; the depth is the surface's own. Rods are repeated across the periodic border and
///           clipped to the view. Each species is drawn with its own beads. Beyond side walls the floor is tinted.
/// Numerics: the samples of a pixel are averaged; the same bits for any number of rasteriser threads.
class RodsPass {
 public:
  /// Rods of more beads than this are refused.
  static constexpr std::size_t kMaxBeads = 255;
  /// Pictures of a wider box than this are refused [pixels].
  static constexpr int kMaxSide = 5400;

  static Result<RodsPass> create();
  RodsPass(RodsPass&&) noexcept;
  RodsPass& operator=(RodsPass&&) noexcept;
  ~RodsPass();

  /// The view as a square of `side` pixels.
  template <class Channel = std::uint8_t>
  Result<ImageOf<Channel>> draw(const RodPicture& picture, const PictureStyle& style, int side);

 private:
  struct Programs;
  RodsPass(GlContext context, std::unique_ptr<Programs> programs);
  GlContext context_;
  std::unique_ptr<Programs> programs_;
};

}  // namespace shaken::render
