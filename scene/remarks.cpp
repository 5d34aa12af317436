#include "scene/remarks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "base/keys/units.h"
#include "scene/keys/derived.h"
#include "scene/keys/fields.h"
#include "scene/keys/measured_species.h"
#include "scene/keys/observables.h"
#include "sim/rod/sizes.h"
#include "sim/rod/species.h"

namespace shaken::scene {

namespace {

/// Some plate rubs on some species.
bool has_plate_friction(const System& system) {
  bool has = false;
  for (std::size_t number = 0; number < kMostSpecies; ++number) {
    if (!system.has_species(number)) continue;
    has |= (system.base && system.rod_base.of(number).has_friction()) ||
           (system.lid && system.rod_lid.of(number).has_friction());
  }
  return has;
}

/// At how many phases of a vibration samples are taken that follow each other after so many periods; 0: at many.
int phases_met(double periods) {
  constexpr int kMany = 24;
  for (int n = 1; n <= kMany; ++n) {
    if (std::abs(n * periods - std::round(n * periods)) < 1e-6 * n * std::max(1.0, periods)) return n;
  }
  return 0;
}

/// The blocks that ask for what spheres do not have, "measure.order, measure.defects"; empty if there are none.
std::string of_axes_that_are_missing(const RunPlan& plan) {
  std::string blocks;
  for (const Observable& observable : observables()) {
    if (!observable.lacks_axis(plan)) continue;
    blocks += (blocks.empty() ? "" : ", ") + observable.block.path;
  }
  return blocks;
}

/// Whether one end differs from the other.
bool has_head(const RodShape& rod) {
  if (!rod.bead_diameters.empty()) {
    return !std::equal(rod.bead_diameters.begin(), rod.bead_diameters.end(), rod.bead_diameters.rbegin());
  }
  return rod.has_axis() && rod.profile == Profile::kPolar && rod.mid_diameter != rod.end_diameter;
}

/// That friction may not stop what slides down the slope; none if it may well, or if walls or posts do.
std::optional<std::string> remark_on_slope(const System& system) {
  if (!system.has_inclination() || system.walls || system.posts) return std::nullopt;
  const double slope = std::tan(system.inclination * kPi / 180);
  double friction = 0;
  for (std::size_t number = 0; number < kMostSpecies; ++number) {
    if (!system.has_species(number)) continue;
    if (system.base) friction = std::max(friction, system.rod_base.of(number).friction);
    if (system.lid) friction = std::max(friction, system.rod_lid.of(number).friction);
  }
  if (slope <= friction) return std::nullopt;
  return fmt::format(
      "plates.inclination {:.4g} degrees is steeper than the friction of the plates, whose angle is {:.3g} degrees: "
      "without walls rods may slide down faster and faster, until the run ends because one is too fast",
      system.inclination, std::atan(friction) * 180 / kPi);
}

/// That no rod gets through between the posts of a lattice that fills the box; none if some do.
std::optional<std::string> remark_on_posts(const System& system) {
  if (!system.posts || !system.posts->places.empty() || system.walls) return std::nullopt;
  double thinnest = INFINITY;
  for (const Component& rods : components_of(system)) {
    if (rods.count > 0) thinnest = std::min(thinnest, species_of(rods.shape).max_radius);
  }
  const double apart = std::max(system.box().x() / system.posts->columns, system.box().y() / system.posts->rows);
  const double gap = apart - system.posts->diameter;
  if (gap > 2 * thinnest) return std::nullopt;
  return fmt::format(
      "the posts leave gaps of at most {}, through which no rod gets: each stays between the posts where it starts",
      format_quantity(gap, Dimension::kLength));
}

/// That rods which pile up may sink into each other: contacts without restitution do not throw apart what one pass over
/// them leaves approaching (docs/stability.md).
std::optional<std::string> remark_on_piles(const System& system) {
  if (system.solver_sweeps > 1 || !system.base || system.gravity == 0) return std::nullopt;
  double thickest = 0, least = 1;
  for (std::size_t number = 0; number < kMostSpecies; ++number) {
    if (!system.has_species(number)) continue;
    for (std::size_t other = 0; other < kMostSpecies; ++other) {
      if (system.has_species(other)) least = std::min(least, system.rod_rod.of(number, other).restitution);
    }
  }
  for (const Component& rods : components_of(system))
    thickest = std::max(thickest, 2 * species_of(rods.shape).max_radius);
  if (system.gap < 2 * thickest || least >= 0.1) return std::nullopt;
  return fmt::format(
      "box.gap {} leaves room for rods on top of each other, and rods have a restitution of {:.3g}: where they pile up "
      "they may sink into each other until the run ends; take contacts.sweeps 4",
      format_quantity(system.gap, Dimension::kLength), least);
}

/// That rods which climb over each other while the lid is up may be crushed when it comes down.
std::optional<std::string> remark_on_closing(const System& system) {
  if (!system.has_lid_motion() || !system.base) return std::nullopt;
  double thinnest = INFINITY;
  for (const Component& rods : components_of(system)) thinnest = std::min(thinnest, species_of(rods.shape).max_radius);
  const double least = system.least_gap(), most = 2 * system.gap - least;
  if (most - least <= thinnest) return std::nullopt;
  return fmt::format(
      "the lid closes the gap from {} to {}, by more than a rod's radius: rods that have climbed over each other may "
      "be crushed, which ends the run; a shorter time.step helps, or contacts.sweeps 4",
      format_quantity(most, Dimension::kLength), format_quantity(least, Dimension::kLength));
}

}  // namespace

std::vector<std::string> remarks(const RunPlan& plan) {
  std::vector<std::string> list;
  for (const auto& remark :
       {remark_on_posts(plan.system), remark_on_piles(plan.system), remark_on_closing(plan.system)}) {
    if (remark) list.push_back(*remark);
  }
  const double total = plan.total_time();
  const auto remark_one_frame = [&](const char* path, double every) {
    if (every <= total) return;
    list.push_back(fmt::format("{} {} is longer than the run, {}: there will be a single frame, of the start", path,
                               format_quantity(every, Dimension::kTime), format_quantity(total, Dimension::kTime)));
  };
  for (const Field& field : fields()) {
    const bool is_locked = field.path.ends_with(".phases") && fields().value(plan, field) == Value("locked");
    if (!is_locked || !plan.system.has_moving_plates()) continue;
    const std::string& block = fields().block_of(field)->path;
    const double every = std::get<double>(field_at(block + ".every").fetch(plan));
    const double periods = every * plan.system.frequency;
    if (const int phases = phases_met(periods); phases > 0) {
      list.push_back(
          fmt::format("{0}.every {1} is {2:.6g} periods of the plates: samples see them at {3} of their "
                      "vibration, and means may be those of that instant; take {0}.phases \"spread\"",
                      block, format_quantity(every, Dimension::kTime), periods,
                      phases == 1 ? "a single phase" : fmt::format("{} phases", phases)));
    }
  }
  if (plan.trajectory) remark_one_frame("trajectory.every", plan.trajectory->every);
  if (plan.movie) remark_one_frame("movie.every", plan.movie->every);
  for (const Field& field : fields()) {
    const Field* block = fields().block_of(field);
    if (block == nullptr || !block->path.starts_with("measure.") || field.path != block->path + ".every" ||
        !std::get<bool>(block->fetch(plan)) || std::get<double>(field.fetch(plan)) <= total) {
      continue;
    }
    list.push_back(fmt::format("{} {} is longer than the run, {}: there will be a single sample, of the start",
                               field.path, format_quantity(std::get<double>(field.fetch(plan)), Dimension::kTime),
                               format_quantity(total, Dimension::kTime)));
  }
  const bool is_of_one_of_several =
      plan.of == MeasuredSpecies::kFirst && (plan.system.added[0] || plan.system.added[1]);
  const std::vector<MeasuredRods> measured = measured_species(plan);
  const auto has = [&](auto what) { return std::ranges::any_of(measured, what); };
  if (plan.polar && has([](const MeasuredRods& rods) { return rods.plan.system.rod.has_axis(); }) &&
      !has([](const MeasuredRods& rods) { return has_head(rods.plan.system.rod); })) {
    list.push_back(
        fmt::format("measure.polar: no rod that is measured has a head, so which end counts as one is arbitrary{}",
                    is_of_one_of_several ? "; observables are those of the first species (measure.of)" : ""));
  }
  for (const MeasuredRods& rods : measured) {
    const std::string unmeasured = of_axes_that_are_missing(rods.plan);
    if (unmeasured.empty()) continue;
    list.push_back(fmt::format(
        "spheres ({}.beads 1) have no axis, so this is not measured: {}{}", rods.prefix.empty() ? "rods" : rods.prefix,
        unmeasured, is_of_one_of_several ? "; observables are those of the first species (measure.of)" : ""));
  }
  if (plan.system.lets_rods_rest()) {
    list.push_back(fmt::format("{} {:.4g}: below 1 the base never falls faster than the rods, which come to rest on it",
                               plan.system.has_second_vibration() || plan.system.has_inclination()
                                   ? "the largest acceleration of the base over that of gravity across it is"
                                   : "plates.gamma is",
                               plan.system.peak_acceleration() / plan.system.gravity_on_plates().down));
  }
  if (const auto remark = remark_on_slope(plan.system)) list.push_back(*remark);
  if (plan.system.inclination > 0 && plan.system.gravity == 0)
    list.emplace_back("plates.inclination: without gravity nothing pulls the rods down the slope");
  if (plan.system.inclination_angle != 0 && plan.system.inclination == 0)
    list.emplace_back("plates.inclination_angle: the plates are level (plates.inclination is 0), so it has no effect");
  if (plan.system.second && !plan.system.base && !plan.system.lid)
    list.emplace_back("plates.second: there are no plates that could vibrate");
  if (plan.system.has_horizontal_vibration() && !has_plate_friction(plan.system)) {
    list.push_back(
        "plates.horizontal_amplitude: no plate has friction, so the vibration in the plane does not reach the rods");
  }
  return list;
}

}  // namespace shaken::scene
