#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/errors/summed.h"
#include "base/core/box.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// Maps of g and G2 over the displacement between two rods, and cuts through them. NaN stands for what is not known: a
/// bin without samples, one that reaches beyond half the box, and G2 where no pair was met.
struct PairCurves {
  std::vector<double> along;   ///< (bins) bin centres along the director [mm]
  std::vector<double> across;  ///< (bins) across it [mm]
  std::vector<double> g;   ///< (bins, bins) pair distribution, 1 in a gas however few rods there are; across slowest
  std::vector<double> g2;  ///< (bins, bins) mean of cos 2 (theta_i - theta_j)
  std::vector<double> r;   ///< (cut bins) bin centres [mm], up to half the longer side of the box
  std::vector<double> g_along, g_across;    ///< (cut bins) in a strip about each axis
  std::vector<double> g2_along, g2_across;  ///< (cut bins)
};

/// g(x, y) and G2(x, y) = <cos 2 (theta_i - theta_j)> over the displacement (x, y) of a pair in the frame of the
/// nematic director of its instant: x along the director, y across it. A pair counts with either rod as the first,
/// which makes the maps even in (x, y) -> (-x, -y); nothing else is symmetrised, so that g(x, y) = g(x, -y) is a
/// measurement. The displacement is that to the nearest periodic image. The box is not aligned with the director, so
/// that a map is unbiased within r < L / 2 of its shorter side only: bins that reach further are NaN. The cuts have
/// their own bins, as wide as those of the map: along from pairs with |y| < strip / 2 at |x|, across the other way
/// round. In a square box they end at L / 2. In a rectangle they end at half the longer side: a sample counts in those
/// bins that the nearest images fill whatever the director of that sample, so that a cut along the longer side is known
/// as far as that goes. One sample costs at most 1024 n_rods pairs: of more than 1024 rods, every k-th is taken as i,
/// another set each time. Rods exactly upright are left out.
class PairMap : public Summed<PairMap> {
 public:
  struct Shape {
    int bins = 81;  ///< each way; an odd number has one about 0
    double range;   ///< the map covers (-range, range) each way [mm]
    double strip;   ///< full width of the strips of the cuts [mm]
    Box box;
    friend bool operator==(const Shape&, const Shape&) = default;
    static auto fields(auto& self) { return listed(self.range, self.strip, self.box); }
  };
  explicit PairMap(const Shape& shape);

  /// Centres (n_rods) [mm] and directors (n_rods).
  void accumulate(std::span<const Vec3> positions, std::span<const Vec3> directors);
  /// Samples that others have taken before: whose turn it is as the first of a pair depends on it.
  void start_at(std::int64_t samples) { calls_ = samples; }
  PairCurves reduce() const;

  static constexpr const char* kName = "PairMap of n (n - 1) pairs";
  static auto fields(auto& self) {
    return listed(Setting{"shape", self.shape_}, Largest{self.calls_}, self.partners_, self.map_, self.cut_along_,
                  self.cut_across_);
  }

 private:
  struct Bins {
    std::vector<std::int64_t> pairs;
    std::vector<double> sums;  // of cos 2 (theta_i - theta_j); behind them, in a cut of a rectangle, the partners_ of
                               // samples in which a bin is the last that nearest images fill
    explicit Bins(std::size_t n, bool counts_partners = false) : pairs(n), sums(counts_partners ? 2 * n : n) {}
    static auto fields(auto& self) { return listed(self.pairs, self.sums); }
  };
  /// Bins of a cut in the direction `axis` that nearest images fill, all of them in a square box.
  std::size_t filled_bins(const Vec2& axis, const Bins& cut) const;
  /// (cut bins) partners_ of the samples that count in each bin of a cut.
  std::vector<double> partners_in(const Bins& cut) const;

  Shape shape_;
  std::size_t bins_;        // each way
  double width_;            // of a bin [mm]
  std::int64_t calls_ = 0;  // samples so far, those before start_at included
  double partners_ = 0;     // sum over references of how many rods can make pairs with them
  Bins map_, cut_along_, cut_across_;
};

}  // namespace shaken::analysis
