#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace shaken::render {

/// The least of 1, 2, 5 times a power of ten that cuts `span` into at most `most` pieces; of degrees, of 15, 30,
/// 45, 90.
double tick_step(double span, int most, bool degrees = false);

/// The multiples of `step` in [low, high].
std::vector<double> ticks(double low, double high, double step);

/// A number for an axis, with a real minus sign: "−15°", "0.2".
std::string tick_text(double value, std::string_view unit = "");

}  // namespace shaken::render
