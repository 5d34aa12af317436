// SPDX-License-Identifier: MIT
#include "study/claim_checks.h"

#include <algorithm>
#include <cmath>

namespace shaken::study {

RunSet of(const Library& runs, const char* set, double length, double fraction) {
  return where(where(runs[set], "rods.length", length), "rods.area_fraction", fraction);
}

RunSet layers(const Library& runs, double length, double fraction, double end_diameter) {
  return where(of(runs, "layers", length, fraction), "rods.end_diameter", end_diameter);
}

bool is_papers_box(const RunSet& runs) {
  return !runs.empty() && std::all_of(runs.begin(), runs.end(),
                                      [](const FinishedRun& run) { return run.number("box.side") >= kPapersBox; });
}

void MeanOverPlaces::add(double value, double sem) {
  if (!std::isfinite(value)) return;
  sum_ += value;
  errors_ += sem;
  ++n_;
}

Estimate MeanOverPlaces::of(const FinishedRun& run) const {
  return n_ > 0 ? run.estimate(sum_ / n_, errors_ / n_) : Estimate{};
}

double error_at(const std::vector<double>& errors, std::size_t k, std::size_t n) {
  return errors.size() == n ? errors[k] : NAN;
}

}  // namespace shaken::study
