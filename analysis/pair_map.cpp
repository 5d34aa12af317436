#include "analysis/pair_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/bins.h"
#include "analysis/geometry/periodic.h"
#include "analysis/order.h"
#include "base/core/check.h"

namespace shaken::analysis {
namespace {

/// Rods taken as the first of a pair in one sample, at most.
constexpr std::size_t kMaxReferencesOfMap = 1024;

bool is_square(const Box& box) { return box.x() == box.y(); }

/// Bins of a cut: their far corners lie within half the box, by its longer side.
std::size_t cut_bins(const PairMap::Shape& shape) {
  const double half_box = shape.box.longer() / 2, half_strip = shape.strip / 2;
  const double reach = std::sqrt(std::max(half_box * half_box - half_strip * half_strip, 0.0));
  return static_cast<std::size_t>(reach * shape.bins / (2 * shape.range));
}

}  // namespace

PairMap::PairMap(const Shape& shape)
    : shape_(shape),
      bins_(static_cast<std::size_t>(std::max(shape.bins, 0))),
      width_(2 * shape.range / std::max(shape.bins, 1)),
      map_(bins_ * bins_),
      cut_along_(cut_bins(shape), !is_square(shape.box)),
      cut_across_(cut_along_.pairs.size(), !is_square(shape.box)) {
  SHAKEN_CHECK(shape.bins >= 1 && shape.range > 0 && shape.strip > 0, "bins, range and strip must not be empty");
  SHAKEN_CHECK(2 * shape.range <= shape.box.shorter() * (1 + 1e-12),
               "distances beyond half the box have no nearest image");
}

std::size_t PairMap::filled_bins(const Vec2& axis, const Bins& cut) const {
  const std::size_t all = cut.pairs.size();
  if (is_square(shape_.box)) return all;
  // the far corners of the strip, reach * axis +- half a strip across it, lie within half of each side
  const double half_strip = shape_.strip / 2;
  double reach = std::numeric_limits<double>::infinity();
  for (const int side : {0, 1})
    reach = std::min(reach, (shape_.box[side] / 2 - half_strip * std::abs(axis[1 - side])) / std::abs(axis[side]));
  return static_cast<std::size_t>(std::clamp(reach / width_, 0.0, static_cast<double>(all)));
}

std::vector<double> PairMap::partners_in(const Bins& cut) const {
  const std::size_t n = cut.pairs.size();
  std::vector<double> partners(n, partners_);
  if (is_square(shape_.box)) return partners;
  double sum = 0;
  for (std::size_t bin = n; bin-- > 0;) partners[bin] = sum += cut.sums[n + bin];
  return partners;
}

void PairMap::accumulate(std::span<const Vec3> positions, std::span<const Vec3> directors) {
  const Box& box = shape_.box;
  const double director = nematic_order(directors).director;
  const double cosine = std::cos(director), sine = std::sin(director);
  const auto [xs, ys, cs, ss] = lying_rods(positions, directors, box.sides());
  const std::size_t n = xs.size();
  const double bins_per_mm = 1 / width_;
  const double half_strip = shape_.strip / 2;
  const std::size_t filled_along = filled_bins({cosine, sine}, cut_along_);
  const std::size_t filled_across = filled_bins({-sine, cosine}, cut_across_);
  const auto count = [](Bins& bins, std::size_t bin, double value) {
    ++bins.pairs[bin];
    bins.sums[bin] += value;
  };
  const auto count_cut = [&](Bins& cut, std::size_t filled, double distance, double value) {
    if (distance >= width_ * static_cast<double>(filled)) return;
    count(cut, std::min(static_cast<std::size_t>(distance * bins_per_mm), filled - 1), value);
  };
  const double partners_before = partners_;
  const std::size_t stride = std::max<std::size_t>(1, (n + kMaxReferencesOfMap - 1) / kMaxReferencesOfMap);
  // In two passes, the first without branches: it becomes vector instructions.
  std::vector<double> alongs(n), acrosses(n);
  for (std::size_t i = static_cast<std::size_t>(calls_) % stride; i < n; i += stride) {
    partners_ += static_cast<double>(n - 1);  // a rod makes no pair with itself
    const double xi = xs[i], yi = ys[i];
    for (std::size_t j = 0; j < n; ++j) {
      const double dx = wrapped_difference(xs[j] - xi, box.x()), dy = wrapped_difference(ys[j] - yi, box.y());
      alongs[j] = dx * cosine + dy * sine;
      acrosses[j] = dy * cosine - dx * sine;
    }
    for (std::size_t j = 0; j < n; ++j) {
      const double far_along = std::abs(alongs[j]), far_across = std::abs(acrosses[j]);
      const bool in_map = std::max(far_along, far_across) < shape_.range;
      if ((!in_map && std::min(far_along, far_across) >= half_strip) || i == j) continue;
      const double value = cs[i] * cs[j] + ss[i] * ss[j];
      if (in_map) {
        const auto column = static_cast<std::size_t>((alongs[j] + shape_.range) * bins_per_mm);
        const auto row = static_cast<std::size_t>((acrosses[j] + shape_.range) * bins_per_mm);
        count(map_, std::min(row, bins_ - 1) * bins_ + std::min(column, bins_ - 1), value);
      }
      if (far_across < half_strip) count_cut(cut_along_, filled_along, far_along, value);
      if (far_along < half_strip) count_cut(cut_across_, filled_across, far_across, value);
    }
  }
  if (!is_square(box)) {
    const std::size_t bins = cut_along_.pairs.size();
    if (filled_along > 0) cut_along_.sums[bins + filled_along - 1] += partners_ - partners_before;
    if (filled_across > 0) cut_across_.sums[bins + filled_across - 1] += partners_ - partners_before;
  }
  ++calls_;
}

PairCurves PairMap::reduce() const {
  PairCurves curves;
  curves.along = curves.across = middles_of_bins(bins_, width_, -shape_.range);
  const double per_area = partners_ / shape_.box.area();
  for (std::size_t row = 0; row < bins_; ++row) {
    for (std::size_t column = 0; column < bins_; ++column) {
      // the other way round: (n - 1 - row, n - 1 - column)
      const std::size_t bin = row * bins_ + column, mirrored = bins_ * bins_ - 1 - bin;
      const double far =
          std::hypot(std::abs(curves.across[row]) + width_ / 2, std::abs(curves.along[column]) + width_ / 2);
      const bool known = far <= shape_.box.shorter() / 2;
      const auto pairs = static_cast<double>(map_.pairs[bin] + map_.pairs[mirrored]);
      curves.g.push_back(known ? mean_of(pairs, 2 * per_area * width_ * width_) : kNaN);
      curves.g2.push_back(known ? mean_of(map_.sums[bin] + map_.sums[mirrored], pairs) : kNaN);
    }
  }
  const std::vector<double> partners_along = partners_in(cut_along_), partners_across = partners_in(cut_across_);
  const auto expected = [&](double partners) {
    return partners / shape_.box.area() * 2 * width_ * shape_.strip;  // both sides of 0
  };
  curves.r = middles_of_bins(cut_along_.pairs.size(), width_);
  for (std::size_t bin = 0; bin < curves.r.size(); ++bin) {
    const auto along = static_cast<double>(cut_along_.pairs[bin]), across = static_cast<double>(cut_across_.pairs[bin]);
    curves.g_along.push_back(mean_of(along, expected(partners_along[bin])));
    curves.g_across.push_back(mean_of(across, expected(partners_across[bin])));
    curves.g2_along.push_back(mean_of(cut_along_.sums[bin], along));
    curves.g2_across.push_back(mean_of(cut_across_.sums[bin], across));
  }
  return curves;
}

}  // namespace shaken::analysis
