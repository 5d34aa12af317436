// SPDX-License-Identifier: MIT
// A pair of defects that a run starts with is what the finder finds: known places, charges and directions.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "analysis/defects.h"
#include "sim/start/compression.h"
#include "sim/start/director_patterns.h"
#include "tests/support/effort.h"

namespace shaken::analysis {
namespace {

std::vector<Defect> defects_of(const System& system) {
  const auto world = make_compressed_world(system);
  EXPECT_TRUE(world) << world.error().message;
  std::vector<Vec3> positions, directors;
  for (const Flight& rod : world->rods) {
    positions.push_back(rod.position);
    directors.push_back(rod.director);
  }
  const DirectorField field(positions, directors, Region(system.box()), Grid(system.box(), system.rod.length / 8),
                            system.rod.length / 2);
  return find_defects(field);
}

// Nothing else is found. Now and then the core of one is so void of rods that the finder sees no director there.
TEST(PlantedDefects, AreFoundWhereTheyWerePlanted) {
  int n_planted = 0, n_found = 0;
  for (const double aspect : {1.0, 2.0}) {
    for (const double angle : {0.0, 90.0}) {
      for (std::uint64_t seed = 1; seed <= (test::kSanitized ? 2 : 5); ++seed) {
        System system;
        system.rod = {.length = 3.5, .n_beads = 11};
        system.box_side = aspect == 1 ? 33 : 24;
        system.box_aspect = aspect;
        system.n_rods = static_cast<int>(std::round(0.75 * system.box().area() / make_species(system.rod).area));
        system.start = Start::kDefectPair;
        system.start_separation = 0.5 * system.box().longer();
        system.start_angle = angle;
        system.seed = seed;
        SCOPED_TRACE(testing::Message() << "aspect " << aspect << ", angle " << angle << ", seed " << seed);
        const auto [plus, minus] = defect_pair(system.box(), system.start_separation);
        const std::vector<Defect> found = defects_of(system);
        EXPECT_LE(found.size(), 2u);
        EXPECT_TRUE(found.size() < 2 || found[0].charge == -found[1].charge);
        for (const Defect& defect : found) {
          EXPECT_EQ(std::abs(defect.charge), 0.5);
          EXPECT_LT((defect.position - (defect.charge > 0 ? plus : minus)).norm(), system.rod.length);
          if (defect.charge < 0) continue;
          // the ray along which the director is radial leads away from the other defect, or to it, as the angle says
          const double line = aspect == 1 ? 0 : 0.5 * kPi;
          const double tail = std::abs(angle * kPi / 180 - line) < 0.1 ? line + kPi : line;
          EXPECT_GT(std::cos(defect.direction - tail), std::cos(0.4)) << defect.direction;
        }
        n_planted += 2;
        n_found += static_cast<int>(found.size());
      }
    }
  }
  std::printf("%d of %d defects are found\n", n_found, n_planted);
  EXPECT_GE(n_found, n_planted - 3);
}

}  // namespace
}  // namespace shaken::analysis
