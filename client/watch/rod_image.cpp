// SPDX-License-Identifier: MIT
#include "client/watch/rod_image.h"

#include <algorithm>
#include <cmath>

#include "client/watch/rod_samples.h"

namespace shaken::client {
namespace {

constexpr Ink kBlack = 0x000000;
constexpr Ink kWhite = 0xFFFFFF;

constexpr auto kBlackPixel = static_cast<std::uint8_t>(kToneCount);
constexpr auto kWhitePixel = static_cast<std::uint8_t>(kToneCount + 1);

std::vector<std::uint8_t> make_palette() {
  std::vector<std::uint8_t> parts;
  const auto add = [&parts](Ink ink) {
    for (const int shift : {16, 8, 0}) parts.push_back(static_cast<std::uint8_t>(ink >> shift & 0xFF));
  };
  for (int tone = 0; tone < kToneCount; ++tone) add(ink_of(static_cast<Tone>(tone)));
  add(kBlack);
  add(kWhite);
  return parts;
}

/// What a disc of radius 1 with a sign has at (x, y), relative to its middle.
std::uint8_t mark_pixel(double x, double y, bool is_positive) {
  constexpr double kReach = 0.65, kHalfStroke = 0.16;
  const bool is_across = std::abs(x) <= kReach && std::abs(y) <= kHalfStroke;
  const bool is_down = std::abs(y) <= kReach && std::abs(x) <= kHalfStroke;
  const bool is_sign = is_across || (is_positive && is_down);
  return is_sign == is_positive ? kBlackPixel : kWhitePixel;
}

void draw_mark(RodImage& image, const RodSamples& samples, const DefectMark& defect, int mark_size) {
  const auto [column, row] = samples.place(defect.x, defect.y);
  if (!samples.is_in_box(column, row)) return;
  const int reach = mark_size / 2;
  const double radius = reach + 0.5;
  for (int y = std::max(0, row - reach); y <= std::min(image.size.height - 1, row + reach); ++y) {
    for (int x = std::max(0, column - reach); x <= std::min(image.size.width - 1, column + reach); ++x) {
      const double dx = (x - column) / radius, dy = (y - row) / radius;
      if (std::hypot(dx, dy) > 1) continue;
      image.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.size.width) +
                   static_cast<std::size_t>(x)] = mark_pixel(dx, dy, defect.is_positive);
    }
  }
}

}  // namespace

std::span<const std::uint8_t> rod_palette() {
  static const std::vector<std::uint8_t> palette = make_palette();
  return palette;
}

PixelSize image_size(PixelSize cell, const Area& area) {
  constexpr int kSixel = 6;
  return {area.columns * cell.width, area.lines * cell.height / kSixel * kSixel};
}

RodImage draw_rod_image(const RodFrame& frame, const std::vector<DefectMark>& defects, const RodView& view,
                        Colouring colouring, PixelSize size, int mark_size) {
  const RodSamples samples(frame, view, colouring, size.width, size.height);
  RodImage image{.size = size, .pixels = {}};
  image.pixels.reserve(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
  for (int row = 0; row < size.height; ++row) {
    for (int column = 0; column < size.width; ++column) {
      image.pixels.push_back(samples.is_in_box(column, row) ? samples.tone(column, row) : kBlackPixel);
    }
  }
  for (const DefectMark& defect : defects) draw_mark(image, samples, defect, mark_size);
  return image;
}

}  // namespace shaken::client
