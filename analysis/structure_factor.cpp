// SPDX-License-Identifier: MIT
#include "analysis/structure_factor.h"

#include <cmath>
#include <limits>

#include "analysis/order.h"
#include "analysis/wave_sums.h"
#include "base/core/check.h"

namespace shaken::analysis {

StructureFactor::StructureFactor(double box_side, int waves) : box_side_(box_side) {
  SHAKEN_CHECK(box_side > 0 && waves >= 1, "a box and waves in it");
  for (Shells* shells : {&all_, &along_, &across_}) {
    shells->terms.resize(static_cast<std::size_t>(waves));
    shells->sums.resize(static_cast<std::size_t>(waves));
  }
}

void StructureFactor::accumulate(std::span<const Vec3> positions, std::span<const Vec3> directors) {
  SHAKEN_CHECK(positions.size() == directors.size(), "one position for each director");
  if (positions.empty()) return;
  std::vector<Vec2> places;
  places.reserve(positions.size());
  for (const Vec3& position : positions) places.emplace_back(position.head<2>());
  const auto waves = static_cast<int>(all_.sums.size());
  const auto n_rods = static_cast<double>(places.size());
  const WavePowers powers = wave_powers(places, std::vector<double>(places.size(), 1.0), box_side_, waves);
  const double director = nematic_order(directors).director;
  const double cosine = std::cos(director), sine = std::sin(director), cone = std::cos(kPi / 6);
  const auto count = [](Shells& shells, std::size_t shell, double s) {
    ++shells.terms[shell];
    shells.sums[shell] += s;
  };
  for (int m = 0; m <= waves; ++m) {
    for (int n = m == 0 ? 1 : -waves; n <= waves; ++n) {  // one of each pair +-q
      const double length = std::hypot(m, n);
      const auto shell = static_cast<std::size_t>(std::lround(length)) - 1;
      if (shell >= all_.sums.size()) continue;
      const double s = powers.at(m, n) / n_rods;
      count(all_, shell, s);
      if (std::abs(m * cosine + n * sine) >= cone * length) count(along_, shell, s);
      if (std::abs(n * cosine - m * sine) >= cone * length) count(across_, shell, s);
    }
  }
}

std::vector<double> StructureFactor::Shells::means() const {
  std::vector<double> means;
  for (std::size_t k = 0; k < sums.size(); ++k) {
    means.push_back(terms[k] > 0 ? sums[k] / static_cast<double>(terms[k]) : std::numeric_limits<double>::quiet_NaN());
  }
  return means;
}

StructureCurve StructureFactor::reduce() const {
  StructureCurve curve{{}, all_.means(), along_.means(), across_.means()};
  for (std::size_t k = 1; k <= curve.all.size(); ++k) {
    curve.q.push_back(2 * kPi * static_cast<double>(k) / box_side_);
  }
  return curve;
}

}  // namespace shaken::analysis
