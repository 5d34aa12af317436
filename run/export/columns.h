#pragma once

#include <string>
#include <vector>

#include "base/core/result.h"
#include "run/files/observables_file.h"

namespace shaken::run {

/// The arrays of observables.h5 that each of `names` stands for, as CSV: a name is that of an array ("/msd/total_mm2",
/// with or without the first slash) or of a group ("msd"), which stands for all arrays in it but not for groups further
/// down (`defect_maps`, which has nothing but axes, for the maps of both charges). Headings are the names below the
/// last folder that all of them share, and end in units. Arrays of a group are in the order of their records
/// (run/measure/), with their errors behind them: what a curve is drawn against comes first. Maps have one line for
/// each of their points, with its place on each axis, the fastest first. NaN is an empty field.
/// Fails with all problems, one a line: names of nothing, and arrays of different lengths.
Result<std::string> observables_csv(const Observables& arrays, const std::vector<std::string>& names);

/// The groups and arrays that a name may stand for, one a line, with units and lengths.
std::string observables_list(const Observables& arrays);

/// The numbers of a summary.json, one a line: name, value, sem, n_effective, steady, over_s. Those of `measured` go by
/// their own names and the average of S(t) by "order"; all others by their paths ("collisions.rod_rod"). What is not
/// known is an empty field. Fails if `summary` is no JSON object.
Result<std::string> summary_csv(const std::string& summary);

}  // namespace shaken::run
