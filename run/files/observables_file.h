// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "run/files/provenance.h"
#include "sim/core/result.h"

namespace shaken::run {

/// The arrays of observables.h5, by path in the file. Units are in the names.
///   /order/{time_s, order, director_rad}                     S(t) and the director's angle
///   /order/pdf/{order, density}                              P[S]
///   /angles/{theta_rad, density_per_rad}                     P(theta) about the director, in the steady state
///   /tilt/{n_z, v_along_mm_s, v_along_sem_mm_s, v_across_mm_s, v_across_sem_mm_s, density}   against the tilt
///   /tilt/folded/{n_z, v_along_mm_s, v_along_sem_mm_s}       for n_z > 0, with v(-n_z) = -v(n_z)
///   /defects/{time_s, n_plus, n_minus}                       defects at each sample
///   /defects/tracks/{span_s, speed_plus_mm_s, speed_minus_mm_s, speed_plus_along_mm_s, speed_plus_across_mm_s} and
///     their ..._sem_mm_s: mean speeds of +1/2 and -1/2 against the time they are taken over, and the +1/2's velocity
///     along and across the ray on which its director is radial (its tail). /defects/tracks/lasting: of those that last
///   /defects/list/{time_s, x_mm, y_mm, charge, direction_rad, track}  every defect found, if the scene asks for it
///   /g2/{r_mm, g2, g2_sem, g, g_sem}                         orientational correlation, pair distribution
///   /fluctuations/{area_fraction, mean_n, std_n, std_n_sem, std_n_without_map, std_n_without_map_sem}   numbers of
///     rods in boxes, over boxes and time and about each box's own mean
///   /frank/{q_along_per_mm, q_across_per_mm, power_mm2, power_sem_mm2, fit_mm2}   the director's fluctuations
///   /pairs/{along_mm, across_mm, g, g2}                      maps in the director's frame, across slowest
///   /pairs/cut/{r_mm, g_along, g_across, g2_along, g2_across}  cuts through them, with ..._sem
///   /layers/{q_per_mm, spectrum_across, spectrum_along}      power of sin 2 (theta - director) against wave number
///   /msd/{lag_s, total_mm2, along_mm2, across_mm2}           mean square displacement
///   /msd/{relative_total_mm2, relative_along_mm2, relative_across_mm2}   without the drift of all rods together
///   /msd/{NAME_sem_mm2, exponent, exponent_sem}              errors of these; d ln total / d ln lag
///   /msd/{d_total_mm2_s, d_along_mm2_s, d_across_mm2_s} and their ..._sem_mm2_s   mean square over 2 d lag
///   /rotation/{lag_s, msad_rad2, msad_sem_rad2, c2, c2_sem}  mean square angular displacement, C_2(t)
///   /velocity/{lag_s, c_v, c_v_sem, c_v_along, c_v_along_sem, c_v_across, c_v_across_sem}   C_v(t)
///   /velocity/{product_mm2_s2, product_along_mm2_s2, product_across_mm2_s2} and their ..._sem_mm2_s2   C_v(t) not
///     normalised; /velocity/{direction, direction_sem}: of the velocities' unit vectors
///   /rods/trace/time_s, /rods/trace/K/{x_mm, y_mm, theta_rad, n_z}   where rod K of those kept goes
using Observables = std::map<std::string, std::vector<double>>;

/// Every data set has its unit as the attribute `unit` (unit_of_name), the file says which run it is of.
[[nodiscard]] std::optional<Error> write_observables(const std::filesystem::path& file, const Observables& arrays,
                                                     const Provenance& provenance = {});
/// All one-dimensional arrays of the file.
Result<Observables> read_observables(const std::filesystem::path& file);

}  // namespace shaken::run
