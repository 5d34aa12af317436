#pragma once

#include <initializer_list>
#include <map>
#include <string>
#include <vector>

#include "base/core/result.h"
#include "render/gl.h"
#include "render/image.h"

namespace shaken::render {

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
