#include "render/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace shaken::render {

std::size_t RodPicture::count_of_shape(std::size_t shape) const {
  if (cell.shape_of_rod.empty()) return shape == 0 ? n_rods() : 0;
  return static_cast<std::size_t>(std::ranges::count(cell.shape_of_rod, shape));
}

std::string RodPicture::length_text() const {
  double n = 0, squares = 0;
  for (std::size_t k = 0; k < cell.species_of_shape.size() && cell.species_of_shape[k] == 0; ++k) {
    const auto rods = static_cast<double>(count_of_shape(k));
    const double longer = cell.shapes[k].length() - rod_length();
    n += rods;
    squares += rods * longer * longer;
  }
  if (squares == 0) return fmt::format("{:.4g} mm", rod_length());
  return fmt::format("{:.4g}\u00b1{:.2g} mm", rod_length(), std::sqrt(squares / n));
}

double RodPicture::area_fraction() const {
  double covered = 0;
  for (std::size_t k = 0; k < cell.shapes.size(); ++k) {
    covered += static_cast<double>(count_of_shape(k)) * cell.shapes[k].area();
  }
  return covered / cell.area();
}

}  // namespace shaken::render
