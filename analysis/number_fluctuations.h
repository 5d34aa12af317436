#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "analysis/errors/blocked.h"
#include "analysis/errors/jackknife.h"
#include "analysis/errors/summed.h"
#include "base/core/box.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// Numbers of rods in square boxes; all of shape (box sizes), from large boxes to small.
struct NumberFluctuationCurve {
  std::vector<double> area_fraction;  ///< of a box
  std::vector<double> mean_n;         ///< <N>
  std::vector<Estimate> std_n;        ///< over boxes and time
  /// Over time about each box's own mean, so that a density map that stands still does not count.
  std::vector<Estimate> std_n_without_map;
  /// x of std ~ <N>^x: 1/2 for rods that do not know of each other, less for an even spacing, up to 1 for giant
  /// fluctuations (Narayan, Ramaswamy & Menon, Science 317, 105 (2007)).
  Estimate exponent, exponent_without_map;
  /// Sizes of boxes that the exponents are fitted to; fewer than three are none.
  std::size_t fitted = 0;
};

/// Giant number fluctuations: the periodic box is cut into m x m boxes of its shape, m = 2, 3, 4, 5, 6, 8, 10, 12, 16,
/// 20, and the centres in each are counted. A sample costs ten divisions a rod; the memory is 17 kB whatever the number
/// of samples.
class NumberFluctuations : public Summed<NumberFluctuations> {
 public:
  /// Exponents are fitted to so many sizes of boxes at least.
  static constexpr std::size_t kMinSizes = 3;

  /// `counts(centre, sides)` says whether a box counts: only those wholly inside of walls should. Without it all do.
  /// `area` is that of the arena [mm^2], the box's without walls. Exponents are fitted to boxes whose shorter side is
  /// `fit_from` [mm] or more: two rod lengths, as what is smaller counts single rods and their perimeters, not density.
  using Where = std::function<bool(const Vec2& centre, const Vec2& sides)>;
  NumberFluctuations(const Box& box, double area, double fit_from, const Where& counts = {});

  /// Centres (n_rods) [mm], in the box or one of its images; not finite ones are left out.
  void accumulate(std::span<const Vec3> positions);

  /// With errors from the stretches of `blocks` from `t_steady` [s] on. Both spreads are of the counts as they are:
  /// n rods thrown at random, their number given, have std = sqrt(<N> (1 - f)) in boxes of area fraction f. The
  /// exponents are of std / sqrt(1 - f), which takes that out (the sum rule of a fixed number, exact for any density
  /// whose correlations are short against the box), fitted to log std against log <N> over boxes of a side of at least
  /// fit_from and f <= 25 %, each size with the number of its boxes as weight; NaN where these are fewer than three
  /// sizes, which takes a box of eight rod lengths. The spread about each box's own mean is unbiased, n / (n - 1), for
  /// independent samples; it is too small by a factor 1 - tau / T if the run T is not long against the time tau that a
  /// box's density needs to forget. Sizes of which no box counts are left out; NaN where there is no spread to tell of.
  static NumberFluctuationCurve reduce(const Blocked<NumberFluctuations>& blocks, double t_steady);

  static constexpr const char* kName = "NumberFluctuations";
  static auto fields(auto& self) { return listed(Setting{"box", self.box_}, self.samples_, self.sums_, self.squares_); }

 private:
  struct Size {
    int divisions;
    double area_fraction;
    std::vector<std::int32_t> place;  // (divisions^2) index of the box among those that count, or -1
    std::size_t first, n_boxes;       // where its boxes lie in sums_
  };
  struct Moments {
    double mean, variance, variance_without_map;
  };
  Moments moments(const Size& size) const;
  bool is_fitted(const Size& size) const;
  std::vector<double> numbers() const;

  Box box_;
  double fit_from_;
  std::vector<Size> sizes_;
  std::int64_t samples_ = 0;
  std::vector<std::int64_t> sums_, squares_;  // (boxes that count) of N and N^2 over the samples
};

}  // namespace shaken::analysis
