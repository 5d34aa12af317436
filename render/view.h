// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "render/picture.h"
#include "render/style.h"

namespace shaken::render {

/// The part of the plane that is drawn: a square [mm].
struct View {
  Vec2 corner{0, 0};  ///< lower left
  double side = 0;
  double period = 0;  ///< of the plane, in x and in y; 0: nothing is repeated
};
View view_of(const RodPicture& picture, const PictureStyle& style);
/// Where the box lies in the view, from its corner; the view itself unless rods are drawn whole.
View box_in(const RodPicture& picture, const PictureStyle& style);

/// Calls `visit(from_corner)` for each periodic image of `point` that lies in the view or within `reach` of it.
template <class Visit>
void for_images(const View& view, const Vec2& point, double reach, const Visit& visit) {
  const Vec2 at = point - view.corner;
  if (view.period <= 0) {
    if (at.minCoeff() >= -reach && at.maxCoeff() <= view.side + reach) visit(at);
    return;
  }
  const auto first = [&](double x) { return std::ceil((-reach - x) / view.period); };
  const auto last = [&](double x) { return std::floor((view.side + reach - x) / view.period); };
  for (double ky = first(at.y()); ky <= last(at.y()); ++ky) {
    for (double kx = first(at.x()); kx <= last(at.x()); ++kx) visit(Vec2(at + view.period * Vec2(kx, ky)));
  }
}

}  // namespace shaken::render
