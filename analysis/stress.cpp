#include "analysis/stress.h"

#include <algorithm>
#include <cmath>

#include "base/core/check.h"

namespace shaken::analysis {
namespace {

/// n.P.n for the unit vector at `angle` to x.
double along(const PlaneTensor& tensor, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return c * c * tensor[0] + c * s * (tensor[1] + tensor[2]) + s * s * tensor[3];
}

/// Makes up for what the mean velocity of all rods takes of their fluctuations; unknown of a single one.
double of_mean(std::size_t n_rods) {
  return n_rods > 1 ? static_cast<double>(n_rods) / (static_cast<double>(n_rods) - 1) : std::nan("");
}

std::array<double, 2> along_and_across(const PlaneTensor& tensor, double director) {
  const double first = along(tensor, director);
  return {first, tensor[0] + tensor[3] - first};
}

}  // namespace

PlaneTensor momentum_flux(std::span<const double> masses, std::span<const Vec3> velocities) {
  SHAKEN_CHECK(masses.size() == velocities.size(), "a mass for each rod");
  Vec3 momentum = Vec3::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    momentum += masses[i] * velocities[i];
    mass += masses[i];
  }
  const Vec3 centre = momentum / mass;
  PlaneTensor flux{};
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const Vec3 v = velocities[i] - centre;
    for (std::size_t k = 0; k < flux.size(); ++k)
      flux[k] += masses[i] * v[static_cast<Eigen::Index>(k / 2)] * v[static_cast<Eigen::Index>(k % 2)];
  }
  return flux;
}

void PressureSums::accumulate(double duration, const PlaneTensor& kinetic, const PlaneTensor& collisional,
                              double director) {
  time_ += duration;
  const std::array<double, 2> of_motion = along_and_across(kinetic, director);
  const std::array<double, 2> of_impacts = along_and_across(collisional, director);
  for (std::size_t k = 0; k < 2; ++k) {
    kinetic_[k] += duration * of_motion[k];
    collisional_[k] += duration * of_impacts[k];
  }
}

Pressure PressureSums::reduce(std::size_t n_rods) const {
  const double along = of_mean(n_rods) * kinetic_[0], across = of_mean(n_rods) * kinetic_[1];
  return {.along = (along + collisional_[0]) / time_,
          .across = (across + collisional_[1]) / time_,
          .kinetic = (along + across) / 2 / time_,
          .collisional = (collisional_[0] + collisional_[1]) / 2 / time_};
}

void StressSeries::accumulate(double time, const StressTotals& totals, double area, double director) {
  if (samples_ > 0) {
    SHAKEN_CHECK(time > time_, "samples must come in order of time");
    const double duration = time - time_;
    PlaneTensor kinetic{}, collisional{};
    std::array<double, 8> one{};
    for (std::size_t k = 0; k < kinetic.size(); ++k) {
      one[k] = kinetic[k] = (last_flux_[k] + totals.momentum_flux[k]) / 2 / area;
      one[4 + k] = collisional[k] = (totals.virial[k] - last_virial_[k]) / duration / area;
    }
    series_.accumulate(time, one);
    sums_.accumulate(time_, duration, kinetic, collisional, director);
  }
  ++samples_;
  time_ = time;
  last_flux_ = totals.momentum_flux;
  last_virial_ = totals.virial;
}

std::vector<double> StressSeries::kinetic(std::size_t k) const {
  std::vector<double> values = series_.column(k);
  for (double& value : values) value *= of_mean(n_rods_);
  return values;
}

}  // namespace shaken::analysis
