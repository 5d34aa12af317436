// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sim/core/result.h"

namespace shaken::run {

/// The arrays of observables.h5, by path in the file. Units are in the names.
///   /order/{time_s, order, director_rad}                     S(t) and the director's angle
///   /angles/{theta_rad, density_per_rad}                     P(theta) about the director, in the steady state
///   /tilt/{n_z, v_along_mm_s, v_along_sem_mm_s, v_across_mm_s, v_across_sem_mm_s, density}   against the tilt
///   /defects/{time_s, n_plus, n_minus}                       defects at each sample
///   /defects/list/{time_s, x_mm, y_mm, charge, direction_rad}  every defect found
///   /g2/{r_mm, g2}                                           orientational correlation
///   /msd/{lag_s, total_mm2, along_mm2, across_mm2}           mean square displacement
using Observables = std::map<std::string, std::vector<double>>;

[[nodiscard]] std::optional<Error> write_observables(const std::filesystem::path& file, const Observables& arrays);
/// All one-dimensional arrays of the file.
Result<Observables> read_observables(const std::filesystem::path& file);

}  // namespace shaken::run
