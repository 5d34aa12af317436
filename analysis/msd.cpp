// SPDX-License-Identifier: MIT
#include "analysis/msd.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "analysis/order.h"
#include "sim/core/check.h"

namespace shaken::analysis {

MeanSquareDisplacement::MeanSquareDisplacement(double interval, int n_levels)
    : interval_(interval),
      levels_(static_cast<std::size_t>(std::clamp(n_levels, 0, 48))),
      along_(levels_.size() * kFrames),
      across_(levels_.size() * kFrames),
      origins_(levels_.size() * kFrames) {
  SHAKEN_CHECK(interval > 0.0, "samples must follow each other");
  SHAKEN_CHECK(n_levels >= 1 && n_levels <= 48, "between 1 and 48 levels");
}

void MeanSquareDisplacement::accumulate(std::span<const Vec3> unwrapped, std::span<const Vec3> directors) {
  SHAKEN_CHECK(unwrapped.size() == directors.size(), "one position for each director");
  std::vector<double> x(unwrapped.size()), y(unwrapped.size());
  for (std::size_t i = 0; i < unwrapped.size(); ++i) {
    x[i] = unwrapped[i].x();
    y[i] = unwrapped[i].y();
  }
  SHAKEN_CHECK(calls_ == 0 || x.size() == n_rods(), "the number of rods must not change");
  const double director = nematic_order(directors).director;
  for (std::size_t k = 0; k < levels_.size() && calls_ % (std::int64_t{1} << k) == 0; ++k) add(k, x, y, director);
  ++calls_;
}

void MeanSquareDisplacement::add(std::size_t k, const std::vector<double>& x, const std::vector<double>& y,
                                 double director) {
  Level& level = levels_[k];
  const std::int64_t last_lag = std::min<std::int64_t>(level.n_frames, kFrames);
  for (std::int64_t lag = k == 0 ? 1 : kFrames / 2 + 1; lag <= last_lag; ++lag) {
    const Frame& origin = level.frames[static_cast<std::size_t>((level.n_frames - lag) % kFrames)];
    double xx = 0, xy = 0, yy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double dx = x[i] - origin.x[i];
      const double dy = y[i] - origin.y[i];
      xx += dx * dx;
      xy += dx * dy;
      yy += dy * dy;
    }
    const double n = std::max<double>(1.0, static_cast<double>(x.size()));
    const double c = std::cos(origin.director);
    const double s = std::sin(origin.director);
    const std::size_t place = k * kFrames + static_cast<std::size_t>(lag - 1);
    along_[place] += (c * c * xx + 2 * c * s * xy + s * s * yy) / n;
    across_[place] += (s * s * xx - 2 * c * s * xy + c * c * yy) / n;
    ++origins_[place];
  }
  const auto place = static_cast<std::size_t>(level.n_frames % kFrames);
  if (level.frames.size() <= place) level.frames.emplace_back();
  level.frames[place] = {x, y, director};
  ++level.n_frames;
}

MsdCurve MeanSquareDisplacement::reduce() const {
  MsdCurve curve;
  for (std::size_t place = 0; place < origins_.size(); ++place) {
    if (origins_[place] == 0) continue;
    const auto samples = static_cast<double>((place % kFrames + 1) << (place / kFrames));
    const auto origins = static_cast<double>(origins_[place]);
    curve.lag.push_back(samples * interval_);
    curve.along.push_back(along_[place] / origins);
    curve.across.push_back(across_[place] / origins);
    curve.total.push_back((along_[place] + across_[place]) / origins);
  }
  return curve;
}

void MeanSquareDisplacement::reset() { *this = MeanSquareDisplacement(interval_, static_cast<int>(levels_.size())); }

void MeanSquareDisplacement::save(StateWriter& writer) const {
  writer.tag("MeanSquareDisplacement");
  writer.put(interval_);
  writer.put(along_);
  writer.put(across_);
  writer.put(origins_);
  writer.put(calls_);
  writer.put(static_cast<std::int64_t>(n_rods()));
  for (const Level& level : levels_) {
    writer.put(level.n_frames);
    for (const Frame& frame : level.frames) {
      writer.put(frame.x);
      writer.put(frame.y);
      writer.put(frame.director);
    }
  }
}

void MeanSquareDisplacement::restore(StateReader& reader) {
  reader.tag("MeanSquareDisplacement");
  if (reader.real() != interval_) throw StateError("saved analysis state: MeanSquareDisplacement of another interval");
  MeanSquareDisplacement saved(interval_, static_cast<int>(levels_.size()));
  saved.along_ = reader.reals(along_.size());
  saved.across_ = reader.reals(across_.size());
  saved.origins_ = reader.integers(origins_.size());
  saved.calls_ = reader.integer(0, std::numeric_limits<std::int64_t>::max() / 2);
  const auto n_rods = static_cast<std::size_t>(reader.integer());
  for (std::size_t k = 0; k < levels_.size(); ++k) {
    Level& level = saved.levels_[k];
    const std::int64_t n_frames = (saved.calls_ + (std::int64_t{1} << k) - 1) >> k;  // of every 2^k-th call
    level.n_frames = reader.integer(n_frames, n_frames);
    level.frames.resize(static_cast<std::size_t>(std::min<std::int64_t>(level.n_frames, kFrames)));
    for (Frame& frame : level.frames) {
      frame.x = reader.reals(n_rods);
      frame.y = reader.reals(n_rods);
      frame.director = reader.real();
    }
  }
  *this = std::move(saved);
}

}  // namespace shaken::analysis
