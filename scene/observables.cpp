// SPDX-License-Identifier: MIT
#include "scene/observables.h"

#include <algorithm>
#include <utility>

#include "base/core/check.h"

namespace shaken::scene {

namespace {

/// Completes a row of the table: the observable's settings are the member `settings` of a plan.
template <auto settings>
Observable of(Observable row) {
  const std::string path = "measure." + row.name;
  std::string doc = row.doc;
  if (!row.within_walls()) doc += " Not available with walls.";
  if (row.axis == AxisUse::kNeeded) doc += " Not measured of spheres, which have no axis.";
  row.block = block(path, at<settings>, row.is_usual, doc);
  row.every = every(
      path + ".every", [](auto& plan) -> auto& { return (plan.*settings)->every; }, row.every_doc);
  for (Field& key : row.keys) key.path = path + "." + key.path;
  return row;
}

using Plan = MeasurePlan;

// clang-format off
std::vector<Observable> make_observables() {
  using enum Dimension;
  return {
    of<&Plan::order>({
      .name = "order",
      .doc = "Nematic order parameter S(t) in the plane.",
      .is_usual = true,
      .axis = AxisUse::kNeeded}),
    of<&Plan::angles>({
      .name = "angles",
      .doc = "Distribution of the angle between a rod and the director.",
      .axis = AxisUse::kNeeded,
      .keys = {
        whole("bins", at<&Plan::angles, &MeasureAngles::bins>, 2, 10000, "Number of bins over [-pi/2, pi/2).")}}),
    of<&Plan::tilt>({
      .name = "tilt",
      .doc = "Mean velocity along and across the rod against its tilt n_z.",
      .axis = AxisUse::kNeeded,
      .every_doc = "Mean time between samples.",
      .keys = {
        choice<SamplePhases>("phases", at<&Plan::tilt, &MeasureTilt::phases>,
                             {{"spread", SamplePhases::kSpread}, {"locked", SamplePhases::kLocked}},
                             "Whether each sample is taken at a random instant of its interval, and so all of them at "
                             "all phases of the vibration alike, or at whole multiples of `every`."),
        whole("bins", at<&Plan::tilt, &MeasureTilt::bins>, 2, 10000,
              "Number of bins, from the largest downward to the largest upward tilt that the gap allows.")}}),
    of<&Plan::defects>({
      .name = "defects",
      .doc = "Topological defects of the smoothed director field, where there are rods (and only within the walls, if "
             "any).",
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
                       "pairs."))}}),
    of<&Plan::g2>({
      .name = "g2",
      .doc = "Orientational correlation G2(r) and pair distribution g(r) (only within the walls, if any).",
      .axis = AxisUse::kPartly,
      .keys = {
        whole("bins", at<&Plan::g2, &MeasureG2::bins>, 2, 10000,
              "Number of bins over distances from 0 to half the box.")}}),
    of<&Plan::msd>({
      .name = "msd",
      .doc = "Mean square displacement (MSD) against lag.",
      .axis = AxisUse::kPartly,
      .every_doc = "Time between samples, which is the shortest lag."}),
    of<&Plan::fluctuations>({
      .name = "fluctuations",
      .doc = "Giant number fluctuations, from the numbers of rods in boxes of 1/4 to 1/400 of the area."}),
    of<&Plan::frank>({
      .name = "frank",
      .doc = "Fluctuations of the director against the wave vector, and the ratio of the Frank constants of bend and "
             "splay.",
      .periodic = "the waves",
      .axis = AxisUse::kNeeded}),
    of<&Plan::rotation>({
      .name = "rotation",
      .doc = "Rotation in the plane against lag: mean square angular displacement (MSAD) and C2(t).",
      .axis = AxisUse::kNeeded,
      .every_doc = "Time between samples, which is the shortest lag. In this time a rod must turn by much less than a "
                   "quarter turn."}),
    of<&Plan::velocity>({
      .name = "velocity",
      .doc = "Velocity autocorrelation C_v(t).",
      .axis = AxisUse::kPartly,
      .every_doc = "Time between samples, which is the shortest lag.",
      .keys = {
        quantity("window", at<&Plan::velocity, &MeasureVelocity::window>, kTime, 1e-7, 1e5,
                 "Velocities are displacements over this time, which is rounded to a multiple of `every`.")}}),
    of<&Plan::rods>({
      .name = "rods",
      .doc = "Paths of single rods, from `time.steady` on (from the start if that is \"auto\").",
      .keys = {
        whole("count", at<&Plan::rods, &MeasureRods::count>, 1, 1000,
              "Number of rods that are followed. They are spread evenly over the indices."),
        quantity("duration", at<&Plan::rods, &MeasureRods::duration>, kTime, 1e-6, 1e7,
                 "Time for which these rods are followed.")}}),
    of<&Plan::pairs>({
      .name = "pairs",
      .doc = "Maps of g(x, y) and G2(x, y) in the frame of the director, and cuts through them.",
      .periodic = "the nearest images",
      .axis = AxisUse::kNeeded,
      .keys = {
        whole("bins", at<&Plan::pairs, &MeasurePairs::bins>, 2, 201,
              "Number of bins of a map in each direction; use an odd number to have a bin centred on 0. A run keeps 64 "
              "maps, one for each interval of time, with 16 bytes per bin: 41 MB at most."),
        derived(quantity("range", at<&Plan::pairs, &MeasurePairs::range>, kLength, 0.01, 1000,
                         "Half the width of the map. It is at most half the box."),
                "three rod lengths, at most half the box")}}),
    of<&Plan::layers>({
      .name = "layers",
      .doc = "Layers along the director: spectrum, wavelength and order.",
      .periodic = "the waves",
      .axis = AxisUse::kNeeded}),
    of<&Plan::lattice>({
      .name = "lattice",
      .doc = "Crystalline order: psi_6 and the largest Bragg peak.",
      .periodic = "the nearest images and waves"}),
    of<&Plan::structure>({
      .name = "structure",
      .doc = "Structure factor S(q) of the rods' centres: in all directions, along the director and across it.",
      .periodic = "the waves",
      .axis = AxisUse::kPartly,
      .keys = {
        whole("waves", at<&Plan::structure, &MeasureStructure::waves>, 2, 128,
              "Number of wave numbers 2 pi k / L. The time that a sample takes grows with its square.")}}),
  };
}
// clang-format on

}  // namespace

bool Observable::lacks_axis(const RunPlan& plan) const {
  return axis == AxisUse::kNeeded && !plan.system.rod.has_axis() && std::get<bool>(block.fetch(plan));
}

std::optional<double> Observable::period(const RunPlan& plan) const {
  if (!std::get<bool>(block.fetch(plan)) || lacks_axis(plan)) return std::nullopt;
  return std::get<double>(every.fetch(plan));
}

const std::vector<Observable>& observables() {
  static const std::vector<Observable> table = make_observables();
  return table;
}

const Observable& observable(std::string_view name) {
  const auto found =
      std::find_if(observables().begin(), observables().end(), [&](const Observable& one) { return one.name == name; });
  SHAKEN_CHECK(found != observables().end(), std::string(name));
  return *found;
}

}  // namespace shaken::scene
