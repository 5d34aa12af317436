// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "analysis/estimate.h"

namespace shaken::analysis {

/// Time at which a correlation that is 1 at lag 0 first falls to 1/e; NaN if it does not within the lags. Between two
/// lags its logarithm is taken as linear, exact for an exponential; the value itself where the later one is not
/// positive. The error is that of the correlation there over its slope. `lags` rising [s].
Estimate decay_time(std::span<const double> lags, const EstimateCurve& correlation);

}  // namespace shaken::analysis
