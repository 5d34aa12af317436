#include "run/export/rod_angles.h"

#include <limits>

#include "analysis/angles.h"
#include "analysis/order.h"
#include "run/files/quaternion.h"

namespace shaken::run {

std::vector<float> rod_angles(const TrajectoryHeader& header, const RecordedFrame& frame) {
  const auto n_rods = static_cast<std::size_t>(header.n_rods);
  std::vector<float> angles(n_rods, std::numeric_limits<float>::quiet_NaN());
  if (!header.cell.has_axes()) return angles;
  std::vector<Vec3> directors;
  directors.reserve(n_rods);
  for (std::size_t i = 0; i < n_rods; ++i) {
    const float* q = &frame.orientation[4 * i];
    directors.push_back(director_of_quaternion({q[0], q[1], q[2], q[3]}));
  }
  const double axis = analysis::nematic_order(header.cell, directors).director;
  for (std::size_t i = 0; i < n_rods; ++i) {
    if (header.cell.beads_of(i).has_axis()) angles[i] = static_cast<float>(analysis::angle_to_axis(directors[i], axis));
  }
  return angles;
}

}  // namespace shaken::run
