#include "run/export/frames.h"

#include <fmt/format.h>

namespace shaken::run {
namespace {

/// The number of frames at the beginning of which `is_before` is true of the tick: frames come in the order of time.
template <class IsBefore>
Result<std::size_t> count_before(const TrajectoryReader& trajectory, IsBefore is_before) {
  std::size_t low = 0;
  std::size_t high = trajectory.n_frames();
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    const auto frame = trajectory.recorded().frame(middle);
    if (!frame) return frame.error();
    if (is_before(static_cast<double>(frame->tick))) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

}  // namespace

Result<FrameRange> find_frames(const TrajectoryReader& trajectory, const WantedFrames& wanted) {
  const double dt = trajectory.header().dt;
  FrameRange range{0, trajectory.n_frames(), wanted.every};
  if (range.end == 0) return Error{"no frame is recorded yet"};
  if (wanted.from) {
    const auto n = count_before(trajectory, [&](double tick) { return tick < *wanted.from / dt - 0.5; });
    if (!n) return n.error();
    range.first = *n;
  }
  if (wanted.to) {
    const auto n = count_before(trajectory, [&](double tick) { return tick <= *wanted.to / dt + 0.5; });
    if (!n) return n.error();
    range.end = *n;
  }
  if (range.size() == 0) {
    const auto first = trajectory.recorded().frame(0);
    const auto last = trajectory.recorded().frame(trajectory.n_frames() - 1);
    if (!first) return first.error();
    if (!last) return last.error();
    return Error{fmt::format("there is no such frame: the {} frames are from {:.6g} s to {:.6g} s",
                             trajectory.n_frames(), first->time, last->time)};
  }
  if (wanted.only_last) range.first = range.first + (range.size() - 1) * range.every;
  return range;
}

Result<std::size_t> export_frames(const TrajectoryReader& trajectory, const FrameRange& range, FrameFormat& format,
                                  const Sink& sink, const std::function<bool(std::size_t n_done)>& goes_on) {
  if (auto done = format.begin(sink); !done) return done.error();
  std::size_t n_done = 0;
  for (std::size_t i = range.first; i < range.end; i += range.every) {
    const auto frame = trajectory.recorded().frame(i);
    if (!frame) return frame.error();
    // whether every number is one that a rod can have
    if (const auto decoded = decode(*frame, trajectory.header().cell.box); !decoded) {
      return Error{fmt::format("{}: frame {}: {}", trajectory.path().string(), i, decoded.error().message)};
    }
    if (auto done = format.write(*frame, sink); !done) return done.error();
    if (!goes_on(++n_done)) break;
  }
  return n_done;
}

}  // namespace shaken::run
