#include "scene/keys/observables.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/core/box_grids.h"
#include "base/core/check.h"
#include "base/core/series_limits.h"
#include "scene/keys/measured_species.h"

namespace shaken::scene {

namespace {

constexpr double kNumberBytes = 8;  ///< bytes of a double or a count
constexpr double kBlocks = kMostStretches, kSeries = kMostSeriesPoints;
/// Arrays that grow with the run double when they are full too: they have room for 1 to 2 times what is in them.
constexpr double kSpare = 0.5;

template <class Access>
Field phases(Access access) {
  return choice<SamplePhases>("phases", access, {{"spread", SamplePhases::kSpread}, {"locked", SamplePhases::kLocked}},
                              "Whether each sample is taken at a random instant of its interval, and so all of them at "
                              "all phases of the vibration alike, or at whole multiples of `every`.");
}

/// Wave vectors up to `waves` of them to the longer side of the box, one of each pair +-q
/// (analysis/geometry/wave_sums.h).
double half_plane(double waves, const Box& box) {
  const Vec2 most = most_waves(box, waves);
  return (most.x() + 1) * (2 * most.y() + 1);
}

/// Bytes of a director field while it is made: Q, the density of rods and that of the nodes, each node's sum by rows
/// and in all.
double field_bytes(double nodes) { return 5 * kNumberBytes * nodes; }

MeasureMemory of_defects(const Sizes& sizes) {
  const System& system = sizes.plan.system;
  const MeasureDefects& defects = *sizes.plan.defects;
  const double nodes = grid_nodes(system.box(), defects.grid_for(system.rod.length)).prod();
  // Zeros of a Gaussian field that is smoothed over s: 1 / (4 pi s^2) of them an area (Halperin, Les Houches 35, 813
  // (1981)); the field has no more than one in a mesh.
  const double smoothing = defects.smoothing_for(system.rod.length);
  const double found = std::min(system.box().area() / (4 * std::numbers::pi * smoothing * smoothing), nodes);
  constexpr double kTrack = 1200;  // with its last 17 places
  const double list = defects.list ? 6 * kNumberBytes * found * sizes.samples : 0;
  return {found * kTrack + list, field_bytes(nodes), list, kSpare * list};
}

double map_sums(double bins) { return 2 * 7 * bins * bins; }

MeasureMemory of_defect_maps(const Sizes& sizes) {
  const System& system = sizes.plan.system;
  // Errors are found from copies of all stretches, twice, and from what each stretch adds to each number.
  const double bins = sizes.plan.defect_maps->bins, copies = 3 * sizes.stretches * kNumberBytes * map_sums(bins);
  const double nodes = grid_nodes(system.box(), sizes.plan.defect_maps->grid_for(system.rod.length)).prod();
  return {0, std::max(field_bytes(nodes), copies)};
}

MeasureMemory of_density(const Sizes& sizes) {
  const MeasureDensity& density = *sizes.plan.density;
  const System& system = sizes.plan.system;
  const double cells = grid_nodes(system.box(), density.grid_for(system.rod.length)).prod();
  const double maps = std::floor(sizes.samples / std::max(1.0, std::round(density.duration / density.every)));
  const double bytes = maps * (cells + 1) * kNumberBytes;
  return {bytes + 3 * kNumberBytes * cells, 0, bytes, kSpare * bytes};
}

MeasureMemory of_velocity(const Sizes& sizes) {
  const MeasureVelocity& velocity = *sizes.plan.velocity;
  const double window = std::max(1.0, std::round(velocity.window / velocity.every));
  return {std::min(window, sizes.samples) * (sizes.rods * 2 * kNumberBytes + 100)};
}

MeasureMemory of_rods(const Sizes& sizes) {
  const MeasureRods& rods = *sizes.plan.rods;
  const double kept = std::min(sizes.samples, std::floor(rods.duration / rods.every * (1 + 1e-12)) + 1);
  const double bytes = kept * kNumberBytes * (4 * std::min<double>(rods.count, sizes.rods) + 1);
  return {bytes, 0, bytes, kSpare * bytes};
}

double pair_sums(const RunPlan& plan) {
  const Box box = plan.system.box();
  const double side = box.shorter(), bins = plan.pairs->bins;
  const double range = std::min(plan.pairs->range_for(plan.system.rod.length, side), side / 2);
  return 2 * (bins * bins + 2 * box.longer() / 2 / (2 * range / bins));
}

double layer_sums(const RunPlan& plan) {
  const Box box = plan.system.box();
  const double waves =
      std::floor(std::min(40 * std::sqrt(box.longer() / box.shorter()), 2 * box.longer() / plan.system.rod.length));
  return 2 * (half_plane(waves, box) + 2 * waves);
}

/// The rows, each by the name of its observable.
namespace rows {

using Plan = MeasurePlan;
using enum Dimension;

// clang-format off
Observable order() {
  return {
    .doc = "Nematic order parameter S(t) in the plane.",
    .is_usual = true,
    .axis = AxisUse::kNeeded,
    .series = 4, .angles = 1, .sums = [](const RunPlan&) { return 105.0; },
    .remedy = "a longer `every`"};
}

Observable angles() {
  return {
    .doc = "Distribution of the angle between a rod and the director.",
    .axis = AxisUse::kNeeded,
    .keys = {
      whole("bins", at<&Plan::angles, &MeasureAngles::bins>, 2, 10000, "Number of bins over [-pi/2, pi/2).")},
    .sums = [](const RunPlan& p) -> double { return p.angles->bins; },
    .remedy = "fewer `bins`"};
}

Observable tilt() {
  return {
    .doc = "Mean velocity along and across the rod against its tilt n_z.",
    .axis = AxisUse::kNeeded,
    .every_doc = "Mean time between samples.",
    .keys = {
      phases(at<&Plan::tilt, &MeasureTilt::phases>),
      whole("bins", at<&Plan::tilt, &MeasureTilt::bins>, 2, 10000,
            "Number of bins, from the largest downward to the largest upward tilt that the gap allows.")},
    .sums = [](const RunPlan& p) -> double { return 3 * p.tilt->bins; },
    .remedy = "fewer `bins`"};
}

Observable defects() {
  return {
    .doc = "Topological defects of the smoothed director field, where there are rods (and only within the walls, if "
           "any).",
    .open = "the director at every place",
    .axis = AxisUse::kNeeded,
    .keys = {
      derived(quantity("smoothing", at<&Plan::defects, &MeasureDefects::smoothing>, kLength, 0.01, 200,
                       "Standard deviation of the Gaussian that smooths the director field."),
              "half a rod length"),
      derived(quantity("grid", at<&Plan::defects, &MeasureDefects::grid>, kLength, 0.01, 200,
                       "Mesh width of the director field."),
              "an eighth of a rod length"),
      later(on_or_off("list", at<&Plan::defects, &MeasureDefects::list>,
                      "Whether every defect found is kept, with its track. The memory for this grows in proportion "
                      "to the run.")),
      later(quantity("min_lifetime", at<&Plan::defects, &MeasureDefects::min_lifetime>, kTime, 1e-7, 1e5,
                     "Tracks at least this long are also reported separately, because noise makes short-lived "
                     "pairs."))},
    .series = 3, .memory = of_defects,
    .remedy = "a coarser `grid`, or no `list`"};
}

Observable g2() {
  return {
    .doc = "Orientational correlation G2(r) and pair distribution g(r) (only within the walls, if any).",
    .open = "lines of sight",
    .axis = AxisUse::kPartly,
    .keys = {
      whole("bins", at<&Plan::g2, &MeasureG2::bins>, 2, 10000,
            "Number of bins over distances from 0 to half the box, by its shorter side.")},
    .sums = [](const RunPlan& p) -> double { return 3 * p.g2->bins; },
    .remedy = "fewer `bins`"};
}

Observable msd() {
  return {
    .doc = "Mean square displacement (MSD) against lag.",
    .axis = AxisUse::kPartly,
    .every_doc = "Time between samples, which is the shortest lag.",
    .lags = {2, 8},
    .remedy = "fewer rods"};
}

Observable fluctuations() {
  return {
    .doc = "Giant number fluctuations, from the numbers of rods in boxes of 1/4 to 1/400 of the area.",
    .open = "numbers in boxes of equal area",
    .sums = [](const RunPlan&) { return 2635.0; }};  // 1054 boxes of ten sizes
}

Observable frank() {
  return {
    .doc = "Fluctuations of the director against the wave vector, and the ratio of the Frank constants of bend and "
           "splay.",
    .periodic = "the waves",
    .is_of_squares = true,
    .axis = AxisUse::kNeeded,
    .sums = [](const RunPlan&) { return 270.0; }};
}

Observable rotation() {
  return {
    .doc = "Rotation in the plane against lag: mean square angular displacement (MSAD) and C2(t).",
    .axis = AxisUse::kNeeded,
    .every_doc = "Time between samples, which is the shortest lag. In this time a rod must turn by much less than a "
                 "quarter turn.",
    .lags = {1, 6},
    .remedy = "fewer rods"};
}

Observable velocity() {
  return {
    .doc = "Velocity autocorrelation C_v(t).",
    .axis = AxisUse::kPartly,
    .every_doc = "Time between samples, which is the shortest lag.",
    .keys = {
      quantity("window", at<&Plan::velocity, &MeasureVelocity::window>, kTime, 1e-7, 1e5,
               "Velocities are displacements over this time, which is rounded to a multiple of `every`.")},
    .lags = {2, 6}, .memory = of_velocity,
    .remedy = "a shorter `window`, or a longer `every`"};
}

Observable rods() {
  return {
    .doc = "Paths of single rods, from `time.steady` on (from the start if that is \"auto\").",
    .keys = {
      whole("count", at<&Plan::rods, &MeasureRods::count>, 1, 1000,
            "Number of rods that are followed. They are spread evenly over the indices."),
      quantity("duration", at<&Plan::rods, &MeasureRods::duration>, kTime, 1e-6, 1e7,
               "Time for which these rods are followed.")},
    .memory = of_rods,
    .remedy = "a smaller `count`, a shorter `duration`, or a longer `every`"};
}

Observable pairs() {
  return {
    .doc = "Maps of g(x, y) and G2(x, y) in the frame of the director, and cuts through them.",
    .periodic = "the nearest images",
    .axis = AxisUse::kNeeded,
    .keys = {
      whole("bins", at<&Plan::pairs, &MeasurePairs::bins>, 2, 201,
            "Number of bins of a map in each direction; use an odd number to have a bin centred on 0. A run keeps 64 "
            "maps, one for each interval of time, with 16 bytes per bin: 41 MB at most."),
      derived(quantity("range", at<&Plan::pairs, &MeasurePairs::range>, kLength, 0.01, 1000,
                       "Half the width of the map. It is at most half the box, by its shorter side."),
              "three rod lengths, at most half the box")},
    .sums = pair_sums,
    .remedy = "fewer `bins`"};
}

Observable layers() {
  return {
    .doc = "Layers along the director: spectrum, wavelength and order.",
    .periodic = "the waves",
    .axis = AxisUse::kNeeded,
    .sums = layer_sums};
}

Observable lattice() {
  return {
    .doc = "Crystalline order: psi_6 and the largest Bragg peak.",
    .periodic = "the nearest images and waves"};
}

Observable structure() {
  return {
    .doc = "Structure factor S(q) of the rods' centres: in all directions, along the director and across it.",
    .periodic = "the waves",
    .axis = AxisUse::kPartly,
    .keys = {
      whole("waves", at<&Plan::structure, &MeasureStructure::waves>, 2, 128,
            "Number of wave numbers 2 pi k / L, L being the longer side of the box. The time that a sample takes grows with its square.")},
    .sums = [](const RunPlan& p) -> double { return 6 * p.structure->waves; },
    .remedy = "fewer `waves`"};
}

Observable polar() {
  return {
    .doc = "Polar order P(t) of the rods' heads, and velocities towards them.",
    .axis = AxisUse::kNeeded,
    .every_doc = "Mean time between samples.",
    .keys = {
      phases(at<&Plan::polar, &MeasurePolar::phases>)},
    .series = 4, .angles = 1,
    .remedy = "a longer `every`"};
}

Observable temperatures() {
  return {
    .doc = "Granular temperatures: of translation along and across the plates and the rods, and of rotation.",
    .axis = AxisUse::kPartly,
    .every_doc = "Mean time between samples.",
    .keys = {
      phases(at<&Plan::temperatures, &MeasureTemperatures::phases>)},
    .series = 9,
    .remedy = "a longer `every`"};
}

Observable scattering() {
  return {
    .doc = "Self-intermediate scattering function F_s(q, t) and non-Gaussian parameter against lag.",
    .axis = AxisUse::kPartly,
    .every_doc = "Time between samples, which is the shortest lag.",
    .keys = {
      derived(quantity("wavelength", at<&Plan::scattering, &MeasureScattering::wavelength>, kLength, 0.001, 1000,
                       "Longest of four wavelengths 2 pi / q, each of which is half of that before."),
              "a rod length")},
    .lags = {2, 15},
    .remedy = "fewer rods"};
}

Observable van_hove() {
  return {
    .doc = "Distribution of displacements (self part of the van Hove function) at four lags.",
    .axis = AxisUse::kPartly,
    .every_doc = "Time between samples, of which the lags are multiples.",
    .keys = {
      quantity("lag", at<&Plan::van_hove, &MeasureVanHove::lag>, kTime, 1e-7, 1e5,
               "Longest of four lags; the others are 1/4, 1/16 and 1/64 of it, rounded to multiples of `every`."),
      whole("bins", at<&Plan::van_hove, &MeasureVanHove::bins>, 2, 10000,
            "Number of bins of the displacement's magnitude at each lag."),
      derived(quantity("range", at<&Plan::van_hove, &MeasureVanHove::range>, kLength, 1e-6, 1e5,
                       "Largest displacement at the longest lag; at the others it is 1/2, 1/4 and 1/8 of it."),
              "a rod length")},
    .sums = [](const RunPlan& p) -> double { return 8 * p.van_hove->bins; }, .per_rod = 64,
    .remedy = "fewer `bins`"};
}

Observable flow() {
  return {
    .doc = "Correlation C(r) of the velocities of two rods against their distance (only within the walls, if any).",
    .open = "lines of sight",
    .axis = AxisUse::kPartly,
    .every_doc = "Time between samples; velocities are the displacements from one to the next.",
    .keys = {
      whole("bins", at<&Plan::flow, &MeasureFlow::bins>, 2, 10000,
            "Number of bins over distances from 0 to half the box, by its shorter side.")},
    .sums = [](const RunPlan& p) -> double { return 4 * p.flow->bins; }, .per_rod = 150,
    .remedy = "fewer `bins`"};
}

Observable clusters() {
  return {
    .doc = "Clusters of rods whose axes are near each other, and their sizes.",
    .keys = {
      derived(quantity("distance", at<&Plan::clusters, &MeasureClusters::distance>, kLength, 0.01, 100,
                       "Rods are of one cluster if their axes, from one end bead's centre to the other's, are nearer "
                       "than this."),
              "1.25 middle diameters"),
      quantity("angle", at<&Plan::clusters, &MeasureClusters::angle>, kPlain, 0, 90,
               "Largest angle in degrees between the axes of two neighbours of one cluster. 90: any.")},
    .series = 3, .per_rod = 150,
    .remedy = "a longer `every`"};
}

Observable collisions() {
  return {
    .doc = "Rates of impacts, mean free time, and the energy that impacts move; of all rods, whatever their species.",
    .every_doc = "Time between samples, over which rates are means.",
    .series = 8,
    .remedy = "a longer `every`"};
}

Observable stress() {
  return {
    .doc = "Pressure in the plane: what motion and impacts of rods carry of momentum, along the director and across "
           "it; of all rods, whatever their species.",
    .axis = AxisUse::kPartly,
    .every_doc = "Mean time between samples, over which momentum that impacts carry is summed.",
    .keys = {phases(at<&Plan::stress, &MeasureStress::phases>)},
    .series = 9,
    .remedy = "a longer `every`"};
}

Observable mixing() {
  return {
    .doc = "Pair distributions g(r) of every two species, and how far the species keep apart (only within the walls, "
           "if any); of all rods, whatever `measure.of` says.",
    .open = "lines of sight",
    .keys = {
      whole("bins", at<&Plan::mixing, &MeasureMixing::bins>, 2, 10000,
            "Number of bins over distances from 0 to half the box, by its shorter side."),
      derived(quantity("distance", at<&Plan::mixing, &MeasureMixing::distance>, kLength, 0.01, 100,
                       "Rods are neighbours if their centres are nearer than this: at most half the box, by its "
                       "shorter side."),
              "a rod length, at most half the box")},
    // 3 or 6 pairs of species
    .sums = [](const RunPlan& p) -> double { return 2 * 4 * p.mixing->bins; }, .per_rod = 40,
    .remedy = "fewer `bins`"};
}

Observable defect_maps() {
  return {
    .doc = "Maps about topological defects of +1/2 and of -1/2, each in the frame of the defect: density, director, "
           "velocity and tilt of rods (only within the walls, if any).",
    .open = "the director at every place",
    .axis = AxisUse::kNeeded,
    .every_doc = "Time between samples; velocities are the displacements from the one before to the one after.",
    .keys = {
      whole("bins", at<&Plan::defect_maps, &MeasureDefectMaps::bins>, 2, 101,
            "Number of bins of a map in each direction; use an odd number to have a bin centred on the defect. A run "
            "keeps 64 sets of maps, one for each interval of time, with 112 bytes per bin: 73 MB at most."),
      derived(quantity("range", at<&Plan::defect_maps, &MeasureDefectMaps::range>, kLength, 0.01, 1000,
                       "Radius of the maps. It is at most half the box, by its shorter side."),
              "two rod lengths, at most half the box"),
      derived(quantity("separation", at<&Plan::defect_maps, &MeasureDefectMaps::separation>, kLength, 0.001, 1000,
                       "Defects that are nearer than this to another one are left out, as the pairs that noise makes."),
              "a rod length"),
      derived(quantity("smoothing", at<&Plan::defect_maps, &MeasureDefectMaps::smoothing>, kLength, 0.01, 200,
                       "Standard deviation of the Gaussian that smooths the director field."),
              "half a rod length"),
      derived(quantity("grid", at<&Plan::defect_maps, &MeasureDefectMaps::grid>, kLength, 0.01, 200,
                       "Mesh width of the director field."),
              "an eighth of a rod length")},
    .sums = [](const RunPlan& p) { return map_sums(p.defect_maps->bins); }, .per_rod = 72, .memory = of_defect_maps,
    .remedy = "fewer `bins`, or a coarser `grid`"};
}

Observable density() {
  return {
    .doc = "Maps of the area fraction in time, how much it varies from place to place, and for how long a map keeps (only "
           "within the walls, if any).",
    .open = "cells of known area",
    .keys = {
      quantity("duration", at<&Plan::density, &MeasureDensity::duration>, kTime, 1e-7, 1e7,
               "Time over which one map is averaged, rounded to a multiple of `every`. All maps of the run are kept."),
      derived(quantity("grid", at<&Plan::density, &MeasureDensity::grid>, kLength, 0.01, 1000,
                       "Width of the cells of a map, at most; there are at least four each way."),
              "a rod length")},
    .memory = of_density,
    .remedy = "a coarser `grid`, or a longer `duration`"};
}

Observable drift() {
  return {
    .doc = "The common drift of all rods in the plane: displacement of the mean of their centres, and mean velocity.",
    .keys = {},
    .series = 3,
    .remedy = "a longer `every`"};
}

// clang-format on

}  // namespace rows

/// Completes a row: the observable's settings are the member `settings` of a plan.
template <auto settings>
Observable of(const char* name, Observable row) {
  row.name = name;
  const std::string path = "measure." + row.name;
  std::string doc = row.doc;
  if (!row.within_walls()) {
    doc += " Not available with walls or posts.";
  } else if (!row.among_posts()) {
    doc += " Not available with posts.";
  }
  if (row.is_of_squares) doc += " Only in square boxes.";
  if (row.axis == AxisUse::kNeeded) doc += " Not measured of spheres, which have no axis.";
  row.block = block(path, at<settings>, row.is_usual, doc);
  row.every = every(
      path + ".every", [](auto& plan) -> auto& { return (plan.*settings)->every; }, row.every_doc);
  for (Field& key : row.keys) key.path = path + "." + key.path;
  return row;
}

}  // namespace

bool Observable::lacks_axis(const RunPlan& plan) const {
  return axis == AxisUse::kNeeded && !plan.system.rod.has_axis() && std::get<bool>(block.fetch(plan));
}

std::optional<double> Observable::period(const RunPlan& plan) const {
  if (!std::get<bool>(block.fetch(plan)) || lacks_axis(plan)) return std::nullopt;
  return std::get<double>(every.fetch(plan));
}

bool Observable::is_spread(const RunPlan& plan) const {
  const int phases = field_index("measure." + name + ".phases");
  return phases >= 0 && fields()[static_cast<std::size_t>(phases)].fetch(plan) == Value("spread");
}

const std::vector<Observable>& observables() {
#define SHAKEN_ROW(name, Settings) of<&MeasurePlan::name>(#name, rows::name()),
  static const std::vector<Observable> table{SHAKEN_OBSERVABLES(SHAKEN_ROW)};
#undef SHAKEN_ROW
  return table;
}

const Observable& observable(std::string_view name) {
  const auto found =
      std::find_if(observables().begin(), observables().end(), [&](const Observable& one) { return one.name == name; });
  SHAKEN_CHECK(found != observables().end(), std::string(name));
  return *found;
}

namespace {

/// The last 8 of every 2^k-th sample, of each of 16 levels, are kept for lags to come (analysis/lags/lag_average.h).
double kept_for_lags(double samples) {
  double kept = 0;
  for (int k = 0; k < 16; ++k) kept += std::min(8.0, std::ceil(samples / std::exp2(k)));
  return kept;
}

MeasureMemory memory_of(const Observable& one, const Sizes& sizes) {
  double points = sizes.samples;  // of a series, whose neighbours are averaged in pairs where it is full
  while (points >= kSeries) points /= 2;
  const double series = std::floor(points) * one.series * kNumberBytes;
  const double sums = (one.sums == nullptr ? 0 : one.sums(sizes.plan)) + 69 * one.lags.sums;
  MeasureMemory needed = one.memory == nullptr ? MeasureMemory{} : one.memory(sizes);
  needed.state += series + sizes.rods * (one.per_rod + kept_for_lags(sizes.samples) * one.lags.columns * kNumberBytes) +
                  sizes.stretches * sums * kNumberBytes;
  needed.file += series - std::floor(points) * one.angles * kNumberBytes;
  needed.spare += std::min(kSeries, sizes.samples) * one.series * kNumberBytes - series;
  return needed;
}

}  // namespace

std::map<std::string, MeasureMemory> measure_memory(const RunPlan& plan) {
  std::map<std::string, MeasureMemory> memory;
  for (const MeasuredRods& rods : measured_species(plan)) {
    for (const Observable& one : observables()) {
      const auto every = one.period(rods.plan);
      if (!every) continue;
      const double ticks = std::max(1.0, std::round(*every / plan.system.dt));
      const double samples = std::floor(plan.longest_time() / (ticks * plan.system.dt) * (1 + 1e-12)) + 1;
      double in_stretch = 1;
      while (samples > kBlocks * in_stretch) in_stretch *= 2;
      Sizes sizes{rods.plan, samples, static_cast<double>(rods.plan.system.n_rods), std::ceil(samples / in_stretch)};
      const MeasureMemory needed = memory_of(one, sizes);
      sizes.stretches = std::min(kBlocks, samples);
      MeasureMemory& sum = memory[one.name];
      sum.state += needed.state;
      sum.scratch = std::max(sum.scratch, needed.scratch);
      sum.file += needed.file;
      sum.spare += needed.spare + memory_of(one, sizes).state - needed.state;
    }
  }
  return memory;
}

double peak_of(const std::map<std::string, MeasureMemory>& memory) {
  double states = 0, spare = 0, scratch = 0;
  for (const auto& [name, one] : memory) {
    states += one.state;
    spare += one.spare;
    scratch = std::max(scratch, one.scratch);
  }
  return states + spare + std::max(states, scratch);
}

}  // namespace shaken::scene
