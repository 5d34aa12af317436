// SPDX-License-Identifier: MIT
#include "render/painter.h"

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
  if (auto done = check(style); !done) return done.error();
  const Layout layout =
      layout_of(style, !picture.history.time.empty(), !picture.label.empty(), picture.n_species() > 1);
  Result<Image> rods = rods_.draw(picture, style, layout.box_side);
  if (!rods) return rods.error();
  Canvas canvas(style.width, style.height, palette(style.theme).page);
  canvas.paste(*rods, layout.box_x, layout.box_y);
  draw_overlay(canvas, layout, picture, style);
  return canvas.image();
}

}  // namespace shaken::render
