#include "analysis/clusters.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <numeric>

#include "analysis/geometry/periodic.h"
#include "base/core/check.h"

namespace shaken::analysis {
namespace {

/// Sets of rods that grow together (Galler & Fischer, Commun. ACM 7, 301 (1964)).
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parent_(n), size_(n, 1) { std::iota(parent_.begin(), parent_.end(), 0); }
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t i, std::size_t j) {
    i = root(i), j = root(j);
    if (i == j) return;
    if (size_[i] < size_[j]) std::swap(i, j);
    parent_[j] = i;
    size_[i] += size_[j];
  }
  /// The size of each set, the largest first.
  std::vector<std::size_t> sizes() const {
    std::vector<std::size_t> sizes;
    for (std::size_t i = 0; i < parent_.size(); ++i) {
      if (parent_[i] == i) sizes.push_back(size_[i]);
    }
    std::ranges::sort(sizes, std::greater());
    return sizes;
  }

 private:
  std::vector<std::size_t> parent_, size_;
};

/// Rods by the square of a mesh that their centre is in. Centres nearer than the mesh's width are in the same square or
/// in neighbouring ones, across the border of the box too.
class Mesh {
 public:
  Mesh(std::span<const Vec3> positions, const Box& box, double least_width)
      : columns_(squares(box.x() / least_width, static_cast<double>(positions.size()) * box.x() / box.y())),
        rows_(squares(box.y() / least_width, static_cast<double>(positions.size()) * box.y() / box.x())),
        rods_(columns_ * rows_) {
    const auto place = [](double x, double side, std::size_t n) {
      return std::min(static_cast<std::size_t>(wrapped(x, side) / side * static_cast<double>(n)), n - 1);
    };
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const std::size_t column = place(positions[i].x(), box.x(), columns_);
      rods_[place(positions[i].y(), box.y(), rows_) * columns_ + column].push_back(i);
    }
  }
  /// visit(i, j) for all pairs in the same or neighbouring squares, some of them more than once.
  template <class Visit>
  void for_pairs(Visit visit) const {
    for (std::size_t row = 0; row < rows_; ++row) {
      for (std::size_t column = 0; column < columns_; ++column) {
        const std::vector<std::size_t>& here = rods_[row * columns_ + column];
        for (std::size_t k = 0; k < here.size(); ++k) {
          for (std::size_t l = 0; l < k; ++l) visit(here[k], here[l]);
        }
        const std::size_t above = (row + 1) % rows_, right = (column + 1) % columns_;
        const std::size_t left = (column + columns_ - 1) % columns_;
        for (const std::size_t other :
             {row * columns_ + right, above * columns_ + left, above * columns_ + column, above * columns_ + right}) {
          for (const std::size_t i : here) {
            for (const std::size_t j : rods_[other]) visit(i, j);
          }
        }
      }
    }
  }

 private:
  /// Along a side: as narrow as may be, but no more squares in all than rods.
  static std::size_t squares(double most, double most_squared) {
    return static_cast<std::size_t>(std::max(1.0, std::floor(std::min(most, std::sqrt(most_squared)))));
  }

  std::size_t columns_, rows_;                  // of squares
  std::vector<std::vector<std::size_t>> rods_;  // of each square, row by row
};

/// The share of a segment at which it is nearest to a point, which `offset` leads to from its beginning.
double nearest_share(const Vec3& along, const Vec3& offset) {
  const double square = along.squaredNorm();
  return square > 0 ? std::clamp(along.dot(offset) / square, 0.0, 1.0) : 0.0;
}

}  // namespace

std::vector<std::size_t> cluster_sizes(std::span<const Vec3> positions, std::span<const Vec3> directors,
                                       std::span<const RodAxis> axes, const Region& region, const ClusterRule& rule) {
  SHAKEN_CHECK(positions.size() == directors.size(), "one position for each director");
  SHAKEN_CHECK(axes.size() == 1 || axes.size() == directors.size(), "one axis, or that of each rod");
  SHAKEN_CHECK(rule.distance > 0, "neighbours are nearer than some distance");
  double farthest = 0;
  for (const RodAxis& axis : axes) farthest = std::max({farthest, axis.tail, axis.head});
  const double reach = 2 * farthest + rule.distance;
  const auto axis_of = [&](std::size_t i) { return axes[axes.size() == 1 ? 0 : i]; };
  const double least_cosine = rule.angle < kPi / 2 ? std::cos(rule.angle) : 0.0;
  DisjointSets sets(positions.size());
  const Mesh mesh(positions, region.box(), reach);
  mesh.for_pairs([&](std::size_t i, std::size_t j) {
    const Vec3& n = directors[i];
    const Vec3& m = directors[j];
    if (i == j || std::abs(n.dot(m)) < least_cosine) return;
    const Vec3 way = positions[j] - positions[i];
    const Vec2 in_plane = region.shortest({way.x(), way.y()});
    const Vec3 apart(in_plane.x(), in_plane.y(), way.z());
    if (apart.squaredNorm() >= reach * reach) return;
    const RodAxis one = axis_of(i), other = axis_of(j);
    if (segment_distance(-one.tail * n, (one.tail + one.head) * n, apart - other.tail * m,
                         (other.tail + other.head) * m) < rule.distance) {
      sets.join(i, j);
    }
  });
  return sets.sizes();
}

namespace {

double mean_over_rods(const std::vector<std::size_t>& sizes) {
  double rods = 0, squares = 0;
  for (const std::size_t size : sizes) {
    rods += static_cast<double>(size);
    squares += static_cast<double>(size) * static_cast<double>(size);
  }
  return squares / rods;
}

double share_of_largest(const std::vector<std::size_t>& sizes) {
  return static_cast<double>(sizes.front()) /
         static_cast<double>(std::accumulate(sizes.begin(), sizes.end(), std::size_t{0}));
}

}  // namespace

void ClusterStatistics::accumulate(const std::vector<std::size_t>& sizes) {
  if (sizes.empty()) return;
  ++samples_;
  largest_ += share_of_largest(sizes);
  for (const std::size_t size : sizes) {
    const auto rods = static_cast<double>(size);
    const std::size_t octave = std::min<std::size_t>(std::bit_width(size) - 1, kClusterOctaves - 1);
    rods_ += rods;
    squares_ += rods * rods;
    if (size == 1) alone_ += 1;
    clusters_of_[octave] += 1;
    rods_of_[octave] += rods;
  }
}

ClusterNumbers ClusterStatistics::reduce() const {
  ClusterNumbers numbers{largest_ / static_cast<double>(samples_), squares_ / rods_, alone_ / rods_, 0};
  for (std::size_t k = 0; k < kClusterOctaves; ++k) {
    numbers.per_rod += clusters_of_[k] / rods_;
    numbers.rods[k] = rods_of_[k] / rods_;
    numbers.density[k] = clusters_of_[k] / rods_ / std::exp2(k);
  }
  return numbers;
}

void ClusterSeries::accumulate(double time, const std::vector<std::size_t>& sizes) {
  if (!sizes.empty()) series_.accumulate(time, {share_of_largest(sizes), mean_over_rods(sizes)});
}

double segment_distance(const Vec3& a, const Vec3& along_a, const Vec3& b, const Vec3& along_b) {
  const Vec3 apart = a - b;
  const double aa = along_a.squaredNorm(), bb = along_b.squaredNorm(), ab = along_a.dot(along_b);
  const double determinant = aa * bb - ab * ab;
  // On the endless line through a the point nearest to that through b; of parallel lines any.
  double share_a = 0;
  if (determinant > 1e-14 * aa * bb) {
    share_a = std::clamp((ab * along_b.dot(apart) - bb * along_a.dot(apart)) / determinant, 0.0, 1.0);
  }
  const double share_b = nearest_share(along_b, apart + share_a * along_a);
  share_a = nearest_share(along_a, share_b * along_b - apart);
  return (apart + share_a * along_a - share_b * along_b).norm();
}

}  // namespace shaken::analysis
