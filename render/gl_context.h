// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sim/core/result.h"

namespace shaken::render {

/// An OpenGL 3.3 core context that draws into memory: no display, no graphics card, no libGL.
/// Mesa's software rasteriser gives the same bits for any number of threads.
class GlContext {
 public:
  static Result<GlContext> create();
  GlContext(GlContext&&) noexcept;
  GlContext& operator=(GlContext&&) noexcept;
  ~GlContext();

  /// Makes the context current in this thread, with a frame buffer of `width` x `height` pixels.
  Result<void> bind(int width, int height);
  /// The frame buffer after all drawing is done: RGBA, rows from bottom to top, (height * width * 4).
  const std::vector<std::uint8_t>& finished_pixels();

 private:
  struct Deleter {
    void operator()(void* context) const;
  };
  explicit GlContext(void* context) : context_(context) {}
  std::unique_ptr<void, Deleter> context_;
  std::vector<std::uint8_t> pixels_;
};

}  // namespace shaken::render
