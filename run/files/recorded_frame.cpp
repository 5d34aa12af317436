#include "run/files/recorded_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace shaken::run {
namespace {

/// The shortest rotation that turns z into the unit vector n, as (w, x, y, z); about x for n = -z.
std::array<double, 4> quaternion_of_director(const Vec3& n) {
  const double across2 = n.x() * n.x() + n.y() * n.y();
  // 1 + n_z without cancellation near n = -z.
  const double w2 = n.z() > 0 ? 1.0 + n.z() : across2 / (1.0 - n.z());
  const double norm = std::sqrt(w2 * w2 + across2);
  if (norm == 0) return {0, 1, 0, 0};
  return {w2 / norm, -n.y() / norm, n.x() / norm, 0.0};
}

/// Where a quaternion, of any length but 0, turns z.
Vec3 director_of_quaternion(const std::array<double, 4>& q) {
  const auto [w, x, y, z] = q;
  return Vec3(2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z).normalized();
}

/// Rounds to float without leaving [0, side): 83.7299999999 must not become 83.73.
float wrapped_float(double x, double side) {
  auto rounded = static_cast<float>(x);
  while (rounded > 0 && static_cast<double>(rounded) >= side) rounded = std::nextafterf(rounded, 0.0F);
  return rounded;
}

}  // namespace

RecordedFrame record(const Snapshot& snapshot) {
  const std::size_t n_rods = std::max(snapshot.n_tracks, snapshot.n_rods());
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  RecordedFrame frame{snapshot.tick,
                      snapshot.time,
                      std::vector(3 * n_rods, kNone),
                      std::vector(3 * n_rods, kNone),
                      std::vector(4 * n_rods, kNone),
                      std::vector<std::int32_t>(3 * n_rods)};
  for (std::size_t i = 0; i < snapshot.n_rods(); ++i) {
    const std::size_t row = snapshot.track_of(i);
    const Vec3 &x = snapshot.position[i], &v = snapshot.velocity[i];
    const std::array<double, 4> turn = quaternion_of_director(snapshot.director[i]);
    const std::array<float, 3> at{wrapped_float(x.x(), snapshot.box.x()), wrapped_float(x.y(), snapshot.box.y()),
                                  static_cast<float>(x.z())};
    for (std::size_t k = 0; k < 3; ++k) {
      frame.position[3 * row + k] = at[k];
      frame.velocity[3 * row + k] = static_cast<float>(v[static_cast<Eigen::Index>(k)]);
    }
    for (std::size_t k = 0; k < 4; ++k) frame.orientation[4 * row + k] = static_cast<float>(turn[k]);
    for (std::size_t k = 0; k < 2; ++k) frame.image[3 * row + k] = snapshot.image[i][k];
  }
  return frame;
}

Result<Snapshot> decode(const RecordedFrame& recorded, const Box& box, bool were_tracked) {
  constexpr double kMost = 1e9;  // heights without a base, and speeds [mm], [mm/s]
  const auto wrong = [](const char* what, std::size_t rod, double value) {
    return Error{fmt::format("the {} of rod {} is {:g}: the file is damaged", what, rod, value)};
  };
  if (!std::isfinite(recorded.time)) return Error{fmt::format("the time is {:g}: the file is damaged", recorded.time)};
  Snapshot frame;
  frame.box = box;
  frame.tick = recorded.tick;
  frame.time = recorded.time;
  const auto &x = recorded.position, &v = recorded.velocity, &q = recorded.orientation;
  for (std::size_t i = 0; 3 * i < x.size(); ++i) {
    const auto is_none = [](float number) { return std::isnan(number); };
    if (were_tracked && std::all_of(&x[3 * i], &x[3 * i] + 3, is_none) &&
        std::all_of(&v[3 * i], &v[3 * i] + 3, is_none) && std::all_of(&q[4 * i], &q[4 * i] + 4, is_none)) {
      continue;
    }
    if (were_tracked) frame.track.push_back(static_cast<std::uint32_t>(i));
    const std::array<double, 4> turn{q[4 * i], q[4 * i + 1], q[4 * i + 2], q[4 * i + 3]};
    const double norm2 = turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2] + turn[3] * turn[3];
    if (!(std::abs(norm2 - 1) < 1e-3)) {
      return Error{"the orientation of rod " + std::to_string(i) + " is not of unit length"};
    }
    // A box to either side leaves room for rounding, and for files that count from its middle; false for NaN.
    for (std::size_t k = 0; k < 2; ++k) {
      if (!(std::abs(x[3 * i + k]) <= 2 * box[static_cast<Eigen::Index>(k)])) return wrong("position", i, x[3 * i + k]);
    }
    if (!(std::abs(x[3 * i + 2]) <= kMost)) return wrong("height", i, x[3 * i + 2]);
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(std::abs(v[3 * i + k]) <= kMost)) return wrong("velocity", i, v[3 * i + k]);
    }
    frame.position.emplace_back(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
    frame.velocity.emplace_back(v[3 * i], v[3 * i + 1], v[3 * i + 2]);
    frame.director.push_back(director_of_quaternion(turn));
    frame.image.push_back({recorded.image[3 * i], recorded.image[3 * i + 1]});
  }
  if (were_tracked) frame.n_tracks = x.size() / 3;
  return frame;
}

}  // namespace shaken::run
