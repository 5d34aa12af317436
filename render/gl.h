#pragma once

// OSMesa exports the functions of OpenGL itself; their declarations come with this macro.
#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>

#include <cstdint>
#include <initializer_list>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "base/core/result.h"
#include "render/image.h"

namespace shaken::render {

/// An OpenGL 3.3 core context that draws into memory: no display, no graphics card, no libGL.
/// Mesa's software rasteriser gives the same bits for any number of threads.
class GlContext {
 public:
  static Result<GlContext> create();

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

/// The pieces of a shader's text, the first of which begins with the line that names the version.
using ShaderText = std::initializer_list<const char*>;

/// One program in as many variants as are asked for. The programs go with their context.
class ProgramVariants {
 public:
  ProgramVariants(ShaderText vertex, ShaderText fragment);
  /// The one with `defines`, lines of the fragment shader after its first; an error has the compiler's words.
  Result<GLuint> with(const std::string& defines);

 private:
  std::string vertex_, fragment_;
  std::map<std::string, GLuint> made_;
};

/// Averages the samples of each pixel of RGBA rows from bottom to top, `samples` (1 to 3) times as wide and as high,
/// and turns the rows round.
template <class Channel>
ImageOf<Channel> averaged(const std::vector<Channel>& rgba, int width, int height, int samples);

}  // namespace shaken::render
