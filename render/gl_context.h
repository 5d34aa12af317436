#pragma once

#include <cstdint>
#include <memory>
#include <tuple>
#include <vector>

#include "base/core/result.h"

namespace shaken::render {

/// An OpenGL 3.3 core context that draws into memory: no display, no graphics card, no libGL.
/// Mesa's software rasteriser gives the same bits for any number of threads.
class GlContext {
 public:
  static Result<GlContext> create();
  GlContext(GlContext&&) noexcept;
  GlContext& operator=(GlContext&&) noexcept;
  ~GlContext();

  /// Makes the context current in this thread, with a frame buffer of `width` x `height` pixels of 8 or 16 bits a
  /// colour.
  template <class Channel = std::uint8_t>
  Result<void> bind(int width, int height);
  /// The frame buffer bound last, after all drawing is done: RGBA, rows from bottom to top, (height * width * 4).
  template <class Channel = std::uint8_t>
  const std::vector<Channel>& finished_pixels();

 private:
  struct Deleter {
    void operator()(void* context) const;
  };
  explicit GlContext(void* context) : context_(context) {}
  std::unique_ptr<void, Deleter> context_;
  std::tuple<std::vector<std::uint8_t>, std::vector<std::uint16_t>> pixels_;
};

}  // namespace shaken::render
