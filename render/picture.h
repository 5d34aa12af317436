#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/defects.h"
#include "analysis/geometry/director_field.h"
#include "base/core/result.h"
#include "base/core/types.h"
#include "sim/cell.h"
#include "sim/snapshot.h"

namespace shaken::render {

/// S(t) of the run so far, drawn as a curve beside the rods; empty where it is not known.
struct OrderHistory {
  std::vector<double> time;   ///< increasing [s]
  std::vector<double> order;  ///< (time.size())
  double start = 0;           ///< left end of the time axis [s]
  double end = 0;             ///< right end of the time axis [s]
};

/// Where one defect was in the time before, the oldest place first.
struct DefectTrail {
  struct Place {
    Vec2 position = Vec2::Zero();  ///< goes on across the border of a periodic box [mm]
    double age = 0;                ///< in [0, 1], 1 being the whole length of the track
  };
  double charge = 0;
  std::vector<Place> places;
};

/// The points of a sweep, by one or two of its parameters.
struct SweepMap {
  struct Point {
    Vec2 at = Vec2::Zero();  ///< in the units of the sweep; of one parameter alone, the second is S
    double order = 0;        ///< S; NaN where it is not known yet
  };
  std::string x, y;  ///< the parameters' names; y is empty if there is one
  std::vector<Point> points;
};

/// Key and value of what a file says of itself: "Run id", "Seed".
using Notes = std::vector<std::pair<std::string, std::string>>;

/// How high plots reach in a film, so that their axes stand still (film_axes); 0: as this picture needs.
struct FilmAxes {
  double share = 0;    ///< of rods, the highest bar of the legend
  double density = 0;  ///< P(theta) [1/degree]
};

/// Rods and plates at one instant: of the rods at least where they are and where they point; the velocities are empty
/// where they are not known.
struct Frame : Snapshot {
  double base = 0;  ///< height of the base [mm]; rods' heights are counted as it is, from its lowest point
  bool has_lid = true;
  std::optional<double> lid{};  ///< height of the lid, where it is not the gap above the base [mm]
  /// (n_rods) how far each rod's centre has come within some time, across borders too [mm]; empty unless asked for.
  std::vector<Vec2> displacement;
};

/// What was found in a frame, of the rods of the first species but for the density; what was not asked for is empty.
struct Findings {
  double order = 0;           ///< S, nematic order in the plane; NaN where there are no axes
  double director_angle = 0;  ///< of the nematic director N, against the x axis [rad]
  std::vector<analysis::Defect> defects;
  std::vector<DefectTrail> tracks;                       ///< of the defects of now and of shortly before
  std::optional<Vec2> followed;                          ///< where the defect is that the view follows [mm]
  std::shared_ptr<const analysis::DirectorField> field;  ///< null unless it was asked for
  std::vector<double> density;                           ///< (n_rods) area fraction around each rod, of all species
};

/// What is written beside the rods, and what the plots show that the frame does not: the run so far, its sweep.
struct Captions {
  Notes settings;        ///< that identify the run, in the words of the field: {"ℓ", "4.5 mm"}
  std::string label;     ///< headline: what makes this run different
  std::string subtitle;  ///< below it: what it has in common with others
  OrderHistory history;
  std::shared_ptr<const SweepMap> sweep;  ///< null where it is not known
  Vec2 sweep_point = Vec2::Zero();        ///< where this run is in it; of one parameter, the second is not asked
  double playback = 0;     ///< of a film: simulated seconds per second of playing; 0: not known, or not a film
  double film_share = -1;  ///< of a film that has passed, in [0, 1]; negative: not a film
  FilmAxes axes;
  Notes notes;  ///< where it comes from, for the metadata of files
};

/// One instant of a run, as plain values: all that is needed to draw it. A function that draws takes the parts that it
/// needs.
struct RodPicture {
  Cell cell;
  Frame frame;
  Findings found;
  Captions captions;

  /// Other runs at the same time, drawn beside this one, each with its own headline (render/panels.h).
  std::vector<RodPicture> beside;

  std::size_t n_rods() const { return frame.position.size(); }
  /// Rods of one species.
  std::size_t count(std::size_t species) const { return cell.of_species(species, frame.position).size(); }
  /// Rods of one shape.
  std::size_t count_of_shape(std::size_t shape) const;
  /// Tip to tip, of the first species' mean rod [mm].
  double rod_length() const { return cell.shapes.front().length(); }
  /// "4.5 mm"; with the standard deviation where rods of the first species differ, "4.5±0.2 mm".
  std::string length_text() const;
  /// Share of the arena, or of the box, covered by the projections of all rods, lying flat and side by side.
  double area_fraction() const;
};

/// What is worked out of the rods for a picture; what is not asked for costs nothing.
struct Asked {
  bool defects = false;
  bool field = false;    ///< the director field
  bool density = false;  ///< the area fraction around each rod
  /// Smoothing and mesh of the director field in which defects are looked for [mm]; 0: the defaults of a run.
  double smoothing = 0, grid = 0;
};

/// Fills what is found: order, director_angle and what is asked for, from the rods of the first species. Defects are
/// looked for within the side walls, and where there are rods (analysis/geometry/director_field.h), as a run does that
/// measures them. The density is that of all rods.
void measure(RodPicture& picture, const Asked& asked);

}  // namespace shaken::render
