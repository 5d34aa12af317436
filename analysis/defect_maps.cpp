#include "analysis/defect_maps.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/bins.h"
#include "analysis/geometry/periodic.h"
#include "base/core/check.h"

namespace shaken::analysis {
namespace {

/// Places in a bin at which it is asked whether it lies within walls, each way.
constexpr int kPlacesInBin = 4;

}  // namespace

DefectMapSums::DefectMapSums(const Shape& shape)
    : shape_(shape),
      bins_(static_cast<std::size_t>(std::max(shape.bins, 0))),
      width_(2 * shape.range / std::max(shape.bins, 1)),
      plus_(bins_ * bins_),
      minus_(bins_ * bins_) {
  SHAKEN_CHECK(shape.bins >= 1 && shape.range > 0 && shape.core > 0, "bins, range and core must not be empty");
  SHAKEN_CHECK(shape.core <= shape.range, "a core reaches beyond the range");
}

std::vector<double> DefectMapSums::centres() const { return middles_of_bins(bins_, width_, -shape_.range); }

void DefectMapSums::add_frame(Sums& sums, const Rods& rods, std::span<const Vec2> velocities, const Vec2& origin,
                              double psi, const Region& region) const {
  const double c = std::cos(psi), s = std::sin(psi), c2 = std::cos(2 * psi), s2 = std::sin(2 * psi);
  for (std::size_t i = 0; i < rods.x.size(); ++i) {
    const Vec2 place(rods.x[i], rods.y[i]);
    const Vec2 way = region.shortest(place - origin);
    const double distance = way.norm();
    if (distance >= shape_.range || !region.in_sight(origin, place)) continue;
    const double along = c * velocities[i].x() + s * velocities[i].y();
    const double across = c * velocities[i].y() - s * velocities[i].x();
    if (distance < shape_.core) {
      ++sums.core_rods;
      sums.core_along += along;
      sums.core_across += across;
    }
    const auto bin_at = [&](double x) {
      return std::min(bins_ - 1, static_cast<std::size_t>(std::max(0.0, (x + shape_.range) / width_)));
    };
    const std::size_t bin = bin_at(c * way.y() - s * way.x()) * bins_ + bin_at(c * way.x() + s * way.y());
    ++sums.rods[bin];
    sums.cos2[bin] += rods.cos2[i] * c2 + rods.sin2[i] * s2;
    sums.sin2[bin] += rods.sin2[i] * c2 - rods.cos2[i] * s2;
    sums.along[bin] += along;
    sums.across[bin] += across;
    sums.tilt2[bin] += rods.n_z[i] * rods.n_z[i];
  }
  const double density = static_cast<double>(rods.x.size()) / region.area(), of_bin = density * width_ * width_;
  ++sums.frames;
  sums.core_expected += density * region.area_in_sight(origin, shape_.core);
  if (!region.has_walls()) {
    for (double& expected : sums.expected) expected += of_bin;
    return;
  }
  const auto n = static_cast<int>(bins_) * kPlacesInBin;
  const double mesh = width_ / kPlacesInBin;
  for (int b = 0; b < n; ++b) {
    for (int a = 0; a < n; ++a) {
      const double x = (a + 0.5) * mesh - shape_.range, y = (b + 0.5) * mesh - shape_.range;
      const Vec2 place = origin + Vec2(c * x - s * y, s * x + c * y);
      if (!region.contains(place) || !region.in_sight(origin, place)) continue;
      const auto bin = static_cast<std::size_t>(b / kPlacesInBin) * bins_ + static_cast<std::size_t>(a / kPlacesInBin);
      sums.expected[bin] += of_bin / (kPlacesInBin * kPlacesInBin);
    }
  }
}

void DefectMapSums::accumulate(const Rods& rods, std::span<const Vec2> velocities, std::span<const Defect> defects,
                               const Region& region) {
  SHAKEN_CHECK(rods.x.size() == velocities.size(), "one velocity for each rod");
  for (const Defect& defect : defects) {
    if (defect.charge == 0.5) add_frame(plus_, rods, velocities, defect.position, defect.direction, region);
    if (defect.charge != -0.5) continue;
    for (int k = 0; k < 3; ++k) {
      add_frame(minus_, rods, velocities, defect.position, defect.direction + 2 * kPi / 3 * k, region);
    }
  }
  ++samples_;
}

DefectMap DefectMapSums::reduced(const Sums& sums, int frames_of_each) const {
  const std::vector<double> at = centres();
  DefectMap map;
  map.defects = static_cast<double>(sums.frames) / frames_of_each;
  for (std::size_t row = 0; row < bins_; ++row) {
    for (std::size_t column = 0; column < bins_; ++column) {
      const double far = std::hypot(std::abs(at[row]) + width_ / 2, std::abs(at[column]) + width_ / 2);
      const bool known = far <= shape_.range * (1 + 1e-12);
      const std::size_t bin = row * bins_ + column;
      const auto rods = static_cast<double>(sums.rods[bin]);
      map.density.push_back(known ? mean_of(rods, sums.expected[bin]) : kNaN);
      map.cos2.push_back(known ? mean_of(sums.cos2[bin], rods) : kNaN);
      map.sin2.push_back(known ? mean_of(sums.sin2[bin], rods) : kNaN);
      map.v_along.push_back(known ? mean_of(sums.along[bin], rods) : kNaN);
      map.v_across.push_back(known ? mean_of(sums.across[bin], rods) : kNaN);
      map.tilt2.push_back(known ? mean_of(sums.tilt2[bin], rods) : kNaN);
    }
  }
  const auto core_rods = static_cast<double>(sums.core_rods);
  map.core_density = mean_of(core_rods, sums.core_expected);
  map.core_along = mean_of(sums.core_along, core_rods);
  map.core_across = mean_of(sums.core_across, core_rods);
  return map;
}

std::vector<Defect> lone_defects(std::span<const Defect> defects, double separation, const Region& region) {
  std::vector<Defect> lone;
  for (std::size_t i = 0; i < defects.size(); ++i) {
    bool is_lone = true;
    for (std::size_t j = 0; j < defects.size() && is_lone; ++j) {
      is_lone = j == i || region.shortest(defects[j].position - defects[i].position).norm() >= separation;
    }
    if (is_lone) lone.push_back(defects[i]);
  }
  return lone;
}

void DefectMaps::accumulate(double time, std::span<const Vec3> positions, std::span<const Vec3> unwrapped,
                            std::span<const Vec3> directors, std::span<const Defect> defects, const Region& region) {
  SHAKEN_CHECK(positions.size() == unwrapped.size() && positions.size() == directors.size(), "each rod once");
  Places now{time, {}, {}};
  for (const Vec3& place : unwrapped) {
    now.x.push_back(place.x());
    now.y.push_back(place.y());
  }
  if (!places_.empty()) {
    SHAKEN_CHECK(places_.back().x.size() == now.x.size() && time > places_.back().time, "as many rods, later");
  }
  if (places_.size() == 2) {
    const Places& before = places_.front();
    std::vector<Vec2> velocities;
    velocities.reserve(now.x.size());
    for (std::size_t i = 0; i < now.x.size(); ++i) {
      velocities.emplace_back(Vec2(now.x[i] - before.x[i], now.y[i] - before.y[i]) / (time - before.time));
    }
    sums_.accumulate(places_.back().time, rods_, velocities, defects_, region);
    places_.erase(places_.begin());
  }
  places_.push_back(std::move(now));
  rods_ = {};
  n_rods_ = positions.size();
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec2 angle = double_angle(directors[i]);
    rods_.x.push_back(positions[i].x());
    rods_.y.push_back(positions[i].y());
    rods_.cos2.push_back(angle.x());
    rods_.sin2.push_back(angle.y());
    rods_.n_z.push_back(directors[i].z());
  }
  defects_.assign(defects.begin(), defects.end());
}

}  // namespace shaken::analysis
