// SPDX-License-Identifier: MIT
#include <algorithm>
#include <vector>

#include "base/clock.h"
#include "base/scratch_folder.h"
#include "run/measurements.h"
#include "run/open_run.h"
#include "run/probe/probe.h"
#include "scene/length.h"

namespace shaken::run {
namespace {

double bytes_of(const Observables& arrays) {
  std::size_t n = 0;
  for (const auto& [path, values] : arrays) n += values.size();
  return 8.0 * static_cast<double>(n);
}

constexpr std::int64_t kMostBlocks = 64;

/// Blocks in use after so many samples: at most 64, and twice as long when those are used up (analysis/blocked.h).
double blocks(std::int64_t samples) {
  std::int64_t length = 1;
  while (samples > kMostBlocks * length) length *= 2;
  const std::int64_t n = (samples + length - 1) / length;
  return static_cast<double>(n);
}

/// Samples that are kept for lags to come: of each of 16 levels the last 8 of every 2^k-th (analysis/lag_average.h).
double kept_for_lags(std::int64_t samples) {
  double kept = 0;
  for (int k = 0; k < 16; ++k) kept += static_cast<double>(std::min<std::int64_t>(8, (samples + (1 << k) - 1) >> k));
  return kept;
}

}  // namespace

SamplingCost time_sampling(const scene::RunPlan& plan, const std::vector<Snapshot>& snapshots, double cpu) {
  SamplingCost cost;
  Observables arrays;
  double later_bytes = 0;  // of arrays, beyond those at hand
  for (const MeasurementKind& kind : measurement_kinds()) {
    const std::optional<Cadence> cadence = kind.cadence(plan);
    if (!cadence) continue;
    const double interval = static_cast<double>(cadence->period()) * plan.system.dt;
    Measurements measurements(only(plan, kind));
    std::vector<Snapshot> states = snapshots;
    Tick taken = 0;
    const auto sample = [&] {
      Snapshot& due = states[static_cast<std::size_t>(taken) % states.size()];
      due.tick = cadence->next(taken * cadence->period());
      due.time = static_cast<double>(due.tick) * plan.system.dt;
      measurements.sample(due);
      ++taken;
    };
    sample();
    const double first_bytes = static_cast<double>(measurements.save().size());
    const double first_array_bytes = bytes_of(measurements.reduce(interval).arrays);

    Cost& samples = cost.samples["measure_" + std::string(kind.name)];
    samples.count = cadence->count(scene::total_ticks(plan));
    double begin = thread_cpu_seconds();
    double early_bytes = first_bytes;                                    // with every block in use for the first time
    const std::int64_t most = std::max<std::int64_t>(samples.count, 3);  // not more than the run will take
    while (taken < 3 || (taken < most && thread_cpu_seconds() - begin < cpu)) {
      sample();
      if (taken != kMostBlocks) continue;
      const double pause = thread_cpu_seconds();
      early_bytes = static_cast<double>(measurements.save().size());
      begin += thread_cpu_seconds() - pause;
    }
    samples.each = (thread_cpu_seconds() - begin) / static_cast<double>(taken - 1);

    const double state = static_cast<double>(measurements.save().size());
    const Observables found = measurements.reduce(static_cast<double>(taken) * interval).arrays;
    switch (kind.growth) {
      case Growth::kSeries: {
        const auto kept = [&](std::int64_t n) {
          return static_cast<double>(kind.kept != nullptr ? kind.kept(plan, n) : n);
        };
        const double gained = kept(taken) - 1;
        const double in_file = gained > 0 ? (bytes_of(found) - first_array_bytes) / gained : 0.0;
        later_bytes += in_file * std::max(0.0, kept(samples.count) - kept(taken));
        // The state has two unknowns, a sample's bytes and a block's. While every sample makes a block they cannot be
        // told apart: then what the file gains is taken for the sample's.
        const double early = kept(kMostBlocks) - 1, late = kept(taken) - kept(kMostBlocks),
                     more = blocks(taken) - kMostBlocks;
        const double determinant = late * (kMostBlocks - 1) - early * more;
        double per_sample = in_file;
        if (taken >= 2 * kMostBlocks && determinant > 0) {
          per_sample = ((state - early_bytes) * (kMostBlocks - 1) - (early_bytes - first_bytes) * more) / determinant;
        }
        const double per_block = (state - first_bytes - per_sample * gained) / (blocks(taken) - 1);
        cost.state_bytes +=
            first_bytes + per_sample * (kept(samples.count) - 1) + per_block * (blocks(samples.count) - 1);
        break;
      }
      case Growth::kBlocks: {
        const double per_block = (state - first_bytes) / (blocks(taken) - 1);
        cost.state_bytes += first_bytes + per_block * (blocks(samples.count) - 1);
        break;
      }
      case Growth::kLags:  // the file has some numbers a lag, and four lags an octave: little
        cost.state_bytes += state * kept_for_lags(samples.count) / kept_for_lags(taken);
        break;
    }
    arrays.insert(found.begin(), found.end());
  }
  const ScratchFolder folder;
  const auto file = folder.path() / "observables.h5";
  if (write_observables(file, arrays)) {
    cost.file_bytes = static_cast<double>(std::filesystem::file_size(file)) + later_bytes;
  }
  return cost;
}

}  // namespace shaken::run
