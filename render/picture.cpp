// SPDX-License-Identifier: MIT
#include "render/picture.h"

#include <algorithm>
#include <cmath>

namespace shaken::render {

namespace {

/// Where a row of beads begins and ends along the rod [mm].
struct Ends {
  double tail = 0, head = 0;
};
Ends ends_of(const BeadRow& beads) {
  Ends ends;
  for (std::size_t i = 0; i < beads.offset.size(); ++i) {
    ends.tail = std::min(ends.tail, beads.offset[i] - beads.radius[i]);
    ends.head = std::max(ends.head, beads.offset[i] + beads.radius[i]);
  }
  return ends;
}

/// Of the outline [mm^2]: its half width at x is the greatest of the beads' there; the midpoint rule is good to 4
/// digits.
double outline_area(const BeadRow& beads) {
  constexpr int kSlices = 2000;
  const Ends ends = ends_of(beads);
  const double dx = (ends.head - ends.tail) / kSlices;
  double area = 0;
  for (int k = 0; k < kSlices; ++k) {
    const double x = ends.tail + (k + 0.5) * dx;
    double half_width = 0;
    for (std::size_t i = 0; i < beads.offset.size(); ++i) {
      const double square = beads.radius[i] * beads.radius[i] - (x - beads.offset[i]) * (x - beads.offset[i]);
      if (square > 0) half_width = std::max(half_width, std::sqrt(square));
    }
    area += 2 * half_width * dx;
  }
  return area;
}

/// What the rods have to share [mm^2].
double floor_area(const RodPicture& picture) {
  return picture.walls ? picture.walls->area() : picture.box_side * picture.box_side;
}

}  // namespace

std::size_t RodPicture::count(std::size_t species) const {
  if (species_of_rod.empty()) return species == 0 ? n_rods() : 0;
  return static_cast<std::size_t>(std::count(species_of_rod.begin(), species_of_rod.end(), species));
}

std::vector<Vec3> RodPicture::first_directors() const {
  if (species_of_rod.empty()) return director;
  std::vector<Vec3> directors;
  for (std::size_t i = 0; i < n_rods(); ++i) {
    if (species_of_rod[i] == 0) directors.push_back(director[i]);
  }
  return directors;
}

double RodPicture::rod_length() const {
  const Ends ends = ends_of(beads);
  return ends.head - ends.tail;
}

double RodPicture::rod_area(std::size_t species) const { return outline_area(beads_of(species)); }

double RodPicture::area_fraction() const {
  double covered = 0;
  for (std::size_t species = 0; species < n_species(); ++species) {
    covered += static_cast<double>(count(species)) * rod_area(species);
  }
  return covered / floor_area(*this);
}

}  // namespace shaken::render
