// SPDX-License-Identifier: MIT
#include "render/painter.h"

#include <string>

#include "render/canvas.h"
#include "render/layout.h"
#include "render/overlay.h"

namespace shaken::render {

Result<Painter> Painter::create() {
  Result<RodsPass> rods = RodsPass::create();
  if (!rods) return rods.error();
  return Painter(std::move(*rods));
}

Result<Image> Painter::paint(const RodPicture& picture, const PictureStyle& style) {
  constexpr int kLeast = 64, kMost = 16384;
  if (style.width < kLeast || style.height < kLeast || style.width > kMost || style.height > kMost) {
    return Error{"a picture of " + std::to_string(style.width) + "x" + std::to_string(style.height) +
                 " pixels is not possible; each side may be 64 to 16384"};
  }
  const Layout layout = layout_of(style, !picture.history.time.empty(), !picture.label.empty());
  Result<Image> rods = rods_.draw(picture, style, layout.box_side);
  if (!rods) return rods.error();
  Canvas canvas(style.width, style.height, palette(style.theme).page);
  canvas.paste(*rods, layout.box_x, layout.box_y);
  draw_overlay(canvas, layout, picture, style);
  return canvas.image();
}

}  // namespace shaken::render
