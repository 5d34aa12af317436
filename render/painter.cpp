#include "render/painter.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "base/files.h"
#include "render/canvas.h"
#include "render/image.h"
#include "render/legend.h"
#include "render/notes.h"
#include "render/overlay.h"
#include "render/panels.h"
#include "render/picture_layout.h"
#include "render/plane_layers.h"

namespace shaken::render {
namespace {

Layout layout_for(const RodPicture& picture, const PictureStyle& style) {
  const Contents contents{.history = !picture.captions.history.time.empty() && style.inset != Inset::kOrder,
                          .label = !picture.captions.label.empty(),
                          .species = picture.cell.n_species() > 1 ? static_cast<int>(picture.cell.n_species()) : 0,
                          .scale = has_scale(picture, style)};
  return style.view != ViewPoint::kTop ? stage_layout_of(style, contents) : layout_of(style, contents);
}

constexpr int kLeastSide = 40;  // of a box among others [pixels]

/// The picture of panel `i`: this one, or one of those beside it.
const RodPicture& panel_of(const RodPicture& picture, std::size_t i) {
  return i == 0 ? picture : picture.beside[i - 1];
}

/// Bodies without axes have no director field: the style without defects, lines, order in the background, plots of
/// angles or S.
PictureStyle drawable(PictureStyle style, const RodPicture& picture) {
  const bool any =
      picture.cell.has_axes() || std::any_of(picture.beside.begin(), picture.beside.end(),
                                             [](const RodPicture& other) { return other.cell.has_axes(); });
  if (any) return style;
  style.mark_defects = false;
  style.lines = FieldLines::kNone;
  if (style.background == Background::kOrder) style.background = PictureStyle{}.background;
  if (style.inset != Inset::kSweep) style.inset = Inset::kNone;
  return style;
}

Result<void> check(const PictureStyle& style, const RodPicture& picture) {
  SHAKEN_TRY(render::check(style));
  if (!picture.beside.empty() && style.view != ViewPoint::kTop) {
    return Error{"several runs are drawn beside each other from above only, not in perspective"};
  }
  if (!picture.beside.empty() && panel_grid(style, 1 + picture.beside.size()).panels.front().box_side < kLeastSide) {
    return Error{"there is no room for " + std::to_string(1 + picture.beside.size()) +
                 " runs: make the picture larger"};
  }
  return {};
}

/// What a picture is made on: the ground, then rods pasted in, then what lies over them.
template <class Channel>
class Sheet;

/// A sheet of 8 bits a colour: one canvas, drawn on in that order.
template <>
class Sheet<std::uint8_t> {
 public:
  Sheet(int width, int height, const Colour& page) : canvas_(width, height, page) {}
  Canvas& under() { return canvas_; }
  Canvas& over() { return canvas_; }
  void paste(const Image& image, int x, int y, double opacity) { canvas_.paste(image, x, y, opacity); }
  Result<void> check() const { return canvas_.check(); }
  Image image() const { return canvas_.image(); }

 private:
  Canvas canvas_;
};

/// A sheet of 16 bits a colour. Cairo has 8: what it draws is put together with the rods in the end.
template <>
class Sheet<std::uint16_t> {
 public:
  Sheet(int width, int height, const Colour& page)
      : under_(width, height, page), over_(Canvas::transparent(width, height)) {}
  Canvas& under() { return under_; }
  Canvas& over() { return over_; }
  void paste(DeepImage image, int x, int y, double opacity) { pasted_.push_back({std::move(image), x, y, opacity}); }
  Result<void> check() const {
    auto done = under_.check();
    return done ? over_.check() : done;
  }
  DeepImage image() const {
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

 private:
  struct Pasted {
    DeepImage image;
    int x, y;
    double opacity;
  };
  Canvas under_, over_;
  std::vector<Pasted> pasted_;
};

/// Ground and rods.
template <class Channel>
Result<void> paint_box(RodsPass& pass, Sheet<Channel>& sheet, const Layout& layout, const RodPicture& picture,
                       const PictureStyle& style) {
  if (style.rods < 1) draw_ground(sheet.under(), layout, picture, style);
  if (style.rods <= 0) return {};
  ImageOf<Channel> rods = SHAKEN_TRY(pass.draw<Channel>(picture, style, layout.box_side, layout.box_side));
  sheet.paste(std::move(rods), layout.box_x, layout.box_y, style.rods);
  return {};
}

template <class Channel>
Result<void> paint_one(RodsPass& pass, Sheet<Channel>& sheet, const RodPicture& picture, const PictureStyle& style) {
  const Layout layout = layout_for(picture, style);
  if (style.view != ViewPoint::kTop) {
    sheet.paste(SHAKEN_TRY(pass.draw<Channel>(picture, style, layout.stage_width, layout.stage_height)), 0, 0, 1);
  } else if (auto done = paint_box(pass, sheet, layout, picture, style); !done) {
    return done.error();
  }
  draw_overlay(sheet.over(), layout, picture, style);
  return {};
}

template <class Channel>
Result<void> paint_panels(RodsPass& pass, Sheet<Channel>& sheet, const RodPicture& picture, const PictureStyle& style) {
  const PanelGrid grid = panel_grid(style, 1 + picture.beside.size());
  for (std::size_t i = 0; i < grid.panels.size(); ++i) {
    const RodPicture& one = panel_of(picture, i);
    SHAKEN_TRY(paint_box(pass, sheet, grid.panels[i], one, style));
    draw_panel_words(sheet.over(), grid.panels[i], one, style, !have_one_time(picture));
  }
  draw_footer(sheet.over(), grid, picture, style);
  return {};
}

}  // namespace

Result<Painter> Painter::create() { return Painter(SHAKEN_TRY(RodsPass::create())); }

template <class Channel>
Result<ImageOf<Channel>> Painter::paint(const RodPicture& picture, const PictureStyle& style) {
  SHAKEN_TRY(check(style, picture));
  const PictureStyle drawn = drawable(style, picture);
  Sheet<Channel> sheet(drawn.width, drawn.height, ground_colours(drawn).page);
  const Result<void> done =
      picture.beside.empty() ? paint_one(rods_, sheet, picture, drawn) : paint_panels(rods_, sheet, picture, drawn);
  if (!done) return done.error();
  draw_time_bar(sheet.over(), picture.captions, drawn);
  SHAKEN_TRY(sheet.check());
  return sheet.image();
}
template Result<Image> Painter::paint(const RodPicture& picture, const PictureStyle& style);
template Result<DeepImage> Painter::paint(const RodPicture& picture, const PictureStyle& style);

Result<ClearImage> Painter::paint_clear(const RodPicture& picture, PictureStyle style) {
  // What is seen of the ground where it is white, and not where it is black, is what shines through.
  style.ground = Colour{0, 0, 0};
  const Image on_black = SHAKEN_TRY(paint(picture, style));
  style.ground = Colour{1, 1, 1};
  const Image on_white = SHAKEN_TRY(paint(picture, style));
  ClearImage clear{on_black.width, on_black.height, {}};
  clear.rgba.reserve(on_black.rgb.size() / 3 * 4);
  for (std::size_t i = 0; i < on_black.rgb.size(); i += 3) {
    int through = 0;  // of three times 255
    for (std::size_t c = i; c < i + 3; ++c) through += on_white.rgb[c] - on_black.rgb[c];
    const int opacity = std::clamp(255 - (through + 1) / 3, 0, 255);
    for (std::size_t c = i; c < i + 3; ++c) {
      const int colour = opacity > 0 ? (on_black.rgb[c] * 255 + opacity / 2) / opacity : 0;
      clear.rgba.push_back(static_cast<std::uint8_t>(std::min(colour, 255)));
    }
    clear.rgba.push_back(static_cast<std::uint8_t>(opacity));
  }
  return clear;
}

Result<void> write_vector(const std::filesystem::path& file, const RodPicture& picture, const PictureStyle& asked) {
  const PictureStyle style = drawable(asked, picture);
  SHAKEN_TRY(check(style, picture));
  if (style.view != ViewPoint::kTop) return Error{"only views from above can be drawn as " + file.extension().string()};
  UnfinishedFile unfinished(file);
  const auto failed = [&](const std::string& why) { return Error{"cannot write " + file.string() + ": " + why}; };
  Result<Canvas> canvas =
      Canvas::vector(unfinished.path(), file.extension().string(), style.width, style.height,
                     style.transparent ? std::nullopt : std::optional(page_colours(style.theme).page),
                     picture.captions.label, picture.captions.notes, style.dpi.value_or(72));
  if (!canvas) return failed(canvas.error().message);
  const auto draw_box = [&](const Layout& layout, const RodPicture& one) {
    draw_ground(*canvas, layout, one, style);
    if (style.rods > 0) draw_flat_rods(*canvas, layout, one, style);
  };
  if (picture.beside.empty()) {
    const Layout layout = layout_for(picture, style);
    draw_box(layout, picture);
    draw_overlay(*canvas, layout, picture, style);
  } else {
    const PanelGrid grid = panel_grid(style, 1 + picture.beside.size());
    for (std::size_t i = 0; i < grid.panels.size(); ++i) {
      draw_box(grid.panels[i], panel_of(picture, i));
      draw_panel_words(*canvas, grid.panels[i], panel_of(picture, i), style, !have_one_time(picture));
    }
    draw_footer(*canvas, grid, picture, style);
  }
  if (auto done = canvas->finish(); !done) return failed(done.error().message);
  if (file.extension() == ".svg") {
    if (auto done =
            add_words_to_svg(unfinished.path(), picture.captions.label, picture.captions.notes, canvas->svg_words());
        !done) {
      return failed(done.error().message);
    }
  }
  return unfinished.replace(Lasting::kNo);
}

}  // namespace shaken::render
