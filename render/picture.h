// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/defects.h"
#include "sim/core/bead_row.h"
#include "sim/core/result.h"
#include "sim/core/types.h"
#include "sim/system.h"

namespace shaken::render {

/// S(t) of the run so far, drawn as a curve beside the rods; empty where it is not known.
struct OrderHistory {
  std::vector<double> time;   ///< increasing [s]
  std::vector<double> order;  ///< (time.size())
  double start = 0;           ///< left end of the time axis [s]
  double end = 0;             ///< right end of the time axis [s]
};

/// One instant of a run, as plain values: all that is needed to draw it.
struct RodPicture {
  double time = 0;      ///< [s]
  double box_side = 0;  ///< of the square box, periodic in x and y [mm]
  double gap = 0;       ///< between the plates [mm]

  BeadRow beads;                             ///< of a rod of the first species
  std::vector<BeadRow> added;                ///< of rods of the other species
  std::vector<std::uint8_t> species_of_rod;  ///< (n_rods) species of each rod, from 0; empty if there is one
  std::vector<Vec3> position;                ///< (n_rods) centres [mm]
  std::vector<Vec3> director;                ///< (n_rods) unit vectors, to the head
  std::optional<SideWalls> walls;            ///< of the arena in the middle of the box, if there are any

  // Of the rods of the first species.
  double order = 0;           ///< S, nematic order in the plane
  double director_angle = 0;  ///< of the mean director N, against the x axis [rad]
  std::vector<analysis::Defect> defects;
  /// Of the director field in which defects are looked for [mm]; 0: the defaults of a run.
  double smoothing = 0, grid = 0;
  OrderHistory history;
  std::string label;  ///< what makes this run different, "rods.length=2.5 rods.area_fraction=0.6"

  std::size_t n_rods() const { return position.size(); }
  std::size_t n_species() const { return 1 + added.size(); }
  std::size_t species_of(std::size_t rod) const { return species_of_rod.empty() ? 0 : species_of_rod[rod]; }
  const BeadRow& beads_of(std::size_t species) const { return species == 0 ? beads : added[species - 1]; }
  /// Rods of one species.
  std::size_t count(std::size_t species) const;
  /// The directors of the rods of the first species, which order and colours are about.
  std::vector<Vec3> first_directors() const;
  /// Tip to tip, of the first species [mm].
  double rod_length() const;
  /// Share of the arena, or of the box, covered by the projections of all rods, lying flat and side by side.
  double area_fraction() const;
};

/// Fills order, director_angle and, if asked, defects from the rods of the first species; defects are looked for within
/// the side walls, and where there are rods (analysis/director_field.h), as a run does that measures them.
void measure(RodPicture& picture, bool with_defects);

enum class Colouring {
  kLayers,  ///< by the angle to the director: red to its left, magenta to its right, neutral along it
  kWheel,   ///< by the angle in the box, on a colour circle of period pi
};
enum class Theme { kLight, kDark };

/// How to draw it.
struct PictureStyle {
  int width = 1280;  ///< [pixels]
  int height = 720;  ///< [pixels]
  Colouring colouring = Colouring::kLayers;
  Theme theme = Theme::kLight;
  bool mark_defects = true;
  bool scale_bar = true;
  bool legend = true;
  bool caption = true;
  double zoom = 1.0;     ///< >= 1: shows a square of box_side / zoom
  Vec2 focus{0.5, 0.5};  ///< middle of the view, in box sides; the view wraps round the box
};

/// What is wrong with a style, if anything.
Result<void> check(const PictureStyle& style);

}  // namespace shaken::render
