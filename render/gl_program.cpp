// SPDX-License-Identifier: MIT
#include "render/gl_program.h"

#include <algorithm>
#include <array>
#include <utility>

namespace shaken::render {

GLuint link_program(const char* vertex_source, const char* fragment_source, std::string& message) {
  const GLuint program = glCreateProgram();
  for (const auto& [species, source] :
       {std::pair{GL_VERTEX_SHADER, vertex_source}, std::pair{GL_FRAGMENT_SHADER, fragment_source}}) {
    const GLuint shader = glCreateShader(static_cast<GLenum>(species));
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    glAttachShader(program, shader);
    glDeleteShader(shader);
  }
  glLinkProgram(program);
  GLint linked = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (linked) return program;
  std::array<char, 2048> text{};
  glGetProgramInfoLog(program, static_cast<GLsizei>(text.size()), nullptr, text.data());
  message = text.data();
  glDeleteProgram(program);
  return 0;
}

// Goes through the samples as they lie in memory.
Image averaged(const std::vector<std::uint8_t>& rgba, int width, int height) {
  Image image(width, height);
  const auto columns = static_cast<std::size_t>(width);
  std::vector<std::uint16_t> sums(columns * 3);
  const std::uint8_t* in = rgba.data();
  for (int y = height - 1; y >= 0; --y) {
    std::fill(sums.begin(), sums.end(), std::uint16_t{0});
    for (int row = 0; row < kSamples; ++row) {
      std::uint16_t* sum = sums.data();
      for (std::size_t x = 0; x < columns; ++x, sum += 3) {
        for (int sample = 0; sample < kSamples; ++sample, in += 4) {
          for (int c = 0; c < 3; ++c) sum[c] = static_cast<std::uint16_t>(sum[c] + in[c]);
        }
      }
    }
    constexpr int kAll = kSamples * kSamples;
    std::transform(sums.begin(), sums.end(), image.pixel(0, y),
                   [](std::uint16_t sum) { return static_cast<std::uint8_t>((sum + kAll / 2) / kAll); });
  }
  return image;
}

}  // namespace shaken::render
