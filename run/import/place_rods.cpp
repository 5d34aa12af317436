#include "run/import/place_rods.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/text.h"
#include "sim/close_up.h"
#include "sim/motion/start_motion.h"
#include "sim/overlaps.h"

namespace shaken::run {
namespace {

constexpr std::size_t kMostListed = 20;
constexpr double kRounding = 1e-6;  ///< of what is 0 where all rods lie in one plane
constexpr double kUmPerMm = 1000;
constexpr double kCorner = 0.01;  ///< share of the box, along each side, in which all places are hardly meant to lie

/// The lowest height over the base that a rod with such a director can have.
double resting_height(const Species& species, const Vec3& director) {
  double height = 0;
  for (int b = 0; b < species.n_beads(); ++b)
    height = std::max(height, species.bead_radius[b] - species.bead_offset[b] * director.z());
  return height;
}

/// Half the gap, where nothing moves rods out of that plane.
void put_into_plane(ImportedRod& rod, double middle) {
  rod.position.z() = middle;
  rod.director.z() = 0;
  rod.director.normalize();
}

bool is_in_plane(const ImportedRod& rod, double middle) {
  const double z = rod.position.z();
  return (std::isnan(z) || std::abs(z - middle) < kRounding * (1 + middle)) && std::abs(rod.director.z()) < kRounding &&
         rod.velocity.z() == 0 && rod.angular_velocity.head<2>().isZero(0);
}

bool is_still(const Flight& flight) {
  return std::abs(flight.director.z()) < kRounding && flight.velocity.isZero(0) && flight.precession.isZero(0) &&
         flight.spin == 0;
}

class PlacingRods {
 public:
  PlacingRods(const System& system, const std::string& file, bool are_lines, std::vector<keys::Problem>& problems)
      : file_(file), are_lines_(are_lines), problems_(problems), placed_{empty_world(system)} {}

  std::optional<PlacedRods> place(const std::vector<ImportedRod>& rods) {
    const std::size_t n_before = problems_.size();
    if (are_lines_ && have_sizes()) return std::nullopt;
    check_numbers(rods);
    for (const ImportedRod& rod : rods) add(rod);
    if (!is_in_other_units() && !is_crowded()) check_overlaps();
    if (problems_.size() > n_before) return std::nullopt;
    begin_flights();
    return std::move(placed_);
  }

 private:
  const System& system() const { return placed_.world.system; }

  void report(const ImportedRod& rod, const std::string& message) {
    problems_.push_back({file_, are_lines_ ? rod.number : 0, are_lines_ ? 1 : 0, "",
                         are_lines_ ? message : fmt::format("rod {}: {}", rod.number, message)});
  }
  void report(const std::string& message) { problems_.push_back({file_, 0, 0, "", message}); }

  /// A line does not say how long its rod is.
  bool have_sizes() {
    if (placed_.world.species_of_shape.back() + 1U == placed_.world.species.size()) return false;
    report(
        "a table says nothing of sizes, and rods of the scene differ in size: leave out length_spread and "
        "end_diameter_spread, or import the trajectory of a run");
    return true;
  }

  void check_numbers(const std::vector<ImportedRod>& rods) {
    const std::vector<std::string> names = species_names(system());
    for (std::size_t k = 0; k < placed_.world.species.size(); ++k) {
      const std::string& name = names[placed_.world.species_of_shape[k]];
      const auto found = std::count_if(rods.begin(), rods.end(), [&](const auto& rod) { return rod.shape == k; });
      const std::vector<std::uint8_t>& kinds = placed_.world.shape_of_rod;
      const auto wanted = std::count(kinds.begin(), kinds.end(), static_cast<std::uint8_t>(k));
      if (found == wanted) continue;
      report(fmt::format(
          "the file has {} of `{}` that can be read, and the scene has {}: set {}.count to the number in the "
          "file, in place of an area_fraction",
          counted(static_cast<std::size_t>(found), "rod"), name, wanted, name));
    }
  }

  /// Takes the rod if its centre is where it may be.
  void add(ImportedRod rod) {
    const double middle = 0.5 * system().gap;
    const Box box = system().box();
    const auto inside = [&](int axis) { return rod.position[axis] >= 0 && rod.position[axis] <= box[axis]; };
    if (!inside(0) || !inside(1)) {
      return report(rod, fmt::format("the centre ({:.6g}, {:.6g}) mm is outside of the box, [0, {:.6g}] by [0, {:.6g}] "
                                     "mm: places count from its lower left corner",
                                     rod.position.x(), rod.position.y(), box.x(), box.y()));
    }
    if (system().is_planar()) {
      if (!is_in_plane(rod, middle)) {
        return report(rod,
                      "without plates and gravity all rods lie in the middle plane: leave out z, nz, tilt, vz, wx "
                      "and wy");
      }
      put_into_plane(rod, middle);
    } else if (std::isnan(rod.position.z())) {
      if (!system().base) return report(rod, "there is no base on which it could rest: give its height, column z");
      ++placed_.n_resting;
      rod.position.z() = resting_height(placed_.world.species[rod.shape], rod.director);
    }
    rod.position.z() += placed_.world.plates.at(0).base;
    poses_.push_back({rod.position, rod.director});
    kinds_.push_back(rod.shape);
    rods_.push_back(rod);
  }

  /// Whether all places lie at the corner of the box.
  bool is_in_other_units() {
    if (poses_.size() < 2) return false;
    Vec2 farthest = Vec2::Zero();
    for (const Pose& pose : poses_) farthest = farthest.cwiseMax(pose.position.head<2>());
    const Vec2 sides = system().box().sides();
    if ((farthest.array() >= kCorner * sides.array()).any()) return false;
    report(
        fmt::format("all places lie within {:.3g} by {:.3g} mm at the corner of a box of {:.6g} by {:.6g} mm: places "
                    "are in mm; are these in metres?",
                    farthest.x(), farthest.y(), sides.x(), sides.y()));
    return true;
  }

  /// Whether more rods have their centres in one place than can lie there: to list all their overlaps would take as
  /// long as the square of their number.
  bool is_crowded() {
    double longest = 0, thinnest = INFINITY;
    for (const Species& species : placed_.world.species) {
      longest = std::max(longest, 2 * (species.half_length + species.end_radius));
      thinnest = std::min(thinnest, 2 * species.max_radius);
    }
    const double layers = std::max(1.0, system().gap / thinnest);
    const double most = 100 + 4 * layers * (longest / thinnest + 1) * 4;
    std::map<std::pair<long, long>, std::size_t> found;
    for (const Pose& pose : poses_) {
      const std::pair cell{std::lround(pose.position.x() / longest), std::lround(pose.position.y() / longest)};
      if (static_cast<double>(++found[cell]) <= most) continue;
      report(fmt::format(
          "more than {:.0f} rods have their centres within {:.3g} mm of ({:.3g}, {:.3g}) mm, where as many "
          "cannot lie: are the places in another unit than mm?",
          most, longest, static_cast<double>(cell.first) * longest, static_cast<double>(cell.second) * longest));
      return true;
    }
    return false;
  }

  double accepted() const {
    double thinnest = INFINITY;
    for (const Species& species : placed_.world.species)
      thinnest = std::min(thinnest, *std::min_element(species.bead_radius.begin(), species.bead_radius.end()));
    return (are_lines_ ? kAcceptedInTables : kAcceptedOfRuns) * thinnest;
  }

  void check_overlaps() {
    std::vector<Overlap> overlaps = find_overlaps(placed_.world, kinds_, poses_);
    std::stable_sort(overlaps.begin(), overlaps.end(),
                     [](const Overlap& a, const Overlap& b) { return a.depth > b.depth; });
    const auto end = std::find_if(overlaps.begin(), overlaps.end(),
                                  [most = accepted()](const Overlap& overlap) { return overlap.depth <= most; });
    if (end != overlaps.end()) placed_.deepest = end->depth;
    const auto n_too_deep = static_cast<std::size_t>(end - overlaps.begin());
    if (n_too_deep == 0) return;
    for (std::size_t k = 0; k < std::min(n_too_deep, kMostListed); ++k) {
      const Overlap& overlap = overlaps[k];
      const std::string other = overlap.other < 0 ? fmt::format("the {}", surface_name(overlap.other))
                                                  : fmt::format("{} {}", are_lines_ ? "the rod of line" : "rod",
                                                                rods_[static_cast<std::size_t>(overlap.other)].number);
      report(rods_[static_cast<std::size_t>(overlap.rod)],
             fmt::format("overlaps {} by {:.1f} um", other, overlap.depth * kUmPerMm));
    }
    report(
        fmt::format("{} deeper than {:.1f} um{}: move the rods apart, in the file, or give the scene rods as thin as "
                    "those of the file and the box, gap, walls and posts that they were in",
                    counted(n_too_deep, "overlap"), accepted() * kUmPerMm,
                    n_too_deep > kMostListed ? fmt::format(", of which the deepest {} are listed", kMostListed) : ""));
  }

  void begin_flights() {
    World& world = placed_.world;
    std::vector<std::size_t> next(world.species.size(), 0);  // of each shape, where to look for its next rod
    for (const std::uint8_t kind : world.shape_of_rod) {
      std::size_t& from = next[kind];
      while (kinds_[from] != kind) ++from;
      const std::size_t k = from++;
      const Species& species = world.species[kind];
      Flight flight;
      begin_flight(flight, 0, poses_[k], {rods_[k].velocity, rods_[k].angular_velocity}, system().box(),
                   species.inertia_ratio);
      flight.image = {0, 0};
      placed_.n_still += is_still(flight) ? 1 : 0;
      world.rods.push_back(flight);
    }
  }

  const std::string& file_;
  bool are_lines_;
  std::vector<keys::Problem>& problems_;
  PlacedRods placed_;
  std::vector<ImportedRod> rods_;  ///< taken so far, with heights as in the world
  std::vector<Pose> poses_;        ///< of these
  std::vector<std::uint8_t> kinds_;
};

}  // namespace

std::vector<std::string> species_names(const System& system) {
  std::vector<std::string> names{"rods"};
  for (std::size_t k = 1; k < kMostSpecies; ++k) {
    if (system.has_species(k)) names.push_back(fmt::format("rods_{}", k + 1));
  }
  return names;
}

std::optional<PlacedRods> place_rods(const System& system, const std::vector<ImportedRod>& rods,
                                     const std::string& file, bool are_lines, std::vector<keys::Problem>& problems) {
  return PlacingRods(system, file, are_lines, problems).place(rods);
}

void draw_velocities(World& world) {
  for (std::size_t i = 0; i < world.rods.size(); ++i) {
    Rng rng(world.system.seed, RngStream::kVelocity, 0, i);
    push_at_start(world.rods[i], world.system, rng);
  }
}

}  // namespace shaken::run
