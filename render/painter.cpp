// SPDX-License-Identifier: MIT
#include "render/painter.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "render/canvas.h"
#include "render/layout.h"
#include "render/legend.h"
#include "render/overlay.h"
#include "render/plane_layers.h"

namespace shaken::render {
namespace {

Layout layout_for(const RodPicture& picture, const PictureStyle& style) {
  const Contents contents{.history = !picture.history.time.empty(),
                          .label = !picture.label.empty(),
                          .species = picture.n_species() > 1,
                          .scale = has_scale(picture, style)};
  return style.view == ViewPoint::kGap ? gap_layout_of(style, contents) : layout_of(style, contents);
}

}  // namespace

Result<Painter> Painter::create() {
  Result<RodsPass> rods = RodsPass::create();
  if (!rods) return rods.error();
  return Painter(std::move(*rods));
}

Result<Image> Painter::paint(const RodPicture& picture, const PictureStyle& style) {
  if (auto done = check(style); !done) return done.error();
  const Layout layout = layout_for(picture, style);
  Canvas canvas(style.width, style.height, palette(style.theme).page);
  if (style.view == ViewPoint::kGap) {
    if (!gap_) {
      Result<GapPass> made = GapPass::create();
      if (!made) return made.error();
      gap_.emplace(std::move(*made));
    }
    const Result<Image> stage = gap_->draw(picture, style, layout.stage_width, layout.stage_height);
    if (!stage) return stage.error();
    canvas.paste(*stage, 0, 0);
    draw_overlay(canvas, layout, picture, style);
    return canvas.image();
  }
  if (style.rods < 1) draw_ground(canvas, layout, picture, style);
  if (style.rods > 0) {
    const Result<Image> rods = rods_.draw(picture, style, layout.box_side);
    if (!rods) return rods.error();
    canvas.paste(*rods, layout.box_x, layout.box_y, style.rods);
  }
  draw_overlay(canvas, layout, picture, style);
  return canvas.image();
}

Result<void> write_vector(const std::filesystem::path& file, const RodPicture& picture, const PictureStyle& style) {
  if (auto done = check(style); !done) return done.error();
  if (style.view != ViewPoint::kTop) return Error{"only views from above can be drawn as " + file.extension().string()};
  // The ending tells the format, so it stays at the end.
  const std::filesystem::path unfinished =
      file.parent_path() / (file.stem().string() + ".tmp" + file.extension().string());
  const auto failed = [&](const std::string& why) {
    std::remove(unfinished.c_str());
    return Error{"cannot write " + file.string() + ": " + why};
  };
  Result<Canvas> canvas =
      Canvas::vector(unfinished, style.width, style.height, palette(style.theme).page, picture.label, picture.notes);
  if (!canvas) return failed(canvas.error().message);
  const Layout layout = layout_for(picture, style);
  draw_ground(*canvas, layout, picture, style);
  if (style.rods > 0) draw_flat_rods(*canvas, layout, picture, style);
  draw_overlay(*canvas, layout, picture, style);
  if (auto done = canvas->finish(); !done) return failed(done.error().message);
  if (std::rename(unfinished.c_str(), file.c_str()) != 0) return failed(std::strerror(errno));
  return {};
}

}  // namespace shaken::render
