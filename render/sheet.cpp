#include "render/sheet.h"

#include <algorithm>
#include <cmath>

namespace shaken::render {

DeepImage Sheet<std::uint16_t>::image() const {
  const Image ground = under_.image();
  DeepImage image(ground.width, ground.height);
  std::transform(ground.rgb.begin(), ground.rgb.end(), image.rgb.begin(),
                 [](std::uint8_t value) { return static_cast<std::uint16_t>(value * 257); });
  for (const Pasted& pasted : pasted_) {
    const auto n = static_cast<std::size_t>(pasted.image.width) * 3;
    for (int y = 0; y < pasted.image.height; ++y) {
      const std::uint16_t* in = pasted.image.pixel(0, y);
      std::uint16_t* out = image.pixel(pasted.x, pasted.y + y);
      for (std::size_t i = 0; i < n; ++i) {
        out[i] = static_cast<std::uint16_t>(std::lround(out[i] + pasted.opacity * (in[i] - out[i])));
      }
    }
  }
  over_.lay_over(image);
  return image;
}

}  // namespace shaken::render
