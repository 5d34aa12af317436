// SPDX-License-Identifier: MIT
#include "bench/accuracy/averaged.h"

#include <cmath>
#include <optional>

#include "analysis/order.h"
#include "sim/balance.h"

namespace shaken::bench {
namespace {

constexpr int kTiltBins = 16;
constexpr double kTiltRange = 0.4;

/// Mean of -sign(n_z) v_along over the rods with 0.1 < |n_z| < 0.25: where the taper lies flat on a plate.
std::optional<double> drift_of(const Snapshot& rods) {
  double sum = 0;
  int n = 0;
  for (std::size_t i = 0; i < rods.n_rods(); ++i) {
    const Vec3& director = rods.director[i];
    const double tilt = std::abs(director.z());
    if (tilt < 0.1 || tilt > 0.25) continue;
    const double along = director.x() * rods.velocity[i].x() + director.y() * rods.velocity[i].y();
    sum -= (director.z() > 0 ? along : -along) / std::hypot(director.x(), director.y());
    ++n;
  }
  if (n == 0) return std::nullopt;
  return sum / n;
}

}  // namespace

ObservableSeries::ObservableSeries() : tilt_(analysis::TiltVelocity(kTiltBins, kTiltRange)) {
  for (const Observable& of : kObservables) values_[of.name];
}

void ObservableSeries::sample(const Simulation& simulation) {
  const World& world = simulation.world();
  const Snapshot rods = simulation.snapshot();
  const auto n = static_cast<double>(rods.n_rods());

  const KineticEnergy energy = kinetic_energy(world);
  values_["T_xy"].push_back(energy.translation_xy / (n * world.species[0].mass));
  values_["T_z"].push_back(2 * energy.translation_z / (n * world.species[0].mass));
  values_["T_rot"].push_back(energy.rotation / (n * world.species[0].inertia_perp));
  values_["S"].push_back(analysis::nematic_order(rods.director).order);
  double n_z2 = 0;
  for (const Vec3& director : rods.director) n_z2 += director.z() * director.z() / n;
  values_["rms_n_z"].push_back(std::sqrt(n_z2));
  if (const auto drift = drift_of(rods)) values_["drift"].push_back(*drift);
  tilt_.accumulate(simulation.time(), rods.director, rods.velocity);

  std::vector<Vec2> places;
  for (std::size_t i = 0; i < rods.n_rods(); ++i) {
    places.emplace_back(rods.position[i].x() + rods.image[i][0] * rods.box.x(),
                        rods.position[i].y() + rods.image[i][1] * rods.box.y());
  }
  if (places_.size() == kLagSamples) {
    double square = 0;
    for (std::size_t i = 0; i < places.size(); ++i) square += (places[i] - places_.front()[i]).squaredNorm() / n;
    values_["msd"].push_back(square);
    places_.pop_front();
  }
  places_.push_back(std::move(places));

  double hit = 0;
  for (const Flight& flight : world.rods) {
    hit += static_cast<double>(world.tick - flight.since) * world.system.dt < kRecently * (1 - 1e-9) ? 1 / n : 0;
  }
  values_["hit"].push_back(hit);

  const Counters& now = world.counters;
  if (places_.size() > 1) {
    const auto plates = [](const Counters& of) { return of.impulses_rod_base + of.impulses_rod_lid; };
    values_["rod_impulses"].push_back(static_cast<double>(now.impulses_rod_rod - last_.impulses_rod_rod) /
                                      (n * kEvery));
    values_["plate_impulses"].push_back(static_cast<double>(plates(now) - plates(last_)) / (n * kEvery));
  }
  last_ = now;
}

}  // namespace shaken::bench
