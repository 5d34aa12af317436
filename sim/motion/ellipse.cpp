#include "sim/motion/ellipse.h"

#include <algorithm>
#include <cmath>

namespace shaken {

Ellipse::Ellipse(double a, double b)
    : a_(a), b_(b), ratio_(b / a), squared_((a - b) * (a + b) / (a * a)), furthest_((a - b) * (a + b) / a) {}

double Ellipse::Disc::depth(const Vec2& point) const {
  const double off = point.x() - centre;
  return radius - std::sqrt(off * off + point.y() * point.y());
}

Ellipse::Disc Ellipse::disc_at(double u) const { return {furthest_ * u, b_ * std::sqrt(1.0 - squared_ * u * u)}; }

Ellipse::Disc Ellipse::disc_round(const Vec2& point) const { return disc_at(std::clamp(point.x() / a_, -1.0, 1.0)); }

double Ellipse::nearest(const Vec2& point) const {
  const double x = std::abs(point.x()), y2 = point.y() * point.y();
  const double end = furthest_ > x ? x / furthest_ : 1.0;
  const auto next = [&](double u) {
    const double w = std::max(0.0, x - furthest_ * u);
    const double D2 = w * w + y2, D = std::sqrt(D2);
    if (!(D2 * D > 0)) return u;  // at the centre of the disc, which is as near to the ellipse above and below
    const double s2 = 1.0 - squared_ * u * u, s = std::sqrt(s2);
    // f / -f', of which both are multiplied by D^3 s^3
    return u + (w * s - ratio_ * u * D) * D2 * s2 / (furthest_ * y2 * s2 * s + ratio_ * D2 * D);
  };
  // It begins where the straight line from the origin through the point meets the ellipse, once that is squeezed into
  // a circle: for a point of the ellipse this is the root.
  const double along = x * ratio_, from_origin = std::sqrt(along * along + y2);
  double u = std::min(end, from_origin > 0 ? along / from_origin : 0.0);
  u = std::clamp(next(u), 0.0, end);
  constexpr int kMost = 100;  // a dozen, unless the point is at the centre of curvature of a tip
  for (int step = 0; step < kMost; ++step) {
    const double lower = std::max(0.0, next(u));
    if (!(lower < u)) break;
    u = lower;
  }
  return u;
}

Ellipse::Seen Ellipse::see(const Vec2& point) const {
  const double u = nearest(point);
  const Disc disc = disc_at(u);
  const double w = std::max(0.0, std::abs(point.x()) - disc.centre), y = std::abs(point.y());
  const double D = std::sqrt(w * w + y * y);
  // both forms are the same; where the point is near the centre, its way from there is lost in rounding
  const bool is_far = D > 0.1 * disc.radius;
  const double s = std::sqrt(1.0 - squared_ * u * u);
  const Vec2 outwards = is_far ? Vec2(w / D, y / D) : Vec2(ratio_ * u / s, std::sqrt(1.0 - u * u) / s);
  return {disc.radius - D, {-std::copysign(outwards.x(), point.x()), -std::copysign(outwards.y(), point.y())}};
}

}  // namespace shaken
