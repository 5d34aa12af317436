// SPDX-License-Identifier: MIT
// The checks behind the table of claims, by subject, and the pieces that several of them are made of.
#pragma once

#include <string>

#include "study/questions.h"
#include "study/run_set.h"

namespace shaken::study {

/// The runs of one sweep at a length and an area fraction.
RunSet of(const Library& runs, const char* set, double length, double fraction);
/// The layered sweep's at a length, an area fraction and an end diameter.
RunSet layers(const Library& runs, double length, double fraction, double end_diameter = 0.4);

/// The paper's box [mm], its smaller one. A narrower box orders more easily: there, order is no sign of order in the
/// paper's, and disorder is.
inline constexpr double kPapersBox = 83.7;
bool is_papers_box(const RunSet& runs);

/// <S> above which a state counts as ordered, as the paper draws the line.
inline constexpr double kOrdered = 0.5;

/// The mean of a curve over several places. Its error is the mean of theirs, as if they went up and down together,
/// which is the most it can be.
class MeanOverPlaces {
 public:
  /// A place without a value is left out; an error of NaN makes that of the mean unknown.
  void add(double value, double sem);
  Estimate of(const FinishedRun& run) const;

 private:
  double sum_ = 0, errors_ = 0;
  int n_ = 0;
};
/// Its error at place k of a curve of `n` places; NaN where the run has none.
double error_at(const std::vector<double>& errors, std::size_t k, std::size_t n);

// order_claims.cpp: where rods order, how sharply, from which start and in which box
Finding starts_aligned_and_settles(const Library& runs);
Finding ordered_when_dense(const Library& runs);
Finding disordered_when_dilute(const Library& runs);
Finding short_rods_do_not_order(const Library& runs);
Finding transition_falls_with_length(const Library& runs);
Finding saturates(const Library& runs);
Finding transition_rises_with_size(const Library& runs);
Finding long_range(const Library& runs);
Finding one_peak(const Library& runs);
Finding broadest_at_the_transition(const Library& runs);
Finding oblique_axis(const Library& runs);
Finding activity(const Library& runs);

// structure_claims.cpp: correlations in space, elasticity
Finding g2_decays_or_levels(const Library& runs);
Finding g2_isotropic_when_dilute(const Library& runs);
Finding g2_anisotropic(const Library& runs);
Finding g_flattens(const Library& runs);
Finding splay_stiffer_than_bend(const Library& runs);
/// G2 far away: mean over the last quarter of the distances, up to half the box.
Estimate far_g2(const RunSet& runs);

// layer_claims.cpp: layers and what they depend on, crystal
Finding layers_when_dense(const Library& runs);
Finding g2_oscillates(const Library& runs);
Finding no_layers_at_wide_gaps(const Library& runs);
Finding crystal_at_a_narrow_gap(const Library& runs);
Finding angle_grows_with_packing(const Library& runs);
Finding angle_falls_with_length(const Library& runs);
Finding angle_falls_with_end(const Library& runs);
Finding two_peaks_at_every_end(const Library& runs);
Finding wavelength_falls_with_packing(const Library& runs);
Finding wavelength_grows_with_length(const Library& runs);
Finding wavelength_grows_with_end(const Library& runs);
Finding larger_box(const Library& runs);

// motion_claims.cpp: swimming, diffusion, rotation, defects
Finding tilt_and_velocity(const Library& runs);
Finding no_motion_sideways(const Library& runs);
Finding tilt_switches(const Library& runs);
Finding persists_when_dense(const Library& runs);
Finding diffusion_rises(const Library& runs);
Finding diffusion_law(const Library& runs);
Finding diffusion_is_normal(const Library& runs);
Finding diffusion_along_the_director(const Library& runs);
Finding no_superdiffusion_across(const Library& runs);
Finding slower_when_denser(const Library& runs);
Finding c2_levels_off(const Library& runs);
Finding velocity_along_grows(const Library& runs);
Finding rotation_slows(const Library& runs);
Finding rotation_subdiffusive(const Library& runs);
Finding turning_saturates(const Library& runs);
Finding defects_move(const Library& runs);

}  // namespace shaken::study
