#pragma once

#include "render/picture.h"
#include "render/style.h"

namespace shaken::render {

/// From where rods are seen. Lengths in mm; depths are counted from the eye along `forward`.
struct Camera {
  Vec3 eye{0, 0, 0};  ///< of a parallel projection the middle of the plane in which its rays begin
  Vec3 right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};
  bool is_parallel = false;
  Vec2 half{1, 1};                   ///< half of what is seen, to the side and upwards: mm if parallel, else tangents
  double distance = 0;               ///< depth of what one looks at
  double nearest = 0, farthest = 0;  ///< depths between which bodies are drawn
  Vec2 heights{0, 0};                ///< that bodies may have, with something to spare
  bool is_cut = false;         ///< the plates are cut open at `nearest`; rods that the cut would meet are left out
  bool fades = false;          ///< into the page, up to `farthest`
  Vec2 low{0, 0}, high{0, 0};  ///< the part of the plane that is seen, a rectangle around it
  Vec2 period{0, 0};           ///< of the plane, in x and in y; 0: nothing is repeated

  /// A point as the eye has it: to the right, up, and its depth.
  Vec3 seen(const Vec3& point) const {
    const Vec3 from_eye = point - eye;
    return {right.dot(from_eye), up.dot(from_eye), forward.dot(from_eye)};
  }
  /// The length of a picture's pixel, of `height` of them, at what one looks at.
  double pixel(int height) const { return 2 * half.y() * (is_parallel ? 1 : distance) / height; }
};

/// The camera that the style asks for, of a picture that is `aspect` times as wide as it is high:
///   top    parallel, along -z: the square of view_of() (render/view.h)
///   gap    into the gap along y, in perspective: opened at `focus`, or at the rod that is followed; the gap is over a
///          quarter of the height there, times the zoom
///   orbit  the whole box in perspective, from the azimuth and the elevation that the style says, `focus` in the middle
Camera camera_of(const RodPicture& picture, const PictureStyle& style, double aspect);

}  // namespace shaken::render
