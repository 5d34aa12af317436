#pragma once

#include <cstdint>
#include <vector>

#include "render/canvas.h"
#include "render/image.h"

namespace shaken::render {

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
  DeepImage image() const;

 private:
  struct Pasted {
    DeepImage image;
    int x, y;
    double opacity;
  };
  Canvas under_, over_;
  std::vector<Pasted> pasted_;
};

}  // namespace shaken::render
