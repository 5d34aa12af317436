#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/errors/summed.h"
#include "analysis/lags/lag_curve.h"

namespace shaken::analysis {

/// A lag and the time from one origin to the next, both in sampling intervals.
struct SampledLag {
  std::int64_t lag = 0;
  std::int64_t spacing = 1;
};

/// Sums over pairs of samples, by lag, kept in at most 64 stretches of origin time, so that the steady part can be
/// reduced when its beginning is known only at the end, and that errors can be taken from the scatter of the stretches.
/// When they are used up, neighbours are joined and new ones are twice as long.
class LagSums : public Saved<LagSums> {
 public:
  /// `lags` rising.
  LagSums(std::vector<SampledLag> lags, std::size_t quantities);

  /// What a pair of samples at lag number `lag` gave, the earlier one being sample number `origin`: `rods` that
  /// counted, and `sums` (quantities) over them.
  void add(std::int64_t origin, std::size_t lag, double rods, std::span<const double> sums);

  /// Means over the origins of the stretches that begin at `t_steady` [s] or later, where sample i was taken at `start`
  /// + i `interval` [s]. Lags without any rod are left out.
  LagCurve after(double t_steady, double start, double interval) const;

  static constexpr const char* kName = "LagSums";
  static auto fields(auto& self) {
    return listed(Setting{"number of lags", self.lags_.size()}, Setting{"number of sums", self.quantities_},
                  self.samples_per_stretch_, Length{self.stretches_, self.empty()}, self.stretches_);
  }
  bool is_sound() const { return samples_per_stretch_ >= 1 && stretches_.size() <= kMaxStretches; }

 private:
  static constexpr std::size_t kMaxStretches = 64;
  struct Stretch : Summed<Stretch> {
    std::vector<std::int64_t> pairs;  // (lags)
    std::vector<double> rods;         // (lags)
    std::vector<double> sums;         // (quantities * lags), quantity by quantity
    static auto fields(auto& self) { return listed(self.pairs, self.rods, self.sums); }
  };
  Stretch empty() const;
  void join_neighbours();

  std::vector<SampledLag> lags_;
  std::size_t quantities_;
  std::int64_t samples_per_stretch_ = 1;
  std::vector<Stretch> stretches_;  // stretch s holds the origins [s, s + 1) * samples_per_stretch_
};

}  // namespace shaken::analysis
