#include "analysis/geometry/segment_distance.h"

#include <algorithm>

namespace shaken::analysis {
namespace {

/// The share of a segment at which it is nearest to a point, which `offset` leads to from its beginning.
double nearest_share(const Vec3& along, const Vec3& offset) {
  const double square = along.squaredNorm();
  return square > 0 ? std::clamp(along.dot(offset) / square, 0.0, 1.0) : 0.0;
}

}  // namespace

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
