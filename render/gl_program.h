// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "render/gl.h"
#include "render/image.h"

namespace shaken::render {

/// Samples along each side of a pixel.
inline constexpr int kSamples = 3;

/// Compiles and links; 0 on failure, with the compiler's words in `message`.
GLuint link_program(const char* vertex_source, const char* fragment_source, std::string& message);

/// Averages the samples of each pixel of RGBA rows from bottom to top, kSamples times as wide and as high, and turns
/// the rows round.
Image averaged(const std::vector<std::uint8_t>& rgba, int width, int height);

}  // namespace shaken::render
