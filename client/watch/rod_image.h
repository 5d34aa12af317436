// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "client/live/rod_frame.h"
#include "client/watch/cells.h"

namespace shaken::client {

/// A size in pixels.
struct PixelSize {
  int width = 0;
  int height = 0;
  friend bool operator==(const PixelSize&, const PixelSize&) = default;
};

/// A picture of a few dozen colours, line by line from the top.
struct RodImage {
  PixelSize size;
  std::vector<std::uint8_t> pixels;  ///< numbers of colours in rod_palette()
  friend bool operator==(const RodImage&, const RodImage&) = default;
};

/// The colours of an image, red, green and blue of each: first the tones, then black and white.
std::span<const std::uint8_t> rod_palette();
inline constexpr int kPaletteSize = kToneCount + 2;

/// The pixels that an area of cells of size `cell` has for an image. Their number of lines is a multiple of 6, as
/// sixels have it: terminals differ in what they do with the rest of one.
PixelSize image_size(PixelSize cell, const Area& area);

/// Draws `frame` from one sample for each pixel, as RodSamples says; black around the box. Defects are discs,
/// `mark_size` pixels wide: white with a black plus, or black with a white minus.
RodImage draw_rod_image(const RodFrame& frame, const std::vector<DefectMark>& defects, const RodView& view,
                        Colouring colouring, PixelSize size, int mark_size);

}  // namespace shaken::client
