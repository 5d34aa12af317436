#include "proto/frame_codec.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "proto/sequence.h"

namespace shaken::proto {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSteps = 65536;      // of a full turn of a periodic quantity
constexpr double kLargestNz = 32767;  // stands for 1

/// Rounds to int16 on a circle of 65536 steps.
std::int16_t wrap(double steps) {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(std::llround(steps) & 0xffff));
}

/// A chunk that says what its arrays and its place in the frame can bear out.
bool plausible(const frame_t& chunk) {
  const auto n = static_cast<std::size_t>(std::max(chunk.n_chunk_rods, 0));
  return chunk.n_chunks > 0 && chunk.n_chunks <= kMostChunks && chunk.chunk >= 0 && chunk.chunk < chunk.n_chunks &&
         chunk.first_rod >= 0 && chunk.n_chunk_rods >= 0 && chunk.x.size() == n && chunk.y.size() == n &&
         chunk.heading.size() == n && chunk.n_z.size() == n;
}

/// Frames that may come late, one behind the other, after a newer one.
constexpr int kMostOlder = 5;

bool siblings(const frame_t& a, const frame_t& b) {
  return a.n_rods == b.n_rods && a.n_chunks == b.n_chunks && a.tick == b.tick && a.box_x_mm == b.box_x_mm &&
         a.box_y_mm == b.box_y_mm;
}

}  // namespace

std::array<double, 3> RodPose::axis() const {
  const double horizontal = std::sqrt(std::max(0.0, 1.0 - n_z * n_z));
  return {horizontal * std::cos(theta), horizontal * std::sin(theta), n_z};
}

RodPose make_pose(double x, double y, const std::array<double, 3>& axis) {
  return {x, y, std::atan2(axis[1], axis[0]), axis[2]};
}

std::vector<frame_t> encode_frame(const Frame& frame) {
  const int n_rods = static_cast<int>(frame.rods.size());
  const int n_chunks = std::max(1, (n_rods + kRodsPerChunk - 1) / kRodsPerChunk);
  std::vector<frame_t> chunks;
  for (int i_chunk = 0; i_chunk < n_chunks; ++i_chunk) {
    frame_t chunk;
    chunk.utime = frame.utime;
    chunk.sequence = frame.sequence;
    chunk.job_id = frame.job_id;
    chunk.sim_time_s = frame.sim_time_s;
    chunk.tick = frame.tick;
    chunk.box_x_mm = frame.box.x();
    chunk.box_y_mm = frame.box.y();
    chunk.order = frame.order;
    chunk.director_rad = frame.director_rad;
    chunk.n_rods = n_rods;
    chunk.chunk = i_chunk;
    chunk.n_chunks = n_chunks;
    chunk.first_rod = i_chunk * kRodsPerChunk;
    chunk.n_chunk_rods = std::min(kRodsPerChunk, n_rods - chunk.first_rod);
    for (int i = chunk.first_rod; i < chunk.first_rod + chunk.n_chunk_rods; ++i) {
      const RodPose& rod = frame.rods[static_cast<std::size_t>(i)];
      chunk.x.push_back(wrap((rod.x / frame.box.x() - 0.5) * kSteps));
      chunk.y.push_back(wrap((rod.y / frame.box.y() - 0.5) * kSteps));
      chunk.heading.push_back(wrap(rod.theta * kSteps / (2 * kPi)));
      chunk.n_z.push_back(static_cast<std::int16_t>(std::lround(std::clamp(rod.n_z, -1.0, 1.0) * kLargestNz)));
    }
    chunks.push_back(std::move(chunk));
  }
  return chunks;
}

std::vector<RodPose> decode_chunk(const frame_t& chunk) {
  std::vector<RodPose> rods;
  rods.reserve(chunk.x.size());
  for (std::size_t i = 0; i < chunk.x.size(); ++i) {
    rods.push_back({(chunk.x[i] / kSteps + 0.5) * chunk.box_x_mm, (chunk.y[i] / kSteps + 0.5) * chunk.box_y_mm,
                    chunk.heading[i] * 2 * kPi / kSteps, std::max(-1.0, chunk.n_z[i] / kLargestNz)});
  }
  return rods;
}

std::optional<Frame> FrameAssembler::add(const frame_t& chunk) {
  if (chunk.job_id != job_id_ || !plausible(chunk)) return std::nullopt;
  bool newer = chunk.sequence > newest_ || chunk.utime > newest_utime_;
  if (!newer && chunk.sequence < newest_) {
    if (n_older_ == 0 || chunk.sequence != older_) ++n_older_;
    older_ = chunk.sequence;
    newer = n_older_ > kMostOlder;
  }
  if (newer) {
    n_older_ = 0;
    chunks_.clear();
    newest_ = chunk.sequence;
    newest_utime_ = chunk.utime;
  } else if (chunk.sequence < newest_ || chunk.sequence == completed_) {
    return std::nullopt;
  }
  if (!chunks_.empty() && !siblings(chunk, chunks_.begin()->second)) return std::nullopt;
  chunks_.emplace(chunk.chunk, chunk);
  if (static_cast<std::int32_t>(chunks_.size()) < chunk.n_chunks) return std::nullopt;

  Frame frame{chunk.utime,      chunk.sequence,     chunk.job_id,
              chunk.sim_time_s, chunk.tick,         {chunk.box_x_mm, chunk.box_y_mm},
              chunk.order,      chunk.director_rad, {}};
  bool in_sequence = true;
  for (const auto& [number, part] : chunks_) {
    in_sequence = in_sequence && static_cast<std::size_t>(part.first_rod) == frame.rods.size();
    const auto rods = decode_chunk(part);
    frame.rods.insert(frame.rods.end(), rods.begin(), rods.end());
  }
  chunks_.clear();
  if (!in_sequence || frame.rods.size() != static_cast<std::size_t>(std::max(chunk.n_rods, 0))) return std::nullopt;
  lost_ += n_lost_between(completed_, chunk.sequence);
  completed_ = chunk.sequence;
  return frame;
}

}  // namespace shaken::proto
