// SPDX-License-Identifier: MIT
#include "render/picture.h"

#include <algorithm>
#include <cmath>

namespace shaken::render {

double RodPicture::rod_length() const {
  double half = 0;
  for (std::size_t i = 0; i < bead_offset.size(); ++i) half = std::max(half, std::abs(bead_offset[i]) + bead_radius[i]);
  return 2 * half;
}

double RodPicture::area_fraction() const {
  // The outline's half width at x is the greatest of the beads' there; the midpoint rule is good to 4 digits.
  constexpr int kSlices = 2000;
  const double length = rod_length(), dx = length / kSlices;
  double area = 0;
  for (int k = 0; k < kSlices; ++k) {
    const double x = -length / 2 + (k + 0.5) * dx;
    double half_width = 0;
    for (std::size_t i = 0; i < bead_offset.size(); ++i) {
      const double square = bead_radius[i] * bead_radius[i] - (x - bead_offset[i]) * (x - bead_offset[i]);
      if (square > 0) half_width = std::max(half_width, std::sqrt(square));
    }
    area += 2 * half_width * dx;
  }
  return area * static_cast<double>(n_rods()) / (box_side * box_side);
}

std::optional<Error> check(const PictureStyle& style) {
  constexpr int kLeast = 64, kMost = 5000;
  if (std::min(style.width, style.height) < kLeast || std::max(style.width, style.height) > kMost) {
    return Error{"a picture of " + std::to_string(style.width) + "x" + std::to_string(style.height) +
                 " pixels is not possible; each side may be 64 to 5000"};
  }
  if (!(style.zoom >= 1) || !style.focus.allFinite()) return Error{"zoom must be at least 1, and focus finite"};
  return std::nullopt;
}

}  // namespace shaken::render
