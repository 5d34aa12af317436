#include "render/style.h"

#include <algorithm>
#include <cmath>

#include "base/picture_limits.h"
#include "render/colourings.h"

namespace shaken::render {

Result<void> check(const PictureStyle& style) {
  if (std::min(style.width, style.height) < kLeastPixels || std::max(style.width, style.height) > kMostPixels) {
    return Error{"a picture of " + std::to_string(style.width) + "x" + std::to_string(style.height) +
                 " pixels is not possible; each side may be " + std::to_string(kLeastPixels) + " to " +
                 std::to_string(kMostPixels)};
  }
  if (!(style.zoom >= 1) || !style.focus.allFinite()) return Error{"zoom must be at least 1, and focus finite"};
  if (!(std::abs(style.orbit.x()) <= 360 && style.orbit.y() >= 1 && style.orbit.y() <= 90)) {
    return Error{"an orbit's azimuth is from -360 to 360 degrees, and its elevation above the plate from 1 to 90"};
  }
  const Colouring* colouring = find_colouring(style.colour);
  if (style.colour != "auto" && colouring == nullptr) return Error{"there is no colouring " + style.colour};
  if (style.range && !(style.range->x() < style.range->y())) return Error{"the range must rise from its first number"};
  if (style.range && colouring == nullptr) return Error{"range needs a colour that it is the range of, not auto"};
  if (style.range && (colouring->scale != Scale::kLine || std::string_view(colouring->unit) == "\u00b0")) {
    return Error{"range is for tilt, speed, order and density; the scale of " + style.colour + " is fixed"};
  }
  if (style.range && colouring->has_middle && style.range->x() != -style.range->y()) {
    return Error{"the range of " + style.colour + " must have 0 in its middle, like -" +
                 std::to_string(static_cast<int>(style.range->y())) + "," +
                 std::to_string(static_cast<int>(style.range->y()))};
  }
  if (style.background != Background::kNone && style.rods >= 1) {
    return Error{"the background is hidden: rods must be less than 1, 0.6 for example"};
  }
  return {};
}

}  // namespace shaken::render
