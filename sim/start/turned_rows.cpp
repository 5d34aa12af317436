#include "sim/start/turned_rows.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace shaken {
namespace {

constexpr int kFewMore = 8;        ///< sites beyond one for each rod, among which the roomiest is looked for
constexpr double kMostWork = 3e8;  ///< pairs of beads looked at before it is given up, about a second

}  // namespace

TurnedRows::TurnedRows(std::span<const Species> species, const Box& box, const Vec2& along, double clearance)
    : box_(box), along_(along), least_clearance_(clearance) {
  std::vector<std::pair<double, double>> beads;  // offset and radius of every bead that may lie ahead of a site
  for (const Species& kind : species) {
    area_ = std::max(area_, kind.area);
    for (int b = 0; b < kind.n_beads(); ++b) {
      for (const double sign : {1.0, -1.0}) beads.emplace_back(sign * kind.bead_offset[b], kind.bead_radius[b]);
      thickness_ = std::max(thickness_, 2.0 * kind.bead_radius[b]);
      reach_ = std::max(reach_, 2.0 * (std::abs(kind.bead_offset[b]) + kind.bead_radius[b]));
    }
  }
  for (const auto& [s_i, r_i] : beads) {
    for (const auto& [s_j, r_j] : beads) pairs_.push_back({s_j - s_i, r_i + r_j});
  }
  // A disc within another's, as most are, decides nothing.
  std::sort(pairs_.begin(), pairs_.end(), [](const BeadPair& one, const BeadPair& other) {
    return std::pair(one.ahead, -one.touch) < std::pair(other.ahead, -other.touch);
  });
  std::vector<BeadPair> kept;
  const auto keep_what_sticks_out = [&](double sign) {
    double farthest = -INFINITY;
    kept.clear();
    for (const BeadPair& pair : pairs_) {
      const double end = pair.touch + sign * pair.ahead;
      if (end > farthest) kept.push_back(pair);
      farthest = std::max(farthest, end);
    }
    std::reverse(kept.begin(), kept.end());
    pairs_ = kept;
  };
  keep_what_sticks_out(1.0);
  keep_what_sticks_out(-1.0);
}

double TurnedRows::gap(double ahead, double aside) const {
  double least = INFINITY;
  for (const BeadPair& pair : pairs_) {
    const double x = ahead + pair.ahead;
    least = std::min(least, std::sqrt(x * x + aside * aside) - pair.touch);
  }
  return least;
}

double TurnedRows::clearance_of(const Lattice& lattice, double least) const {
  // In units of a rod's length along the rods and of its thickness across, rods are about as long as wide.
  const double long_unit = reach_ + least, wide_unit = thickness_ + least;
  const auto seen = [&](double x, double y) {
    return Vec2((along_.x() * x + along_.y() * y) / long_unit, (along_.x() * y - along_.y() * x) / wide_unit);
  };
  const auto gap_at = [&](const Vec2& site) { return gap(site.x() * long_unit, site.y() * wide_unit); };
  const double pitch = box_.x() / lattice.columns;
  Vec2 one = seen(pitch, 0);
  Vec2 other = seen(pitch * lattice.turns / lattice.rows, box_.y() / lattice.rows);
  // the two shortest vectors of the lattice (Lagrange & Gauss)
  while (true) {
    if (other.squaredNorm() < one.squaredNorm()) std::swap(one, other);
    const Vec2 shorter = other - std::nearbyint(one.dot(other) / one.squaredNorm()) * one;
    if (!(shorter.squaredNorm() < (1.0 - 1e-9) * other.squaredNorm())) break;
    other = shorter;
  }
  double clearance = gap_at(one);
  if (!(clearance > least)) return clearance;
  clearance = std::min(clearance, gap_at(other));
  if (!(clearance > least)) return clearance;
  // Rods beyond 1 in either direction are apart by more than `least`, but may be nearer than the clearance so far. The
  // shortest vectors are at least 60 degrees apart, so i of one and j of the other are sin 60 times each away or more,
  // and a little less for rounding.
  const double far = std::sqrt(2.0) * (1.0 + clearance / wide_unit) / 0.866;
  const int most_one = static_cast<int>(far / one.norm()), most_other = static_cast<int>(far / other.norm());
  for (int j = 0; j <= most_other; ++j) {
    for (int i = j == 0 ? 1 : -most_one; i <= most_one; ++i) {
      clearance = std::min(clearance, gap_at(i * one + j * other));
      if (!(clearance > least)) return clearance;
    }
  }
  return clearance;
}

double TurnedRows::search(int n_sites, std::optional<Lattice>& best) const {
  double n_lattices = 0;
  for (int columns = 1; columns <= n_sites; ++columns) {
    if (n_sites % columns != 0) continue;
    const int rows = n_sites / columns;
    n_lattices += rows;
    for (int turns = 0; turns < rows; ++turns) {
      Lattice lattice{columns, rows, turns, 0};
      const double least = best ? best->clearance : least_clearance_;
      lattice.clearance = clearance_of(lattice, least);
      if (lattice.clearance > least) best = lattice;
    }
  }
  return n_lattices * static_cast<double>(pairs_.size());
}

int TurnedRows::most_sites() const { return static_cast<int>(std::min(box_.area() / area_, 2e9)); }

std::optional<Lattice> TurnedRows::find(int n_rods) const {
  std::optional<Lattice> best;
  double work = 0;
  for (int n = n_rods; n <= most_sites() && work < kMostWork; ++n) {
    if (best && n > n_rods + kFewMore) break;
    work += search(n, best);
  }
  return best;
}

int TurnedRows::most_below(int n_rods) const {
  std::optional<Lattice> best;
  double work = 0;
  for (int n = std::min(n_rods - 1, most_sites()); n > 0 && work < kMostWork; --n) {
    work += search(n, best);
    if (best) return n;
  }
  return 0;
}

}  // namespace shaken
