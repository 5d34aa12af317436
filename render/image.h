#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace shaken::render {

/// A picture of sRGB pixels, rows from top to bottom without padding; of each colour there are 8 or 16 bits.
template <class Channel>
struct ImageOf {
  int width = 0;
  int height = 0;
  std::vector<Channel> rgb;  ///< (height * width * 3)

  ImageOf() = default;
  ImageOf(int w, int h) : width(w), height(h), rgb(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * 3) {}

  Channel* pixel(int x, int y) { return rgb.data() + offset(x, y); }
  const Channel* pixel(int x, int y) const { return rgb.data() + offset(x, y); }
  std::size_t row_bytes() const { return static_cast<std::size_t>(width) * 3 * sizeof(Channel); }
  friend bool operator==(const ImageOf&, const ImageOf&) = default;

 private:
  std::size_t offset(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) * 3;
  }
};
/// Pixels with an opacity; colours are not multiplied with it.
struct ClearImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;  ///< (height * width * 4), rows from top to bottom
};
using Image = ImageOf<std::uint8_t>;
using DeepImage = ImageOf<std::uint16_t>;

}  // namespace shaken::render
