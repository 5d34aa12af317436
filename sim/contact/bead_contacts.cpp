#include "sim/contact/bead_contacts.h"

#include <algorithm>
#include <cmath>

namespace shaken {

namespace {

/// Kept between a quick test and what it lets pass, so that rounding hides no contact [mm].
constexpr double kMargin = 1e-5;

}  // namespace

void find_bead_contacts(const Species& i, const Vec3& n_i, const Species& j, const Vec3& n_j, const Vec3& D,
                        std::vector<BeadContact>& contacts) {
  const double reach = i.max_radius + j.max_radius + kMargin;
  if (segment_distance_squared(D, n_i, i.half_length, n_j, j.half_length) > reach * reach) return;
  find_bead_contacts(i, n_i, j, n_j, D, {0, i.n_beads()}, contacts);
}

void find_bead_contacts(const Species& i, const Vec3& n_i, const Species& j, const Vec3& n_j, const Vec3& D,
                        BeadRange beads, std::vector<BeadContact>& contacts) {
  const int last = j.n_beads() - 1;
  const double pitch = j.pitch();
  const double first = j.bead_offset.front();
  for (int a = beads.from; a < beads.to; ++a) {
    const Vec3 from_a = D - i.bead_offset[a] * n_i;  // bead a -> centre of j
    const double foot = -from_a.dot(n_j);            // coordinate on j's axis nearest to bead a
    const double cut = i.bead_radius[a] + j.max_radius + kMargin;
    const double across2 = from_a.squaredNorm() - foot * foot;
    if (across2 > cut * cut) continue;
    const double half_chord = std::sqrt(cut * cut - std::max(across2, 0.0));
    const int from = std::max(0, static_cast<int>(std::ceil((foot - half_chord - first) / pitch)));
    const int to = std::min(last, static_cast<int>(std::floor((foot + half_chord - first) / pitch)));
    for (int b = from; b <= to; ++b) {
      const Vec3 r = from_a + j.bead_offset[b] * n_j;
      const double touch = i.bead_radius[a] + j.bead_radius[b];
      const double r2 = r.squaredNorm();
      if (r2 >= touch * touch) continue;
      const double distance = std::sqrt(r2);
      contacts.push_back({a, b, touch - distance, distance > 0 ? Vec3(r / distance) : Vec3(Vec3::UnitZ())});
    }
  }
}

}  // namespace shaken
