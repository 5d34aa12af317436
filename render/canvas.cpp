#include "render/canvas.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "render/notes.h"

namespace shaken::render {

Canvas::Canvas(int width, int height, const Colour& page)
    : Canvas(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height)) {
  colour(page);
  cairo_paint(cairo());
}

Canvas Canvas::transparent(int width, int height) {
  return Canvas(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width, height));
}

Result<Canvas> Canvas::vector(const std::filesystem::path& file, const std::string& ending, int width, int height,
                              const std::optional<Colour>& page, const std::string& title, const Notes& notes,
                              double dpi) {
  cairo_surface_t* surface = nullptr;
  if (ending == ".svg") {
    surface = cairo_svg_surface_create(file.c_str(), width, height);
    cairo_svg_surface_set_document_unit(surface, CAIRO_SVG_UNIT_PX);
  } else {
    surface = cairo_pdf_surface_create(file.c_str(), width * 72 / dpi, height * 72 / dpi);
    std::string words;
    for (const auto& [key, value] : notes)
      words.append(words.empty() ? "" : ", ").append(key).append(" ").append(value);
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_TITLE, title.c_str());
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_KEYWORDS, words.c_str());
    // Equal pictures give equal files, whenever they are drawn.
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
  }
  Canvas canvas(surface);
  if (ending == ".pdf") cairo_scale(canvas.cairo(), 72 / dpi, 72 / dpi);
  if (ending == ".svg") canvas.svg_words_ = std::make_unique<std::string>();
  if (page) {
    canvas.colour(*page);
    cairo_paint(canvas.cairo());
  }
  if (const cairo_status_t status = cairo_surface_status(surface); status != CAIRO_STATUS_SUCCESS) {
    return Error{"cannot write " + file.string() + ": " + cairo_status_to_string(status)};
  }
  return canvas;
}

Canvas::Canvas(cairo_surface_t* surface) : surface_(surface), context_(cairo_create(surface)) {
  // The same letters everywhere: no hinting, no sub-pixel colours.
  cairo_font_options_t* options = cairo_font_options_create();
  cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_set_font_options(context_.get(), options);
  cairo_font_options_destroy(options);
  cairo_set_line_cap(context_.get(), CAIRO_LINE_CAP_BUTT);
  cairo_set_line_join(context_.get(), CAIRO_LINE_JOIN_ROUND);
}

void Canvas::colour(const Colour& colour, double opacity) const {
  cairo_set_source_rgba(cairo(), colour[0], colour[1], colour[2], opacity);
}

void Canvas::fill(const Rect& rect) const {
  cairo_rectangle(cairo(), rect.x, rect.y, rect.width, rect.height);
  cairo_fill(cairo());
}

void Canvas::line(double x0, double y0, double x1, double y1, double thickness) const {
  cairo_set_line_width(cairo(), thickness);
  cairo_move_to(cairo(), x0, y0);
  cairo_line_to(cairo(), x1, y1);
  cairo_stroke(cairo());
}

std::string typeset(const std::string& text) {
  std::string drawn;
  const auto is_digit = [&](std::size_t i) { return i < text.size() && text[i] >= '0' && text[i] <= '9'; };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool begins = i == 0 || std::string_view(" =([,").find(text[i - 1]) != std::string_view::npos;
    const bool is_micro = text[i] == 'u' && i >= 2 && text[i - 1] == ' ' && is_digit(i - 2) && i + 1 < text.size() &&
                          (text[i + 1] == 's' || text[i + 1] == 'm') &&
                          (i + 2 == text.size() || text[i + 2] == ',' || text[i + 2] == ' ');
    if (text[i] == '-' && begins && is_digit(i + 1)) {
      drawn += "\u2212";
    } else if (is_micro) {
      drawn += "\u00b5";
    } else {
      drawn += text[i];
    }
  }
  return drawn;
}

double Canvas::text_width(const std::string& text, double size, bool bold) const {
  cairo_select_font_face(cairo(), "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo(), size);
  cairo_text_extents_t extents;
  cairo_text_extents(cairo(), typeset(text).c_str(), &extents);
  return extents.x_advance;
}

double Canvas::text(double x, double y, const std::string& text, double size, Align align, bool bold) const {
  const double width = text_width(text, size, bold);
  if (svg_words_) {
    double red = 0, green = 0, blue = 0, opacity = 1;
    cairo_pattern_get_rgba(cairo_get_source(cairo()), &red, &green, &blue, &opacity);
    *svg_words_ += fmt::format(
        R"(<text x="{:.2f}" y="{:.2f}" font-family="DejaVu Sans, Verdana, Arial, sans-serif" font-size="{:.2f}"{}{} fill="#{:02x}{:02x}{:02x}"{}>{}</text>)"
        "\n",
        x, y, size, bold ? " font-weight=\"bold\"" : "",
        align == Align::kLeft     ? ""
        : align == Align::kCentre ? " text-anchor=\"middle\""
                                  : " text-anchor=\"end\"",
        std::lround(255 * red), std::lround(255 * green), std::lround(255 * blue),
        opacity < 1 ? fmt::format(" fill-opacity=\"{:.3g}\"", opacity) : "", xml_text(typeset(text)));
    return width;
  }
  const double shift = align == Align::kLeft ? 0 : align == Align::kCentre ? width / 2 : width;
  cairo_move_to(cairo(), x - shift, y);
  cairo_show_text(cairo(), typeset(text).c_str());
  cairo_new_path(cairo());
  return width;
}

namespace {

/// A surface with a copy of the picture.
cairo_surface_t* surface_of(const Image& image) {
  cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, image.width, image.height);
  cairo_surface_flush(surface);
  unsigned char* data = cairo_image_surface_get_data(surface);
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface));
  for (int j = 0; j < image.height; ++j) {
    unsigned char* out = data + static_cast<std::size_t>(j) * stride;
    const std::uint8_t* in = image.pixel(0, j);
    for (int i = 0; i < image.width; ++i, in += 3, out += 4) {
      const std::uint32_t pixel =
          static_cast<std::uint32_t>(in[0]) << 16 | static_cast<std::uint32_t>(in[1]) << 8 | in[2];
      std::memcpy(out, &pixel, sizeof(pixel));
    }
  }
  cairo_surface_mark_dirty(surface);
  return surface;
}

}  // namespace

void Canvas::paste(const Image& image, int x, int y, double opacity) {
  const std::unique_ptr<cairo_surface_t, Free> source(surface_of(image));
  cairo_set_source_surface(cairo(), source.get(), x, y);
  cairo_paint_with_alpha(cairo(), opacity);
}

void Canvas::spread(const Image& image, const Rect& rect) const {
  const std::unique_ptr<cairo_surface_t, Free> source(surface_of(image));
  const double sx = rect.width / (image.width - 1), sy = rect.height / (image.height - 1);
  cairo_save(cairo());
  cairo_rectangle(cairo(), rect.x, rect.y, rect.width, rect.height);
  cairo_clip(cairo());
  cairo_translate(cairo(), rect.x - sx / 2, rect.y - sy / 2);
  cairo_scale(cairo(), sx, sy);
  cairo_set_source_surface(cairo(), source.get(), 0, 0);
  cairo_pattern_set_filter(cairo_get_source(cairo()), CAIRO_FILTER_BILINEAR);
  cairo_pattern_set_extend(cairo_get_source(cairo()), CAIRO_EXTEND_PAD);
  cairo_paint(cairo());
  cairo_restore(cairo());
}

Result<void> Canvas::check() const {
  const cairo_status_t status = cairo_status(cairo());
  if (status != CAIRO_STATUS_SUCCESS) return Error{std::string("cannot draw: ") + cairo_status_to_string(status)};
  return {};
}

Result<void> Canvas::finish() {
  if (auto done = check(); !done) return done;
  context_.reset();
  cairo_surface_finish(surface_.get());
  const cairo_status_t status = cairo_surface_status(surface_.get());
  if (status != CAIRO_STATUS_SUCCESS) return Error{cairo_status_to_string(status)};
  return {};
}

Image Canvas::image() const {
  cairo_surface_flush(surface_.get());
  Image image(cairo_image_surface_get_width(surface_.get()), cairo_image_surface_get_height(surface_.get()));
  const unsigned char* data = cairo_image_surface_get_data(surface_.get());
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface_.get()));
  for (int j = 0; j < image.height; ++j) {
    const unsigned char* in = data + static_cast<std::size_t>(j) * stride;
    std::uint8_t* out = image.pixel(0, j);
    for (int i = 0; i < image.width; ++i, in += 4, out += 3) {
      std::uint32_t pixel;
      std::memcpy(&pixel, in, sizeof(pixel));
      out[0] = static_cast<std::uint8_t>(pixel >> 16);
      out[1] = static_cast<std::uint8_t>(pixel >> 8);
      out[2] = static_cast<std::uint8_t>(pixel);
    }
  }
  return image;
}

void Canvas::lay_over(DeepImage& image) const {
  cairo_surface_flush(surface_.get());
  const unsigned char* data = cairo_image_surface_get_data(surface_.get());
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface_.get()));
  for (int j = 0; j < image.height; ++j) {
    const unsigned char* in = data + static_cast<std::size_t>(j) * stride;
    std::uint16_t* out = image.pixel(0, j);
    for (int i = 0; i < image.width; ++i, in += 4, out += 3) {
      std::uint32_t pixel;  // its colours are times its opacity
      std::memcpy(&pixel, in, sizeof(pixel));
      const std::uint32_t through = 255 - (pixel >> 24);
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t colour = pixel >> (16 - 8 * c) & 255;
        out[c] = static_cast<std::uint16_t>(std::min(colour * 257 + (out[c] * through + 127) / 255, 65535U));
      }
    }
  }
}

}  // namespace shaken::render
