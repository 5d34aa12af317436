#include "sim/rod/species.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/core/check.h"

namespace shaken {
namespace {

/// Integrals over the profile R(x) of the beads' union.
struct ProfileIntegrals {
  double r1 = 0;    ///< of R
  double r2 = 0;    ///< of R^2
  double r4 = 0;    ///< of R^4
  double r2x = 0;   ///< of R^2 x
  double r2x2 = 0;  ///< of R^2 x^2
};

/// Integral of sqrt(r^2 - u^2) from 0 to u.
double half_disc(double r, double u) {
  const double c = std::clamp(u / r, -1.0, 1.0);
  return 0.5 * r * r * (c * std::sqrt(1.0 - c * c) + std::asin(c));
}

ProfileIntegrals integrate_profile(const std::vector<double>& offset, const std::vector<double>& radius) {
  const std::size_t n = offset.size();
  // between two neighbouring cuts one and the same bead is the outermost
  std::vector<double> cuts;
  for (std::size_t a = 0; a < n; ++a) {
    cuts.push_back(offset[a] - radius[a]);
    cuts.push_back(offset[a] + radius[a]);
    for (std::size_t b = a + 1; b < n; ++b) {
      const double ds = offset[b] - offset[a];
      if (ds > 0) {
        cuts.push_back(0.5 * (offset[a] + offset[b]) + (radius[a] * radius[a] - radius[b] * radius[b]) / (2 * ds));
      }
    }
  }
  std::sort(cuts.begin(), cuts.end());

  ProfileIntegrals sum;
  for (std::size_t c = 0; c + 1 < cuts.size(); ++c) {
    const double from = cuts[c];
    const double to = cuts[c + 1];
    const double middle = 0.5 * (from + to);
    std::size_t outer = n;
    double outer_r2 = 0;
    for (std::size_t b = 0; b < n; ++b) {
      const double u = middle - offset[b];
      const double r2 = radius[b] * radius[b] - u * u;
      if (r2 > outer_r2) {
        outer = b;
        outer_r2 = r2;
      }
    }
    if (outer == n) continue;  // between beads that do not overlap
    const double s = offset[outer];
    const double r = radius[outer];
    sum.r1 += half_disc(r, to - s) - half_disc(r, from - s);
    // three Gauss-Legendre points are exact for polynomials up to degree 5
    constexpr std::array<double, 3> kNode{-0.7745966692414834, 0.0, 0.7745966692414834};
    constexpr std::array<double, 3> kWeight{5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};
    for (int k = 0; k < 3; ++k) {
      const double x = middle + 0.5 * (to - from) * kNode[k];
      const double w = 0.5 * (to - from) * kWeight[k];
      const double r2 = r * r - (x - s) * (x - s);
      sum.r2 += w * r2;
      sum.r4 += w * r2 * r2;
      sum.r2x += w * r2 * x;
      sum.r2x2 += w * r2 * x * x;
    }
  }
  return sum;
}

/// Sums over the beads, of whose masses r^3 is a measure.
struct BeadSums {
  double r3 = 0;    ///< of r^3
  double r3x = 0;   ///< of r^3 x
  double r3x2 = 0;  ///< of r^3 x^2
  double r5 = 0;    ///< of r^5
};

BeadSums sum_of_beads(const std::vector<double>& offset, const std::vector<double>& radius) {
  BeadSums sum;
  for (std::size_t b = 0; b < offset.size(); ++b) {
    const double r2 = radius[b] * radius[b];
    const double r3 = r2 * radius[b];
    sum.r3 += r3;
    sum.r3x += r3 * offset[b];
    sum.r3x2 += r3 * offset[b] * offset[b];
    sum.r5 += r3 * r2;
  }
  return sum;
}

/// Beads whose radius falls linearly from the middle one to both ends; the hull follows them exactly.
void place_symmetric_beads(const RodShape& shape, Species& species) {
  SHAKEN_CHECK(shape.n_beads >= 1 && shape.n_beads % 2 == 1, "a rod has an odd number of beads");
  species.mid_radius = 0.5 * shape.mid_diameter;
  species.end_radius = shape.n_beads > 1 ? 0.5 * shape.end_diameter : species.mid_radius;
  species.half_length = shape.n_beads > 1 ? 0.5 * shape.length - species.end_radius : 0.0;
  species.tail = species.head = {species.half_length, species.end_radius};
  const int middle = shape.n_beads / 2;
  for (int b = 0; b < shape.n_beads; ++b) {
    const double along = middle > 0 ? static_cast<double>(b - middle) / middle : 0.0;  // -1 .. 1, exactly antisymmetric
    species.bead_offset.push_back(species.half_length * along);
    species.bead_radius.push_back(species.mid_radius - (species.mid_radius - species.end_radius) * std::abs(along));
  }
  species.outer_beads = middle > 0 ? std::vector<int>{0, middle, shape.n_beads - 1} : std::vector<int>{0};
}

/// The beads' diameters from tail to head.
std::vector<double> diameters_of(const RodShape& shape) {
  if (!shape.bead_diameters.empty()) return shape.bead_diameters;
  std::vector<double> diameters(shape.n_beads);
  for (int b = 0; b < shape.n_beads; ++b) {
    const double along = shape.n_beads > 1 ? static_cast<double>(b) / (shape.n_beads - 1) : 0.0;
    diameters[b] = shape.mid_diameter + along * (shape.end_diameter - shape.mid_diameter);
  }
  return diameters;
}

/// The corners of the upper hull of the points (offset, radius), from tail to head (Andrew 1979).
std::vector<int> outer_beads_of(const std::vector<double>& offset, const std::vector<double>& radius) {
  std::vector<int> corners;
  for (int b = 0; b < static_cast<int>(offset.size()); ++b) {
    const auto is_below = [&](int a, int middle) {
      return (radius[middle] - radius[a]) * (offset[b] - offset[a]) <=
             (radius[b] - radius[a]) * (offset[middle] - offset[a]);
    };
    while (corners.size() >= 2 && is_below(corners[corners.size() - 2], corners.back())) corners.pop_back();
    corners.push_back(b);
  }
  return corners;
}

/// Beads as given, round their centre of mass, and the hull of one straight line to each side of it that clears them.
void place_free_beads(const RodShape& shape, Species& species) {
  const std::vector<double> diameters = diameters_of(shape);
  const std::size_t n = diameters.size();
  const double from = 0.5 * diameters.front();
  const double pitch = n > 1 ? (shape.length - from - 0.5 * diameters.back()) / static_cast<double>(n - 1) : 0.0;
  std::vector<double>& offset = species.bead_offset;
  std::vector<double>& radius = species.bead_radius;
  for (std::size_t b = 0; b < n; ++b) {
    offset.push_back(from + static_cast<double>(b) * pitch);
    radius.push_back(0.5 * diameters[b]);
  }
  const ProfileIntegrals profile = integrate_profile(offset, radius);
  const BeadSums beads = sum_of_beads(offset, radius);
  const double centre = shape.inertia == Inertia::kSolid ? profile.r2x / profile.r2 : beads.r3x / beads.r3;
  for (double& s : offset) s -= centre;
  species.outer_beads = outer_beads_of(offset, radius);
  species.mid_radius = species.end_radius = radius.front();
  if (n == 1) {
    offset.front() = 0;
    species.tail = species.head = {0.0, radius.front()};
    return;
  }
  species.half_length = std::max(-offset.front(), offset.back());
  for (std::size_t c = 0; c + 1 < species.outer_beads.size(); ++c) {
    const int a = species.outer_beads[c];
    const int b = species.outer_beads[c + 1];
    if (offset[a] > 0 || offset[b] < 0) continue;
    species.mid_radius = radius[a] + (radius[b] - radius[a]) * (0.0 - offset[a]) / (offset[b] - offset[a]);
  }
  species.mid_radius *= 1.0 + 1e-12;  // so that rounding leaves no bead outside
  double tail_taper = INFINITY;
  double head_taper = INFINITY;
  for (std::size_t b = 0; b < n; ++b) {
    double& taper = offset[b] < 0 ? tail_taper : head_taper;
    if (offset[b] != 0) taper = std::min(taper, (species.mid_radius - radius[b]) / std::abs(offset[b]));
  }
  species.tail = {-offset.front(), species.mid_radius + tail_taper * offset.front()};
  species.head = {offset.back(), species.mid_radius - head_taper * offset.back()};
  species.end_radius = species.mid_radius - std::min(tail_taper, head_taper) * species.half_length;
}

}  // namespace

Species make_species(const RodShape& shape) {
  Species species;
  const bool is_symmetric = shape.profile == Profile::kSymmetric && shape.bead_diameters.empty();
  is_symmetric ? place_symmetric_beads(shape, species) : place_free_beads(shape, species);
  SHAKEN_CHECK(species.n_beads() <= kMostBeads, "too many beads");
  species.max_radius = std::max({species.mid_radius, species.tail.radius, species.head.radius});

  const ProfileIntegrals profile = integrate_profile(species.bead_offset, species.bead_radius);
  species.area = 2.0 * profile.r1;
  species.mass = shape.density * kPi * profile.r2;
  species.inertia_par = shape.density * 0.5 * kPi * profile.r4;
  species.inertia_perp = shape.density * kPi * (0.25 * profile.r4 + profile.r2x2);
  if (shape.inertia == Inertia::kBeads) {
    const BeadSums beads = sum_of_beads(species.bead_offset, species.bead_radius);
    species.inertia_par = species.mass * 0.4 * beads.r5 / beads.r3;
    species.inertia_perp = species.mass * (0.4 * beads.r5 + beads.r3x2) / beads.r3;
  }
  species.inertia_ratio = species.inertia_par / species.inertia_perp;
  return species;
}

double BeadRow::tail() const {
  double end = 0;
  for (std::size_t b = 0; b < offset.size(); ++b) end = std::min(end, offset[b] - radius[b]);
  return end;
}

double BeadRow::head() const {
  double end = 0;
  for (std::size_t b = 0; b < offset.size(); ++b) end = std::max(end, offset[b] + radius[b]);
  return end;
}

double BeadRow::reach() const { return std::max(head(), -tail()); }

double BeadRow::area() const { return 2.0 * integrate_profile(offset, radius).r1; }

double least_box_side(std::span<const Species> species) {
  double farthest = 0;
  for (const Species& kind : species) farthest = std::max(farthest, kind.reach());
  return 1.1 * (4.0 * farthest);
}

int beads_for_pitch(double length, double end_diameter, double pitch) {
  const double axis = length - end_diameter;
  // a pitch that fits up to rounding fits
  const int intervals = static_cast<int>(std::ceil(axis / pitch * (1.0 - 1e-12)));
  return intervals + 1 + intervals % 2;
}

}  // namespace shaken
