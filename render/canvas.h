#pragma once

#include <cairo.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "render/colours.h"
#include "render/image.h"
#include "render/picture.h"

namespace shaken::render {

/// A rectangle of the picture; x to the right, y down [pixels].
struct Rect {
  double x = 0, y = 0, width = 0, height = 0;
  double right() const { return x + width; }
  double bottom() const { return y + height; }
};

/// Text as it is drawn: numbers below 0 with a real minus sign, and "4 us" as "4 µs".
std::string typeset(const std::string& text);

/// Where drawing with Cairo happens. Coordinates are pixels from the upper left corner.
class Canvas {
 public:
  /// A canvas of pixels.
  Canvas(int width, int height, const Colour& page);
  /// A canvas of pixels with nothing on it: what is drawn is laid over a picture afterwards.
  static Canvas transparent(int width, int height);
  /// A canvas of lines and areas, as a file of the format that `ending` names: ".svg" or ".pdf". A PDF has a title and,
  /// as keywords, the notes; its pages are as large as so many pixels are at `dpi` to the inch. Without a page's colour
  /// there is nothing under what is drawn.
  static Result<Canvas> vector(const std::filesystem::path& file, const std::string& ending, int width, int height,
                               const std::optional<Colour>& page, const std::string& title, const Notes& notes,
                               double dpi = 72);

  /// For paths: Cairo's own functions.
  cairo_t* cairo() const { return context_.get(); }

  void colour(const Colour& colour, double opacity = 1) const;
  void fill(const Rect& rect) const;
  /// A straight line in the present colour.
  void line(double x0, double y0, double x1, double y1, double thickness) const;

  enum class Align { kLeft, kCentre, kRight };
  /// One line of text of `size` pixels with its baseline at y, typeset(); returns its width.
  double text(double x, double y, const std::string& text, double size, Align align = Align::kLeft,
              bool bold = false) const;
  double text_width(const std::string& text, double size, bool bold = false) const;

  /// Copies a picture in, its upper left corner at (x, y).
  void paste(const Image& image, int x, int y, double opacity = 1);
  /// Draws a picture smoothly over `rect`, of which its outer pixels' middles are the edges.
  void spread(const Image& image, const Rect& rect) const;
  /// The pixels of a canvas that has them.
  Image image() const;
  /// Lays a transparent canvas over a picture of its size.
  void lay_over(DeepImage& image) const;
  /// The elements of all text of an SVG, which Cairo would write as outlines. They belong at the file's end.
  std::string svg_words() const { return svg_words_ ? *svg_words_ : ""; }
  /// Whether everything was drawn so far: after a font that cannot be read, say, Cairo draws nothing any more.
  Result<void> check() const;
  /// Ends a file.
  Result<void> finish();

 private:
  explicit Canvas(cairo_surface_t* surface);
  struct Free {
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
    void operator()(cairo_t* context) const { cairo_destroy(context); }
  };
  std::unique_ptr<cairo_surface_t, Free> surface_;
  std::unique_ptr<cairo_t, Free> context_;
  std::unique_ptr<std::string> svg_words_;  // null unless an SVG is drawn
};

}  // namespace shaken::render
