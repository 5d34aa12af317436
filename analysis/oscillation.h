#pragma once

#include <optional>
#include <span>

namespace shaken::analysis {

/// The distance r [mm] of the first maximum after the first minimum of a correlation (n) at equally spaced, rising
/// distances (n) [mm]: the wavelength of what it is a correlation of. The curve is averaged over windows of `smoothing`
/// [mm] first, which takes away shorter periods, and no maximum nearer than two windows is one; a minimum or maximum
/// counts when the curve has left it by more than six times its noise (that of neighbouring points in the farther
/// half). The place of the maximum is that of a parabola through the points about it. Values that are not finite are
/// passed over. None where the curve has none.
std::optional<double> first_period(std::span<const double> r, std::span<const double> values, double smoothing);

}  // namespace shaken::analysis
