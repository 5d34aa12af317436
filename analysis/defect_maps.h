#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/defects.h"
#include "analysis/errors/blocked.h"
#include "analysis/errors/summed.h"
#include "analysis/geometry/region.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// What is about defects of one charge, in their frame. Maps are (bins, bins), y' slowest; NaN where nothing is known.
struct DefectMap {
  double defects = 0;            ///< that the maps are means over
  std::vector<double> density;   ///< number density of rods over its mean in the region
  std::vector<double> cos2;      ///< mean of cos 2 (theta - psi), psi being the angle of the x' axis
  std::vector<double> sin2;      ///< mean of sin 2 (theta - psi)
  std::vector<double> v_along;   ///< mean velocity of rods along x' [mm/s]
  std::vector<double> v_across;  ///< along y' [mm/s]
  std::vector<double> tilt2;     ///< mean of n_z^2
  double core_density = 0;       ///< density of rods nearer to the defect than the core's radius, over the mean
  double core_along = 0;         ///< mean velocity of these along x' [mm/s]
  double core_across = 0;        ///< along y' [mm/s]
};

/// Rods about one defect at the origin of a frame whose x' axis is the defect's own (Defect::direction): of +1/2 the
/// ray along which the director is radial, which is its polarity div Q / |div Q|, from the comet's head to its tail
/// (Vromans & Giomi, Soft Matter 12, 6490 (2016), eq. 5; Tang & Selinger, Soft Matter 13, 5481 (2017)); of -1/2 each of
/// its three such rays in turn, so that its maps have that symmetry but for the shape of the bins. There is no mirror
/// symmetry but that of the rods: y' -> -y' is a measurement. Velocities are those in the plane at rest; nothing is
/// subtracted. Maps are discs of radius `range`: a bin that reaches beyond is unknown. Where walls stand, what of a bin
/// lies in the region, and in sight of the defect, is counted at 4 x 4 places in it.
class DefectMapSums : public Summed<DefectMapSums> {
 public:
  struct Shape {
    int bins = 31;  ///< each way; an odd number has one about 0
    double range;   ///< [mm]; at most half of a side along which the region is periodic
    double core;    ///< radius of the core, at most the range [mm]
    friend bool operator==(const Shape&, const Shape&) = default;
    static auto fields(auto& self) { return listed(self.range, self.core); }
  };
  /// Rods at one instant; all of the same length (n_rods).
  struct Rods {
    std::vector<double> x, y;        ///< in the box [mm]
    std::vector<double> cos2, sin2;  ///< of twice the angle in the plane; both 0 of a rod exactly upright
    std::vector<double> n_z;
    static auto fields(auto& self) { return listed(Growing{self.x, self.y, self.cos2, self.sin2, self.n_z}); }
  };

  explicit DefectMapSums(const Shape& shape);

  /// With the velocities of the rods in the plane (n_rods) [mm/s]; defects other than +-1/2 do not count.
  void accumulate(const Rods& rods, std::span<const Vec2> velocities, std::span<const Defect> defects,
                  const Region& region);
  std::vector<double> centres() const;  ///< (bins) of the bins along either axis [mm]
  std::int64_t samples() const { return samples_; }
  DefectMap plus() const { return reduced(plus_, 1); }
  DefectMap minus() const { return reduced(minus_, 3); }

  static constexpr const char* kName = "DefectMapSums";
  static auto fields(auto& self) {
    return listed(Setting{"shape", self.shape_}, self.samples_, self.plus_, self.minus_);
  }

 private:
  struct Sums {
    std::int64_t frames = 0;  // a defect of -1/2 has three
    std::vector<std::int64_t> rods;
    std::vector<double> expected, cos2, sin2, along, across, tilt2;
    std::int64_t core_rods = 0;
    double core_expected = 0, core_along = 0, core_across = 0;
    explicit Sums(std::size_t n) : rods(n), expected(n), cos2(n), sin2(n), along(n), across(n), tilt2(n) {}
    static auto fields(auto& self) {
      return listed(self.frames, self.rods, self.expected, self.cos2, self.sin2, self.along, self.across, self.tilt2,
                    self.core_rods, self.core_expected, self.core_along, self.core_across);
    }
  };
  void add_frame(Sums& sums, const Rods& rods, std::span<const Vec2> velocities, const Vec2& origin, double psi,
                 const Region& region) const;
  DefectMap reduced(const Sums& sums, int frames_of_each) const;

  Shape shape_;
  std::size_t bins_;  // each way
  double width_;      // of a bin [mm]
  std::int64_t samples_ = 0;
  Sums plus_, minus_;
};

/// Defects at least `separation` from all others, of any charge.
std::vector<Defect> lone_defects(std::span<const Defect> defects, double separation, const Region& region);

/// Maps about defects, with velocities that are displacements from the sample before to the one after, over the time
/// between: twice the interval of the samples, about the instant at which the defects and the places are taken.
class DefectMaps : public Saved<DefectMaps> {
 public:
  explicit DefectMaps(const DefectMapSums::Shape& shape) : sums_(DefectMapSums(shape)) {}

  /// At `time` [s], later than all before: centres in the box and unwrapped [mm], and directors (n_rods, the same in
  /// every call), and the defects to be mapped.
  void accumulate(double time, std::span<const Vec3> positions, std::span<const Vec3> unwrapped,
                  std::span<const Vec3> directors, std::span<const Defect> defects, const Region& region);
  /// By the time of the sample in the middle.
  const Blocked<DefectMapSums>& sums() const { return sums_; }

  static constexpr const char* kName = "DefectMaps";
  static auto fields(auto& self) {
    return listed(Length{self.places_}, self.n_rods_, self.places_, self.rods_, Length{self.defects_, Defect(), 4},
                  self.defects_, self.sums_);
  }
  bool is_sound() const {
    const auto of_all_rods = [&](const auto& each) { return each.x.size() == n_rods_; };
    return places_.size() <= 2 && std::ranges::all_of(places_, of_all_rods) && of_all_rods(rods_);
  }

 private:
  /// Unwrapped centres.
  struct Places {
    double time = 0;
    std::vector<double> x, y;
    static auto fields(auto& self) { return listed(self.time, Growing{self.x, self.y}); }
  };
  std::vector<Places> places_;  // at most two: the sample before, and that in the middle
  // of that in the middle
  std::size_t n_rods_ = 0;
  DefectMapSums::Rods rods_;
  std::vector<Defect> defects_;
  Blocked<DefectMapSums> sums_;
};

}  // namespace shaken::analysis
