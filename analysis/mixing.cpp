#include "analysis/mixing.h"

#include <algorithm>
#include <utility>

#include "analysis/bins.h"
#include "analysis/geometry/pair_bins.h"
#include "analysis/geometry/periodic.h"
#include "base/core/check.h"

namespace shaken::analysis {

std::size_t PairMixing::pair_kind(std::size_t species, std::size_t a, std::size_t b) {
  if (a > b) std::swap(a, b);
  return a * species - a * (a + 1) / 2 + b;
}

PairMixing::PairMixing(std::size_t n_species, int bins, double r_max, double near)
    : r_max_(r_max),
      near_(near),
      rods_(n_species),
      pairs_(kinds(n_species) * static_cast<std::size_t>(std::max(bins, 0))),
      expected_(pairs_.size()),
      neighbours_(kinds(n_species)) {
  SHAKEN_CHECK(n_species > 0 && bins >= 1 && r_max > 0 && near > 0, "species, bins and range must not be empty");
}

void PairMixing::accumulate(std::span<const Vec3> positions, std::span<const std::uint8_t> species_of,
                            const Region& region) {
  const std::size_t n = positions.size(), n_species = rods_.size();
  const std::size_t n_bins = pairs_.size() / kinds(n_species);
  SHAKEN_CHECK(species_of.empty() || species_of.size() == n, "a species for each rod");
  SHAKEN_CHECK(has_room(region, std::max(r_max_, near_)), "distances beyond half the box have no nearest image");
  const auto of = [&](std::size_t i) { return species_of.empty() ? std::size_t{0} : std::size_t{species_of[i]}; };
  std::vector<double> xs, ys;
  for (const Vec3& position : positions) {
    xs.push_back(wrapped(position.x(), region.box().x()));
    ys.push_back(wrapped(position.y(), region.box().y()));
  }
  std::vector<std::int64_t> rods(n_species);
  for (std::size_t i = 0; i < n; ++i) ++rods.at(of(i));
  const PairBins distances(n_bins, r_max_, region), neighbourhood(1, near_, region);
  std::vector<int> bins(n), near(n);
  std::vector<double> references(n_species);
  // what a rod of species `a` may meet of species `b`, per area
  const auto density = [&](std::size_t a, std::size_t b) {
    return static_cast<double>(rods[b] - (a == b ? 1 : 0)) / region.area();
  };
  const auto expect = [&](std::size_t a, const Vec2& place, double how_often) {
    for (std::size_t b = 0; b < n_species; ++b) {
      const std::size_t first = pair_kind(n_species, a, b) * n_bins;
      add_gas(std::span(expected_).subspan(first, n_bins), r_max_, place, region, how_often * density(a, b));
    }
  };
  const std::size_t stride = reference_stride(n);
  for (std::size_t i = static_cast<std::size_t>(calls_) % stride; i < n; i += stride) {
    const std::size_t a = of(i);
    references[a] += 1;
    distances.find(xs[i], ys[i], xs, ys, bins);
    neighbourhood.find(xs[i], ys[i], xs, ys, near);
    for (std::size_t j = 0; j < n; ++j) {
      if (j == i) continue;
      const std::size_t kind = pair_kind(n_species, a, of(j)), bin = static_cast<std::size_t>(bins[j]);
      if (bin < n_bins) ++pairs_[kind * n_bins + bin];
      if (near[j] == 0) ++neighbours_[kind];
    }
    if (region.has_walls()) expect(a, {xs[i], ys[i]}, 1);
  }
  if (!region.has_walls()) {
    for (std::size_t a = 0; a < n_species; ++a) expect(a, Vec2::Zero(), references[a]);
  }
  for (std::size_t a = 0; a < n_species; ++a) rods_[a] += rods[a];
  ++samples_;
  ++calls_;
}

MixingCurves PairMixing::reduce() const {
  const std::size_t n_species = rods_.size(), n_bins = pairs_.size() / kinds(n_species);
  MixingCurves curves;
  curves.r = middles_of_bins(n_bins, r_max_ / static_cast<double>(n_bins));
  for (std::size_t kind = 0; kind < kinds(n_species); ++kind) {
    std::vector<double>& g = curves.g.emplace_back();
    for (std::size_t k = kind * n_bins; k < (kind + 1) * n_bins; ++k)
      g.push_back(mean_of(static_cast<double>(pairs_[k]), expected_[k]));
  }
  curves.segregation.assign(kinds(n_species), kNaN);
  const auto neighbours = [&](std::size_t a, std::size_t b) {
    return static_cast<double>(neighbours_[pair_kind(n_species, a, b)]);
  };
  const auto rods_in_a_sample = [&](std::size_t a) {
    return static_cast<double>(rods_[a]) / static_cast<double>(samples_);
  };
  for (std::size_t a = 0; a < n_species; ++a) {
    for (std::size_t b = a + 1; b < n_species; ++b) {
      const double n_a = rods_in_a_sample(a), n_b = rods_in_a_sample(b), n = n_a + n_b;
      const double of_both = neighbours(a, a) + neighbours(a, b) + neighbours(b, b);
      if (of_both > 0)
        curves.segregation[pair_kind(n_species, a, b)] =
            1 - neighbours(a, b) / of_both / (2 * n_a * n_b / (n * (n - 1)));
    }
  }
  return curves;
}

}  // namespace shaken::analysis
