#pragma once

#include <array>
#include <vector>

#include "base/palettes.h"
#include "render/gl.h"
#include "render/picture.h"

namespace shaken::render {

/// One rod as shaders see it; lengths in mm.
struct RodInstance {
  RodInstance(const Vec3& at, const Vec3& director, const Colour& of);
  std::array<float, 3> centre, axis, colour;
};

/// The rods of one species, as the shaders of each pass get them.
struct RodBatch {
  /// A batch for a species that check_drawable() (render/rods_pass.h) has let through; without rods.
  explicit RodBatch(const BeadRow& row);
  /// Hands beads and rods to `program`, which must be in use, and draws one quad for each rod from the bound RodBuffer.
  void draw(GLuint program) const;

  std::vector<float> beads;  ///< offset along the rod and radius of each [mm]
  Vec2 ends;                 ///< offsets of the first and the last bead [mm]
  double pitch = 0;          ///< distance of neighbouring beads [mm]; 0 if it is not the same all along the rod
  double thick = 0;          ///< greatest radius [mm]
  double half = 0;           ///< from the centre to the farther tip [mm]
  std::vector<RodInstance> rods;
};

/// Draws one quad for each instance from the bound RodBuffer, with the program in use.
void draw_quads(const std::vector<RodInstance>& instances);

/// Where OpenGL keeps the instances of the batch that is drawn. Goes with its context.
class RodBuffer {
 public:
  /// Makes it in the current context.
  RodBuffer();
  void bind() const;

 private:
  GLuint vertex_array_ = 0, buffer_ = 0;
};

}  // namespace shaken::render
