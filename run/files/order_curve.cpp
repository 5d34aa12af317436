#include "run/files/order_curve.h"

#include <algorithm>
#include <system_error>

#include "analysis/order.h"
#include "run/files/observables_file.h"

namespace shaken::run {
namespace {

/// That much is read while somebody waits.
constexpr std::size_t kMostFrameBytes = 64'000'000;

}  // namespace

Result<OrderCurve> order_of_frames(const TrajectoryReader& frames, std::size_t most) {
  OrderCurve curve;
  const Cell& cell = frames.header().cell;
  const std::size_t n = frames.n_frames(), points = std::min(n, most);
  if (!cell.has_axes()) return curve;
  for (std::size_t k = 0; k < points; ++k) {
    const Snapshot frame = SHAKEN_TRY(frames.frame(points == 1 ? n - 1 : k * (n - 1) / (points - 1)));
    curve.times.push_back(frame.time);
    curve.orders.push_back(analysis::nematic_order(cell, frame.director).order);
  }
  return curve;
}

Result<OrderCurve> recorded_order(const RunDirectory& directory, std::size_t most) {
  std::error_code ignored;
  if (std::filesystem::exists(directory.recorded(), ignored)) {
    const TrajectoryReader frames = SHAKEN_TRY(TrajectoryReader::open(directory.recorded()));
    const std::size_t bytes = frame_bytes(static_cast<std::size_t>(frames.header().n_rods));
    return order_of_frames(frames, std::min(most, std::max<std::size_t>(2, kMostFrameBytes / bytes)));
  }
  Observables arrays = SHAKEN_TRY(read_observables(directory.observables()));
  return OrderCurve{std::move(arrays["/order/time_s"]), std::move(arrays["/order/order"])};
}

}  // namespace shaken::run
