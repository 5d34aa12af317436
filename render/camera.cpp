#include "render/camera.h"

#include <algorithm>
#include <cmath>

#include "render/view.h"

namespace shaken::render {
namespace {

/// A rod may stand up by as much as the lid lets it; a little more than that is spanned on either side.
Vec2 heights_of(const Cell& cell) {
  double thick = 0;
  for (const BeadRow& beads : cell.shapes) {
    for (const double radius : beads.radius) thick = std::max(thick, radius);
  }
  return {-thick, std::max(cell.gap, 2 * thick) + thick};
}

Camera from_above(const RodPicture& picture, const PictureStyle& style) {
  const View view = view_of(picture, style);
  const Vec2 heights = heights_of(picture.cell);
  Camera camera;
  camera.is_parallel = true;
  camera.low = view.corner;
  camera.high = view.corner + Vec2(view.side, view.side);
  camera.period = view.period;
  camera.half = Vec2(view.side, view.side) / 2;
  camera.eye << view.corner + camera.half, heights.y();
  camera.distance = camera.farthest = heights.y() - heights.x();
  return camera;
}

Camera into_the_gap(const RodPicture& picture, const PictureStyle& style, double aspect) {
  constexpr double kShare = 0.28;      // of the height that the gap takes at the opening
  constexpr double kDistance = 6.5;    // from the eye to the opening, in gaps
  constexpr double kDepth = 22;        // from the opening to where all has faded, in gaps
  constexpr double kEyeHeight = 0.66;  // above the base, in gaps
  const double gap = picture.cell.gap;
  Camera camera;
  camera.up = Vec3(0, 0, 1);
  camera.forward = Vec3(0, 1, 0);
  camera.is_cut = camera.fades = true;
  camera.distance = camera.nearest = kDistance * gap;
  camera.farthest = camera.nearest + kDepth * gap;
  Vec2 at = style.focus.cwiseProduct(picture.cell.box.sides());
  if (const std::optional<std::size_t> rod = followed_rod(picture.frame, style)) {
    at = picture.frame.position[*rod].head<2>() - Vec2(0, 1.5 * gap);
  }
  // The eye rests, so that the plates are seen to move; a vibration is small against the gap.
  camera.eye = Vec3(at.x(), at.y() - camera.nearest, kEyeHeight * gap);
  const double up = gap / kShare / 2 / camera.nearest / std::max(style.zoom, 1.0);
  camera.half = Vec2(aspect * up, up);
  const double reach = camera.half.x() * camera.farthest;
  camera.low = Vec2(at.x() - reach, at.y());
  camera.high = Vec2(at.x() + reach, camera.eye.y() + camera.farthest);
  camera.period = picture.cell.period();
  return camera;
}

Camera around_the_box(const RodPicture& picture, const PictureStyle& style, double aspect) {
  constexpr double kTangent = 0.27;  // of half the angle of view, upwards
  constexpr double kMargin = 1.03;
  const Vec2 sides = picture.cell.box.sides();
  const double gap = picture.cell.gap;
  const double azimuth = style.orbit.x() * kPi / 180, elevation = style.orbit.y() * kPi / 180;
  const auto round = [](double x) { return std::abs(x) < 1e-12 ? 0.0 : x; };
  Camera camera;
  camera.right = Vec3(round(std::cos(azimuth)), round(std::sin(azimuth)), 0);
  const Vec3 level(-camera.right.y(), camera.right.x(), 0);
  camera.forward = round(std::cos(elevation)) * level - Vec3(0, 0, std::sin(elevation));
  camera.up = camera.right.cross(camera.forward);
  camera.half = Vec2(aspect * kTangent, kTangent);
  // As near as leaves the whole box in the picture.
  double radius = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 from_middle(((corner & 1) - 0.5) * sides.x(), ((corner >> 1 & 1) - 0.5) * sides.y(),
                           ((corner >> 2) - 0.5) * gap);
    const Vec2 aside(std::abs(camera.right.dot(from_middle)), std::abs(camera.up.dot(from_middle)));
    const double needed = (kMargin * aside.cwiseQuotient(camera.half)).maxCoeff();
    camera.distance = std::max(camera.distance, needed - camera.forward.dot(from_middle));
    radius = std::max(radius, from_middle.norm());
  }
  camera.half /= std::max(style.zoom, 1.0);
  Vec3 at = Vec3(style.focus.x() * sides.x(), style.focus.y() * sides.y(), gap / 2);
  if (const std::optional<std::size_t> rod = followed_rod(picture.frame, style)) at = picture.frame.position[*rod];
  camera.eye = at - camera.distance * camera.forward;
  camera.nearest = 1e-3 * camera.distance;
  camera.farthest = camera.distance + 2 * radius + gap;
  camera.high = sides;
  return camera;
}

}  // namespace

Camera camera_of(const RodPicture& picture, const PictureStyle& style, double aspect) {
  Camera camera = style.view == ViewPoint::kGap     ? into_the_gap(picture, style, aspect)
                  : style.view == ViewPoint::kOrbit ? around_the_box(picture, style, aspect)
                                                    : from_above(picture, style);
  camera.heights = heights_of(picture.cell);
  return camera;
}

}  // namespace shaken::render
