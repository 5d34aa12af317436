#pragma once

#include <cmath>
#include <cstddef>
#include <optional>

#include "render/picture.h"
#include "render/style.h"

namespace shaken::render {

/// The part of the plane that is drawn in a view from above: a square [mm].
struct View {
  Vec2 corner{0, 0};  ///< lower left
  double side = 0;
  Vec2 period{0, 0};  ///< of the plane, in x and in y; 0: nothing is repeated
};
/// Shows a periodic box that is longer than wide by its longer side: its images stand beside it.
View view_of(const RodPicture& picture, const PictureStyle& style);
/// What is framed in the view [mm], from its corner: the view itself, unless more than the box is seen.
struct Framed {
  Vec2 corner{0, 0};
  Vec2 sides{0, 0};
};
Framed framed_in(const RodPicture& picture, const PictureStyle& style);
/// Whether a point, or an image of it, is in the view from above; other views show the whole box.
bool is_in_view(const RodPicture& picture, const PictureStyle& style, const Vec2& point);
/// The rod that the view follows, if the frame has it.
std::optional<std::size_t> followed_rod(const Frame& frame, const PictureStyle& style);

/// Calls `visit(place)` for each image of `point` that lies in the rectangle or within `reach` of it; images are
/// `period` apart each way; there are none but the point itself along an axis where that is 0.
template <class Visit>
void for_images(const Vec2& low, const Vec2& high, const Vec2& period, const Vec2& point, double reach,
                const Visit& visit) {
  for (int axis = 0; axis < 2; ++axis) {
    const bool is_near = point[axis] - low[axis] >= -reach && high[axis] - point[axis] >= -reach;
    if (!(period[axis] > 0) && !is_near) return;
  }
  const auto first = [&](int axis) {
    return period[axis] > 0 ? std::ceil((low[axis] - reach - point[axis]) / period[axis]) : 0.0;
  };
  const auto last = [&](int axis) {
    return period[axis] > 0 ? std::floor((high[axis] + reach - point[axis]) / period[axis]) : 0.0;
  };
  for (double ky = first(1); ky <= last(1); ++ky) {
    for (double kx = first(0); kx <= last(0); ++kx) visit(Vec2(point + period.cwiseProduct(Vec2(kx, ky))));
  }
}

/// The same for a view, with places from its corner.
template <class Visit>
void for_images(const View& view, const Vec2& point, double reach, const Visit& visit) {
  for_images(Vec2(0, 0), Vec2(view.side, view.side), view.period, point - view.corner, reach, visit);
}

}  // namespace shaken::render
