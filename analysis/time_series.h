// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace shaken::analysis {

/// Integrated autocorrelation time in samples, tau = sum of rho(t) for t = 1 .. M, the window M being the first with
/// M >= 5 (1 + 2 tau(M)) (Sokal 1997, with the constant of emcee). At least 0; 0 for a constant series or fewer than
/// four samples. Costs at most a bounded number of operations times log(n): where the window is long the series is
/// first averaged in pairs, which leaves the error of the mean as it is. Only as good as the series is long: trust it
/// where n > 100 tau.
double autocorrelation_time(std::span<const double> values);

/// g = 1 + 2 tau: the number of samples worth one independent one, in [1, n].
double statistical_inefficiency(std::span<const double> values);

/// One level of the blocking transformation.
struct BlockLevel {
  std::size_t block_length = 1;  ///< samples in a block
  std::size_t n_blocks = 0;
  double sem = 0;        ///< standard error of the mean as if blocks were independent; grows to a plateau
  double sem_error = 0;  ///< its own standard error, sem / sqrt(2 (n_blocks - 1))
};
/// Flyvbjerg & Petersen, J. Chem. Phys. 91, 461 (1989): levels of doubling block length down to two blocks.
std::vector<BlockLevel> block_levels(std::span<const double> values);
/// The standard error of the mean at the first block length B with B^3 > 2 n g_B^2, g_B = (sem_B / sem_1)^2
/// (Lee et al., Phys. Rev. E 83, 066706 (2011)); the last level's if there is none, 0 below two samples.
double block_sem(std::span<const double> values);

/// Index at which the steady state begins: the t0 that leaves the most effective samples, N_eff = (n - t0) / g(t0)
/// (Chodera, J. Chem. Theory Comput. 12, 1799 (2016)). Long series are averaged to at most 4096 points first; t0 is
/// looked for on a coarse set of candidates within the first three quarters and then refined round the best. A t0 at
/// three quarters says that no steady state was reached.
std::size_t steady_index(std::span<const double> values);

/// A series' steady state in numbers.
struct SteadySummary {
  double mean = 0;
  double std = 0;          ///< spread of single samples: the bars of Sharma & Soni 2024, not an error of the mean
  double sem = 0;          ///< standard error of the mean, std * sqrt(g / n); 0 and unknown where n_effective <= 1
  double tau = 0;          ///< integrated autocorrelation time [unit of times]
  double t_steady = 0;     ///< time of the first sample that counts
  double n_effective = 0;  ///< independent samples, n / g; 0 if no sample counts
};

/// Summary of `values` (n) at equally spaced, rising `times` (n), from `steady_start` on, or from the time that
/// steady_index finds. Works for any length, also none, and for constant values.
SteadySummary summarize_series(std::span<const double> times, std::span<const double> values,
                               std::optional<double> steady_start = std::nullopt);

}  // namespace shaken::analysis
