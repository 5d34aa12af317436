#include "client/watch/rod_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sim/motion/side_walls.h"

namespace shaken::client {
namespace {

constexpr double kHalfTurn = std::numbers::pi;

/// `x` less whole periods, in [-period/2, period/2); as it is where the period is 0.
double folded(double x, double period) { return period > 0 ? x - period * std::floor(x / period + 0.5) : x; }

Tone tone_of(const RodFrame& frame, std::size_t rod, Colouring colouring) {
  const std::size_t species = frame.cell.species_of(rod);
  const proto::RodPose& pose = frame.rods[rod];
  if (colouring == Colouring::kTilt) return tilt_tone(pose.n_z);
  if (colouring == Colouring::kSpecies) return species_tone(species);
  if (species > 0) return other_tone(species);
  if (colouring == Colouring::kWheel) return wheel_tone(pose.theta);
  return layer_tone(folded(pose.theta - frame.director, kHalfTurn));
}

int bounded(double place, int most) { return static_cast<int>(std::clamp(place, 0.0, 1.0 * most)); }

}  // namespace

double samples_per_mm(const RodFrame& frame, const RodView& view, int width, int height) {
  return view.zoom * std::min(width, height) / frame.cell.box.longer();
}

RodSamples::RodSamples(const RodFrame& frame, const RodView& view, Colouring colouring, int width, int height)
    : frame_(frame),
      x_(view.x * frame.cell.box.x()),
      y_(view.y * frame.cell.box.y()),
      period_(frame.cell.period()),
      per_mm_(samples_per_mm(frame, view, width, height)),
      width_(width),
      height_(height),
      tones_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), kFloorTone) {
  // Where it is periodic the box is seen from half a side left of the middle of the view to half a side right of it.
  const Box& box = frame.cell.box;
  const double left = period_.x() > 0 ? -box.x() / 2 : -x_, bottom = period_.y() > 0 ? -box.y() / 2 : -y_;
  column_begin_ = std::max(0, first_column(left));
  column_end_ = std::min(width_, first_column(left + box.x()));
  row_begin_ = std::max(0, first_row(bottom + box.y()));
  row_end_ = std::min(height_, first_row(bottom));
  if (frame.cell.walls) draw_walls(*frame.cell.walls);
  draw_posts(frame.cell.posts);
  for (std::size_t i = 0; i < frame.rods.size(); ++i) {
    draw(frame.rods[i], frame.outlines[frame.cell.shape_of(i)], tone_of(frame, i, colouring));
  }
}

std::pair<double, double> RodSamples::from_middle(double x, double y) const {
  return {folded(x - x_, period_.x()), folded(y - y_, period_.y())};
}

/// The first column or row of samples whose middle is not left of, or above, a distance from the middle of the view.
int RodSamples::first_column(double x) const { return bounded(std::ceil(width_ / 2.0 + x * per_mm_ - 0.5), width_); }
int RodSamples::first_row(double y) const { return bounded(std::ceil(height_ / 2.0 - y * per_mm_ - 0.5), height_); }

std::pair<int, int> RodSamples::place(double x, double y) const {
  const auto [dx, dy] = from_middle(x, y);
  return {static_cast<int>(std::floor(width_ / 2.0 + dx * per_mm_)),
          static_cast<int>(std::floor(height_ / 2.0 - dy * per_mm_))};
}

/// Paints those samples within this reach of a point of the box, and of its images, that are inside of something as
/// seen from there.
template <class IsInside>
void RodSamples::paint(double x, double y, const Vec2& reach, Tone tone, const IsInside& is_inside) {
  const auto [dx, dy] = from_middle(x, y);
  const int wide = period_.x() > 0 ? 1 : 0, high = period_.y() > 0 ? 1 : 0;
  for (int i = -wide; i <= wide; ++i) {
    for (int j = -high; j <= high; ++j) {
      const double at_x = dx + i * period_.x(), at_y = dy + j * period_.y();
      const int begin_column = std::max(column_begin_, first_column(at_x - reach.x()));
      const int end_column = std::min(column_end_, first_column(at_x + reach.x()));
      const int begin_row = std::max(row_begin_, first_row(at_y + reach.y()));
      const int end_row = std::min(row_end_, first_row(at_y - reach.y()));
      for (int row = begin_row; row < end_row; ++row) {
        for (int column = begin_column; column < end_column; ++column) {
          if (is_inside(x_of(column) - at_x, y_of(row) - at_y)) tones_[index(column, row)] = tone;
        }
      }
    }
  }
}

void RodSamples::draw(const proto::RodPose& rod, const RodOutline& outline, Tone tone) {
  const std::array axis = rod.axis();
  const double flat = std::hypot(axis[0], axis[1]);
  const double half = outline.half_length * flat;
  const double ux = flat > 0 ? axis[0] / flat : 1, uy = flat > 0 ? axis[1] / flat : 0;
  const double thinnest = 0.5001 / per_mm_;  // never between two samples
  const double widest = std::max({outline.middle, outline.end, thinnest});
  const Vec2 reach(half * std::abs(ux) + widest, half * std::abs(uy) + widest);
  paint(rod.x, rod.y, reach, tone, [&](double x, double y) {
    const double along = std::abs(x * ux + y * uy), across = std::abs(y * ux - x * uy);
    const double part = half > 0 ? std::min(along / half, 1.0) : 1.0;
    const double radius = std::max(outline.middle + part * (outline.end - outline.middle), thinnest);
    return std::hypot(std::max(along - half, 0.0), across) <= radius;
  });
}

void RodSamples::draw_walls(const SideWalls& walls) {
  const double reach = 0.75 / per_mm_;
  for (int row = row_begin_; row < row_end_; ++row) {
    for (int column = column_begin_; column < column_end_; ++column) {
      const Vec3 point(x_ + x_of(column), y_ + y_of(row), 0);
      const double distance = distance_to_walls(walls, frame_.cell.box, point);
      if (std::abs(distance) < reach) tones_[index(column, row)] = kWallTone;
    }
  }
}

void RodSamples::draw_posts(const StandingPosts& posts) {
  const double radius = std::max(0.5 * posts.diameter, 0.5001 / per_mm_);  // never between two samples
  const auto is_inside = [&](double x, double y) { return std::hypot(x, y) <= radius; };
  for (const Vec2& centre : posts.centres) paint(centre.x(), centre.y(), {radius, radius}, kWallTone, is_inside);
}

}  // namespace shaken::client
