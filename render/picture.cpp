// SPDX-License-Identifier: MIT
#include "render/picture.h"

namespace shaken::render {

double RodPicture::area_fraction() const {
  double covered = 0;
  for (std::size_t k = 0; k < cell.species.size(); ++k) {
    covered += static_cast<double>(count(k)) * cell.species[k].area();
  }
  return covered / cell.area();
}

}  // namespace shaken::render
