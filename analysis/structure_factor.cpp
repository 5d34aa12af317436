#include "analysis/structure_factor.h"

#include <cmath>

#include "analysis/bins.h"
#include "analysis/geometry/wave_sums.h"
#include "analysis/order.h"
#include "base/core/check.h"

namespace shaken::analysis {

StructureFactor::StructureFactor(const Box& box, int waves) : vectors_(box, waves) {
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
  const auto n_rods = static_cast<double>(places.size());
  const std::vector<double> powers = wave_powers(places, std::vector<double>(places.size(), 1.0), vectors_);
  const double director = nematic_order(directors).director;
  const double cosine = std::cos(director), sine = std::sin(director), cone = std::cos(kPi / 6);
  const auto count = [](Shells& shells, std::size_t shell, double s) {
    ++shells.terms[shell];
    shells.sums[shell] += s;
  };
  vectors_.for_each([&](int m, int n, const Vec2& q) {
    const double length = std::hypot(q.x(), q.y());
    const auto shell = static_cast<std::size_t>(std::lround(length)) - 1;
    if (shell >= all_.sums.size()) return;
    const double s = powers[vectors_.index(m, n)] / n_rods;
    count(all_, shell, s);
    if (std::abs(q.x() * cosine + q.y() * sine) >= cone * length) count(along_, shell, s);
    if (std::abs(q.y() * cosine - q.x() * sine) >= cone * length) count(across_, shell, s);
  });
}

std::vector<double> StructureFactor::Shells::means() const {
  std::vector<double> means;
  for (std::size_t k = 0; k < sums.size(); ++k) {
    means.push_back(mean_of(sums[k], terms[k]));
  }
  return means;
}

StructureCurve StructureFactor::reduce() const {
  StructureCurve curve{{}, all_.means(), along_.means(), across_.means()};
  for (std::size_t k = 1; k <= curve.all.size(); ++k) {
    curve.q.push_back(vectors_.wave_number(static_cast<double>(k)));
  }
  return curve;
}

}  // namespace shaken::analysis
