// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/core/result.h"
#include "render/gl.h"
#include "render/image.h"
#include "render/style.h"

namespace shaken::render {

/// Compiles and links; 0 on failure, with the compiler's words in `message`. `defines`: lines after the first of the
/// fragment shader.
GLuint link_program(const char* vertex_source, const char* fragment_source, std::string& message,
                    const std::string& defines = "");

/// A program that shades rods in a light, in place of `program` if that is of another. `made_for` keeps its defines.
/// An error has the compiler's words.
Result<void> relight(GLuint& program, std::string& made_for, const char* vertex_source, const char* fragment_source,
                     const Light& light);

/// Averages the samples of each pixel of RGBA rows from bottom to top, `samples` (1 to 3) times as wide and as high,
/// and turns the rows round.
template <class Channel>
ImageOf<Channel> averaged(const std::vector<Channel>& rgba, int width, int height, int samples);

}  // namespace shaken::render
