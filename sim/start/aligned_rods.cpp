#include "sim/start/aligned_rods.h"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include "base/core/sincos.h"
#include "sim/start/rows_along_x.h"
#include "sim/start/turned_rows.h"

namespace shaken {
namespace {

/// Each site of a lattice has room for the largest of all kinds, which a mixture mostly does not need.
std::string denser_mixture(const Placement& rods) {
  const bool can_be_compressed = rods.species.size() > 1 && !rods.system.walls;
  return can_be_compressed ? "; rods.start \"compressed\" packs mixtures more densely" : "";
}

/// A lattice with a site for every rod, along x.
Result<Lattice> lattice_along_x(const Placement& rods) {
  if (const auto lattice = rows_along_x(rods)) return *lattice;
  return rods.does_not_fit("in rows at most " + rods.amount(most_in_rows_along_x(rods)) + " can be placed" +
                           denser_mixture(rods));
}

/// The same of rods that lie at the angle of the start.
Result<Lattice> lattice_at_angle(const Placement& rods, const SinCos& angle) {
  const System& system = rods.system;
  if (rods.has_uprights())
    return rods.does_not_fit("rows at an angle to the box are for periodic boxes, without walls or posts");
  const double shorter = rods.shortened_by_tilt();
  const TurnedRows turned(rods.species, system.box(), Vec2(angle.cos, angle.sin),
                          Placement::kClearance + 2.0 * shorter);
  if (const auto lattice = turned.find(rods.n_rods())) return *lattice;
  char degrees[32];
  std::snprintf(degrees, sizeof degrees, "%.10g", system.start_angle);
  return rods.does_not_fit(std::string("in rows of rods at ") + degrees + " degrees at most " +
                           rods.amount(turned.most_below(rods.n_rods())) + " can be placed" + denser_mixture(rods));
}

}  // namespace

Result<std::vector<Flight>> aligned_rods(const Placement& rods) {
  const System& system = rods.system;
  const double angle = system.start_angle * (kPi / 180.0);
  const auto lattice = angle == 0 ? lattice_along_x(rods) : lattice_at_angle(rods, sincos(angle));
  if (!lattice) return lattice.error();

  // which sites stay empty: the tail of a random permutation (Fisher & Yates)
  std::vector<int> sites = usable_sites(*lattice, rods);
  Rng shuffle(system.seed, RngStream::kLattice, 0, 0);
  for (std::size_t k = sites.size() - 1; k > 0; --k) std::swap(sites[k], sites[shuffle.below(k + 1)]);
  sites.resize(static_cast<std::size_t>(rods.n_rods()));
  std::sort(sites.begin(), sites.end());

  std::vector<Flight> flights(sites.size());
  for (int i = 0; i < rods.n_rods(); ++i) {
    Rng rng(system.seed, RngStream::kVelocity, 0, static_cast<std::uint64_t>(i));
    flights[i].position = lattice->position(sites[i], system.box());
    if (angle != 0) {
      std::int32_t ignored = 0;
      wrap(flights[i].position.x(), ignored, system.box().x());
    }
    // polar rods point either way
    const bool turned = Placement::is_polar(rods.species_of(i)) && rng.uniform() < 0.5;
    rods.lift_and_push(flights[i], rods.species_of(i), unit_vector(turned ? angle + kPi : angle), false, rng);
  }
  return flights;
}

}  // namespace shaken
